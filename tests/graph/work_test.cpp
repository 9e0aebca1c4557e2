// What passes are counted to do.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

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

// --- texel reads, counted by hand ---

/// A technique on pillars, counted; pixels of which `mask` reads one texel of the mask, receivers more.
struct Counted {
  explicit Counted(const std::string& technique, const std::string& parameters)
      : session(builtinSetup("pillars", {60, 45})), slot(addSlot(session, technique, parameters)) {
    session.frame(slot);
    visibility = session.visibility(slot);
    report = session.runTechnique(slot, {.skipUnchanged = false, .countReads = true});
    const Image mask = session.receiverMask();
    receivers = static_cast<std::uint64_t>(std::count(mask.data.begin(), mask.data.end(), 1.0f));
  }
  std::uint64_t reads(const std::string& pass, Format format) const {
    const auto& all = passOf(report, pass).reads.value();
    const auto found = all.find(format);
    return found == all.end() ? 0 : found->second;
  }

  Session session;
  Slot slot;
  Image visibility;
  GraphReport report;
  std::uint64_t receivers = 0;
  static constexpr std::uint64_t kPixels = 60 * 45;
};

TEST(Reads, OfPcfAreItsTapsAndTheGBuffer) {
  for (const int taps : {2, 3, 9}) {
    const Counted pcf("pcf", fmt::format(R"({{"map_size": 64, "taps": {}}})", taps));
    const std::string pass = pcf.report.passes.back().name;
    EXPECT_EQ(pcf.reads(pass, Format::d32f), static_cast<std::uint64_t>(taps * taps) * pcf.receivers) << taps;
    EXPECT_EQ(pcf.reads(pass, Format::r8), Counted::kPixels) << taps;
    EXPECT_EQ(pcf.reads(pass, Format::rgba32f) + pcf.reads(pass, Format::rgba16f), 2 * pcf.receivers) << taps;
  }
}

TEST(Reads, OfPixelsSumToThoseOfTheScreensPass) {
  const Counted pcf("pcf", R"({"map_size": 64, "taps": 5})");
  double pixels = 0.0;
  for (const float reads : pcf.report.pixelReads.data) pixels += static_cast<double>(reads);
  std::uint64_t all = 0;
  for (const auto& [format, texels] : passOf(pcf.report, pcf.report.passes.back().name).reads.value()) all += texels;
  EXPECT_EQ(static_cast<std::uint64_t>(pixels), all);
}

TEST(Reads, LieWhereTheReceiversAre) {
  const Counted pcf("pcf", R"({"map_size": 64, "taps": 5})");
  const Image mask = pcf.session.receiverMask();
  for (std::size_t i = 0; i < mask.data.size(); ++i) {
    if (mask.data[i] == 0.0f) {
      ASSERT_EQ(pcf.report.pixelReads.data[i], 1.0f) << i;  // the mask alone
    } else {
      ASSERT_EQ(pcf.report.pixelReads.data[i], 28.0f) << i;  // and position, normal, 25 taps
    }
  }
}

TEST(Reads, OfMapsAreNotThoseOfPixels) {
  const Counted vsm("vsm_gaussian", R"({"map_size": 64})");
  std::uint64_t all = 0;
  for (const PassReport& pass : vsm.report.passes) {
    for (const auto& [format, texels] : pass.reads.value_or(std::map<Format, std::uint64_t>{})) all += texels;
  }
  double pixels = 0.0;
  for (const float reads : vsm.report.pixelReads.data) pixels += static_cast<double>(reads);
  EXPECT_GT(pixels, 0.0);
  EXPECT_GT(static_cast<double>(all), pixels + 64.0 * 64.0);
}

class ReadsOf : public testing::TestWithParam<const char*> {};

TEST_P(ReadsOf, EveryTechniqueAreCountedTheSameTwiceAndChangeNothing) {
  Counted counted(GetParam(), "{}");
  EXPECT_EQ(counted.session.visibility(counted.slot).data, counted.visibility.data);
  const GraphReport again = counted.session.runTechnique(counted.slot, {.skipUnchanged = false, .countReads = true});
  for (std::size_t i = 0; i < again.passes.size(); ++i) {
    EXPECT_EQ(again.passes[i].reads, counted.report.passes[i].reads) << again.passes[i].name;
    EXPECT_EQ(again.passes[i].uncounted, "");
  }
  EXPECT_EQ(again.pixelReads.data, counted.report.pixelReads.data);
}

INSTANTIATE_TEST_SUITE_P(Techniques, ReadsOf,
                         testing::Values("unshadowed", "shadow_map", "pcf", "vsm", "vsm_gaussian", "esm", "pcss",
                                         "ray_traced"));

TEST(Reads, AreNotCountedUnlessAskedFor) {
  Session session(builtinSetup("pillars", {60, 45}));
  const Slot slot = addSlot(session, "pcf");
  for (const PassReport& pass : session.frame(slot).technique.passes) EXPECT_FALSE(pass.reads.has_value());
  EXPECT_TRUE(session.frame(slot).technique.pixelReads.data.empty());
}

TEST_F(Work, BytesWrittenAreThoseOfTheTargets) {
  EXPECT_EQ(passOf(counted(), "light depth").work.bytesWritten, 64U * 64U * 4U);
  EXPECT_EQ(passOf(counted(), "compare").work.bytesWritten, 60U * 45U * 4U);
}

}  // namespace
}  // namespace gnomon::test
