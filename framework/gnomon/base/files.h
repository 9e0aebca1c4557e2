// Files: whole reads, atomic writes, synced appends, hashes, and where the installation lies.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace gnomon {

/// The whole file. Throws Error that names the path and the system's reason.
std::string readFile(const std::filesystem::path& path);

/// What tells one version of a file from the next: time and size, and the inode where another file took its place.
struct FileStamp {
  std::int64_t changedNanoseconds = 0;  ///< of the last write, since 1970
  std::uint64_t bytes = 0;
  std::uint64_t inode = 0;

  auto operator<=>(const FileStamp&) const = default;
};

/// None where there is no regular file (links are followed).
std::optional<FileStamp> fileStamp(const std::filesystem::path& path);

/// Writes to a temporary name beside `path`, syncs, renames, syncs the folder: a reader sees the old file or the new one.
/// Creates missing folders. Throws Error.
void writeFileAtomically(const std::filesystem::path& path, std::string_view bytes);

/// The same for a writer that wants a path: calls `write` with a temporary name that has the extension of `path`.
void replaceFileAtomically(const std::filesystem::path& path,
                           const std::function<void(const std::filesystem::path& temporary)>& write);

/// Appends `line` and a newline in one write and syncs it. A torn last line of an earlier crash is cut first.
/// One writer a file. Throws Error, also if `line` holds a line break.
void appendLineSynced(const std::filesystem::path& path, std::string_view line);

/// 128-bit hash as 32 hexadecimal digits (XXH3; not cryptographic).
std::string hashHex(std::string_view bytes);
std::string hashHex(std::span<const std::byte> bytes);

/// Folder that holds shaders/ and plugins/: gnomon/ beside libgnomon itself. Throws Error if there is none.
std::filesystem::path installationDirectory();

/// $XDG_CACHE_HOME/gnomon, else ~/.cache/gnomon, else a folder under the system's temporary one.
std::filesystem::path cacheDirectory();

}  // namespace gnomon
