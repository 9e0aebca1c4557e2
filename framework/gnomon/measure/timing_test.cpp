#include "gnomon/measure/timing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "gnomon/base/error.h"
#include "gnomon/base/random.h"

namespace gnomon {
namespace {

constexpr double kRatio = 1.7;

FrameTime allClocks(double ms) {
  return {ms, ms, ms};
}

double width(const Interval& interval) {
  return interval.high - interval.low;
}

TEST(MeasurePaired, ConstantCostsAreExact) {
  const TimingFigures figures = measurePaired(
      [](Side side, int) -> FrameTime {
        return side == Side::candidate ? FrameTime{6.0, 9.0} : FrameTime{4.0, 5.0};
      },
      {.poses = 3, .blocks = 4, .clock = Clock::cpu});
  EXPECT_EQ(figures.medianMs, 6.0);
  EXPECT_EQ(figures.wallMedianMs, 9.0);
  EXPECT_EQ(figures.madMs, 0.0);
  EXPECT_EQ(figures.p95Ms, 6.0);
  EXPECT_EQ(figures.ci95Ms, (Interval{6.0, 6.0}));
  EXPECT_EQ(figures.n, 2 * 3 * 4);
  EXPECT_EQ(figures.ratio, 1.5);
  EXPECT_EQ(figures.ratioCi95, (Interval{1.5, 1.5}));
}

TEST(MeasurePaired, EachPoseIsSymmetricAboutItsBlocksCentre) {
  std::vector<std::pair<Side, int>> order;
  measurePaired(
      [&](Side side, int pose) {
        order.emplace_back(side, pose);
        return allClocks(1.0);
      },
      {.poses = 3, .blocks = 2, .warmup = 0});
  ASSERT_EQ(order.size(), 24u);
  for (std::size_t block = 0; block < 2; ++block) {
    for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(order[12 * block + i], order[12 * block + 11 - i]);
  }
  EXPECT_EQ(order[0].first, Side::candidate);
  EXPECT_EQ(order[12].first, Side::baseline) << "blocks take turns";
}

TEST(MeasurePaired, LinearDriftCancelsExactly) {  // each frame slower than the last, twice as slow at the end
  int frame = 0;
  const TimingPlan plan{.poses = 5, .blocks = 6, .warmup = 0, .clock = Clock::wall};
  const double frames = 4.0 * plan.poses * plan.blocks;
  const TimingFigures figures = measurePaired(
      [&](Side side, int pose) {
        const double slowdown = 1.0 + frame++ / frames;
        return allClocks(slowdown * (1.0 + 0.1 * pose) * (side == Side::candidate ? kRatio : 1.0));
      },
      plan);
  EXPECT_NEAR(*figures.ratio, kRatio, 1e-12);
  EXPECT_LT(width(*figures.ratioCi95), 1e-12);
}

TEST(MeasurePaired, DoublingDriftWithNoiseLeavesTheRatioInANarrowInterval) {
  RandomStream random(5);
  int frame = 0;
  const TimingPlan plan{.poses = 6, .blocks = 6, .warmup = 0, .clock = Clock::wall};
  const double frames = 4.0 * plan.poses * plan.blocks;
  const TimingFigures figures = measurePaired(
      [&](Side side, int) {
        const double slowdown = std::exp2(frame++ / frames) * std::exp(0.01 * random.normal());
        return allClocks(slowdown * (side == Side::candidate ? kRatio : 1.0));
      },
      plan);
  EXPECT_TRUE(figures.ratioCi95->contains(kRatio)) << figures.ratioCi95->low << " " << figures.ratioCi95->high;
  EXPECT_LT(width(*figures.ratioCi95), 0.02 * kRatio);
}

TEST(MeasurePaired, ExponentialDriftWithoutNoiseIsStillCovered) {  // blocks of one order would all err to one side
  int frame = 0;
  const TimingPlan plan{.poses = 6, .blocks = 6, .warmup = 0, .clock = Clock::wall};
  const double frames = 4.0 * plan.poses * plan.blocks;
  const TimingFigures figures = measurePaired(
      [&](Side side, int) { return allClocks(std::exp2(frame++ / frames) * (side == Side::candidate ? kRatio : 1.0)); }, plan);
  EXPECT_TRUE(figures.ratioCi95->contains(kRatio));
}

/// Repetitions of 200 in which the ratio's interval holds the truth, under noise with spikes of up to tenfold.
int coveredOf200(std::uint64_t seed) {
  int covered = 0;
  for (int repetition = 0; repetition < 200; ++repetition) {
    RandomStream random(seed + static_cast<std::uint64_t>(repetition));
    const TimingPlan plan{.poses = 5, .blocks = 5, .warmup = 0, .clock = Clock::wall, .bootstrap = {.resamples = 1000}};
    const TimingFigures figures = measurePaired(
        [&](Side side, int) {
          const double spike = random.uniform() < 0.1 ? 1.0 / (1.0 - 0.9 * random.uniform()) : 1.0;
          return allClocks(std::exp(0.1 * random.normal()) * spike * (side == Side::candidate ? kRatio : 1.0));
        },
        plan);
    covered += figures.ratioCi95->contains(kRatio) ? 1 : 0;
  }
  return covered;
}

TEST(MeasurePaired, IntervalCoversTheRatioUnderHeavyTails) {
  EXPECT_GE(coveredOf200(1000), 180);
}

TEST(MeasurePaired, IntervalIsNotVacuousUnderHeavyTails) {
  RandomStream random(77);
  const TimingFigures figures = measurePaired(
      [&](Side side, int) {
        const double spike = random.uniform() < 0.1 ? 10.0 : 1.0;
        return allClocks(std::exp(0.1 * random.normal()) * spike * (side == Side::candidate ? kRatio : 1.0));
      },
      {.poses = 8, .blocks = 10, .warmup = 0, .clock = Clock::wall});
  EXPECT_LT(width(*figures.ratioCi95), 0.25 * kRatio);
}

/// Frames whose candidate takes up to `spread` more or less than 1 ms.
TimedFrame unsteady(double spread) {
  return [spread, random = RandomStream(3)](Side side, int) mutable {
    return allClocks(side == Side::baseline ? 1.0 : 1.0 + spread * (2.0 * random.uniform() - 1.0));
  };
}

TEST(MeasurePaired, BlocksAreAddedUntilTheIntervalIsNarrow) {
  const TimingFigures figures =
      measurePaired(unsteady(0.1), {.poses = 2, .blocks = 2, .warmup = 0, .halfWidth = 0.01, .seconds = 300.0});
  EXPECT_LE(width(*figures.ratioCi95), 2.0 * 0.01);
  EXPECT_GT(figures.pairs.size(), 2U * 2U) << "two blocks of such frames differ by more";
}

TEST(MeasurePaired, ANarrowIntervalEndsAtThePlansBlocks) {
  const TimingFigures figures =
      measurePaired(unsteady(0.0), {.poses = 2, .blocks = 3, .warmup = 0, .halfWidth = 0.05, .seconds = 300.0});
  EXPECT_EQ(figures.pairs.size(), 2U * 3U);
}

TEST(MeasurePaired, TimeRunsOutBeforeAnImpossibleWidth) {
  const TimingFigures figures =
      measurePaired(unsteady(0.5), {.poses = 2, .blocks = 1, .warmup = 0, .halfWidth = 1e-9, .seconds = 0.05});
  EXPECT_GE(figures.pairs.size(), 2U);
}

TEST(MeasurePaired, AHalfWidthWithoutTimeIsAnError) {
  EXPECT_THROW(measurePaired(unsteady(0.0), {.halfWidth = 0.1}), Error);
}

/// Two pairs of one block whose candidate takes `ms` and whose baseline takes 1.
std::vector<TimedPair> steadyPairs(double ms) {
  const TimedPair pair{0, 0, {allClocks(ms), allClocks(ms)}, {allClocks(1.0), allClocks(1.0)}};
  return {pair, pair};
}

TEST(TimingFigures, ProcessesThatDisagreeWidenTheInterval) {
  const std::vector<std::vector<TimedPair>> processes{steadyPairs(2.0), steadyPairs(3.0), steadyPairs(4.0)};
  const TimingFigures figures = timingFigures(processes, Clock::cpu);
  EXPECT_EQ(figures.ratio, 3.0);
  EXPECT_LT(figures.ratioCi95->low, 2.0);
  EXPECT_GT(figures.ratioCi95->high, 4.0);
  EXPECT_GT(figures.ci95Ms->high, 4.0);
  EXPECT_EQ(figures.n, 3 * 4);
  EXPECT_EQ(figures.pairs, processes[0]);
}

TEST(TimingFigures, NothingTimedIsAnError) {
  EXPECT_THROW(timingFigures({}, Clock::cpu), Error);
}

TEST(PoseSteps, NoSideStandsStillBetweenTwoFrames) {
  PoseSteps steps(3);
  std::map<Side, int> last;
  measurePaired(
      [&](Side side, int pose) {
        const int step = steps.next(side, pose);
        EXPECT_EQ(step / 2, pose);
        EXPECT_FALSE(last.contains(side) && last.at(side) == step) << "step " << step;
        last[side] = step;
        return allClocks(1.0);
      },
      {.poses = 3, .blocks = 4, .warmup = 2});
}

TEST(PoseSteps, BothSidesOfAPairStandOnTheSameSteps) {
  PoseSteps steps(3);
  std::map<std::pair<Side, int>, int> frames;
  measurePaired(
      [&](Side side, int pose) {
        ++frames[{side, steps.next(side, pose)}];
        return allClocks(1.0);
      },
      {.poses = 3, .blocks = 1, .warmup = 0});
  for (int step = 0; step < steps.count(); ++step) {
    EXPECT_EQ((frames[{Side::candidate, step}]), 1) << step;
    EXPECT_EQ((frames[{Side::baseline, step}]), 1) << step;
  }
}

TEST(MeasurePaired, WarmupIsNotTimed) {
  std::map<std::pair<Side, int>, int> calls;
  const TimingFigures figures = measurePaired(
      [&](Side side, int pose) {
        return allClocks(++calls[{side, pose}] <= 2 ? 1000.0 : 1.0);
      },
      {.poses = 4, .blocks = 2, .warmup = 2});
  EXPECT_EQ(figures.p95Ms, 1.0);
}

TEST(MeasurePaired, RawPairsAreKept) {
  double ms = 0.0;
  const TimingFigures figures =
      measurePaired([&](Side, int) { return allClocks(ms += 1.0); }, {.poses = 1, .blocks = 2, .warmup = 0});
  const std::vector<TimedPair> expected = {{0, 0, {allClocks(1.0), allClocks(4.0)}, {allClocks(2.0), allClocks(3.0)}},
                                           {1, 0, {allClocks(6.0), allClocks(7.0)}, {allClocks(5.0), allClocks(8.0)}}};
  EXPECT_EQ(figures.pairs, expected);
}

TEST(MeasurePaired, ABaselineOfNoTimeHasNoRatio) {
  const TimingFigures figures =
      measurePaired([](Side side, int) { return allClocks(side == Side::candidate ? 1.0 : 0.0); }, {.poses = 2, .blocks = 2});
  EXPECT_FALSE(figures.ratio.has_value());
  EXPECT_FALSE(figures.ratioCi95.has_value());
}

TEST(MeasurePaired, AMissingGpuTimeIsAnErrorAndNotZero) {
  EXPECT_THROW(measurePaired([](Side, int) -> FrameTime { return {1.0, 1.0}; }, {.clock = Clock::gpu}), Error);
}

TEST(MeasurePaired, ATimeThatIsNoneIsAnError) {
  EXPECT_THROW(measurePaired([](Side, int) { return allClocks(std::numeric_limits<double>::quiet_NaN()); }, {}), Error);
}

TEST(MeasurePaired, APlanWithoutBlocksIsAnError) {
  EXPECT_THROW(measurePaired([](Side, int) { return allClocks(1.0); }, {.blocks = 0}), Error);
}

}  // namespace
}  // namespace gnomon
