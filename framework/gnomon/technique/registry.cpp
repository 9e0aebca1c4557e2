#include "gnomon/technique/registry.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "gnomon/base/files.h"
#include "gnomon/technique/plugin_note.h"

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

struct Registry::Library {
  void* handle = nullptr;
  const PluginEntries* entries = nullptr;
};

Registry::Registry(const std::vector<std::filesystem::path>& directories) {
  std::map<std::string, std::filesystem::path> firstFile;
  std::set<std::string> twice;
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
          twice.insert(declaration.name);
          problems_.add(path.string(), "/techniques/" + declaration.name,
                        fmt::format("'{}' is registered by {} too; neither counts until one is renamed", declaration.name,
                                    first->second.string()));
          continue;
        }
        techniques_.push_back({declaration, path, library});
      }
    }
  }
  std::erase_if(techniques_, [&](const RegisteredTechnique& t) { return twice.contains(t.declaration.name); });
  std::sort(techniques_.begin(), techniques_.end(),
            [](const auto& a, const auto& b) { return a.declaration.name < b.declaration.name; });
}

// Libraries stay open until the process ends: unloading one whose code or type infos are still referenced would crash.
Registry::~Registry() = default;

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
  const auto fail = [&](const std::string& message) { throw InputError({{registered->file.string(), "/library", message}}); };
  std::unique_ptr<Library>& library = libraries_[path];
  if (!library) {
    std::string tag;
    try {
      tag = pluginAbiTag(path);
    } catch (const Error& error) {
      fail(error.what());
    }
    if (tag != frameworkAbiTag()) {
      fail(fmt::format(
          "{} was built for another framework: its tag is '{}', this one's is '{}'; rebuild it. None of its code was run",
          path.filename().string(), tag.empty() ? "none" : tag, frameworkAbiTag()));
    }
    auto opened = std::make_unique<Library>();
    opened->handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (opened->handle == nullptr) fail(fmt::format("cannot be loaded: {}", dlerror()));
    using Function = const PluginEntries* (*)();
    const auto function = reinterpret_cast<Function>(dlsym(opened->handle, "gnomon_plugin"));
    if (function == nullptr) fail(path.filename().string() + " does not export gnomon_plugin; end it with GNOMON_PLUGIN(...)");
    opened->entries = function();
    library = std::move(opened);
  }
  std::vector<std::string> offered;
  for (const Entry& entry : library->entries->entries) {
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
