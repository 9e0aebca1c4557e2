// What `gnomon describe` says of a technique, and what switching one of its defences off does to results.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "program.h"

namespace gnomon::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Json described(const std::string& technique) {
  const Outcome outcome = gnomonProgram({"describe", technique, "--json"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
  EXPECT_EQ(outcome.err, "");
  return Json::parse(outcome.out);
}

const Json& pcf() {
  static const Json json = described("pcf");
  return json;
}

/// The element of a list whose `key` is `value`.
const Json& where(const Json& list, const std::string& key, const std::string& value) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const Json& each) { return each[key] == value; });
  if (found == list.end()) throw Error("no element with " + key + " " + value + " in " + list.dump());
  return *found;
}

std::vector<std::string> texts(const Json& list) {
  return list.get<std::vector<std::string>>();
}

TEST(Describe, NamesThePaperInWhichItWasPublished) {
  EXPECT_THAT(pcf()["paper"].get<std::string>(), HasSubstr("SIGGRAPH 1987"));
}

TEST(Describe, NamesThePapersOfAllComponents) {
  EXPECT_THAT(described("pcss_vsm")["paper"].get<std::string>(),
              AllOf(HasSubstr("Williams"), HasSubstr("; Donnelly"), HasSubstr("; Fernando")));
}

TEST(Describe, TellsWhichLightsATechniqueTakes) {
  EXPECT_EQ(where(pcf()["lights"], "light", "spot with a rectangle")["takes"], true);
  const Json& point = where(pcf()["lights"], "light", "point");
  EXPECT_EQ(point["takes"], false);
  EXPECT_NE(point["refusal"], "");
  for (const Json& answer : described("ray_traced")["lights"]) EXPECT_EQ(answer["takes"], true) << answer;
  EXPECT_EQ(pcf()["lights"].size(), 7U);  // of three types, those with an extent too; a spot's has two shapes
}

TEST(Describe, TellsEffectsApart) {
  EXPECT_THAT(texts(pcf()["effects"]["ignored"]), Contains("varying_penumbra"));
  EXPECT_THAT(texts(pcf()["effects"]["reproduced"]), Contains("self_shadowing"));
  EXPECT_THAT(texts(described("ray_traced")["effects"]["reproduced"]), Contains("varying_penumbra"));
}

TEST(Describe, TellsEachParameterWithItsRangeUnitBindingAndDefault) {
  const Json& taps = where(pcf()["parameters"], "name", "taps");
  EXPECT_EQ(taps["default"], 5);
  EXPECT_EQ(taps["allowed"], "an integer from 2 to 31 texels");
  EXPECT_EQ(taps["unit"], "texels");
  EXPECT_EQ(taps["binding"], "specialise");
}

TEST(Describe, ListsTheDefencesOfTheShadersThatAreUsedAndNoOthers) {
  std::vector<std::string> names;
  for (const Json& defence : pcf()["defences"]) {
    names.push_back(defence["name"]);
    EXPECT_NE(defence["meaning"], "") << defence;
  }
  EXPECT_THAT(names, AllOf(Contains("behind_light"), Contains("plane_beyond_far")));
  EXPECT_TRUE(described("unshadowed")["defences"].empty());
}

TEST(Describe, TellsPassesAndTexturesOfASetUp) {
  const Json& setUp = pcf()["set_up"];
  EXPECT_THAT(texts(setUp["passes"]), Contains("fit"));
  const Json& map = where(setUp["textures"], "name", "depth map");
  EXPECT_EQ(map["format"], "d32f");
  EXPECT_EQ(map["size"], (Json{1024, 1024}));
  EXPECT_EQ(map["bytes"], 1024 * 1024 * 4);
  EXPECT_GT(setUp["memory_bytes"], map["bytes"]);
}

TEST(Describe, SaysTheSameToPeople) {
  const Outcome outcome = gnomonProgram({"describe", "pcf"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
  for (const char* words : {"SIGGRAPH 1987", "spot with a rectangle", "refused: ", "ignored     varying_penumbra",
                            "behind_light", "an integer from 2 to 31 texels", "d32f 1024x1024, 4194304 bytes"})
    EXPECT_THAT(outcome.out, HasSubstr(words));
}

// --- without a defence ---

class Without : public ::testing::Test {
 protected:
  Json render(const std::vector<std::string>& more = {}, const std::string& changes = "{}") {
    const std::string config = folder_.write("run.json", smallConfig(changes)).string();
    std::vector<std::string> arguments{"render",  config,         "--no-exr", "--out", (folder_ / "out").string(),
                                       "--cache", cache_.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = gnomonProgram(arguments);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
    return records(folder_ / "out/results.jsonl").at(0);
  }

  TemporaryFolder folder_;
  std::filesystem::path cache_ = folder_ / "cache";
};

TEST_F(Without, TheRecordSaysSo) {
  const Json whole = render();
  const Json lacking = render({"--without", "behind_light", "--without", "plane_beyond_far"});
  for (const char* name : {"behind_light", "plane_beyond_far"}) {
    const Json& decision = where(lacking["plan"], "effect", std::string("defence ") + name);
    EXPECT_EQ(decision["on"], false);
    EXPECT_NE(decision["reason"], "");
  }
  EXPECT_EQ(lacking["plan"].size(), whole["plan"].size() + 2);
  EXPECT_NE(lacking["job"], whole["job"]);  // so that --resume never takes one for the other
}

TEST_F(Without, AConfigSaysItAsTheOptionDoes) {
  const Json byOption = render({"--without", "behind_light"});
  const Json byConfig = render({}, R"({"plan": {"without": ["behind_light"]}})");
  EXPECT_EQ(byOption["job"], byConfig["job"]);
  EXPECT_EQ(byOption["plan"], byConfig["plan"]);
}

TEST_F(Without, TheReferenceKeepsItsDefencesAndItsCache) {
  render();
  const std::string file = namesIn(cache_).at(0);
  const std::string before = identity(cache_ / file);
  render({"--without", "behind_light"});
  EXPECT_THAT(namesIn(cache_), ElementsAre(file));
  EXPECT_EQ(identity(cache_ / file), before);
}

TEST_F(Without, AnUnknownNameGetsTheNearest) {
  const std::string config = folder_.write("run.json", smallConfig()).string();
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"render", config, "--out", (folder_ / "out").string(), "--without", "behind_lihgt"},
        {"stability", "shadow_map", "--case", "scale_1e-4", "--without", "behind_lihgt"}}) {
    const Outcome outcome = gnomonProgram(arguments);
    EXPECT_EQ(outcome.exitCode, 2) << outcome.all();
    EXPECT_THAT(outcome.lines("error"),
                ElementsAre(AllOf(HasSubstr("--without"), HasSubstr("did you mean \"behind_light\"?"))));
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(Without, TheStabilitySuiteFailsACellThatNeedsTheDefence) {
  const std::vector<std::string> cell{"stability", "shadow_map", "--case", "normal_offset_behind_light"};
  EXPECT_EQ(gnomonProgram(cell).exitCode, 0);
  std::vector<std::string> lacking = cell;
  lacking.insert(lacking.end(), {"--without", "behind_light"});
  const Outcome outcome = gnomonProgram(lacking);
  EXPECT_EQ(outcome.exitCode, 1) << outcome.all();
  EXPECT_THAT(outcome.out, HasSubstr("without behind_light: "));
}

}  // namespace
}  // namespace gnomon::test
