// `gnomon check`: what it takes, its exit code, and one line for each thing that is wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "plugin_folder.h"
#include "program.h"

namespace gnomon::test {
namespace {

using ::testing::ContainsRegex;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// The one technique of the test plugin that keeps its promises, alone.
class WellBehaved : public PluginFolder {
 public:
  WellBehaved() : PluginFolder("misconduct") {
    setJson(R"({"library": "misconduct", "techniques": {"well_behaved": {"title": "Good", "entry": "well_behaved"}}})");
  }
};

TEST(CheckCommand, TakesAFolderOrAFileAndExitsWithZeroWhereAllPasses) {
  const WellBehaved plugin;
  for (const std::filesystem::path& path : {plugin.path(), plugin.json()}) {
    const Outcome outcome = gnomonProgram({"check", path.string(), "--only", "contract", "sizes"});
    EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
    EXPECT_THAT(outcome.out, ContainsRegex("pass +well_behaved +contract "));
    EXPECT_THAT(outcome.out, HasSubstr("2 checks: 2 pass, 0 refused, 0 fail"));
  }
}

TEST(CheckCommand, ExitsWithOneWhereSomethingFails) {
  const Outcome outcome = gnomonProgram({"check", testPluginFolder("misconduct"), "--only", "contract"});
  EXPECT_EQ(outcome.exitCode, 1) << outcome.all();
  EXPECT_THAT(outcome.out, ContainsRegex("fail +writes_two +contract +V is 2 at pixel"));
  EXPECT_THAT(outcome.out, ContainsRegex("pass +well_behaved +contract "));
}

TEST(CheckCommand, ALibraryThatCannotBeUsedIsOneFailure) {
  const PluginFolder plugin("counter");
  plugin.cutLibrary(1000);
  const Outcome outcome = gnomonProgram({"check", plugin.path().string()});
  EXPECT_EQ(outcome.exitCode, 1) << outcome.all();
  EXPECT_THAT(outcome.out, ContainsRegex("fail +counter +contract .*is cut short"));
  EXPECT_THAT(outcome.out, HasSubstr("1 checks: 0 pass, 0 refused, 1 fail"));
}

TEST(CheckCommand, AFileWithFaultsFails) {
  const PluginFolder plugin("counter");
  plugin.setJson(R"({"library": "counter", "techniques": {"counter": {"titel": "Counter", "entry": "counter"}}})");
  const Outcome outcome = gnomonProgram({"check", plugin.path().string()});
  EXPECT_EQ(outcome.exitCode, 1) << outcome.all();
  EXPECT_THAT(outcome.out, ContainsRegex("fail .*files .*titel"));
}

TEST(CheckCommand, PrintsJson) {
  const WellBehaved plugin;
  const Outcome outcome = gnomonProgram({"check", plugin.path().string(), "--only", "contract", "--json"});
  const Json lines = Json::parse(outcome.out);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0]["technique"], "well_behaved");
  EXPECT_EQ(lines[0]["check"], "contract");
  EXPECT_EQ(lines[0]["outcome"], "pass");
}

TEST(CheckCommand, BadUsageExitsWithTwo) {
  EXPECT_EQ(gnomonProgram({"check", "/no/such/folder"}).exitCode, 2);
  const Outcome outcome = gnomonProgram({"check", testPluginFolder("counter"), "--only", "contrakt"});
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.lines("error"), ElementsAre(HasSubstr("did you mean \"contract\"?")));
}

}  // namespace
}  // namespace gnomon::test
