#include "source_tree.h"

#include <algorithm>

#include "gnomon/base/error.h"
#include "gnomon/base/files.h"

namespace gnomon::test {

std::vector<SourceFile> sourceFiles(const std::vector<std::string>& folders, const std::vector<std::string>& endings) {
  const std::filesystem::path root = GNOMON_SOURCE_DIR;
  std::vector<SourceFile> files;
  for (const std::string& folder : folders) {
    if (!std::filesystem::exists(root / folder)) throw Error("the source tree has no " + folder);
    const auto take = [&](const std::filesystem::path& path) {
      const std::string name = path.filename().string();
      const bool wanted =
          std::any_of(endings.begin(), endings.end(), [&](const std::string& ending) { return name.ends_with(ending); });
      if (wanted) files.push_back({path.lexically_relative(root).generic_string(), readFile(path)});
    };
    if (std::filesystem::is_regular_file(root / folder)) take(root / folder);
    if (!std::filesystem::is_directory(root / folder)) continue;
    for (const auto& item : std::filesystem::recursive_directory_iterator(root / folder)) {
      if (item.is_regular_file()) take(item.path());
    }
  }
  std::sort(files.begin(), files.end(), [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return files;
}

const std::vector<std::string>& codeEndings() {
  static const std::vector<std::string> endings{".cpp", ".h", ".glsl", ".vert", ".frag", ".comp", ".geom"};
  return endings;
}

}  // namespace gnomon::test
