#include "gnomon/technique/registry.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

namespace gnomon {

namespace {

std::vector<std::filesystem::path> jsonFiles(const std::filesystem::path& directory) {
  std::vector<std::filesystem::path> files;
  std::error_code ignored;
  const auto take = [&](const std::filesystem::path& folder) {
    for (const auto& item : std::filesystem::directory_iterator(folder, ignored)) {
      if (item.path().extension() == ".json" && item.is_regular_file(ignored)) files.push_back(item.path());
    }
  };
  take(directory);
  for (const auto& item : std::filesystem::directory_iterator(directory, ignored)) {
    if (item.is_directory(ignored) && !item.is_symlink(ignored)) take(item.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

Registry::Registry(const std::vector<std::filesystem::path>& directories, std::shared_ptr<Libraries> libraries)
    : libraries_(libraries ? std::move(libraries) : std::make_shared<Libraries>()) {
  std::map<std::string, std::filesystem::path> firstFile;  // by kind and name
  std::set<std::filesystem::path> seenFiles;               // a folder may be named twice, or lie in another
  for (const auto& directory : directories) {
    std::error_code ignored;
    if (!std::filesystem::is_directory(directory, ignored)) {
      problems_.add(directory.string(), "",
                    "is not a folder; technique folders hold technique JSON files beside their libraries");
      continue;
    }
    for (const auto& path : jsonFiles(directory)) {
      if (seenFiles.insert(std::filesystem::weakly_canonical(path, ignored)).second) addFile(path, firstFile);
    }
  }
  for (const SharedName& shared : sharedNames_) {
    std::erase_if(techniques_, [&](const auto& t) { return shared.kind == "techniques" && t.declaration.name == shared.name; });
    std::erase_if(components_, [&](const auto& c) { return shared.kind == "components" && c.declaration.name == shared.name; });
  }
  const auto byName = [](const auto& a, const auto& b) { return a.declaration.name < b.declaration.name; };
  std::sort(techniques_.begin(), techniques_.end(), byName);
  std::sort(components_.begin(), components_.end(), byName);
}

void Registry::addFile(const std::filesystem::path& path, std::map<std::string, std::filesystem::path>& firstFile) {
  Problems found;
  const TechniqueFile file = readTechniqueFile(path, found);
  problems_.append(found);
  if (!found.empty()) return;
  std::error_code ignored;
  const std::filesystem::path library =
      file.library.empty() ? std::filesystem::path() : path.parent_path() / (file.library + ".so");
  if (!library.empty() && !std::filesystem::is_regular_file(library, ignored)) {
    return problems_.add(
        path.string(), "/library",
        fmt::format("there is no {} beside this file; build the plugin, or correct the name", library.filename().string()));
  }
  if (std::filesystem::is_symlink(library, ignored)) {
    return problems_.add(
        path.string(), "/library",
        fmt::format("{} is a symbolic link; libraries are never followed out of their folder", library.filename().string()));
  }
  const auto isNew = [&](const std::string& kind, const std::string& name) {
    const auto [first, fresh] = firstFile.emplace(kind + "/" + name, path);
    if (fresh) return true;
    sharedNames_.push_back({kind, name, first->second, path});
    const Problem problem = problemOf(sharedNames_.back());
    problems_.add(problem.file, problem.pointer, problem.message);
    return false;
  };
  for (const TechniqueDeclaration& declaration : file.techniques) {
    if (isNew("techniques", declaration.name)) techniques_.push_back({declaration, path, library});
  }
  for (const ComponentDeclaration& declaration : file.components) {
    if (isNew("components", declaration.name)) components_.push_back({declaration, path, library});
  }
}

Problem Registry::problemOf(const SharedName& shared) {
  return {shared.other.string(), "/" + shared.kind + "/" + shared.name,
          fmt::format("'{}' is registered by {} too; neither counts until one is renamed", shared.name, shared.first.string())};
}

Problems Registry::problemsOf(const std::filesystem::path& file) const {
  const auto isIt = [&](const std::filesystem::path& other) {
    std::error_code ignored;
    return std::filesystem::equivalent(file, other, ignored);
  };
  Problems found;
  for (const Problem& problem : problems_.list()) {
    if (isIt(problem.file)) found.add(problem.file, problem.pointer, problem.message);
  }
  for (const SharedName& shared : sharedNames_) {  // told above for the second file alone
    if (!isIt(shared.first)) continue;
    const Problem problem = problemOf({shared.kind, shared.name, shared.other, shared.first});
    found.add(problem.file, problem.pointer, problem.message);
  }
  return found;
}

std::vector<std::string> Registry::names() const {
  std::vector<std::string> names;
  for (const RegisteredTechnique& t : techniques_) names.push_back(t.declaration.name);
  return names;
}

const RegisteredTechnique* Registry::find(const std::string& name) const {
  for (const RegisteredTechnique& t : techniques_) {
    if (t.declaration.name == name) return &t;
  }
  return nullptr;
}

const RegisteredTechnique* Registry::withRole(TechniqueRole role) const {
  for (const RegisteredTechnique& t : techniques_) {
    if (t.declaration.role == role) return &t;
  }
  return nullptr;
}

OpenTechnique Registry::open(const std::string& name) {
  const RegisteredTechnique* registered = find(name);
  if (registered == nullptr) {
    // The file that should register it may be broken: its own problem says more than "unknown".
    std::vector<Problem> related;
    for (const Problem& problem : problems_.list()) {
      const bool names =
          problem.pointer == "/techniques/" + name || problem.file.find("/" + name + ".json") != std::string::npos;
      if (names) related.push_back(problem);
    }
    if (!related.empty()) throw InputError(related);
    const std::string nearest = nearestName(name, names());
    throw InputError(
        {{"", "",
          fmt::format("no technique is registered as '{}'{}", name,
                      nearest.empty() ? "; `gnomon list` shows those that are" : "; did you mean '" + nearest + "'?")}});
  }
  if (registered->declaration.compose) return openComposed(*registered);
  const PluginEntries& library = openLibrary(registered->library, registered->file, "/library");
  std::vector<std::string> offered;
  for (const Entry& entry : library.entries) {
    if (entry.name == registered->declaration.entry)
      return {registered, &entry, {registered->file.parent_path()}, {registered->library}};
    offered.push_back(entry.name);
  }
  std::string list;
  for (const std::string& o : offered) list += (list.empty() ? "" : ", ") + o;
  throw InputError({{registered->file.string(), "/techniques/" + name + "/entry",
                     fmt::format("{} has no entry '{}'; it has {}", registered->library.filename().string(),
                                 registered->declaration.entry, list)}});
}

const PluginEntries& Registry::openLibrary(const std::filesystem::path& library, const std::filesystem::path& file,
                                           const std::string& pointer) {
  const PluginEntries*& opened = opened_[library];
  try {
    if (opened == nullptr) opened = &libraries_->open(library);
  } catch (const Error& error) {
    throw InputError({{file.string(), pointer, error.what()}});
  }
  return *opened;
}

const RegisteredComponent& Registry::component(const std::string& name, Axis axis, const Location& where) const {
  std::vector<std::string> names;
  std::string elsewhere;
  for (const RegisteredComponent& c : components_) {
    if (c.declaration.axis == axis) {
      if (c.declaration.name == name) return c;
      names.push_back(c.declaration.name);
    } else if (c.declaration.name == name) {
      elsewhere = fmt::format(" ({0} is a {1})", name, axisName(c.declaration.axis));
    }
  }
  const std::string nearest = elsewhere.empty() ? nearestName(name, names) : "";
  throw InputError({{where.file, where.pointer,
                     fmt::format("no {} is registered as '{}'{}; {}there {}", axisName(axis), name, elsewhere,
                                 nearest.empty() ? "" : fmt::format("did you mean '{}'? ", nearest),
                                 names.empty() ? "are none" : fmt::format("are {}", fmt::join(names, ", ")))}});
}

const Component& Registry::openComponent(const RegisteredComponent& registered) {
  const auto& [name, title, axis] = registered.declaration;
  for (const Component& component : openLibrary(registered.library, registered.file, "/library").components) {
    if (component.name == name && component.axis() == axis) return component;
  }
  throw InputError({{registered.file.string(), "/components/" + name,
                     fmt::format("{} has no {} '{}'", registered.library.filename().string(), axisName(axis), name)}});
}

OpenTechnique Registry::openComposed(const RegisteredTechnique& registered) {
  const TechniqueDeclaration& declaration = registered.declaration;
  const Location where{registered.file.string(), "/techniques/" + declaration.name + "/compose"};
  OpenTechnique opened{&registered, nullptr, {registered.file.parent_path()}, {}};
  Components components{};
  Problems problems;  // of all three
  for (const Axis axis : kAxes) {
    try {
      const RegisteredComponent& found = component(declaration.compose->of(axis), axis, where.child(axisName(axis)));
      components[static_cast<std::size_t>(axis)] = &openComponent(found);
      opened.directories.push_back(found.file.parent_path());
      opened.libraries.push_back(found.library);
    } catch (const InputError& error) {
      for (const Problem& p : error.problems()) problems.add(p.file, p.pointer, p.message);
    }
  }
  problems.throwIfAny();
  try {
    opened.entry = &libraries_->composed(declaration.name, components);
  } catch (const Error& error) {
    throw InputError({{where.file, where.pointer, error.what()}});
  }
  return opened;
}

std::vector<std::string> Registry::admissible(const RegisteredTechnique& composed, Axis axis) {
  Components components{};
  for (const Axis other : kAxes) {
    if (other != axis)
      components[static_cast<std::size_t>(other)] =
          &openComponent(component(composed.declaration.compose->of(other), other, {}));
  }
  std::vector<std::string> names;
  for (const RegisteredComponent& candidate : components_) {
    if (candidate.declaration.axis != axis) continue;
    try {
      components[static_cast<std::size_t>(axis)] = &openComponent(candidate);
      composedEntry(composed.declaration.name, components);
      names.push_back(candidate.declaration.name);
    } catch (const Error&) {
      continue;  // it cannot be had, or makes no sense with the others
    }
  }
  return names;
}

std::shared_ptr<void> presetOf(const OpenTechnique& technique, Problems& problems) {
  std::shared_ptr<void> values = technique.entry->makeParameters();
  const RegisteredTechnique& registered = *technique.registered;
  const Json preset = Json::parse(registered.declaration.parametersJsonText, nullptr, false);
  if (preset.is_object()) {
    readObject(preset, *technique.entry->parameters, values.get(),
               {registered.file.string(), "/techniques/" + registered.declaration.name + "/parameters"}, problems);
  }
  return values;
}

std::shared_ptr<void> Registry::parameters(const OpenTechnique& technique, const Json& overrides, const Location& where,
                                           Problems& problems) {
  std::shared_ptr<void> values = presetOf(technique, problems);
  if (!overrides.is_null()) readObject(overrides, *technique.entry->parameters, values.get(), where, problems);
  return values;
}

}  // namespace gnomon
