#include "gnomon/base/watch.h"

#include <deque>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

namespace gnomon {
namespace {

namespace fs = std::filesystem;

std::optional<FileStamp> stampIn(const std::map<fs::path, FileStamp>& stamps, const fs::path& path) {
  const auto found = stamps.find(path);
  return found == stamps.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace

FileWatch::Stamps FileWatch::look(const fs::path& fileOrFolder) {
  Stamps stamps;
  if (const std::optional<FileStamp> stamp = fileStamp(fileOrFolder)) {
    stamps.emplace(fileOrFolder, *stamp);
    return stamps;
  }
  // Breadth first: where the bound cuts, what lies nearest has been seen.
  std::deque<std::pair<fs::path, int>> folders{{fileOrFolder, 0}};
  std::size_t entries = 0;
  for (; !folders.empty(); folders.pop_front()) {
    const auto& [folder, depth] = folders.front();
    std::error_code code;  // a folder that vanished or may not be read is as one without entries
    for (auto item = fs::directory_iterator(folder, code); !code && item != fs::directory_iterator(); item.increment(code)) {
      if (++entries > kMostEntries) return stamps;
      if (item->path().filename().native().front() == '.') continue;
      std::error_code ignored;
      if (item->is_directory(ignored)) {
        if (depth < kDeepest && !item->is_symlink(ignored)) folders.emplace_back(item->path(), depth + 1);
      } else if (const std::optional<FileStamp> stamp = fileStamp(item->path())) {
        stamps.emplace(item->path(), *stamp);
      }
    }
  }
  return stamps;
}

void FileWatch::watch(const std::vector<fs::path>& filesAndFolders) {
  std::map<fs::path, Watched> watched;
  for (const fs::path& path : filesAndFolders) {
    if (const auto before = watched_.find(path); before != watched_.end()) {
      watched.emplace(path, before->second);
    } else {
      const Stamps now = look(path);
      watched.emplace(path, Watched{now, now});
    }
  }
  watched_ = std::move(watched);
}

std::vector<fs::path> FileWatch::changes() {
  std::set<fs::path> changed;  // folders may overlap
  for (auto& [path, watched] : watched_) {
    Stamps now = look(path);
    Stamps all = now;  // and those that vanished
    all.insert(watched.reported.begin(), watched.reported.end());
    for (const auto& [file, any] : all) {
      const std::optional<FileStamp> stamp = stampIn(now, file);
      if (stamp == stampIn(watched.reported, file) || stamp != stampIn(watched.lastSeen, file)) continue;
      changed.insert(file);
      if (stamp)
        watched.reported.insert_or_assign(file, *stamp);
      else
        watched.reported.erase(file);
    }
    watched.lastSeen = std::move(now);
  }
  return {changed.begin(), changed.end()};
}

}  // namespace gnomon
