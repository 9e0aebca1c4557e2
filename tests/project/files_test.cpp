// What holds for every file that people write.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <set>

#include "source_tree.h"

namespace gnomon::test {
namespace {

using ::testing::IsEmpty;

const std::vector<std::string> kFolders{"framework", "plugins", "viewer", "tests", "cmake", "scripts", "CMakeLists.txt"};

TEST(Files, HaveAtMostFiveHundredLines) {
  std::vector<std::string> endings = codeEndings();
  endings.insert(endings.end(), {".py", ".cmake", "CMakeLists.txt"});
  const std::vector<SourceFile> files = sourceFiles(kFolders, endings);
  ASSERT_GE(files.size(), 100U);
  std::vector<std::string> longer;
  for (const SourceFile& file : files) {
    const auto lines = std::count(file.text.begin(), file.text.end(), '\n');
    if (lines > 500) longer.push_back(file.path + ": " + std::to_string(lines) + " lines");
  }
  EXPECT_THAT(longer, IsEmpty());
}

TEST(Files, EndWithANewlineAndHaveNoTabs) {
  std::vector<std::string> wrong;
  for (const SourceFile& file : sourceFiles(kFolders, codeEndings())) {
    if (file.text.empty() || file.text.back() != '\n' || file.text.find('\t') != std::string::npos) wrong.push_back(file.path);
  }
  EXPECT_THAT(wrong, IsEmpty());
}

/// clang-format is in scripts/packages.txt, so it is there.
TEST(Files, AreAsClangFormatWritesThem) {
  std::string command = "cd '" GNOMON_SOURCE_DIR "' && clang-format --dry-run";
  for (const SourceFile& file : sourceFiles({"framework", "plugins", "viewer", "tests"}, {".cpp", ".h"}))
    command += " '" + file.path + "'";
  command += " 2>&1";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), &pclose);
  ASSERT_NE(pipe, nullptr);
  std::set<std::string> wrong;
  for (char buffer[4096]; std::fgets(buffer, sizeof buffer, pipe.get()) != nullptr;) {
    const std::string line = buffer;
    if (line.find("[-Wclang-format-violations]") != std::string::npos) wrong.insert(line.substr(0, line.find(':')));
    EXPECT_EQ(line.find("not found"), std::string::npos) << line;
  }
  EXPECT_THAT(wrong, IsEmpty());
}

}  // namespace
}  // namespace gnomon::test
