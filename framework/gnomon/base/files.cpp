#include "gnomon/base/files.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

// The hash is compiled in: with XXH_INLINE_ALL its vector code is chosen here and nothing has to be linked.
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <random>
#include <system_error>

#include "gnomon/base/error.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& what, int code) {
  throw Error(fmt::format("{}: {}: {}", path.string(), what, std::generic_category().message(code)));
}

/// An open file; closes itself.
class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags, const std::string& what)
      : path_(path), fd_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {
    if (fd_ < 0) fail(path, what, errno);
  }
  ~Descriptor() { ::close(fd_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  /// Waits until no other process holds it; held until the descriptor closes.
  void lock() const {
    while (::flock(fd_, LOCK_EX) != 0) {
      if (errno != EINTR) fail(path_, "cannot lock", errno);
    }
  }

  std::size_t read(char* to, std::size_t size) const {
    while (true) {
      const ssize_t got = ::read(fd_, to, size);
      if (got >= 0) return static_cast<std::size_t>(got);
      if (errno != EINTR) fail(path_, "cannot read", errno);
    }
  }
  std::size_t readAt(off_t offset, char* to, std::size_t size) const {
    const ssize_t got = ::pread(fd_, to, size, offset);
    if (got < 0) fail(path_, "cannot read", errno);
    return static_cast<std::size_t>(got);
  }
  void write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t put = ::write(fd_, bytes.data(), bytes.size());
      if (put < 0 && errno != EINTR) fail(path_, "cannot write", errno);
      if (put > 0) bytes.remove_prefix(static_cast<std::size_t>(put));
    }
  }
  void sync() const {
    // EINVAL: not a thing that can be synced (a pipe, some folders on network file systems).
    if (::fsync(fd_) != 0 && errno != EINVAL) fail(path_, "cannot sync", errno);
  }
  off_t size() const {
    struct stat info {};
    if (::fstat(fd_, &info) != 0) fail(path_, "cannot look at", errno);
    return info.st_size;
  }
  void truncate(off_t size) const {
    if (::ftruncate(fd_, size) != 0) fail(path_, "cannot cut a torn line", errno);
  }

 private:
  fs::path path_;
  int fd_;
};

fs::path folderOf(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

void makeFolder(const fs::path& folder) {
  std::error_code code;
  fs::create_directories(folder, code);
  if (code) throw Error(fmt::format("{}: cannot create the folder: {}", folder.string(), code.message()));
}

void syncFolder(const fs::path& folder) {
  Descriptor(folder, O_RDONLY | O_DIRECTORY, "cannot open the folder").sync();
}

/// A name beside `path` that no other process, thread or machine uses, with the same extension.
fs::path temporaryName(const fs::path& path) {
  static const unsigned token = std::random_device()();
  static std::atomic<unsigned> serial = 0;
  const std::string name =
      fmt::format(".{}.{}-{:08x}-{}.tmp{}", path.stem().string(), ::getpid(), token, serial++, path.extension().string());
  return folderOf(path) / name;
}

/// Where the last whole line of the file ends.
off_t endOfWholeLines(const Descriptor& file) {
  off_t end = file.size();
  std::array<char, 4096> block{};
  while (end > 0) {
    const off_t start = std::max<off_t>(0, end - static_cast<off_t>(block.size()));
    const std::size_t got = file.readAt(start, block.data(), static_cast<std::size_t>(end - start));
    const std::size_t newline = std::string_view(block.data(), got).rfind('\n');
    if (newline != std::string_view::npos) return start + static_cast<off_t>(newline) + 1;
    end = start;
  }
  return 0;
}

}  // namespace

std::string readFile(const fs::path& path) {
  const Descriptor file(path, O_RDONLY, "cannot open");
  std::string bytes;
  std::size_t filled = 0;
  while (true) {
    constexpr std::size_t kStep = 1 << 16;
    bytes.resize(std::max<std::size_t>(filled + kStep, static_cast<std::size_t>(file.size()) + 1));
    const std::size_t got = file.read(bytes.data() + filled, bytes.size() - filled);
    filled += got;
    if (got == 0) break;
  }
  bytes.resize(filled);
  return bytes;
}

std::optional<FileStamp> fileStamp(const fs::path& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return {};
  return FileStamp{std::int64_t{info.st_mtim.tv_sec} * 1'000'000'000 + info.st_mtim.tv_nsec,
                   static_cast<std::uint64_t>(info.st_size), info.st_ino};
}

void replaceFileAtomically(const fs::path& path, const std::function<void(const fs::path&)>& write) {
  makeFolder(folderOf(path));
  const fs::path temporary = temporaryName(path);
  try {
    write(temporary);
    Descriptor(temporary, O_RDONLY, "cannot open again").sync();
    std::error_code code;
    fs::rename(temporary, path, code);
    if (code) throw Error(fmt::format("{}: cannot be replaced: {}", path.string(), code.message()));
  } catch (...) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw;
  }
  syncFolder(folderOf(path));
}

void writeFileAtomically(const fs::path& path, std::string_view bytes) {
  replaceFileAtomically(path, [&](const fs::path& temporary) {
    Descriptor(temporary, O_WRONLY | O_CREAT | O_EXCL, "cannot create").write(bytes);
  });
}

void appendLineSynced(const fs::path& path, std::string_view line) {
  if (line.find('\n') != std::string_view::npos) throw Error(path.string() + ": a line to append holds a line break");
  makeFolder(folderOf(path));
  const bool isNew = !fs::exists(path);
  const Descriptor file(path, O_RDWR | O_CREAT | O_APPEND, "cannot open");
  file.lock();  // another process's append must not look like a torn tail
  const off_t whole = endOfWholeLines(file);
  if (whole != file.size()) file.truncate(whole);
  file.write(std::string(line) + '\n');
  file.sync();
  if (isNew) syncFolder(folderOf(path));
}

std::string hashHex(std::string_view bytes) {
  XXH128_canonical_t digits;
  XXH128_canonicalFromHash(&digits, XXH3_128bits(bytes.data(), bytes.size()));
  return fmt::format("{:02x}", fmt::join(digits.digest, ""));
}

std::string hashHex(std::span<const std::byte> bytes) {
  return hashHex(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

fs::path installationDirectory() {
  Dl_info info{};
  const auto here = reinterpret_cast<const void*>(static_cast<fs::path (*)()>(&installationDirectory));
  if (::dladdr(here, &info) == 0 || info.dli_fname == nullptr) throw Error("the system does not say where libgnomon lies");
  const fs::path folder = fs::canonical(info.dli_fname).parent_path() / "gnomon";
  if (!fs::is_directory(folder)) {
    throw Error(fmt::format("{}: no such folder; shaders and plugins are looked for there, beside libgnomon", folder.string()));
  }
  return folder;
}

fs::path cacheDirectory() {
  const auto absolute = [](const char* variable) {
    const char* value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): nobody sets the environment here
    const fs::path path = value != nullptr ? value : "";
    return path.is_absolute() ? path : fs::path();  // relative ones are to be ignored (XDG base directory specification)
  };
  if (const fs::path cache = absolute("XDG_CACHE_HOME"); !cache.empty()) return cache / "gnomon";
  if (const fs::path home = absolute("HOME"); !home.empty()) return home / ".cache" / "gnomon";
  return fs::temp_directory_path() / fmt::format("gnomon-{}", ::getuid());
}

}  // namespace gnomon
