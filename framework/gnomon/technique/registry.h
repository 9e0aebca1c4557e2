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
#include "gnomon/technique/technique_file.h"

namespace gnomon {

/// A technique as its JSON file declares it.
struct RegisteredTechnique {
  TechniqueDeclaration declaration;
  std::filesystem::path file;     ///< the JSON
  std::filesystem::path library;  ///< the shared object beside it
};

/// A technique with all that is needed to make and describe it: its library has been opened.
struct OpenTechnique {
  const RegisteredTechnique* registered = nullptr;
  const Entry* entry = nullptr;
};

class Registry {
 public:
  /// Reads every *.json in `directories` and their direct sub-folders. Broken files become problems(); a name that two
  /// files register counts for neither.
  explicit Registry(const std::vector<std::filesystem::path>& directories);
  ~Registry();
  Registry(const Registry&) = delete;
  Registry& operator=(const Registry&) = delete;

  const std::vector<RegisteredTechnique>& techniques() const { return techniques_; }
  const Problems& problems() const { return problems_; }
  std::vector<std::string> names() const;
  const RegisteredTechnique* find(const std::string& name) const;
  /// The one with that role, or null; the first by name where there are several.
  const RegisteredTechnique* withRole(TechniqueRole role) const;

  /// Opens the library. Throws InputError: unknown name (with the nearest), missing library, foreign ABI (its code was not
  /// run), no such entry.
  OpenTechnique open(const std::string& name);

  /// Defaults, then the JSON file's preset, then `overrides`. Faults go to `problems` under `where`.
  std::shared_ptr<void> parameters(const OpenTechnique& technique, const Json& overrides, const Location& where,
                                   Problems& problems);

  /// Folder of the technique's shaders.
  static std::filesystem::path directory(const RegisteredTechnique& technique) { return technique.file.parent_path(); }

 private:
  struct Library;
  std::vector<RegisteredTechnique> techniques_;
  Problems problems_;
  std::map<std::filesystem::path, std::unique_ptr<Library>> libraries_;
};

/// The ABI tag in the ELF note of a plugin, read from the file; empty when it has none. Throws Error for a file that is no
/// 64-bit ELF shared object, or is cut short.
std::string pluginAbiTag(const std::filesystem::path& library);
/// The tag that this framework accepts.
std::string frameworkAbiTag();

}  // namespace gnomon
