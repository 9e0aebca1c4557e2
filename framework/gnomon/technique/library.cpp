#include "gnomon/technique/library.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <stdlib.h>

#include <atomic>
#include <fstream>
#include <mutex>

#include "gnomon/base/error.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

/// Only for this user, and gone with all that is in it.
class PrivateFolder {
 public:
  PrivateFolder() {
    std::string name = (fs::temp_directory_path() / "gnomon-plugin-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw Error(name + ": a folder for a library's copy cannot be made");
    path_ = name;
  }
  ~PrivateFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// dlopen knows files by their names and returns what it once loaded under one, so that only the first version of a path can
/// come from there. That holds for the process, whoever loads.
bool isFirstVersion(const fs::path& path, const FileStamp& stamp) {
  static std::mutex mutex;
  static std::map<fs::path, FileStamp> first;
  const std::lock_guard lock(mutex);
  return first.emplace(path, stamp).first->second == stamp;
}

void* load(const fs::path& file, const std::string& name, const std::string& advice = "") {
  void* const handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) throw Error(fmt::format("{} cannot be loaded: {}{}", name, dlerror(), advice));
  return handle;
}

/// The mapping outlives the file: the copy is deleted before its code is used, and a crash leaves nothing behind.
void* loadCopy(const std::string& bytes, const std::string& name) {
  static std::atomic<unsigned> serial = 0;  // a folder's random name might come again, and dlopen remembers names
  const PrivateFolder folder;
  const fs::path copy = folder.path() / fmt::format("{}.{}", ++serial, name);
  std::ofstream out(copy, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) throw Error(fmt::format("{}: cannot be written; libraries are copied there before they are loaded", copy.string()));
  return load(copy, name, "; it was loaded from a copy in the folder for temporary files ($TMPDIR), which must allow that");
}

const PluginEntries& entriesOf(void* handle, const std::string& name) {
  using Function = const PluginEntries* (*)();
  const auto function = reinterpret_cast<Function>(dlsym(handle, "gnomon_plugin"));
  if (function == nullptr) throw Error(name + " does not export gnomon_plugin; end it with GNOMON_PLUGIN(...)");
  try {
    if (const PluginEntries* entries = function()) return *entries;
  } catch (const std::exception& error) {
    throw Error(fmt::format("{}: gnomon_plugin failed: {}", name, error.what()));
  } catch (...) {
    throw Error(name + ": gnomon_plugin failed with what is no std::exception");
  }
  throw Error(name + ": gnomon_plugin returned no entries; end it with GNOMON_PLUGIN(...)");
}

}  // namespace

const PluginEntries& Libraries::open(const fs::path& library) {
  std::error_code code;
  const fs::path path = fs::canonical(library, code);
  const std::optional<FileStamp> stamp = fileStamp(path);
  if (!stamp) throw Error(library.string() + ": no such file");
  const auto known = opened_.find({path, *stamp});
  if (known != opened_.end()) return *known->second;

  const std::string name = path.filename().string();
  const std::string bytes = readFile(path);
  if (fileStamp(path) != stamp) throw Error(name + " is being written; try again when it is complete");
  const std::string tag = pluginAbiTag(bytes, library.string());
  if (tag != frameworkAbiTag()) {
    throw Error(fmt::format(
        "{} was built for another framework: its tag is '{}', this one's is '{}'; rebuild it. None of its code was run", name,
        tag.empty() ? "none" : tag, frameworkAbiTag()));
  }
  const bool inPlace = copies_ == Copies::whenChanged && isFirstVersion(path, *stamp);
  void* const handle =
      inPlace ? load(path, name) : loadCopy(bytes, name);  // never closed: instances and type infos refer to it
  const PluginEntries& entries = entriesOf(handle, name);
  opened_.emplace(std::pair(path, *stamp), &entries);
  return entries;
}

const Entry& Libraries::composed(const std::string& name, const Components& components) {
  std::unique_ptr<const Entry>& entry = composed_[{name, components}];
  if (!entry) entry = std::make_unique<const Entry>(composedEntry(name, components));
  return *entry;
}

}  // namespace gnomon
