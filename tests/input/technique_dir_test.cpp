// Folders of technique files given with --technique-dir: broken ones cost only themselves, and only those who name them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "program.h"

namespace gnomon::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

/// A technique file whose library is not there.
class BrokenTechnique : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  std::string directory_ = (folder_ / "techniques").string();
  std::string json_ =
      folder_
          .write("techniques/lost.json", R"({"library": "lost", "techniques": {"lost": {"title": "Lost", "entry": "lost"}}})")
          .string();
};

TEST_F(BrokenTechnique, ListWarnsAndGoesOn) {
  const Outcome outcome = gnomonProgram({"list", "--technique-dir", directory_});
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.lines("warning"), ElementsAre(AllOf(StartsWith(json_ + ": /library: "), HasSubstr("lost.so"))));
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("shadow_map"), ::testing::Not(HasSubstr("lost"))));
}

TEST_F(BrokenTechnique, ValidateRefusesIt) {
  const Outcome outcome = gnomonProgram({"validate", json_});
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.lines("error"), ElementsAre(StartsWith(json_ + ": /library: ")));
}

TEST_F(BrokenTechnique, AConfigThatNamesItIsRefused) {
  const std::string config = folder_.write("run.json", smallConfig(R"({"techniques": [{"technique": "lost"}]})")).string();
  const Outcome outcome = gnomonProgram({"batch", config, "--technique-dir", directory_, "--out", (folder_ / "out").string()});
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.lines("error"), ElementsAre(StartsWith(json_ + ": /library: ")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(BrokenTechnique, AConfigThatDoesNotNameItRuns) {
  const std::string config = folder_.write("run.json", smallConfig()).string();
  const Outcome outcome = gnomonProgram({"render", config, "--technique-dir", directory_, "--out", (folder_ / "out").string()});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
}

TEST(TechniqueDir, NamesRegisteredTwiceAreToldByListAndCountForNeither) {
  const TemporaryFolder folder;
  const std::filesystem::path second = folder / "second";
  std::filesystem::create_directories(second);
  for (const char* file : {"trace.json", "trace.so", "trace.frag"}) {
    std::filesystem::copy_file(std::filesystem::path(testPluginFolder("trace")) / file, second / file);
  }
  const Outcome outcome =
      gnomonProgram({"list", "--technique-dir", testPluginFolder("trace"), "--technique-dir", second.string()});
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.lines("warning"), ElementsAre(HasSubstr(": /techniques/trace: ")));
  EXPECT_THAT(outcome.out, ::testing::Not(HasSubstr("trace  ")));
}

TEST(TechniqueDir, ListRunsNoCodeOfPlugins) {
  const TemporaryFolder folder;
  const std::string trace = (folder / "trace").string();
  const Outcome outcome = gnomonProgram({"list", "--technique-dir", testPluginFolder("trace")}, {{"GNOMON_TEST_TRACE", trace}});
  EXPECT_THAT(outcome.out, HasSubstr("trace"));
  EXPECT_FALSE(std::filesystem::exists(trace));
}

TEST(TechniqueDir, DescribeRunsIt) {  // the trace that list must not leave is left here
  const TemporaryFolder folder;
  const std::string trace = (folder / "trace").string();
  const Outcome outcome =
      gnomonProgram({"describe", "trace", "--technique-dir", testPluginFolder("trace")}, {{"GNOMON_TEST_TRACE", trace}});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
  EXPECT_THAT(outcome.out, HasSubstr("steps"));
  EXPECT_TRUE(std::filesystem::exists(trace));
}

TEST(TechniqueDir, ValidateLooksIntoTheLibrary) {
  const TemporaryFolder folder;
  std::filesystem::copy_file(testPluginFolder("trace") + "/trace.so", folder / "trace.so");
  const std::string file = folder
                               .write("trace.json", R"({"library": "trace", "techniques": {
      "few": {"title": "t", "entry": "trace", "parameters": {"stepz": 2}},
      "many": {"title": "t", "entry": "tracer"}}})")
                               .string();
  const Outcome outcome = gnomonProgram({"validate", file});
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.lines("error"), ElementsAre(StartsWith(file + ": /techniques/few/parameters/stepz: "),
                                                  StartsWith(file + ": /techniques/many/entry: ")));
}

TEST(TechniqueDir, ValidateOfAForeignLibraryIsOneLine) {
  for (const char* plugin : {"no_note", "no_symbol"}) {
    const std::string file = testPluginFolder(plugin) + "/" + plugin + ".json";
    const Outcome outcome = gnomonProgram({"validate", file});
    EXPECT_EQ(outcome.exitCode, 2);
    EXPECT_THAT(outcome.lines("error"), ElementsAre(StartsWith(file + ": /library: "))) << outcome.all();
  }
}

TEST(TechniqueDir, ValidateOfWhatIsNoLibraryIsOneLine) {
  const TemporaryFolder folder;
  folder.write("text.so", "not a library");
  const std::string file =
      folder.write("text.json", R"({"library": "text", "techniques": {"text": {"title": "t", "entry": "e"}}})").string();
  const Outcome outcome = gnomonProgram({"validate", file});
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.lines("error"), ElementsAre(StartsWith(file + ": /library: "))) << outcome.all();
}

}  // namespace
}  // namespace gnomon::test
