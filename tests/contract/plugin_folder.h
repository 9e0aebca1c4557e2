// Technique folders that tests damage: copies of the test plugins, changed before a registry sees them.
#pragma once

#include <filesystem>
#include <string>

#include "gnomon/base/error.h"
#include "temporary_folder.h"

namespace gnomon::test {

/// Where the build laid the plugins of tests/contract/plugins.
std::filesystem::path testPlugin(const std::string& name);

class PluginFolder {
 public:
  /// Copies the folder of a test plugin; its JSON, shaders and library keep their names.
  explicit PluginFolder(const std::string& plugin);

  const std::filesystem::path& path() const { return folder_.path(); }
  std::filesystem::path json() const { return folder_ / (plugin_ + ".json"); }
  std::filesystem::path library() const { return folder_ / (plugin_ + ".so"); }
  const TemporaryFolder& folder() const { return folder_; }

  void setJson(const std::string& text) const { folder_.write(plugin_ + ".json", text); }
  /// Keeps the first `bytes` of the library.
  void cutLibrary(std::size_t bytes) const;

 private:
  std::string plugin_;
  TemporaryFolder folder_;
};

/// Where code of the trace and no_note plugins says that it ran; the variable is unset again at the end.
class LoadTrace {
 public:
  LoadTrace();
  ~LoadTrace();
  LoadTrace(const LoadTrace&) = delete;
  LoadTrace& operator=(const LoadTrace&) = delete;
  bool left() const { return std::filesystem::exists(folder_ / "trace"); }

 private:
  TemporaryFolder folder_;
};

/// The lines of the problems, each of which must be one line.
std::vector<std::string> linesOf(const std::vector<Problem>& problems);

}  // namespace gnomon::test
