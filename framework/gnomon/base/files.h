// Files: whole reads, atomic writes, synced appends, hashes, and where the installation lies.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace gnomon {

/// The whole file. Throws Error that names the path and the system's reason.
std::string readFile(const std::filesystem::path& path);

/// Writes to a temporary name beside `path`, syncs, renames, syncs the folder: a reader sees the old file or the new one.
/// Creates missing folders. Throws Error.
void writeFileAtomically(const std::filesystem::path& path, std::string_view bytes);

/// Appends `line` and a newline in one write and syncs it. A torn last line of an earlier crash is cut first. Throws Error.
void appendLineSynced(const std::filesystem::path& path, std::string_view line);

/// 128-bit hash as 32 hexadecimal digits (XXH3; not cryptographic).
std::string hashHex(std::string_view bytes);
std::string hashHex(std::span<const std::byte> bytes);

/// Folder that holds shaders/ and plugins/: found from where libgnomon itself lies.
std::filesystem::path installationDirectory();

/// $XDG_CACHE_HOME/gnomon, else ~/.cache/gnomon, else a folder under the system's temporary one.
std::filesystem::path cacheDirectory();

}  // namespace gnomon
