#include <gtest/gtest.h>

#include <algorithm>

#include "render.h"

namespace gnomon::test {
namespace {

constexpr glm::ivec2 kOutput{80, 60};

class Unshadowed : public testing::Test {
 protected:
  Unshadowed() : session(builtinSetup("square", kOutput)), slot(addSlot(session, "unshadowed")), report(session.frame(slot)) {}

  Session session;
  Slot slot;
  FrameReport report;
};

TEST_F(Unshadowed, IsLitEverywhere) {
  const Image v = session.visibility(slot);
  ASSERT_EQ(v.pixels(), 80u * 60u);
  EXPECT_TRUE(std::all_of(v.data.begin(), v.data.end(), [](float value) { return value == 1.0f; }));
}

TEST_F(Unshadowed, IsOneFullScreenPass) {
  EXPECT_EQ(session.passNames(slot), std::vector<std::string>{"constant"});
  EXPECT_EQ(report.technique.counters.passesRun, 1u);
  EXPECT_EQ(report.technique.counters.draws, 1u);
  EXPECT_EQ(report.technique.counters.texelsWritten, 80u * 60u);
  EXPECT_EQ(report.technique.counters.rays, 0u);
}

TEST_F(Unshadowed, RunsOnceHoweverManyFramesThereAre) {
  session.moveLight(session.light());
  EXPECT_EQ(session.frame(slot).technique.counters.passesRun, 0u);
}

TEST_F(Unshadowed, HoldsItsPictureAndNothingElse) {  // two bytes a pixel
  EXPECT_GE(session.memoryBytes(slot), 2u * 80u * 60u);
  EXPECT_LE(session.memoryBytes(slot), 2u * 80u * 60u + 64u);  // a block of no parameters takes some bytes
}

}  // namespace
}  // namespace gnomon::test
