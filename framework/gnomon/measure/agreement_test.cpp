#include "gnomon/measure/agreement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace gnomon {
namespace {

Estimate around(double value, double half) {
  return {value, {value - half, value + half}};
}

Verdict verdictOf(const Estimate& a, const Estimate& b) {
  const std::pair<Estimate, Estimate> pair{a, b};
  return compareFamily(std::span(&pair, 1)).at(0);
}

TEST(CompareFamily, FiguresApartByMoreThanTheirIntervalsDiffer) {
  EXPECT_EQ(verdictOf(around(1.0, 0.1), around(2.0, 0.1)), Verdict::higher);
  EXPECT_EQ(verdictOf(around(2.0, 0.1), around(1.0, 0.1)), Verdict::lower);
}

TEST(CompareFamily, IntervalsThatOverlapMayDifferAllTheSame) {  // sqrt(2) half widths apart is the 5 % mark
  EXPECT_EQ(verdictOf(around(1.0, 0.1), around(1.0 + 0.145, 0.1)), Verdict::higher);
  EXPECT_EQ(verdictOf(around(1.0, 0.1), around(1.0 + 0.138, 0.1)), Verdict::same);
}

TEST(CompareFamily, TheSideThatFacesTheOtherCounts) {
  EXPECT_EQ(verdictOf({1.0, {0.0, 1.01}}, {1.1, {1.09, 2.0}}), Verdict::higher);
  EXPECT_EQ(verdictOf({1.0, {0.99, 2.0}}, {1.1, {0.1, 1.11}}), Verdict::same);
}

TEST(CompareFamily, ExactFiguresDifferWhenTheyDiffer) {
  EXPECT_EQ(verdictOf(around(1.0, 0.0), around(1.0, 0.0)), Verdict::same);
  EXPECT_EQ(verdictOf(around(1.0, 0.0), around(1.0 + 1e-12, 0.0)), Verdict::higher);
}

TEST(CompareFamily, WhatIsNotFiniteIsNoEvidence) {
  EXPECT_EQ(verdictOf(around(1.0, 0.1), around(std::numeric_limits<double>::quiet_NaN(), 0.1)), Verdict::same);
}

TEST(CompareFamily, OfFamiliesWithoutAChangeFewAreRejected) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 1.0);
  int families = 0;
  for (int trial = 0; trial < 400; ++trial) {
    std::vector<std::pair<Estimate, Estimate>> pairs;
    for (int i = 0; i < 30; ++i) pairs.push_back({around(noise(random), 1.96), around(noise(random), 1.96)});
    const std::vector<Verdict> verdicts = compareFamily(pairs);
    families += std::any_of(verdicts.begin(), verdicts.end(), [](Verdict v) { return v != Verdict::same; }) ? 1 : 0;
  }
  EXPECT_LE(families, 35);  // 20 expected; more than 35 of 400 at 5 % has a probability of 1e-3
  EXPECT_GE(families, 6);
}

}  // namespace
}  // namespace gnomon
