// The installed package on its own: moved elsewhere, and built against by a plugin outside the source tree.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "gnomon/base/json.h"
#include "gnomon/technique/library.h"
#include "installed.h"

namespace gnomon::test {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Paths below `folder`.
std::set<std::string> filesBelow(const fs::path& folder) {
  std::set<std::string> files;
  for (const auto& item : fs::recursive_directory_iterator(folder)) {
    if (item.is_regular_file()) files.insert(fs::relative(item.path(), folder).string());
  }
  return files;
}

TEST(Package, RunsWhereverItIsMoved) {
  const InstalledGnomon gnomon;
  const ShellOutcome listed = gnomon.runWithPackage("gnomon list --json");
  ASSERT_EQ(listed.exitCode, 0) << listed.text;
  const Json techniques = Json::parse(listed.text);
  EXPECT_GE(techniques.size(), 4U);
  for (const Json& technique : techniques)  // the library that said so lies in the package: it looks beside itself
    EXPECT_THAT(technique["file"].get<std::string>(),
                HasSubstr(fs::canonical(gnomon.package()).string() + "/lib/gnomon/plugins"));

  const ShellOutcome rendered = gnomon.runWithPackage(
      "cat > run.json <<'END'\n"
      R"({"scene": {"builtin": "half_plane"}, "output": {"size": [32, 24], "images": ["shaded"]},
          "reference": {"technique": "ray_traced", "parameters": {"samples": 2}}, "techniques": [{"technique": "shadow_map"}]})"
      "\nEND\ngnomon render run.json --out out");
  EXPECT_EQ(rendered.exitCode, 0) << rendered.text;

  const ShellOutcome viewer = gnomon.runWithPackage("gnomon-view --keys");
  EXPECT_EQ(viewer.exitCode, 0) << viewer.text;
}

TEST(Package, NamesNeitherBuildNorSourceTree) {
  const InstalledGnomon gnomon;
  std::vector<std::string> naming;
  for (const std::string& file : filesBelow(gnomon.package())) {
    const std::string bytes = readFile(gnomon.package() / file);
    if (bytes.find(GNOMON_BINARY_DIR) != std::string::npos || bytes.find(GNOMON_SOURCE_DIR) != std::string::npos)
      naming.push_back(file);
  }
  EXPECT_THAT(naming, IsEmpty());
}

TEST(Package, HasTheHeadersThatPluginsReachAndNoOther) {
  const InstalledGnomon gnomon;
  const std::set<std::string> headers = filesBelow(gnomon.package() / "include");
  EXPECT_THAT(headers, Contains("gnomon/plugin.h"));
  EXPECT_THAT(headers, Contains("gnomon/technique/technique.h"));
  EXPECT_THAT(headers, Contains("gnomon/abi_tag.h"));
  EXPECT_THAT(headers, Not(Contains("gnomon/session.h")));
  EXPECT_THAT(headers, Not(Contains("gnomon/base/json.h")));
  const ShellOutcome alone =
      gnomon.run("echo '#include <gnomon/plugin.h>' > all.cpp && c++ -std=c++20 -fsyntax-only -Ignomon/include all.cpp");
  EXPECT_EQ(alone.exitCode, 0) << alone.text;
}

/// What is printed by `new-technique`, built: one test, which fails until the shader is filled in; and the framework's tag.
TEST(Package, TemplateBuildsRunsAndHasOneFailingTest) {
  const InstalledGnomon gnomon;
  const ShellOutcome built = gnomon.runWithPackage(
      "gnomon new-technique seven_samurai\n"
      "cmake -S seven_samurai -B seven_samurai/build -DCMAKE_CXX_FLAGS='-O1 -Wall -Wextra -Werror'\n"
      "cmake --build seven_samurai/build\n");
  ASSERT_EQ(built.exitCode, 0) << built.text;
  const fs::path folder = gnomon.home() / "seven_samurai/build/plugins/seven_samurai";
  EXPECT_EQ(pluginAbiTag(folder / "seven_samurai.so"), frameworkAbiTag());
  EXPECT_EQ(filesBelow(folder), (std::set<std::string>{"seven_samurai.frag", "seven_samurai.json", "seven_samurai.so"}));

  const ShellOutcome tested = gnomon.runWithPackage("ctest --test-dir seven_samurai/build");
  EXPECT_THAT(tested.text, HasSubstr("0% tests passed, 1 tests failed out of 1"));
  const ShellOutcome checked = gnomon.runWithPackage(
      "gnomon check seven_samurai/build/plugins --only contract parameters sizes bits inputs state leaks");
  EXPECT_EQ(checked.exitCode, 0) << "all that it promises it keeps: " << checked.text;
}

TEST(Package, ForeignCompilerFlagsAreRefusedAtLoading) {  // so that the tag is the plugin's own, not a copy of the framework's
  const InstalledGnomon gnomon;
  const ShellOutcome listed = gnomon.runWithPackage(
      "gnomon new-technique debugged\n"
      "cmake -S debugged -B build -DCMAKE_CXX_FLAGS='-D_GLIBCXX_DEBUG'\n"
      "cmake --build build\n"
      "gnomon describe debugged --technique-dir build/plugins");
  EXPECT_EQ(listed.exitCode, 2);
  EXPECT_THAT(listed.text, HasSubstr("debugged.so was built for another framework"));
  EXPECT_THAT(listed.text, HasSubstr("debug=on"));
}

// --- the page for newcomers ---

/// The commands of a page: its sh blocks, in order.
std::string commandsOf(const std::string& page) {
  std::istringstream lines(page);
  std::string commands;
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    const bool fence = line.starts_with("```");
    if (inside && !fence) commands += line + "\n";
    if (fence) inside = !inside && line == "```sh";
  }
  return commands;
}

TEST(WritingATechnique, TakesANewcomerToTheTableByTheCommandsPrinted) {
  const InstalledGnomon gnomon;
  const std::string commands = commandsOf(readFile(fs::path(GNOMON_SOURCE_DIR) / "docs/writing-a-technique.md"));
  ASSERT_THAT(commands, HasSubstr("gnomon batch"));
  const ShellOutcome outcome = gnomon.run(commands);
  ASSERT_EQ(outcome.exitCode, 0) << outcome.text;
  EXPECT_THAT(outcome.text, HasSubstr("to be filled in"));
  EXPECT_THAT(outcome.text, HasSubstr("100% tests passed, 0 tests failed out of 1"));
  EXPECT_THAT(outcome.text, ContainsRegex("my_shadows[^\n]* 0\\.[0-9]+")) << "a line of the table, with its error";
}

}  // namespace
}  // namespace gnomon::test
