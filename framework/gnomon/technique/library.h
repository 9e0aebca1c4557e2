// Plugin libraries: each version of a file is loaded once and never unloaded.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "gnomon/base/files.h"
#include "gnomon/technique/compose.h"
#include "gnomon/technique/entry.h"

namespace gnomon {

/// Loaded plugin libraries, shared by registries that follow one another. Not for several threads at once.
///
/// A version is a path with the stamp of the file that lies there. A file that changed since this process loaded it is
/// loaded again from a private copy, beside the old version: both work, and neither sees the other's static variables.
/// A plugin must therefore not look for files from the path that its own code was loaded from.
class Libraries {
 public:
  /// When a private copy is loaded instead of the file itself.
  enum class Copies : std::uint8_t {
    whenChanged,  ///< only where this process holds another version of the file; the file must not be overwritten in place
    always        ///< so that a build may also overwrite files whose code is in use
  };

  explicit Libraries(Copies copies = Copies::whenChanged) : copies_(copies) {}
  Libraries(const Libraries&) = delete;
  Libraries& operator=(const Libraries&) = delete;

  /// The entries of the library as its file is now; they stay valid to the end of the process. Throws Error: no such file, a
  /// foreign ABI or a file cut short (its code was not run), a file that is being written, no entries. What failed is tried
  /// again at the next call.
  const PluginEntries& open(const std::filesystem::path& library);
  /// The entry that those components make; valid as long as this object, and the same one for the same three under a name.
  /// Throws Error: see composedEntry.
  const Entry& composed(const std::string& name, const Components& components);

 private:
  Copies copies_;
  std::map<std::pair<std::string, Components>, std::unique_ptr<const Entry>> composed_;
  std::map<std::pair<std::filesystem::path, FileStamp>, const PluginEntries*> opened_;
};

/// The ABI tag in the ELF note of a plugin, read from the file; empty when it has none. Throws Error for a file that is no
/// 64-bit ELF shared object, or is cut short.
std::string pluginAbiTag(const std::filesystem::path& library);
/// The same of a file's bytes; `name` is what errors call it.
std::string pluginAbiTag(const std::string& bytes, const std::string& name);
/// The tag that this framework accepts.
std::string frameworkAbiTag();

}  // namespace gnomon
