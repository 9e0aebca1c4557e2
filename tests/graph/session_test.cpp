// What a session runs again when something moves, by its counters.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/ext/matrix_transform.hpp>

#include "bench.h"

namespace gnomon::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class Moving : public testing::Test {
 protected:
  Moving() : session_(builtinSetup("pillars", {60, 45})) { first_ = session_.frame(slot_); }

  FrameReport frame(const GraphRun& options = {}) { return session_.frame(slot_, options); }

  Session session_;
  Slot slot_ = addSlot(session_, "shadow_map");
  FrameReport first_;
};

TEST_F(Moving, TheFirstFrameRunsAll) {
  EXPECT_THAT(ran(first_.shared), ElementsAre("view", "g-buffer", "light view", "receiver mask"));
  EXPECT_THAT(ran(first_.technique), ElementsAre("fit", "light depth", "compare"));
  EXPECT_THAT(ran(first_.shading), ElementsAre("shading"));
}

TEST_F(Moving, AStaticFrameRunsNoPass) {
  const FrameReport report = frame();
  EXPECT_EQ(report.technique.counters.passesRun, 0U);
  EXPECT_EQ(report.technique.counters.passesSkipped, 3U);
  EXPECT_EQ(report.shared.counters.passesRun, 0U);
  EXPECT_EQ(report.shading.counters.passesRun, 0U);
}

TEST_F(Moving, TheLightRunsFitDepthAndCompareAndNoGBuffer) {
  Light light = session_.light();
  light.position.x += 0.1;
  session_.moveLight(light);
  const FrameReport report = frame();
  EXPECT_THAT(ran(report.shared), ElementsAre("light view", "receiver mask"));
  EXPECT_THAT(ran(report.technique), ElementsAre("fit", "light depth", "compare"));
}

TEST_F(Moving, ALightThatDidNotReallyMoveDrawsNoMap) {
  session_.moveLight(session_.light());
  EXPECT_THAT(ran(frame().technique), ElementsAre("fit"));
}

TEST_F(Moving, TheCameraUnderAnUnchangedFitDrawsNoMap) {
  // Turned about the view's axis by 180 degrees, the camera sees the same part of space from the same place.
  Camera camera = session_.camera();
  camera.up = -camera.up;
  session_.moveCamera(camera);
  const FrameReport report = frame();
  EXPECT_THAT(ran(report.shared), ElementsAre("view", "g-buffer", "light view", "receiver mask"));
  EXPECT_THAT(ran(report.technique), ElementsAre("fit", "compare"));
}

TEST_F(Moving, TheCameraRunsWhatItsFitDependsOn) {
  Camera camera = session_.camera();
  camera.position = {0.5, 1.0, 2.0};  // close: other casters, other near and far
  session_.moveCamera(camera);
  EXPECT_THAT(ran(frame().technique), ElementsAre("fit", "light depth", "compare"));
}

TEST_F(Moving, AnInstanceRunsAll) {
  std::vector<glm::dmat4> worlds;
  for (const Instance& instance : session_.scene().instances) worlds.push_back(instance.world);
  worlds.back() = glm::translate(glm::dmat4(1.0), {0.0, 0.1, 0.0}) * worlds.back();
  session_.moveInstances(worlds);
  const FrameReport report = frame();
  EXPECT_THAT(ran(report.shared), testing::Contains("g-buffer"));
  EXPECT_THAT(ran(report.technique), ElementsAre("fit", "light depth", "compare"));
}

TEST_F(Moving, SkippingOffForAFrameRunsAll) {
  const FrameReport report = frame({.skipUnchanged = false});
  EXPECT_EQ(report.technique.counters.passesSkipped, 0U);
  EXPECT_EQ(report.shared.counters.passesSkipped, 0U);
}

TEST_F(Moving, BackAndForthGivesTheFirstPictureAgain) {
  const std::vector<float> before = session_.visibility(slot_).data;
  const Light home = session_.light();
  Light away = home;
  away.position.x += 0.5;
  session_.moveLight(away);
  frame();
  EXPECT_NE(session_.visibility(slot_).data, before);
  session_.moveLight(home);
  frame();
  EXPECT_EQ(session_.visibility(slot_).data, before);
}

TEST_F(Moving, ASecondSlotSharesTheGBufferAndNothingElse) {
  const Slot other = addSlot(session_, "shadow_map");
  const FrameReport report = session_.frame(other);
  EXPECT_THAT(ran(report.shared), IsEmpty());
  EXPECT_THAT(ran(report.technique), ElementsAre("fit", "light depth", "compare"));
}

TEST_F(Moving, AWrongNumberOfTransformsIsRefused) {
  EXPECT_THAT(errorOf([&] { session_.moveInstances({glm::dmat4(1.0)}); }), testing::HasSubstr("1 transforms for 19 instances"));
}

}  // namespace
}  // namespace gnomon::test
