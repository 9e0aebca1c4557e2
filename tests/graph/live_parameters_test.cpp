// Parameters that change while their technique stays.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench.h"
#include "gl_calls.h"

namespace gnomon::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

bool setParameters(Session& session, Slot slot, const std::string& technique, const std::string& json) {
  return session.setParameters(slot, registry().open(technique), parametersOf(technique, json));
}

SessionSetup smallSetup() {
  return builtinSetup("pillars", {60, 45});
}

struct Change {
  const char* name;
  const char* technique;
  std::string from, to;
  std::vector<std::string> runs;  ///< passes that run again; further ones may, where their inputs follow
};

void PrintTo(const Change& change, std::ostream* out) {
  *out << change.name;
}

class UniformChange : public testing::TestWithParam<Change> {
 protected:
  UniformChange() { session_.frame(slot_); }

  bool apply() { return setParameters(session_, slot_, change_.technique, change_.to); }

  const Change& change_ = GetParam();
  Session session_{smallSetup()};
  Slot slot_ = addSlot(session_, change_.technique, change_.from);
};

TEST_P(UniformChange, SetsNothingUp) {
  EXPECT_FALSE(apply());
}

TEST_P(UniformChange, CompilesNothing) {
  const LinkedPrograms linked;
  apply();
  session_.frame(slot_);
  EXPECT_EQ(linked.count(), 0);
}

TEST_P(UniformChange, RunsOnlyWhatReadsTheBlock) {
  apply();
  const FrameReport report = session_.frame(slot_);
  EXPECT_THAT(ran(report.technique), testing::ElementsAreArray(change_.runs));
  EXPECT_THAT(ran(report.shared), IsEmpty());
}

TEST_P(UniformChange, GivesTheBitsOfAFreshSlot) {
  const std::vector<float> before = session_.visibility(slot_).data;
  apply();
  session_.frame(slot_);
  EXPECT_NE(session_.visibility(slot_).data, before);
  EXPECT_EQ(session_.visibility(slot_).data, renderVisibility(smallSetup(), change_.technique, change_.to).data);
}

const std::vector<Change> kChanges{
    {"SlopeOfAShadowMap",
     "shadow_map",
     R"({"map_size": 64, "bias.slope": 0})",
     R"({"map_size": 64, "bias.slope": 3})",
     {"fit", "compare"}},
    {"CurvatureOfPcf", "pcf", R"({"map_size": 64})", R"({"map_size": 64, "bias.curvature": 20})", {"fit", "filter"}},
    {"SeedOfRays", "ray_traced", R"({"samples": 4})", R"({"samples": 4, "seed": 9})", {"trace"}},
    {"SamplesOfRays", "ray_traced", R"({"samples": 4})", R"({"samples": 7})", {"trace"}}};

INSTANTIATE_TEST_SUITE_P(LiveParameters, UniformChange, testing::ValuesIn(kChanges),
                         [](const auto& each) { return std::string(each.param.name); });

// --- one technique ---

class LiveShadowMap : public testing::Test {
 protected:
  LiveShadowMap() { session_.frame(slot_); }

  bool set(const std::string& json) { return setParameters(session_, slot_, "shadow_map", json); }

  Session session_{smallSetup()};
  Slot slot_ = addSlot(session_, "shadow_map", R"({"map_size": 64})");
};

TEST_F(LiveShadowMap, TheSameValuesRunNothing) {
  EXPECT_FALSE(set(R"({"map_size": 64})"));
  EXPECT_THAT(ran(session_.frame(slot_).technique), IsEmpty());
}

TEST_F(LiveShadowMap, AnotherStructureIsSetUpAnew) {
  EXPECT_TRUE(set(R"({"map_size": 32})"));
  session_.frame(slot_);
  EXPECT_EQ(session_.facts(slot_).mapSize, glm::ivec2(32));
}

TEST_F(LiveShadowMap, ASpecialisedConstantSetsNothingUp) {
  EXPECT_FALSE(set(R"({"map_size": 64, "bias.receiver_plane": true})"));
}

TEST_F(LiveShadowMap, ASpecialisedConstantRunsWhatUsesItAndDrawsNoMap) {
  set(R"({"map_size": 64, "bias.receiver_plane": true})");
  const std::vector<std::string> passes = ran(session_.frame(slot_).technique);
  EXPECT_THAT(passes, testing::Not(testing::Contains("light depth")));
  EXPECT_EQ(passes.size(), 2U);  // the fit, which states the constant among its facts, and the comparison
  EXPECT_TRUE(session_.facts(slot_).receiverPlane);
}

TEST_F(LiveShadowMap, ASpecialisedConstantGivesTheBitsOfAFreshSlot) {
  const std::string other = R"({"map_size": 64, "bias.receiver_plane": true})";
  const std::vector<float> before = session_.visibility(slot_).data;
  set(other);
  session_.frame(slot_);
  EXPECT_NE(session_.visibility(slot_).data, before);
  EXPECT_EQ(session_.visibility(slot_).data, renderVisibility(smallSetup(), "shadow_map", other).data);
}

TEST_F(LiveShadowMap, ASpecialisedConstantThatComesBackCompilesNothing) {
  set(R"({"map_size": 64, "bias.receiver_plane": true})");
  session_.frame(slot_);
  const LinkedPrograms linked;
  EXPECT_FALSE(set(R"({"map_size": 64})"));
  session_.frame(slot_);
  EXPECT_EQ(linked.count(), 0);
}

TEST_F(LiveShadowMap, ASecondSlotCompilesNothing) {
  const LinkedPrograms linked;
  session_.frame(addSlot(session_, "shadow_map", R"({"map_size": 64})"));
  EXPECT_EQ(linked.count(), 0);
}

TEST_F(LiveShadowMap, AnotherTechniqueIsSetUpAnew) {
  EXPECT_TRUE(setParameters(session_, slot_, "pcf", R"({"map_size": 64})"));
  EXPECT_THAT(session_.passNames(slot_), testing::Contains("filter"));
}

TEST_F(LiveShadowMap, FactsFollowTheBiases) {
  set(R"({"map_size": 64, "bias.constant": 3, "bias.slope": 4, "bias.normal": 5, "bias.curvature": 6, "bias.limit": 7})");
  session_.frame(slot_);
  const Facts facts = session_.facts(slot_);
  EXPECT_THAT(
      (std::vector<double>{facts.biasConstant, facts.biasSlope, facts.biasNormal, facts.biasCurvature, facts.biasLimit}),
      ElementsAre(3.0, 4.0, 5.0, 6.0, 7.0));
}

TEST_F(LiveShadowMap, CullingLeavesRoomForTheNormalBias) {  // receivers look up texels that far away
  Camera camera = session_.camera();
  camera.position = {0.5, 1.0, 2.0};  // close: it needs few casters
  session_.moveCamera(camera);
  const auto drawn = [&](Slot slot) { return session_.frame(slot, {.skipUnchanged = false}).technique.counters.primitives; };
  const std::uint64_t before = drawn(slot_);
  const std::string wide = R"({"map_size": 64, "bias.normal": 20})";
  set(wide);
  const std::uint64_t after = drawn(slot_);
  EXPECT_GT(after, before);
  EXPECT_EQ(after, drawn(addSlot(session_, "shadow_map", wide)));
}

TEST(LiveParameters, TheTapsOfPcfGiveTheBitsOfAFreshSlot) {  // a constant of the filter, and how far the map must reach
  Session session(smallSetup());
  const Slot slot = addSlot(session, "pcf", R"({"map_size": 64, "taps": 3})");
  session.frame(slot);
  const std::string wide = R"({"map_size": 64, "taps": 9})";
  EXPECT_FALSE(setParameters(session, slot, "pcf", wide));
  session.frame(slot);
  EXPECT_EQ(session.facts(slot).filterRadiusTexels, 4.0);
  EXPECT_EQ(session.visibility(slot).data, renderVisibility(smallSetup(), "pcf", wide).data);
}

// --- whose values they are ---

TEST(LiveParameters, TheCallersObjectIsFreeAfterwards) {
  Session session(builtinSetup("half_plane", {40, 30}));  // a floor below its source: no horizon cuts it
  const std::shared_ptr<void> values = parametersOf("ray_traced", R"({"samples": 4})");
  const OpenTechnique technique = registry().open("ray_traced");
  const Slot slot = session.addSlot(technique, values);
  *static_cast<int*>(technique.entry->parameters->find("samples")->make(values.get())) = 9;
  const std::uint64_t four = session.frame(slot).technique.counters.rays;
  const Slot single = addSlot(session, "ray_traced", R"({"samples": 1})");
  EXPECT_EQ(four, 4 * session.frame(single).technique.counters.rays);
}

TEST(LiveParameters, ARayTracerBuildsItsStructureOnce) {
  Session session(smallSetup());
  const Slot slot = addSlot(session, "ray_traced", R"({"samples": 2})");
  int built = 0;
  for (int seed = 0; seed < 4; ++seed) {
    setParameters(session, slot, "ray_traced", fmt::format(R"({{"samples": {}, "seed": {}}})", 2 + seed, seed));
    const std::vector<std::string> passes = ran(session.frame(slot).technique);
    built += static_cast<int>(std::count(passes.begin(), passes.end(), "build"));
    EXPECT_EQ(session.facts(slot).samples, 2 + seed);
  }
  EXPECT_EQ(built, 1);
}

}  // namespace
}  // namespace gnomon::test
