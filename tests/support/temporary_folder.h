// A folder of a test's own, gone with the test, and what tests do with files in it.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <string>

#include "gnomon/base/error.h"
#include "gnomon/base/files.h"

namespace gnomon::test {

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "gnomon-test-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw Error("no folder can be made under " + name);
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  /// Writes a file, with the folders it lies in; returns its path.
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    writeFileAtomically(path_ / name, text);
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace gnomon::test
