#include "gnomon/base/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "gnomon/base/error.h"
#include "gnomon/base/random.h"

namespace gnomon {
namespace {

TEST(Statistics, MedianOfOddAndEven) {
  EXPECT_EQ(median(std::vector{3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median(std::vector{4.0, 1.0, 3.0, 2.0}), 2.5);
}

TEST(Statistics, DeviationIgnoresOneOutlier) {
  EXPECT_EQ(medianAbsoluteDeviation(std::vector{1.0, 2.0, 3.0, 4.0, 1000.0}), 1.0);
}

TEST(Statistics, PercentileInterpolatesBetweenOrderStatistics) {
  const std::vector<double> values = {40.0, 10.0, 20.0, 30.0, 50.0};
  EXPECT_EQ(percentile(values, 0.0), 10.0);
  EXPECT_EQ(percentile(values, 100.0), 50.0);
  EXPECT_DOUBLE_EQ(percentile(values, 95.0), 48.0);
}

TEST(Statistics, VarianceHasOneDegreeLess) {
  EXPECT_DOUBLE_EQ(variance(std::vector{1.0, 3.0}), 2.0);
}

TEST(Statistics, NothingIsAnErrorAndNotZero) {
  const std::vector<double> none;
  EXPECT_THROW(median(none), Error);
  EXPECT_THROW(mean(none), Error);
  EXPECT_THROW(percentile(none, 50.0), Error);
  EXPECT_THROW(variance(std::vector{1.0}), Error);
}

TEST(Distributions, NormalQuantileOfTables) {
  EXPECT_NEAR(normalQuantile(0.975), 1.959963984540054, 1e-12);
  EXPECT_NEAR(normalPValue(1.959963984540054), 0.05, 1e-12);
}

TEST(Distributions, StudentHasClosedFormsForOneAndTwoDegrees) {
  for (const double t : {-30.0, -1.0, 0.0, 0.3, 5.0}) {
    EXPECT_NEAR(studentTCdf(t, 1.0), 0.5 + std::atan(t) / std::numbers::pi, 1e-13) << t;
    EXPECT_NEAR(studentTCdf(t, 2.0), 0.5 + t / (2.0 * std::sqrt(2.0 + t * t)), 1e-13) << t;
  }
  EXPECT_NEAR(studentTQuantile(0.975, 1.0), std::tan(0.475 * std::numbers::pi), 1e-9);
  EXPECT_NEAR(studentTQuantile(0.975, 1e7), normalQuantile(0.975), 1e-5);
}

TEST(Distributions, ChiSquareHasClosedFormsForOneAndEvenDegrees) {
  for (const double x : {0.1, 1.0, 4.0, 30.0}) {
    EXPECT_NEAR(chiSquareSurvival(x, 1.0), std::erfc(std::sqrt(0.5 * x)), 1e-13) << x;
    EXPECT_NEAR(chiSquareSurvival(x, 4.0), std::exp(-0.5 * x) * (1.0 + 0.5 * x), 1e-13) << x;
  }
}

TEST(Distributions, QuantileOutsideZeroToOneIsAnError) {
  EXPECT_THROW(normalQuantile(0.0), Error);
  EXPECT_THROW(normalQuantile(1.0), Error);
}

TEST(Holm, StepsDownFromTheSmallest) {
  // 0.01 <= 0.05/4 and 0.014 <= 0.05/3 fall; 0.04 > 0.05/2 stays, and so does all after it.
  EXPECT_EQ(holmRejections(std::vector{0.04, 0.01, 0.9, 0.014}, 0.05), (std::vector<bool>{false, true, false, true}));
}

TEST(Holm, ANumberThatIsNoneRejectsNothing) {
  EXPECT_EQ(holmRejections(std::vector{std::numeric_limits<double>::quiet_NaN()}, 0.05), std::vector<bool>{false});
}

TEST(Jackknife, EqualGroupsGiveTheErrorOfTheirMeans) {
  const std::vector<GroupSum> groups = {{1.0 * 5, 5}, {2.0 * 5, 5}, {6.0 * 5, 5}};
  const double expected = std::sqrt(variance(std::vector{1.0, 2.0, 6.0}) / 3.0);
  EXPECT_NEAR(jackknifeErrorOfMean(groups).value(), expected, 1e-14);
}

TEST(Jackknife, UnequalGroupsMatchTheSpreadOfRepetition) {
  const std::vector<int> sizes = {3, 50, 10, 100, 80, 60, 90, 40, 70, 20};
  RandomStream random(11);
  std::vector<double> means;
  double squaredError = 0.0;
  for (int repetition = 0; repetition < 400; ++repetition) {
    GroupSum all;
    std::vector<GroupSum> groups;
    for (const int size : sizes) {
      GroupSum group{0.0, static_cast<double>(size)};
      for (int i = 0; i < size; ++i) group.sum += random.normal();
      all.sum += group.sum;
      all.count += group.count;
      groups.push_back(group);
    }
    means.push_back(all.sum / all.count);
    squaredError += std::pow(jackknifeErrorOfMean(groups).value(), 2) / 400.0;
  }
  EXPECT_NEAR(squaredError / variance(means), 1.0, 0.3);  // 4 sigma of the two spreads
}

TEST(Jackknife, OneGroupSaysNothing) {
  EXPECT_FALSE(jackknifeErrorOfMean(std::vector<GroupSum>{{3.0, 2.0}, {0.0, 0.0}}).has_value());
}

TEST(Bootstrap, ConstantDataHaveAnIntervalOfNoWidth) {
  const std::vector<std::vector<double>> groups(4, std::vector<double>(3, 2.5));
  EXPECT_EQ(bootstrapInterval(groups, medianInPlace).value(), (Interval{2.5, 2.5}));
}

TEST(Bootstrap, OneValueSaysNothing) {
  EXPECT_FALSE(bootstrapInterval(std::vector<std::vector<double>>{{1.0}, {}}, medianInPlace).has_value());
}

TEST(Bootstrap, IsTheSameOnEveryRun) {
  const std::vector<std::vector<double>> groups = {{1.0, 2.0, 4.0}, {2.0, 3.0, 9.0}};
  EXPECT_EQ(bootstrapInterval(groups, medianInPlace), bootstrapInterval(groups, medianInPlace));
}

TEST(Bootstrap, CoversTheMeanWhenGroupsShareTheirLuck) {
  // Six groups whose shared part dominates: taking values for independent would cover about half the time.
  RandomStream random(21);
  int covered = 0;
  for (int repetition = 0; repetition < 200; ++repetition) {
    std::vector<std::vector<double>> groups(6);
    for (std::vector<double>& group : groups) {
      const double shared = random.normal();
      for (int i = 0; i < 5; ++i) group.push_back(shared + 0.3 * random.normal());
    }
    const auto interval = bootstrapInterval(groups, [](std::span<double> values) { return mean(values); }, {.resamples = 500});
    covered += interval->contains(0.0) ? 1 : 0;
  }
  EXPECT_GE(covered, 165);  // normal percentiles of 6 groups: P(|t_5| < 1.96) = 89 %, 178; 165 is 3 sigma below
}

/// Of 200 sets of values in which only repeats differ truly, those whose interval holds the mean.
int coveredByRepeats(std::size_t repeats, bool areKnown) {
  RandomStream random(22);
  int covered = 0;
  for (int repetition = 0; repetition < 200; ++repetition) {
    std::vector<GroupedValues> values(repeats, GroupedValues(3));
    for (GroupedValues& repeat : values) {
      const double shared = random.normal();
      for (std::vector<double>& group : repeat) {
        for (int i = 0; i < 4; ++i) group.push_back(shared + 0.1 * random.normal());
      }
    }
    GroupedValues pooled;
    for (const GroupedValues& repeat : values) pooled.insert(pooled.end(), repeat.begin(), repeat.end());
    const Statistic average = [](std::span<double> all) { return mean(all); };
    const auto interval = areKnown ? bootstrapInterval(values, average, {.resamples = 500})
                                   : bootstrapInterval(pooled, average, {.resamples = 500});
    covered += interval->contains(0.0) ? 1 : 0;
  }
  return covered;
}

TEST(Bootstrap, CoversTheMeanWhenRepeatsShareTheirLuck) {
  EXPECT_GE(coveredByRepeats(4, true), 181);  // 95 % is 190; 3 sigma below
}

TEST(Bootstrap, CoversLessWhenRepeatsAreTakenForBlocks) {  // else the level above would not be needed
  EXPECT_LE(coveredByRepeats(4, false), 150);
}

}  // namespace
}  // namespace gnomon
