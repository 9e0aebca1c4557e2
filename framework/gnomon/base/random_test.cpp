#include "gnomon/base/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "gnomon/base/statistics.h"

namespace gnomon {
namespace {

constexpr double kFamilyWise = 1e-3;  // chance that a test of this file fails on an ideal generator

/// p-value of "these cells are equally likely".
double uniformityPValue(const std::vector<int>& counts) {
  double total = 0.0;
  for (const int count : counts) total += count;
  const double expected = total / static_cast<double>(counts.size());
  double chiSquare = 0.0;
  for (const int count : counts) chiSquare += (count - expected) * (count - expected) / expected;
  return chiSquareSurvival(chiSquare, static_cast<double>(counts.size() - 1));
}

std::size_t cell16(glm::dvec2 p) {
  return static_cast<std::size_t>(p.y * 16.0) * 16 + static_cast<std::size_t>(p.x * 16.0);
}

/// Whether `count` = 2^k points from `start` have exactly one in each elementary interval of area 2^-k, of every shape.
bool isNet(std::uint32_t seed, std::uint32_t start, unsigned k) {
  for (unsigned columnsLog = 0; columnsLog <= k; ++columnsLog) {
    const double columns = std::ldexp(1.0, static_cast<int>(columnsLog));
    const double rows = std::ldexp(1.0, static_cast<int>(k - columnsLog));
    std::vector<bool> seen(std::size_t{1} << k, false);
    for (std::uint32_t i = 0; i < (1u << k); ++i) {
      const glm::dvec2 p = sobolOwen2(start + i, seed);
      const std::size_t cell =
          static_cast<std::size_t>(std::floor(p.y * rows) * columns) + static_cast<std::size_t>(p.x * columns);
      if (seen[cell]) return false;
      seen[cell] = true;
    }
  }
  return true;
}

TEST(SobolOwen, EveryPowerOfTwoIsANet) {
  for (const std::uint32_t seed : {0u, 1u, 0xdeadbeefu}) {
    for (unsigned k = 0; k <= 10; ++k) EXPECT_TRUE(isNet(seed, 0, k)) << "seed " << seed << ", 2^" << k << " points";
  }
}

TEST(SobolOwen, LaterAlignedRunsAreNetsToo) {  // progressive sampling may stop and go on
  for (unsigned run = 1; run < 8; ++run) EXPECT_TRUE(isNet(7u, run << 6u, 6)) << "run " << run;
}

TEST(SobolOwen, PointsLieInTheOpenSquare) {
  for (std::uint32_t i = 0; i < 4096; ++i) {
    const glm::dvec2 p = sobolOwen2(i, i * 977u);
    ASSERT_TRUE(p.x > 0.0 && p.x < 1.0 && p.y > 0.0 && p.y < 1.0);
  }
}

TEST(SobolOwen, EachPointIsUniformOverSeeds) {
  std::vector<double> pValues;
  for (const std::uint32_t index : {0u, 1u, 5u, 511u}) {
    std::vector<int> counts(256, 0);
    for (std::uint32_t seed = 0; seed < 32768; ++seed) ++counts[cell16(sobolOwen2(index, seed))];
    pValues.push_back(uniformityPValue(counts));
  }
  for (const bool rejected : holmRejections(pValues, kFamilyWise)) EXPECT_FALSE(rejected);
}

TEST(SobolOwen, NeighbouringSeedsAreIndependent) {
  std::vector<int> counts(256, 0);
  for (std::uint32_t seed = 0; seed < 65536; seed += 2) {
    ++counts[cell16({sobolOwen2(3, seed).x, sobolOwen2(3, seed + 1).x})];
  }
  EXPECT_GT(uniformityPValue(counts), kFamilyWise);
}

TEST(SobolOwen, NeighbouringPixelsAndStreamsAreIndependent) {
  std::vector<int> across(256, 0);
  std::vector<int> halves(256, 0);
  for (std::uint32_t y = 0; y < 200; ++y) {
    for (std::uint32_t x = 0; x < 200; ++x) {
      const glm::dvec2 here = sobolOwen2(0, pixelSeed(x, y, 0));
      ++across[cell16({here.x, sobolOwen2(0, pixelSeed(x + 1, y, 0)).x})];
      ++halves[cell16({here.y, sobolOwen2(0, pixelSeed(x, y, 1)).y})];
    }
  }
  const std::vector<double> pValues = {uniformityPValue(across), uniformityPValue(halves)};
  for (const bool rejected : holmRejections(pValues, kFamilyWise)) EXPECT_FALSE(rejected);
}

TEST(SobolOwen, FlipsOfANodeAndItsTwoChildrenAreIndependent) {  // 3 bits of the tree, 8 outcomes; a sum alone gives 4
  std::vector<int> counts(8, 0);
  for (std::uint32_t seed = 0; seed < 16384; ++seed) {
    const SobolOwen2 points(seed);
    const std::uint32_t root = points.bits(0).x >> 31u;
    const std::uint32_t left = (points.bits(0).x >> 30u) & 1u;  // index 0 and 1 unscrambled: 0.00 and 0.10
    const std::uint32_t right = (points.bits(1).x >> 30u) & 1u;
    ++counts[root * 4 + left * 2 + right];
  }
  EXPECT_GT(uniformityPValue(counts), kFamilyWise);
}

/// Estimates of the lit area of the unit square beyond a slanted edge, over seeds.
std::vector<double> slantedEdgeEstimates(std::uint32_t points, std::uint32_t seeds) {
  std::vector<double> estimates;
  for (std::uint32_t seed = 0; seed < seeds; ++seed) {
    const SobolOwen2 sequence(pixelSeed(seed, points, 5));
    int lit = 0;
    for (std::uint32_t i = 0; i < points; ++i) {
      const glm::dvec2 p = sequence(i);
      lit += p.x + 0.37 * p.y < 0.6 ? 1 : 0;
    }
    estimates.push_back(lit / static_cast<double>(points));
  }
  return estimates;
}

constexpr double kSlantedArea = 0.6 - 0.37 / 2.0;  // the edge crosses x = 0.6 - 0.37 y, inside the square for all y

TEST(SobolOwen, EstimatesAreUnbiased) {
  std::vector<double> pValues;
  for (const std::uint32_t points : {1u, 4u, 16u, 512u}) {
    pValues.push_back(meanPValue(slantedEdgeEstimates(points, 1500), kSlantedArea));
  }
  for (const bool rejected : holmRejections(pValues, kFamilyWise)) EXPECT_FALSE(rejected);
}

TEST(SobolOwen, VarianceAcrossAnEdgeFallsFasterThanRandom) {
  // Between 16 and 1024 points n^-1 gives 1/64 and n^-1.5 gives 1/512. The two variances are known to 6 % (1 sigma) each.
  const double ratio = variance(slantedEdgeEstimates(16, 600)) / variance(slantedEdgeEstimates(1024, 600));
  EXPECT_GT(ratio, 300.0);
}

TEST(RandomStream, IsUniformNormalAndInRange) {
  RandomStream random(3);
  std::vector<int> counts(10, 0);
  std::vector<double> normals;
  for (int i = 0; i < 20000; ++i) {
    ++counts[random.below(10)];
    normals.push_back(random.normal());
  }
  EXPECT_GT(uniformityPValue(counts), kFamilyWise / 2.0);
  EXPECT_GT(meanPValue(normals, 0.0), kFamilyWise / 2.0);
  EXPECT_NEAR(variance(normals), 1.0, 0.04);  // 4 sigma of sqrt(2/n)
}

}  // namespace
}  // namespace gnomon
