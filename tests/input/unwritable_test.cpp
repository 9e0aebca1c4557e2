// Folders that cannot be written end a run with one clear line; a cache that cannot be written costs nothing but time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "program.h"

namespace gnomon::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Places below which nobody can make a file, whoever runs the tests.
std::vector<std::string> unwritable(const TemporaryFolder& folder) {
  return {"/dev/full", "/proc/no_such_folder", folder.write("file", "").string(), (folder / "file/below").string()};
}

TEST(Unwritable, OutputFolderEndsTheRunWithOneLine) {
  const TemporaryFolder folder;
  const std::string config = folder.write("run.json", smallConfig()).string();
  for (const std::string& out : unwritable(folder)) {
    for (const char* command : {"batch", "render"}) {
      const Outcome outcome = gnomonProgram({command, config, "--out", out});
      EXPECT_EQ(outcome.exitCode, 2) << outcome.all();
      EXPECT_THAT(outcome.lines("error"), ElementsAre(StartsWith(out))) << outcome.all();
    }
  }
}

TEST(Unwritable, CacheFolderIsAWarningAndTheResultsAreThere) {
  const TemporaryFolder folder;
  const std::string config = folder.write("run.json", smallConfig()).string();
  for (const std::string& cache : unwritable(folder)) {
    const Outcome outcome = gnomonProgram({"render", config, "--no-exr", "--out", (folder / "out").string(), "--cache", cache});
    EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
    EXPECT_THAT(outcome.lines("warning"), ElementsAre(AllOf(HasSubstr(cache), HasSubstr("not kept")))) << outcome.all();
    EXPECT_EQ(records(folder / "out/results.jsonl").at(0)["status"], "ok");
  }
}

TEST(Usage, AnUnknownCommandIsNamedWithTheNearest) {
  const Outcome near = gnomonProgram({"lst"});
  EXPECT_EQ(near.exitCode, 2);
  EXPECT_THAT(near.lines("error"), ElementsAre(AllOf(HasSubstr("'lst'"), HasSubstr("did you mean 'list'?"))));
  EXPECT_THAT(gnomonProgram({"xyzzyx"}).lines("error"), ElementsAre(AllOf(HasSubstr("'xyzzyx'"), HasSubstr("--help"))));
}

}  // namespace
}  // namespace gnomon::test
