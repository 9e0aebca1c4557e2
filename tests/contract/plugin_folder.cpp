#include "plugin_folder.h"

#include <gtest/gtest.h>
#include <stdlib.h>

namespace gnomon::test {

std::filesystem::path testPlugin(const std::string& name) {
  return std::filesystem::path(GNOMON_BINARY_DIR) / "test_plugins" / name;
}

PluginFolder::PluginFolder(const std::string& plugin) : plugin_(plugin) {
  for (const auto& item : std::filesystem::directory_iterator(testPlugin(plugin))) {
    if (item.is_regular_file()) std::filesystem::copy_file(item.path(), folder_.path() / item.path().filename());
  }
}

void PluginFolder::cutLibrary(std::size_t bytes) const {
  std::filesystem::resize_file(library(), bytes);
}

LoadTrace::LoadTrace() {
  setenv("GNOMON_TEST_TRACE", (folder_ / "trace").c_str(), 1);
}
LoadTrace::~LoadTrace() {
  unsetenv("GNOMON_TEST_TRACE");
}

std::vector<std::string> linesOf(const std::vector<Problem>& problems) {
  std::vector<std::string> lines;
  for (const Problem& problem : problems) {
    lines.push_back(problem.line());
    EXPECT_EQ(lines.back().find('\n'), std::string::npos) << "a problem is one line: " << lines.back();
  }
  return lines;
}

}  // namespace gnomon::test
