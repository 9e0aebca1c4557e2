// What `validate` says of files that are sound by themselves, and of files that are not there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "program.h"

namespace gnomon::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class ValidateSharedName : public ::testing::TestWithParam<const char*> {
 protected:
  ValidateSharedName() {
    for (const char* file : {"trace.json", "trace.so"})
      std::filesystem::copy_file(std::filesystem::path(testPluginFolder("trace")) / file, folder_ / file);
  }
  std::string write(const std::string& file, const std::string& technique) const {
    return folder_
        .write(file, R"({"library": "trace", "techniques": {")" + technique + R"(": {"title": "t", "entry": "trace"}}})")
        .string();
  }
  TemporaryFolder folder_;
};

/// Whichever of the two comes first by name.
TEST_P(ValidateSharedName, OfAFileBesideItIsRefused) {
  const std::string file = write(GetParam(), "trace");
  const Outcome outcome = gnomonProgram({"validate", file});
  EXPECT_EQ(outcome.exitCode, 2) << outcome.all();
  EXPECT_THAT(outcome.lines("error"), ElementsAre(AllOf(StartsWith(file + ": /techniques/trace: "),
                                                        HasSubstr("registered by " + (folder_ / "trace.json").string()))));
}

TEST_P(ValidateSharedName, OfTheInstallationIsRefused) {
  const std::string file = write(GetParam(), "shadow_map");
  const Outcome outcome = gnomonProgram({"validate", file});
  EXPECT_EQ(outcome.exitCode, 2) << outcome.all();
  EXPECT_THAT(outcome.lines("error"),
              ElementsAre(AllOf(StartsWith(file + ": /techniques/shadow_map: "), HasSubstr("shadow_map.json too"))));
}

INSTANTIATE_TEST_SUITE_P(Validate, ValidateSharedName, ::testing::Values("before.json", "zzz.json"),
                         [](const auto& each) { return std::string(each.param).substr(0, std::string(each.param).find('.')); });

TEST(ValidateTechniqueDirectory, SharedNameIsRefused) {
  const TemporaryFolder folder;
  const std::string file =
      folder.write("own.json", R"({"library": "own", "techniques": {"trace": {"title": "t", "entry": "trace"}}})").string();
  std::filesystem::copy_file(testPluginFolder("trace") + "/trace.so", folder / "own.so");
  const Outcome outcome = gnomonProgram({"validate", file, "--technique-dir", testPluginFolder("trace")});
  EXPECT_EQ(outcome.exitCode, 2) << outcome.all();
  EXPECT_THAT(outcome.lines("error"), ElementsAre(StartsWith(file + ": /techniques/trace: ")));
}

TEST(ValidateMissingFile, NamesItOnce) {
  for (const char* file : {"nofile.json", "nofile.glb"}) {
    const Outcome outcome = gnomonProgram({"validate", file});
    EXPECT_EQ(outcome.exitCode, 2) << outcome.all();
    EXPECT_THAT(outcome.lines("error"), ElementsAre(StartsWith(std::string(file) + ": cannot open: ")));
  }
}

}  // namespace
}  // namespace gnomon::test
