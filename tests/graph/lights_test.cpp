// Several lights in one session: what they share, what each has of its own, and the picture of them all.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "allocations.h"
#include "bench.h"

namespace gnomon::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr const char* kMap = R"({"map_size": 128})";
constexpr float kAmbient = 0.12f;  // of shading.glsl

Light firstLight() {
  return builtinSetup("pillars", {60, 45}).light;
}

/// From another side, of another kind.
Light secondLight() {
  Light light;
  light.type = LightType::directional;
  light.position = {-6.0, 4.0, -7.0};
  light.intensity = 0.5;
  return light;
}

SessionSetup setupWith(const Light& light, const std::vector<Light>& more = {}) {
  SessionSetup setup = builtinSetup("pillars", {60, 45});
  setup.light = light;
  setup.moreLights = more;
  return setup;
}

Slot addSlotOf(Session& session, std::size_t light, const std::string& technique = "shadow_map",
               const std::string& json = kMap) {
  return session.addSlot(registry().open(technique), parametersOf(technique, json), light);
}

Image shadedAlone(const Light& light) {
  Session session(setupWith(light));
  const Slot slot = addSlotOf(session, 0);
  session.frame(slot);
  return session.shaded(slot);
}

Light moved(Light light) {
  light.position.x += 0.3;
  return light;
}

std::ptrdiff_t count(const std::vector<std::string>& passes, const std::string& name) {
  return std::count(passes.begin(), passes.end(), name);
}

class Lights : public testing::Test {
 protected:
  Slot sum() { return session_.addSum(std::array{first_, second_}); }

  Session session_{setupWith(firstLight(), {secondLight()})};
  Slot first_ = addSlotOf(session_, 0);
  Slot second_ = addSlotOf(session_, 1);
};

// --- each light by itself ---

TEST_F(Lights, EachVisibilityHasTheBitsOfASessionWithThatLightAlone) {
  session_.frame(first_);
  session_.frame(second_);
  EXPECT_EQ(session_.visibility(first_).data, renderVisibility(setupWith(firstLight()), "shadow_map", kMap).data);
  EXPECT_EQ(session_.visibility(second_).data, renderVisibility(setupWith(secondLight()), "shadow_map", kMap).data);
  EXPECT_NE(session_.visibility(first_).data, session_.visibility(second_).data);
}

TEST_F(Lights, EachPictureHasTheBitsOfASessionWithThatLightAlone) {
  session_.frame(second_);
  EXPECT_EQ(session_.shaded(second_).data, shadedAlone(secondLight()).data);
}

TEST_F(Lights, TheirOrderDoesNotMatterToAnyBit) {
  Session turned(setupWith(secondLight(), {firstLight()}));
  const Slot other = addSlotOf(turned, 1);
  session_.frame(first_);
  turned.frame(other);
  EXPECT_EQ(turned.visibility(other).data, session_.visibility(first_).data);
  EXPECT_EQ(turned.receiverMask(1).data, session_.receiverMask(0).data);
}

TEST_F(Lights, EachHasTheSurveyThePlanAndTheMaskOfASessionWithThatLightAlone) {
  Session alone(setupWith(secondLight()));
  alone.runShared();
  session_.runShared();
  EXPECT_EQ(session_.survey(1).receiverTriangles, alone.survey().receiverTriangles);
  EXPECT_EQ(session_.survey(1).casterTriangles, alone.survey().casterTriangles);
  const auto& decisions = session_.plan(1).decisions;
  for (std::size_t i = 0; i < decisions.size(); ++i) EXPECT_EQ(decisions[i].reason, alone.plan().decisions[i].reason);
  EXPECT_EQ(session_.receiverMask(1).data, alone.receiverMask().data);
  EXPECT_NE(session_.receiverMask(1).data, session_.receiverMask(0).data);
}

TEST(LightsThatSharePasses, StillHaveMapsOfTheirOwn) {  // fits of two lights are one pass in all but the light
  SessionSetup setup = setupWith(firstLight(), {moved(moved(firstLight()))});
  setup.sharePasses = true;
  Session session(setup);
  const Slot first = addSlotOf(session, 0);
  const Slot second = addSlotOf(session, 1);
  session.frame(first);
  session.frame(second);
  EXPECT_EQ(session.visibility(first).data, renderVisibility(setupWith(firstLight()), "shadow_map", kMap).data);
  EXPECT_EQ(session.visibility(second).data, renderVisibility(setupWith(session.light(1)), "shadow_map", kMap).data);
  EXPECT_THAT(ran(session.frame(first).technique), IsEmpty());  // the other took nothing of it
}

TEST_F(Lights, OneThatThereIsNotIsRefused) {
  EXPECT_EQ(session_.lights(), 2U);
  EXPECT_THAT(errorOf([&] { session_.moveLight(firstLight(), 2); }), HasSubstr("light 2: the session has 2"));
  EXPECT_THAT(errorOf([&] { addSlotOf(session_, 2); }), HasSubstr("light 2: the session has 2"));
}

// --- what moves ---

TEST_F(Lights, TheGBufferIsMadeOnceAFrame) {
  const std::vector<std::string> shared = ran(session_.frame(sum(), {.skipUnchanged = false}).shared);
  EXPECT_EQ(count(shared, "g-buffer"), 1);
  EXPECT_EQ(count(shared, "receiver mask"), 2);
}

TEST_F(Lights, MovingOneRunsNoPassOfTheOther) {
  session_.frame(first_);
  session_.frame(second_);
  session_.moveLight(moved(session_.light(1)), 1);
  const FrameReport first = session_.frame(first_);
  EXPECT_THAT(ran(first.shared), ElementsAre("light view", "receiver mask"));  // the moved one's
  EXPECT_EQ(first.technique.counters.passesRun, 0U);
  EXPECT_EQ(first.shading.counters.passesRun, 0U);
  EXPECT_THAT(ran(session_.frame(second_).technique), ElementsAre("fit", "light depth", "compare"));
}

TEST_F(Lights, MovingOneGivesTheBitsOfOneThatWasAlwaysThere) {
  session_.frame(second_);
  session_.moveLight(moved(secondLight()), 1);
  session_.frame(second_);
  EXPECT_EQ(session_.light(1).position, moved(secondLight()).position);
  EXPECT_EQ(session_.visibility(second_).data, renderVisibility(setupWith(moved(secondLight())), "shadow_map", kMap).data);
}

TEST_F(Lights, AnInstanceThatMovesMovesForAll) {
  session_.frame(second_);
  SessionSetup after = setupWith(secondLight());
  std::vector<glm::dmat4> worlds;
  for (Instance& instance : after.scene.instances) {
    instance.world[3].y += 0.25;
    worlds.push_back(instance.world);
  }
  session_.moveInstances(worlds);
  session_.frame(second_);
  EXPECT_EQ(session_.visibility(second_).data, renderVisibility(after, "shadow_map", kMap).data);
}

TEST_F(Lights, ReceiversAreRestrictedForAll) {
  Image left(60, 45);
  left.at(7, 30, 0) = 1.0f;
  session_.restrictReceivers(left);
  session_.runShared();
  for (const std::size_t light : {0U, 1U}) {
    const Image mask = session_.receiverMask(light);
    EXPECT_LE(std::count(mask.data.begin(), mask.data.end(), 1.0f), 1) << light;
  }
}

// --- their sum ---

TEST_F(Lights, TheirSumIsThatOfThePicturesOfEach) {  // less one ambient term, within the rounding of the halves it is made of
  const Slot all = sum();
  session_.frame(all);
  const Image shown = session_.shaded(all);
  const Image first = shadedAlone(firstLight());
  const Image second = shadedAlone(secondLight());
  // Ambient alone: a light that brings nothing.
  Light dark = firstLight();
  dark.intensity = 0.0;
  const Image ambient = shadedAlone(dark);
  int lit = 0;
  for (std::size_t i = 0; i < shown.data.size(); ++i) {
    const float expected = first.data[i] + second.data[i] - ambient.data[i];
    const float largest = std::max({first.data[i], second.data[i], expected});
    ASSERT_NEAR(shown.data[i], expected, largest * 4.0f / 2048.0f) << i;  // four values, each half a unit of 2^-10 off
    lit += first.data[i] > ambient.data[i] && second.data[i] > ambient.data[i] ? 1 : 0;
  }
  EXPECT_GT(lit, 100) << "both lights shine on the same pixels somewhere";
}

TEST_F(Lights, AmbientLightIsThereOnce) {
  Session dark([] {
    Light none = firstLight();
    none.intensity = 0.0;
    return setupWith(none, {none});
  }());
  const Slot one = addSlotOf(dark, 0);
  const Slot all = dark.addSum(std::array{one, addSlotOf(dark, 1)});
  dark.frame(one);
  dark.frame(all);
  EXPECT_EQ(dark.shaded(all).data, dark.shaded(one).data);
}

TEST_F(Lights, ASumOfOneHasTheBitsOfItsSlot) {
  const Slot one = session_.addSum(std::array{second_});
  session_.frame(one);
  EXPECT_EQ(session_.shaded(one).data, shadedAlone(secondLight()).data);
}

TEST_F(Lights, AFrameOfTheSumRunsTheTechniquesOfAll) {
  const FrameReport report = session_.frame(sum());
  EXPECT_THAT(ran(report.technique), ElementsAre("fit", "light depth", "compare", "fit", "light depth", "compare"));
  EXPECT_EQ(report.technique.counters.passesRun, 6U);
  EXPECT_THAT(ran(report.shading), ElementsAre("shading", "shading, light 2 of 2"));
  EXPECT_THAT(session_.passNames(first_), Not(IsEmpty()));
}

TEST_F(Lights, AStaticFrameOfTheSumRunsNothing) {
  const Slot all = sum();
  session_.frame(all);
  const FrameReport report = session_.frame(all);
  EXPECT_EQ(report.shared.counters.passesRun + report.technique.counters.passesRun + report.shading.counters.passesRun, 0U);
}

TEST_F(Lights, TheSumAddsOnlyTheLightThatMoved) {
  const Slot all = sum();
  session_.frame(all);
  session_.moveLight(moved(secondLight()), 1);
  const FrameReport report = session_.frame(all);
  EXPECT_THAT(ran(report.technique), ElementsAre("fit", "light depth", "compare"));
  EXPECT_THAT(ran(report.shading), ElementsAre("shading, light 2 of 2"));
}

TEST(SumOfLights, TakesNoMemoryInAFrame) {
  SessionSetup setup = builtinSetup("sphere_grid", {60, 45}, R"({"count": 20})");
  setup.moreLights = {moved(setup.light)};
  Session session(setup);
  const Slot first = addSlotOf(session, 0);
  const Slot all = session.addSum(std::array{first, addSlotOf(session, 1)});
  std::size_t taken = 0;
  for (int i = 0; i < 4; ++i) {  // the first ones grow what grows
    Light pose = setup.moreLights[0];
    pose.position.x += 0.01 * i;
    session.moveLight(pose, 1);
    const std::size_t before = allocations();
    session.frame(all);
    taken = allocations() - before;
  }
  EXPECT_EQ(taken, 0U);
}

TEST_F(Lights, TheSumShowsWhatTookASlotsPlace) {
  const Slot all = sum();
  session_.frame(all);
  session_.replaceSlot(second_, registry().open("unshadowed"), parametersOf("unshadowed", "{}"));
  session_.frame(all);
  Session fresh(setupWith(firstLight(), {secondLight()}));
  const Slot expected = fresh.addSum(std::array{addSlotOf(fresh, 0), addSlotOf(fresh, 1, "unshadowed", "{}")});
  fresh.frame(expected);
  EXPECT_EQ(session_.shaded(all).data, fresh.shaded(expected).data);
}

TEST_F(Lights, TheSumShowsPicturesOfALight) {
  session_.frame(second_);
  const auto picture = std::make_shared<TextureResource>(session_.visibilityTexture(second_));
  const Slot shown = session_.addPicture(picture, 1);
  const Slot all = session_.addSum(std::array{first_, shown});
  session_.frame(all);
  const Image withPicture = session_.shaded(all);
  const Slot both = sum();
  session_.frame(both);
  EXPECT_EQ(withPicture.data, session_.shaded(both).data);
}

TEST_F(Lights, ASumHasNoVisibilityAndNoParameters) {
  const Slot all = sum();
  EXPECT_THAT(errorOf([&] { session_.visibility(all); }), HasSubstr("a sum of lights has no visibility"));
  EXPECT_THAT(errorOf([&] { session_.facts(all); }), HasSubstr("a sum of lights states no facts"));
  EXPECT_THAT(errorOf([&] { session_.setParameters(all, registry().open("pcf"), parametersOf("pcf", "{}")); }),
              HasSubstr("a sum of lights has no parameters"));
  EXPECT_THAT(errorOf([&] { session_.replaceSlot(all, registry().open("pcf"), parametersOf("pcf", "{}")); }),
              HasSubstr("a sum of lights has no technique"));
}

TEST_F(Lights, NoSlotAndSumsAreNotSummed) {
  EXPECT_THAT(errorOf([&] { session_.addSum({}); }), HasSubstr("a sum of no slots"));
  const Slot all = sum();
  EXPECT_THAT(errorOf([&] { session_.addSum(std::array{all}); }), HasSubstr("a sum of lights is none to sum"));
}

// --- refusals ---

/// A light that shadow_map refuses.
Light pointLight() {
  Light light;
  light.type = LightType::point;
  light.position = {0.0, 5.0, 0.0};
  return light;
}

TEST(SumOfLights, LeavesARefusedOneOut) {
  Session session(setupWith(firstLight(), {pointLight()}));
  const Slot good = addSlotOf(session, 0);
  const Slot refused = addSlotOf(session, 1);
  ASSERT_FALSE(session.support(refused).ok());
  const Slot all = session.addSum(std::array{good, refused});
  EXPECT_TRUE(session.support(all).ok());
  session.frame(all);
  EXPECT_EQ(session.shaded(all).data, shadedAlone(firstLight()).data);
}

TEST(SumOfLights, IsRefusedWhereAllAre) {
  Session session(setupWith(pointLight(), {pointLight()}));
  const Slot first = addSlotOf(session, 0);
  const Slot all = session.addSum(std::array{first, addSlotOf(session, 1)});
  EXPECT_EQ(session.support(all).refusal, session.support(first).refusal);
  EXPECT_FALSE(session.support(all).ok());
}

TEST(SumOfLights, TakesARefusedSlotInOnceItServes) {
  Session session(setupWith(firstLight(), {pointLight()}));
  const Slot good = addSlotOf(session, 0);
  const Slot other = addSlotOf(session, 1);
  const Slot all = session.addSum(std::array{good, other});
  session.replaceSlot(other, registry().open("unshadowed"), parametersOf("unshadowed", "{}"));
  session.frame(all);
  EXPECT_NE(session.shaded(all).data, shadedAlone(firstLight()).data);
}

}  // namespace
}  // namespace gnomon::test
