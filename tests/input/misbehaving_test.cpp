// Plugins that misbehave inside a batch: each job of theirs says on one line what is wrong, and the jobs of others have the
// same bits as without them. What ends a process, a crash or a hang, is not here: it cannot be contained inside one, and waits
// for batches whose jobs run in processes of their own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "program.h"

namespace gnomon::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Misdeed {
  const char* fault;
  const char* status;              ///< of its record
  std::vector<std::string> words;  ///< of its reason
};

const std::vector<Misdeed> kMisdeeds{
    {"refuse", "refused", {"it was asked to refuse"}},
    {"throw_in_create", "failed", {"thrown in create"}},
    {"throw_in_support", "failed", {"thrown in support"}},
    {"throw_in_setup", "failed", {"thrown in setup"}},
    {"throw_number_in_setup", "failed", {"no std::exception"}},
    {"throw_in_update", "failed", {"thrown in update"}},
    {"throw_in_pass", "failed", {"pass 'work'", "thrown in the pass"}},
    {"no_visibility", "failed", {"no visibility"}},
    {"wrong_size", "failed", {"3x2", "64x48"}},
    {"wrong_format", "failed", {"r8", "r16f or r32f"}},
    {"syntax_error", "failed", {"syntax_error.frag:5"}},
    {"include_outside", "failed", {"include_outside.frag:1", "leaves the shader folders"}},
    {"gl_error", "failed", {"pass 'work'", "OpenGL"}},
    {"not_a_number", "ok", {"V is nan at pixel (63, 47)", "at 1 pixels"}},
    {"visibility_of_two", "ok", {"V is 2 at pixel (0, 0)", "at 1 pixels"}},
    {"leaves_state", "ok", {}},
    {"leaves_conditional", "ok", {}},
    {"leaves_feedback", "ok", {}},
    {"leaves_rounding", "ok", {}},
    {"no_technique", "failed", {"its entry 'mischief' made no technique"}},
    {"writes_foreign_buffers", "failed", {"which belongs to others"}},
};

/// A batch of shadow_map, the faults and pcf; also the one without the faults.
struct Ran {
  TemporaryFolder folder;
  Outcome outcome;
  std::vector<Json> records;

  explicit Ran(const std::vector<Misdeed>& misdeeds, const std::vector<std::string>& more = {}) {
    Json techniques = Json::array();
    techniques.push_back({{"technique", "shadow_map"}, {"parameters", {{"map_size", 64}}}});
    for (const Misdeed& m : misdeeds) techniques.push_back({{"technique", "mischief"}, {"parameters", {{"fault", m.fault}}}});
    techniques.push_back({{"technique", "pcf"}, {"parameters", {{"map_size", 64}}}});
    const std::string config = folder.write("run.json", smallConfig(Json{{"techniques", techniques}}.dump())).string();
    std::vector<std::string> arguments{
        "render", config, "--no-exr", "--out", (folder / "out").string(), "--technique-dir", testPluginFolder("mischief")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    outcome = gnomonProgram(arguments);
    records = test::records(folder / "out/results.jsonl");
  }
  std::string picture(const Json& record) const {
    return readFile(folder / "out/images" / (record["job"].get<std::string>() + "_visibility.png"));
  }
};

const Ran& misbehaved() {
  static const Ran ran(kMisdeeds);
  return ran;
}

class Misdeeds : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Misdeeds, AreToldOnOneLineOfTheirRecord) {
  const Ran& ran = misbehaved();
  ASSERT_EQ(ran.records.size(), kMisdeeds.size() + 2) << ran.outcome.all();
  const Json& record = ran.records[GetParam() + 1];
  const Misdeed& misdeed = kMisdeeds[GetParam()];
  EXPECT_EQ(record["parameters"]["fault"], misdeed.fault);
  EXPECT_EQ(record["status"], misdeed.status) << record;
  const std::string reason = record["reason"].is_string() ? record["reason"].get<std::string>() : "";
  EXPECT_EQ(reason.empty(), misdeed.words.empty()) << reason;
  for (const std::string& word : misdeed.words) EXPECT_THAT(reason, HasSubstr(word));
  EXPECT_EQ(reason.find("technique 'mischief': ") == 0, std::string(misdeed.status) == "failed") << reason;
}

INSTANTIATE_TEST_SUITE_P(Batch, Misdeeds, ::testing::Range<std::size_t>(0, kMisdeeds.size()),
                         [](const auto& each) { return std::string(kMisdeeds[each.param].fault); });

TEST(Misbehaving, OthersHaveTheSameBits) {
  const Ran& with = misbehaved();
  const Ran without({});
  ASSERT_EQ(with.records.size(), kMisdeeds.size() + 2) << with.outcome.all();
  ASSERT_EQ(without.records.size(), 2U) << without.outcome.all();
  for (const auto& [mine, alone] :
       {std::pair(with.records.front(), without.records.front()), std::pair(with.records.back(), without.records.back())}) {
    EXPECT_EQ(mine["job"], alone["job"]);
    EXPECT_EQ(mine["error"], alone["error"]);
    EXPECT_EQ(with.picture(mine), without.picture(alone));
  }
}

TEST(Misbehaving, TheBatchEndsWithOne) {
  EXPECT_EQ(misbehaved().outcome.exitCode, 1) << misbehaved().outcome.all();
}

TEST(Misbehaving, NumbersThatAreNoneAreCountedInTheRecord) {
  const auto index =
      static_cast<std::size_t>(std::find_if(kMisdeeds.begin(), kMisdeeds.end(),
                                            [](const Misdeed& m) { return m.fault == std::string("not_a_number"); }) -
                               kMisdeeds.begin());
  const Json& record = misbehaved().records.at(index + 1);
  EXPECT_EQ(record["error"]["non_finite"], 1) << record;
}

TEST(Misbehaving, CheckFiniteFailsTheJobAndNamesThePass) {
  const Ran ran({{"not_a_number", "failed", {}}}, {"--check-finite"});
  EXPECT_EQ(ran.records.at(1)["status"], "failed");
  EXPECT_THAT(ran.records.at(1)["reason"].get<std::string>(), AllOf(HasSubstr("'mischief'"), HasSubstr("pass 'work'")));
  EXPECT_EQ(ran.records.at(2)["status"], "ok");
}

// --- libraries that cannot be opened ---

TEST(BrokenLibraries, CostOnlyThemselves) {
  const TemporaryFolder folder;
  const std::string config = folder.write("run.json", smallConfig()).string();
  const std::vector<std::string> plain{"render", config, "--no-exr", "--out", (folder / "a").string()};
  std::vector<std::string> among{"render", config, "--no-exr", "--out", (folder / "b").string()};
  for (const char* broken : {"lacks_symbol", "no_symbol", "no_note"}) {
    among.emplace_back("--technique-dir");
    among.push_back(testPluginFolder(broken));
  }
  EXPECT_EQ(gnomonProgram(plain).exitCode, 0);
  const Outcome outcome = gnomonProgram(among);
  EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
  EXPECT_EQ(records(folder / "a/results.jsonl").at(0)["error"], records(folder / "b/results.jsonl").at(0)["error"]);
}

TEST(BrokenLibraries, AConfigThatNamesOneSaysSoAndRunsNothing) {
  for (const char* broken : {"lacks_symbol", "no_symbol", "no_note"}) {
    const TemporaryFolder folder;
    const std::string config =
        folder.write("run.json", smallConfig(Json{{"techniques", {{{"technique", broken}}}}}.dump())).string();
    const Outcome outcome =
        gnomonProgram({"render", config, "--out", (folder / "out").string(), "--technique-dir", testPluginFolder(broken)});
    EXPECT_EQ(outcome.exitCode, 2) << outcome.all();
    EXPECT_THAT(outcome.lines("error"), ElementsAre(HasSubstr(std::string(broken) + ".json: /library: "))) << outcome.all();
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  }
}

}  // namespace
}  // namespace gnomon::test
