// A batch under several lights: a result for each, and the picture of them all.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>

#include "gnomon/base/files.h"
#include "gnomon/image/image_io.h"
#include "gnomon/run/pictures.h"
#include "program.h"
#include "render.h"

namespace gnomon::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const char* const kSpot = R"({"type": "spot", "position": [0, 6, 1], "target": [0, 0, 0], "cone_half_angle_degrees": 40})";
const char* const kSun = R"({"type": "directional", "position": [3, 6, -2], "target": [0, 0, 0], "intensity": 0.5})";
const char* const kBulb = R"({"type": "point", "position": [0, 5, 0]})";
const char* const kEnding = "_lights_shaded.png";

class LightsBatch : public ::testing::Test {
 protected:
  void configure(const std::vector<std::string>& lights, const std::string& changes = "{}") {
    Json patch = Json::parse(changes);
    for (const std::string& light : lights) patch["lights"].push_back(Json::parse(light));
    if (!patch.contains("output")) patch["output"]["images"] = {"shaded"};
    folder_.write("run.json", smallConfig(patch.dump()));
  }
  Outcome run(const std::vector<std::string>& more = {}, const std::string& out = "out") const {
    std::vector<std::string> arguments{
        "render",  (folder_ / "run.json").string(), "--out", (folder_ / out).string(), "--no-exr",
        "--cache", (folder_ / "cache").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return gnomonProgram(arguments);
  }
  Outcome batch(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{
        "batch",   (folder_ / "run.json").string(), "--out", (folder_ / "out").string(), "--no-exr",
        "--cache", (folder_ / "cache").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return gnomonProgram(arguments);
  }
  std::vector<Json> results(const std::string& out = "out") const { return records(folder_ / out / "results.jsonl"); }
  std::filesystem::path images(const std::string& out = "out") const { return folder_ / out / "images"; }
  std::vector<std::string> sums(const std::string& out = "out") const { return namesIn(images(out), kEnding); }

  TemporaryFolder folder_;
};

TEST_F(LightsBatch, HasAResultForEachAndOnePictureOfAll) {
  configure({kSpot, kSun});
  const Outcome outcome = run();
  ASSERT_EQ(outcome.exitCode, 0) << outcome.all();
  ASSERT_THAT(results(), SizeIs(2));
  EXPECT_EQ(results()[0]["light"], 0);
  EXPECT_EQ(results()[1]["light"], 1);
  ASSERT_THAT(sums(), SizeIs(1));
  EXPECT_EQ(sums()[0].rfind("shadow_map-", 0), 0U);
  EXPECT_THAT(outcome.out, HasSubstr(sums()[0]));
}

TEST_F(LightsBatch, TheResultOfEachIsThatOfARunWithThatLightAlone) {
  configure({kSpot, kSun});
  ASSERT_EQ(run().exitCode, 0);
  configure({kSun});
  ASSERT_EQ(run({}, "alone").exitCode, 0);
  const Json both = results()[1];
  const Json alone = results("alone")[0];
  EXPECT_EQ(both["job"], alone["job"]);
  EXPECT_EQ(both["error"], alone["error"]);
  const std::string picture = alone["job"].get<std::string>() + "_shaded.png";
  EXPECT_EQ(readFile(images() / picture), readFile(images("alone") / picture));
}

TEST_F(LightsBatch, OneLightHasNoPictureOfAll) {
  configure({kSpot});
  ASSERT_EQ(run().exitCode, 0);
  EXPECT_THAT(sums(), IsEmpty());
}

TEST_F(LightsBatch, WithoutShadedPicturesThereIsNoneOfAll) {
  configure({kSpot, kSun}, R"({"output": {"images": ["visibility"]}})");
  ASSERT_EQ(run().exitCode, 0);
  EXPECT_THAT(sums(), IsEmpty());
}

TEST_F(LightsBatch, EveryParameterValueHasOne) {
  configure({kSpot, kSun}, R"({"techniques": [{"technique": "shadow_map", "sweep": {"map_size": [32, 64]}}]})");
  ASSERT_EQ(run().exitCode, 0);
  EXPECT_THAT(sums(), SizeIs(2));
}

TEST_F(LightsBatch, ThePictureIsTheSumOfASession) {
  configure({kSpot, kSun});
  ASSERT_EQ(run().exitCode, 0);
  ASSERT_THAT(sums(), SizeIs(1));

  Light spot;
  spot.type = LightType::spot;
  spot.position = {0.0, 6.0, 1.0};
  spot.coneHalfAngleDegrees = 40.0;
  Light sun;
  sun.type = LightType::directional;
  sun.position = {3.0, 6.0, -2.0};
  sun.intensity = 0.5;
  SessionSetup setup = builtinSetup("half_plane", {64, 48});
  setup.light = spot;
  setup.moreLights = {sun};
  Session session(std::move(setup));
  const OpenTechnique technique = registry().open("shadow_map");
  const auto parameters = parametersOf("shadow_map", R"({"map_size": 64})");
  const std::array slots{session.addSlot(technique, parameters, 0), session.addSlot(technique, parameters, 1)};
  const Slot sum = session.addSum(slots);
  session.frame(sum);
  writePng(folder_ / "expected.png", colourOf(session.shaded(sum)));
  EXPECT_EQ(readFile(images() / sums()[0]), readFile(folder_ / "expected.png"));
}

TEST_F(LightsBatch, ALightThatATechniqueRefusesIsLeftOutAndNamed) {
  configure({kSpot, kBulb, kSun});
  const Outcome outcome = run();
  EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
  ASSERT_THAT(sums(), SizeIs(1));
  EXPECT_THAT(outcome.out, HasSubstr("without light 1: a point light"));
  configure({kSpot, kSun});
  ASSERT_EQ(run({}, "two").exitCode, 0);
  EXPECT_EQ(readFile(images() / sums()[0]), readFile(images("two") / sums("two")[0]));
}

TEST_F(LightsBatch, WhereAllAreRefusedThereIsNoPictureAndNoFailure) {
  configure({kBulb, kBulb});
  const Outcome outcome = run();
  EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
  EXPECT_THAT(sums(), IsEmpty());
  EXPECT_THAT(outcome.out, HasSubstr("all lights: no picture: light 0: a point light"));
}

TEST_F(LightsBatch, ATechniqueThatFailsLeavesThePicturesOfTheOthers) {
  configure({kSpot, kSun}, R"({"techniques": [{"technique": "mischief", "parameters": {"fault": "throw_in_pass"}},
                                              {"technique": "shadow_map", "parameters": {"map_size": 64}}]})");
  const Outcome outcome = run({"--technique-dir", testPluginFolder("mischief")});
  EXPECT_EQ(outcome.exitCode, 1) << outcome.all();
  EXPECT_THAT(outcome.out, HasSubstr("all lights: no picture: technique 'mischief': pass 'work': thrown in the pass"));
  ASSERT_THAT(sums(), SizeIs(1));
  EXPECT_EQ(sums()[0].rfind("shadow_map-", 0), 0U);
}

TEST_F(LightsBatch, ResumeDrawsThePictureThatIsMissingAndNoOther) {
  configure({kSpot, kSun}, R"({"techniques": [{"technique": "unshadowed"}, {"technique": "shadow_map"}]})");
  ASSERT_EQ(batch({}).exitCode, 0);
  const std::vector<std::string> before = sums();
  ASSERT_THAT(before, SizeIs(2));
  const std::string kept = identity(images() / before[1]);
  const std::string bytes = readFile(images() / before[0]);
  std::filesystem::remove(images() / before[0]);
  const Outcome outcome = batch({"--resume"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
  EXPECT_THAT(outcome.out, HasSubstr("4 of 4 results were there already"));
  EXPECT_EQ(readFile(images() / before[0]), bytes);
  EXPECT_EQ(identity(images() / before[1]), kept);
}

TEST_F(LightsBatch, ShardsDrawEachPictureOnce) {
  configure({kSpot, kSun}, R"({"techniques": [{"technique": "unshadowed"}, {"technique": "shadow_map"}]})");
  ASSERT_EQ(batch({"--shard", "0/2"}).exitCode, 0);
  ASSERT_THAT(sums(), SizeIs(1));
  const std::string first = identity(images() / sums()[0]);
  const std::string name = sums()[0];
  ASSERT_EQ(batch({"--shard", "1/2"}).exitCode, 0);
  EXPECT_THAT(sums(), SizeIs(2));
  EXPECT_EQ(identity(images() / name), first);
}

/// What decides the picture is in its name.
TEST_F(LightsBatch, AnotherSecondLightIsAnotherPicture) {
  configure({kSpot, kSun});
  ASSERT_EQ(run().exitCode, 0);
  configure({kSpot, R"({"type": "directional", "position": [4, 6, -2], "target": [0, 0, 0], "intensity": 0.5})"});
  ASSERT_EQ(run().exitCode, 0);
  EXPECT_THAT(sums(), SizeIs(2));
}

TEST_F(LightsBatch, PlanTellsOfEachLight) {
  configure({kSpot, kSun});
  const Outcome outcome = gnomonProgram({"plan", (folder_ / "run.json").string()});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
  EXPECT_THAT(outcome.out, HasSubstr("half_plane, light 0:"));
  EXPECT_THAT(outcome.out, HasSubstr("half_plane, light 1:"));
}

}  // namespace
}  // namespace gnomon::test
