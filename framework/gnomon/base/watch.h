// Which files changed since somebody last asked.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <vector>

#include "gnomon/base/files.h"

namespace gnomon {

/// Looks at files and folders when asked, from one thread and at a steady beat, such as twice a second: what counts as still
/// is what two looks in a row see alike.
class FileWatch {
 public:
  /// Bounds of one look into one folder, so that any folder may be given: deeper and further entries are not seen.
  static constexpr int kDeepest = 4;  ///< levels of folders below the one given
  static constexpr std::size_t kMostEntries = 4096;

  /// Replaces what is watched. Changes count from here; for what was watched before they go on counting. Paths need not
  /// exist yet. Folders are watched at any depth within the bounds, except links to folders and names that begin with a dot
  /// (temporary files of editors and writers, version control).
  void watch(const std::vector<std::filesystem::path>& filesAndFolders);

  /// Files that appeared, vanished or changed since they were last reported (time, size, another file in their place) and
  /// are still: a file that differs from the last look waits for the next. Each once, sorted, spelled as the paths given.
  std::vector<std::filesystem::path> changes();

 private:
  using Stamps = std::map<std::filesystem::path, FileStamp>;
  struct Watched {
    Stamps reported;  ///< as the caller knows them
    Stamps lastSeen;
  };
  static Stamps look(const std::filesystem::path& fileOrFolder);

  std::map<std::filesystem::path, Watched> watched_;  ///< by the path given
};

}  // namespace gnomon
