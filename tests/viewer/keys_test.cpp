// Keys are told in three places from one table: the help in the window, --help, and a page of the documentation.
#include <gmock/gmock.h>

#include "gnomon/base/files.h"
#include "viewer_window.h"

namespace gnomon::test {
namespace {

std::string output(const std::string& argument) {
  const TemporaryFolder folder;
  Viewer viewer("", folder.path(), {argument});
  EXPECT_EQ(viewer.exitCode(), 0) << viewer.errors();
  return viewer.errors();
}

TEST(ViewerKeys, ThePageIsWhatTheProgramWrites) {
  EXPECT_EQ(readFile(std::string(GNOMON_SOURCE_DIR) + "/docs/keys.md"), output("--keys"))
      << "write it again: gnomon-view --keys > docs/keys.md";
}

TEST(ViewerKeys, HelpNamesEveryKeyOfThePage) {
  const std::string page = output("--keys");
  const std::string help = output("--help");
  int keys = 0;
  for (std::size_t at = page.find("| `"); at != std::string::npos; at = page.find("| `", at + 1)) {
    const std::string name = page.substr(at + 3, page.find('`', at + 3) - at - 3);
    EXPECT_THAT(help, ::testing::HasSubstr("  " + name + " ")) << name;
    ++keys;
  }
  EXPECT_GT(keys, 40);
}

}  // namespace
}  // namespace gnomon::test
