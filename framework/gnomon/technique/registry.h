// The registry: which techniques exist, by their JSON; their libraries are opened on first use.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gnomon/base/error.h"
#include "gnomon/base/json.h"
#include "gnomon/technique/entry.h"
#include "gnomon/technique/library.h"
#include "gnomon/technique/technique_file.h"

namespace gnomon {

/// A technique as its JSON file declares it.
struct RegisteredTechnique {
  TechniqueDeclaration declaration;
  std::filesystem::path file;     ///< the JSON
  std::filesystem::path library;  ///< the shared object beside it; empty where it is composed and its file has none
};

/// A component of map techniques, as its JSON file declares it.
struct RegisteredComponent {
  ComponentDeclaration declaration;
  std::filesystem::path file;
  std::filesystem::path library;
};

/// A technique with all that is needed to make and describe it: its library has been opened.
struct OpenTechnique {
  const RegisteredTechnique* registered = nullptr;      ///< the registry's, which outlives what was opened from it
  const Entry* entry = nullptr;                         ///< the library's: valid to the end of the process
  std::vector<std::filesystem::path> directories = {};  ///< of its shaders, the first to be searched first
  std::vector<std::filesystem::path> libraries = {};    ///< whose code it runs
};

/// The entry's defaults and the JSON file's preset. Faults of the preset go to `problems`.
std::shared_ptr<void> presetOf(const OpenTechnique& technique, Problems& problems);

/// What technique files said when it was made; files that change later need another registry. It outlives every OpenTechnique
/// that it gave, and the sessions that use them.
class Registry {
 public:
  /// Reads every *.json in `directories` and their direct sub-folders. Broken files become problems(); a name that two
  /// files register counts for neither. Registries with the same `libraries` load a library again only when its file changed;
  /// null: libraries of its own.
  explicit Registry(const std::vector<std::filesystem::path>& directories, std::shared_ptr<Libraries> libraries = {});
  Registry(const Registry&) = delete;
  Registry& operator=(const Registry&) = delete;

  const std::vector<RegisteredTechnique>& techniques() const { return techniques_; }
  const std::vector<RegisteredComponent>& components() const { return components_; }
  const Problems& problems() const { return problems_; }
  /// What speaks against that file: its own faults, and its names that other files register too.
  Problems problemsOf(const std::filesystem::path& file) const;
  std::vector<std::string> names() const;
  const RegisteredTechnique* find(const std::string& name) const;
  /// The one with that role, or null; the first by name where there are several.
  const RegisteredTechnique* withRole(TechniqueRole role) const;

  /// Opens the library, which this registry then keeps as it was. Throws InputError: unknown name (with the nearest), missing
  /// or half-written library, foreign ABI (its code was not run), no such entry.
  OpenTechnique open(const std::string& name);

  /// Components that could stand in the place of a composed technique's own on that axis. Throws InputError where the other
  /// two cannot be had.
  std::vector<std::string> admissible(const RegisteredTechnique& composed, Axis axis);

  /// Defaults, then the JSON file's preset, then `overrides`. Faults go to `problems` under `where`.
  std::shared_ptr<void> parameters(const OpenTechnique& technique, const Json& overrides, const Location& where,
                                   Problems& problems);

 private:
  struct SharedName {
    std::string kind, name;              ///< "techniques" or "components"
    std::filesystem::path first, other;  ///< files that register it
  };
  static Problem problemOf(const SharedName& shared);
  void addFile(const std::filesystem::path& path, std::map<std::string, std::filesystem::path>& firstFile);
  /// Throws InputError at `pointer` of `file`.
  const PluginEntries& openLibrary(const std::filesystem::path& library, const std::filesystem::path& file,
                                   const std::string& pointer);
  OpenTechnique openComposed(const RegisteredTechnique& registered);
  /// Throws InputError at `where`, with the names that there are.
  const RegisteredComponent& component(const std::string& name, Axis axis, const Location& where) const;
  const Component& openComponent(const RegisteredComponent& registered);

  std::shared_ptr<Libraries> libraries_;
  std::vector<RegisteredTechnique> techniques_;
  std::vector<RegisteredComponent> components_;
  Problems problems_;
  std::vector<SharedName> sharedNames_;
  std::map<std::filesystem::path, const PluginEntries*> opened_;  ///< by library
};

}  // namespace gnomon
