// A standard error to reach: rays are saved, and nothing else changes. (That stopping favours no sample is seen by StoppedEarly
// of tests/analytic/reference_test.cpp.)
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "agreement.h"
#include "soup.h"

namespace gnomon::test {
namespace {

struct Traced {
  Image visibility, statistics, mask;
  std::uint64_t rays = 0, saved = 0;
  std::uint64_t receivers() const { return static_cast<std::uint64_t>(std::count(mask.data.begin(), mask.data.end(), 1.0f)); }
};

Traced trace(Session& session, int samples, double standardError, int seed = 0) {
  const Slot slot = addSlot(
      session, "ray_traced",
      fmt::format(R"({{"samples": {}, "standard_error": {}, "seed": {}, "statistics": true}})", samples, standardError, seed));
  const FrameCounters counters = session.frame(slot).technique.counters;
  Traced result{session.visibility(slot), session.statistics(slot).value(), session.receiverMask(), counters.rays,
                counters.raysSaved};
  session.removeSlots();
  return result;
}

/// The name of a built-in scene, or of a kind of source over half_plane's edge.
SessionSetup setupOf(const std::string& name) {
  const bool isKind = std::find(kSourceKinds.begin(), kSourceKinds.end(), name) != kSourceKinds.end();
  SessionSetup setup = builtinSetup(isKind ? "half_plane" : name, {64, 48});
  if (isKind) setup.light = soupLight(name);
  return setup;
}

class Adaptive : public testing::TestWithParam<std::string> {};

TEST_P(Adaptive, RaysAndSavedRaysAreThoseOfTheFixedNumber) {
  Session session(setupOf(GetParam()));
  const Traced fixed = trace(session, 256, 0.0);
  EXPECT_EQ(fixed.saved, 0u);
  for (const double target : {0.01, 0.05}) {
    const Traced t = trace(session, 256, target);
    EXPECT_GT(t.saved, 0u);
    // Samples below a receiver's horizon are no rays: the fixed number has fewer than 256 a receiver there, and of those that
    // were not taken nobody knows.
    EXPECT_GE(t.rays + t.saved, fixed.rays);
    EXPECT_LE(t.rays + t.saved, 256 * t.receivers());
    RecordProperty(fmt::format("{}", target),
                   fmt::format("{:.3f} of the rays", static_cast<double>(t.rays) / static_cast<double>(fixed.rays)));
  }
  EXPECT_LT(trace(session, 256, 0.05).rays, trace(session, 256, 0.01).rays);
}

TEST_P(Adaptive, ProvenPixelsAreThoseOfTheFixedNumber) {
  Session session(setupOf(GetParam()));
  const Traced fixed = trace(session, 1024, 0.0);
  const Traced t = trace(session, 1024, 0.02);
  std::size_t proven = 0;
  std::size_t lit = 0;
  for (std::size_t i = 0; i < t.mask.pixels(); ++i) {
    if (t.mask.data[i] < 0.5f || t.statistics.data[2 * i] != 0.0f) continue;
    ++proven;
    lit += t.visibility.data[i] == 1.0f ? 1 : 0;
    EXPECT_EQ(t.visibility.data[i], fixed.visibility.data[i]) << "pixel " << i;
    EXPECT_EQ(t.statistics.data[2 * i + 1], t.visibility.data[i]) << "V_cos, pixel " << i;
  }
  RecordProperty("proven", fmt::format("{} lit, {} dark of {}", lit, proven - lit, t.receivers()));
  EXPECT_GE(2 * lit, t.receivers());  // casters are few and far between
  if (GetParam() != "sphere_grid") {
    EXPECT_GE(proven - lit, 10u);  // a proof of darkness needs one triangle that hides all of the source; there are none there
  }
}

TEST_P(Adaptive, PixelsStopAtTheTargetOrWithAllSamples) {
  Session session(setupOf(GetParam()));
  constexpr double target = 0.04;
  const Traced t = trace(session, 4096, target);  // enough for every pixel: 0.5 / sqrt(4096) = 0.008
  for (std::size_t i = 0; i < t.mask.pixels(); ++i) {
    // Each sequence stops by the other's figure, so that both together may be above it, though not by much.
    if (t.mask.data[i] < 0.5f) continue;
    EXPECT_LE(t.statistics.data[2 * i], 2.0 * target) << "pixel " << i;
  }
}

TEST_P(Adaptive, StandardErrorIsThatOverSeeds) {
  constexpr int seeds = 24;
  Session session(setupOf(GetParam()));
  for (const double target : {0.0, 0.03}) {
    std::vector<Traced> all;
    for (int seed = 0; seed < seeds; ++seed) all.push_back(trace(session, target > 0.0 ? 1024 : 64, target, seed));
    double seen = 0.0;
    double said = 0.0;
    double saidOfVarying = 0.0;
    std::vector<double> values(seeds);
    for (std::size_t i = 0; i < all[0].mask.pixels(); ++i) {
      if (all[0].mask.data[i] < 0.5f) continue;
      double saidHere = 0.0;
      for (std::size_t s = 0; s < seeds; ++s) {
        values[s] = all[s].visibility.data[i];
        saidHere += std::pow(all[s].statistics.data[2 * i], 2) / seeds;
      }
      const double seenHere = variance(values);
      said += saidHere;
      seen += seenHere;
      if (seenHere > 0.0) saidOfVarying += saidHere;
    }
    const double ratio = std::sqrt(said / seen);
    const double ratioOfVarying = std::sqrt(saidOfVarying / seen);
    RecordProperty(fmt::format("target {}", target),
                   fmt::format("{:.2f} of the spread, {:.2f} where there is one", ratio, ratioOfVarying));
    EXPECT_GT(ratio, 0.95);          // never too hopeful
    EXPECT_LT(ratioOfVarying, 2.0);  // an upper estimate: by 8^(1/4) = 1.7 across a straight edge, and by 1/(2n) beside it
  }
}

TEST_P(Adaptive, MeanIsThatOfTheFixedNumber) {
  constexpr int seeds = 16;
  Session session(setupOf(GetParam()));
  std::vector<double> fixedMeans;
  std::vector<double> means;
  const auto meanOf = [](const Traced& t) {
    return std::accumulate(t.visibility.data.begin(), t.visibility.data.end(), 0.0) / static_cast<double>(t.mask.pixels());
  };
  for (int seed = 0; seed < seeds; ++seed) {
    fixedMeans.push_back(meanOf(trace(session, 64, 0.0, seed)));
    means.push_back(meanOf(trace(session, 512, 0.05, 100 + seed)));
  }
  const double error = std::sqrt((variance(means) + variance(fixedMeans)) / seeds);
  const double t = (mean(means) - mean(fixedMeans)) / error;
  RecordProperty("difference", fmt::format("{:.2e} +- {:.1e}", mean(means) - mean(fixedMeans), error));
  EXPECT_GT(2.0 * studentTCdf(-std::abs(t), seeds - 1.0), 1e-4) << t;
}

INSTANTIATE_TEST_SUITE_P(RayTraced, Adaptive,
                         testing::Values("pillars", "sphere_grid", "layers", "rectangle", "disc", "sphere", "directions"),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace gnomon::test
