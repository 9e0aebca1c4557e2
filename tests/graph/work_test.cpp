// What passes are counted to do.
#include <gtest/gtest.h>

#include <algorithm>

#include "bench.h"
#include "gnomon/run/light_run.h"

namespace gnomon::test {
namespace {

const PassReport& passOf(const GraphReport& report, const std::string& name) {
  const auto found = std::find_if(report.passes.begin(), report.passes.end(), [&](const auto& p) { return p.name == name; });
  if (found == report.passes.end()) throw Error("no pass is called " + name);
  return *found;
}

class Work : public testing::Test {
 protected:
  Work() { session_.frame(slot_); }
  const GraphReport& counted(bool skipUnchanged = false) {
    return session_.runTechnique(slot_, {.skipUnchanged = skipUnchanged, .countFragments = true});
  }
  std::uint64_t receivers() const {
    const Image mask = session_.receiverMask();
    return static_cast<std::uint64_t>(std::count(mask.data.begin(), mask.data.end(), 1.0f));
  }

  /// Texels of the depth map that hold a caster.
  std::uint64_t covered() const {
    for (const auto& texture : session_.textures(slot_)) {
      if (texture->info.size != glm::ivec2(64, 64)) continue;
      const Image depth = readTexture(*texture);
      return static_cast<std::uint64_t>(depth.data.size()) -
             static_cast<std::uint64_t>(std::count(depth.data.begin(), depth.data.end(), 0.0f));
    }
    throw Error("there is no map of that size");
  }

  Session session_{builtinSetup("pillars", {60, 45})};
  Slot slot_ = addSlot(session_, "shadow_map", R"({"map_size": 64})");
};

TEST_F(Work, AFullscreenPassThatDiscardsCountsItsReceivers) {
  EXPECT_GT(receivers(), 500U);
  EXPECT_EQ(passOf(counted(), "compare").fragments, receivers());
}

TEST_F(Work, ADepthPassCountsTrianglesAndSamplesThatPassed) {
  const PassReport& depth = passOf(counted(), "light depth");
  EXPECT_GT(depth.work.primitives, 100U);
  EXPECT_GE(depth.fragments.value(), covered());  // a texel may be drawn more than once
  EXPECT_EQ(depth.work.texelsWritten, 64U * 64U);
}

TEST_F(Work, PassesSumToTheFrame) {
  const GraphReport& report = counted();
  FrameCounters sum;
  for (const PassReport& pass : report.passes) sum += pass.work;
  EXPECT_EQ(sum.primitives, report.counters.primitives);
  EXPECT_EQ(sum.texelsWritten, report.counters.texelsWritten);
  EXPECT_EQ(sum.draws, report.counters.draws);
}

TEST_F(Work, APassOnTheCpuHasNoFragments) {
  EXPECT_FALSE(passOf(counted(), "fit").fragments.has_value());
}

TEST_F(Work, WhatIsSkippedDidNothing) {
  const PassReport& depth = passOf(counted(true), "light depth");
  EXPECT_FALSE(depth.fragments.has_value());
  EXPECT_EQ(depth.work.primitives, 0U);
}

TEST_F(Work, AStepOfTheDynamicRegimeDrawsTheDepthMap) {  // so a shadow map's headline time includes it
  session_.moveLight(lightAtPose(session_.light(), 1, 12));
  session_.runShared();
  const PassReport& depth = passOf(counted(true), "light depth");
  EXPECT_TRUE(depth.ran);
  EXPECT_GT(depth.work.primitives, 100U);
}

TEST_F(Work, CountingLeavesThePictureAsItIs) {
  const Image before = session_.visibility(slot_);
  counted();
  EXPECT_EQ(session_.visibility(slot_).data, before.data);
}

}  // namespace
}  // namespace gnomon::test
