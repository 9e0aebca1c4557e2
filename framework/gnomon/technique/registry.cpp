#include "gnomon/technique/registry.h"

#include <fmt/format.h>

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
  std::map<std::string, std::filesystem::path> firstFile;
  std::set<std::filesystem::path> seenFiles;  // a folder may be named twice, or lie in another
  for (const auto& directory : directories) {
    std::error_code ignored;
    if (!std::filesystem::is_directory(directory, ignored)) {
      problems_.add(directory.string(), "",
                    "is not a folder; technique folders hold technique JSON files beside their libraries");
      continue;
    }
    for (const auto& path : jsonFiles(directory)) {
      if (!seenFiles.insert(std::filesystem::weakly_canonical(path, ignored)).second) continue;
      Problems found;
      const TechniqueFile file = readTechniqueFile(path, found);
      problems_.append(found);
      if (!found.empty()) continue;
      const std::filesystem::path library = path.parent_path() / (file.library + ".so");
      if (!std::filesystem::is_regular_file(library, ignored)) {
        problems_.add(
            path.string(), "/library",
            fmt::format("there is no {} beside this file; build the plugin, or correct the name", library.filename().string()));
        continue;
      }
      if (std::filesystem::is_symlink(library, ignored)) {
        problems_.add(path.string(), "/library",
                      fmt::format("{} is a symbolic link; libraries are never followed out of their folder",
                                  library.filename().string()));
        continue;
      }
      for (const TechniqueDeclaration& declaration : file.techniques) {
        const auto [first, isNew] = firstFile.emplace(declaration.name, path);
        if (!isNew) {
          sharedNames_.push_back({declaration.name, first->second, path});
          const Problem problem = problemOf(sharedNames_.back());
          problems_.add(problem.file, problem.pointer, problem.message);
          continue;
        }
        techniques_.push_back({declaration, path, library});
      }
    }
  }
  for (const SharedName& shared : sharedNames_)
    std::erase_if(techniques_, [&](const RegisteredTechnique& t) { return t.declaration.name == shared.name; });
  std::sort(techniques_.begin(), techniques_.end(),
            [](const auto& a, const auto& b) { return a.declaration.name < b.declaration.name; });
}

Problem Registry::problemOf(const SharedName& shared) {
  return {shared.other.string(), "/techniques/" + shared.name,
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
    const Problem problem = problemOf({shared.name, shared.other, shared.first});
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
  const std::filesystem::path& path = registered->library;
  const PluginEntries*& library = opened_[path];
  try {
    if (library == nullptr) library = &libraries_->open(path);
  } catch (const Error& error) {
    throw InputError({{registered->file.string(), "/library", error.what()}});
  }
  std::vector<std::string> offered;
  for (const Entry& entry : library->entries) {
    if (entry.name == registered->declaration.entry) return {registered, &entry};
    offered.push_back(entry.name);
  }
  std::string list;
  for (const std::string& o : offered) list += (list.empty() ? "" : ", ") + o;
  throw InputError(
      {{registered->file.string(), "/techniques/" + name + "/entry",
        fmt::format("{} has no entry '{}'; it has {}", path.filename().string(), registered->declaration.entry, list)}});
}

std::shared_ptr<void> Registry::parameters(const OpenTechnique& technique, const Json& overrides, const Location& where,
                                           Problems& problems) {
  std::shared_ptr<void> values = technique.entry->makeParameters();
  const RegisteredTechnique& registered = *technique.registered;
  const Json preset = Json::parse(registered.declaration.parametersJsonText, nullptr, false);
  if (preset.is_object()) {
    readObject(preset, *technique.entry->parameters, values.get(),
               {registered.file.string(), "/techniques/" + registered.declaration.name + "/parameters"}, problems);
  }
  if (!overrides.is_null()) readObject(overrides, *technique.entry->parameters, values.get(), where, problems);
  return values;
}

}  // namespace gnomon
