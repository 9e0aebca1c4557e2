#include "gnomon/technique/effects.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "gnomon/base/json.h"

namespace gnomon {
namespace {

SceneSurvey softScene() {
  SceneSurvey survey;
  survey.triangles = 100;
  survey.casterTriangles = 80;
  survey.receiverTriangles = 20;
  survey.facingTriangles = 10;
  survey.sourceHasExtent = true;
  survey.widestPenumbraPixels = 30.0;
  survey.nearestCasterDistance = 2.0;
  survey.farthestReceiverDistance = 12.0;
  return survey;
}

EffectPlan plan(const SceneSurvey& survey, const PlanOverrides& overrides = {}) {
  return planEffects(survey, Light{}, Camera{}, overrides);
}

const PlanDecision& decision(const EffectPlan& plan, Effect effect) {
  return plan.decisions[planIndex(effect)];
}
const PlanDecision& decision(const EffectPlan& plan, Rule rule) {
  return plan.decisions[planIndex(rule)];
}

TEST(EffectPlan, DecidesEveryNameWithAReason) {
  const EffectPlan all = plan(softScene());
  ASSERT_EQ(all.decisions.size(), kEffects + kRules);
  for (std::size_t i = 0; i < all.decisions.size(); ++i) {
    EXPECT_EQ(all.decisions[i].name, planNames()[i]);
    EXPECT_FALSE(all.decisions[i].reason.empty());
  }
  EXPECT_EQ(decision(all, Effect::motion).name, "motion");
  EXPECT_EQ(decision(all, Rule::skipping).name, "skipping");
}

TEST(EffectPlan, NoExtentMeansNoPenumbra) {
  SceneSurvey survey = softScene();
  EXPECT_TRUE(plan(survey).has(Effect::penumbra));
  survey.sourceHasExtent = false;
  EXPECT_FALSE(plan(survey).has(Effect::penumbra));
  EXPECT_NE(decision(plan(survey), Effect::penumbra).reason.find("no extent"), std::string::npos);
}

TEST(EffectPlan, PenumbraUnderHalfAPixelIsOff) {
  SceneSurvey survey = softScene();
  survey.widestPenumbraPixels = 0.4999;
  const PlanDecision narrow = decision(plan(survey), Effect::penumbra);
  EXPECT_FALSE(narrow.on);
  EXPECT_EQ(narrow.value, 0.4999);
  EXPECT_EQ(narrow.reason, "the widest possible penumbra is 0.4999 pixels, under 0.5: nobody searches for it");
  survey.widestPenumbraPixels = 0.5;
  EXPECT_TRUE(plan(survey).has(Effect::penumbra));
}

TEST(EffectPlan, PenumbraWithoutBoundOrNumberIsOn) {
  SceneSurvey survey = softScene();
  for (const double width : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    survey.widestPenumbraPixels = width;
    EXPECT_TRUE(plan(survey).has(Effect::penumbra)) << width;
  }
}

TEST(EffectPlan, WithoutPenumbraNoneVariesOrOverlaps) {
  SceneSurvey survey = softScene();
  EXPECT_TRUE(plan(survey).has(Effect::varyingPenumbra));
  EXPECT_TRUE(plan(survey).has(Effect::overlappingPenumbrae));
  survey.sourceHasExtent = false;
  EXPECT_FALSE(plan(survey).has(Effect::varyingPenumbra));
  EXPECT_FALSE(plan(survey).has(Effect::overlappingPenumbrae));
}

TEST(EffectPlan, OneCasterTriangleOverlapsNone) {
  SceneSurvey survey = softScene();
  survey.casterTriangles = 1;
  EXPECT_FALSE(plan(survey).has(Effect::overlappingPenumbrae));
  survey.casterTriangles = 2;
  EXPECT_TRUE(plan(survey).has(Effect::overlappingPenumbrae));
}

TEST(EffectPlan, SelfShadowingNeedsCastersAndReceivers) {
  SceneSurvey survey = softScene();
  EXPECT_TRUE(plan(survey).has(Effect::selfShadowing));
  survey.receiverTriangles = 0;
  EXPECT_FALSE(plan(survey).has(Effect::selfShadowing));
}

TEST(EffectPlan, OnlyPointLightsShineAllAround) {
  Light light;
  const auto decided = [&] { return decision(planEffects(softScene(), light, Camera{}), Effect::omnidirectionalLight); };
  light.coneHalfAngleDegrees = 90.0;
  EXPECT_FALSE(decided().on);
  EXPECT_EQ(decided().value, 180.0);
  light.type = LightType::directional;
  EXPECT_FALSE(decided().on);
  light.type = LightType::point;
  EXPECT_TRUE(decided().on);
}

TEST(EffectPlan, DepthRangeIsLargeAbove256) {
  SceneSurvey survey = softScene();
  survey.farthestReceiverDistance = 512.0;
  EXPECT_FALSE(plan(survey).has(Effect::largeDepthRange));
  EXPECT_EQ(decision(plan(survey), Effect::largeDepthRange).value, 256.0);
  survey.farthestReceiverDistance = 512.1;
  EXPECT_TRUE(plan(survey).has(Effect::largeDepthRange));
  survey.nearestCasterDistance = 0.0;
  EXPECT_TRUE(plan(survey).has(Effect::largeDepthRange));
}

TEST(EffectPlan, WhatTheSceneCannotHoldIsOff) {
  const EffectPlan decided = plan(softScene());
  for (const Effect effect : {Effect::alphaTestedCasters, Effect::translucentCasters}) {
    EXPECT_FALSE(decided.has(effect));
    EXPECT_EQ(decision(decided, effect).value, 0.0);
  }
}

TEST(EffectPlan, MotionIsWhereInstancesRideOnAnAnimation) {
  SceneSurvey survey = softScene();
  EXPECT_FALSE(plan(survey).has(Effect::motion));
  survey.movingInstances = 3;
  EXPECT_TRUE(plan(survey).has(Effect::motion));
  EXPECT_EQ(decision(plan(survey), Effect::motion).value, 3.0);
}

TEST(EffectPlan, WhatWasNotSurveyedHasNoNumber) {
  EXPECT_TRUE(std::isnan(decision(plan(softScene()), Effect::wideView).value));
  EXPECT_EQ(toJson(*planDecisionTable()->find("value"), &decision(plan(softScene()), Effect::wideView)).dump(), "null");
}

TEST(EffectPlan, NoReceiverThatFacesTheLightMeansNothingRuns) {
  SceneSurvey survey = softScene();
  survey.facingTriangles = 1;
  EXPECT_TRUE(plan(survey).has(Rule::receivers));
  survey.facingTriangles = 0;
  EXPECT_FALSE(plan(survey).has(Rule::receivers));
  EXPECT_EQ(decision(plan(survey), Rule::receivers).reason, "no visible receiver faces the light: nothing runs and V is 1");
}

TEST(EffectPlan, CullingAndFittingNeedCasters) {
  SceneSurvey survey = softScene();
  EXPECT_TRUE(plan(survey).has(Rule::culling));
  EXPECT_TRUE(plan(survey).has(Rule::fitting));
  EXPECT_EQ(decision(plan(survey), Rule::fitting).value, 10.0);
  survey.casterTriangles = 0;
  EXPECT_FALSE(plan(survey).has(Rule::culling));
  EXPECT_FALSE(plan(survey).has(Rule::fitting));
}

TEST(EffectPlan, SkippingIsOnUntilTurnedOff) {
  PlanOverrides overrides;
  EXPECT_TRUE(plan(softScene()).has(Rule::skipping));
  overrides[Rule::skipping] = Toggle::off;
  EXPECT_FALSE(plan(softScene(), overrides).has(Rule::skipping));
}

TEST(EffectPlan, OverrideKeepsTheNumberAndSaysBoth) {
  PlanOverrides overrides;
  overrides[Effect::penumbra] = Toggle::off;
  const PlanDecision forced = decision(plan(softScene(), overrides), Effect::penumbra);
  EXPECT_FALSE(forced.on);
  EXPECT_EQ(forced.value, 30.0);
  EXPECT_EQ(forced.reason, "set off by the config; the survey says: the widest possible penumbra is 30 pixels");
}

TEST(EffectPlan, NothingDecidedMeansOff) {
  EXPECT_FALSE(EffectPlan{}.has(Effect::penumbra));
  EXPECT_FALSE(EffectPlan{}.has(Rule::skipping));
}

TEST(PlanOverrides, AreReadByName) {
  PlanOverrides overrides;
  Problems problems;
  readObject(Json{{"penumbra", "off"}, {"culling", "on"}, {"penumbr", "auto"}, {"motion", "maybe"}}, *planOverridesTable(),
             &overrides, {"f", "/plan"}, problems);
  EXPECT_EQ(overrides[Effect::penumbra], Toggle::off);
  EXPECT_EQ(overrides[Rule::culling], Toggle::on);
  ASSERT_EQ(problems.list().size(), 2U);
  EXPECT_NE(problems.list()[0].message.find("did you mean \"penumbra\""), std::string::npos);
  EXPECT_EQ(problems.list()[1].pointer, "/plan/motion");
}

// --- defences ---

TEST(Defences, AreOnUnlessSwitchedOff) {
  const EffectPlan all = plan(softScene());
  EXPECT_TRUE(all.defence("min_variance"));
  EXPECT_TRUE(all.defencesOff().empty());
  EXPECT_TRUE(EffectPlan{}.defence("min_variance"));
}

TEST(Defences, ThoseSwitchedOffStandInThePlanBehindAllElse) {
  PlanOverrides overrides;
  overrides.without = {"min_variance", "bias", "min_variance"};
  const EffectPlan some = plan(softScene(), overrides);
  EXPECT_FALSE(some.defence("min_variance"));
  EXPECT_FALSE(some.defence("bias"));
  EXPECT_TRUE(some.defence("variance"));
  EXPECT_EQ(some.defencesOff(), (std::set<std::string>{"bias", "min_variance"}));
  ASSERT_EQ(some.decisions.size(), kEffects + kRules + 2);
  EXPECT_EQ(some.decisions[kEffects + kRules].name, "defence min_variance");
  EXPECT_FALSE(some.decisions[kEffects + kRules].on);
  EXPECT_EQ(decision(some, Rule::skipping).name, "skipping");
}

TEST(Defences, AreSwitchedOffByAConfigsPlan) {
  PlanOverrides overrides;
  Problems problems;
  readObject(Json{{"without", {"bias"}}}, *planOverridesTable(), &overrides, {"run.json", "/plan"}, problems);
  EXPECT_TRUE(problems.empty());
  EXPECT_EQ(overrides.without, std::vector<std::string>{"bias"});
}

}  // namespace
}  // namespace gnomon
