#include "gnomon/measure/compare.h"

#include <gtest/gtest.h>

namespace gnomon {
namespace {

JobRecord record(const std::string& job, double median = 10.0, double half = 0.1) {
  JobRecord r;
  r.job = job;
  r.config = "c";
  r.scene = "s";
  r.technique = "t";
  r.parametersJson = R"({"taps":5})";
  r.machine = {"renderer", "processor"};
  r.error.emplace();
  r.error->mse = 1e-2;
  r.error->mseSe = 1e-4;
  TimeRecord& time = r.time.emplace();
  time.timer = Clock::cpu;
  time.regimes["dynamic"] = {.medianMs = median, .ci95Ms = Interval{median - half, median + half}};
  time.regimes["static"] = {.medianMs = 0.001, .ci95Ms = Interval{0.001, 0.001}};
  r.work.texelReads = 100;
  return r;
}

Change changeOf(const ResultsComparison& comparison, const std::string& figure) {
  for (const JobChange& job : comparison.jobs) {
    for (const FigureChange& f : job.figures) {
      if (f.figure == figure) return f.change;
    }
  }
  ADD_FAILURE() << figure << " was not compared";
  return Change::unknown;
}

ResultsComparison compared(const JobRecord& before, const JobRecord& after) {
  return compareResults(std::span(&before, 1), std::span(&after, 1));
}

TEST(CompareResults, EqualResultsAreTheSame) {
  const ResultsComparison c = compared(record("a"), record("a"));
  EXPECT_EQ(c.count(Change::same), 5u);  // status, mse, non_finite, texel_reads, median
  EXPECT_FALSE(c.anyWorse());
}

TEST(CompareResults, ATimeBeyondItsIntervalIsWorse) {
  EXPECT_EQ(changeOf(compared(record("a"), record("a", 11.0)), "time.dynamic.median_ms"), Change::worse);
  EXPECT_EQ(changeOf(compared(record("a", 11.0), record("a")), "time.dynamic.median_ms"), Change::better);
}

TEST(CompareResults, ATimeWithinItsIntervalIsNoChange) {
  const ResultsComparison c = compared(record("a"), record("a", 10.05));
  EXPECT_EQ(changeOf(c, "time.dynamic.median_ms"), Change::within);
  EXPECT_FALSE(c.anyWorse());
}

TEST(CompareResults, ManyFiguresAreJudgedTogether) {
  // 2.1 half widths apart: z = 2.1 * 1.96 / sqrt(2) = 2.9, p = 0.0036. Enough for one of two figures, not for one of forty.
  std::vector<JobRecord> before, after;
  for (int i = 0; i < 40; ++i) {
    before.push_back(record("j" + std::to_string(i)));
    after.push_back(record("j" + std::to_string(i), i == 0 ? 10.21 : 10.001));
  }
  EXPECT_EQ(changeOf(compared(before[0], after[0]), "time.dynamic.median_ms"), Change::worse);
  EXPECT_FALSE(compareResults(before, after).anyWorse());
}

TEST(CompareResults, AStaticTimeIsNotCompared) {
  JobRecord after = record("a");
  after.time->regimes["static"] = {.medianMs = 5.0, .ci95Ms = Interval{5.0, 5.0}};
  EXPECT_FALSE(compared(record("a"), after).anyWorse());
}

TEST(CompareResults, TimesOfOtherMachinesAreRefusedAndTheRestCompared) {
  JobRecord after = record("a", 20.0);
  after.machine.cpu = "another";
  after.work.texelReads = 90;
  const ResultsComparison c = compared(record("a"), after);
  ASSERT_EQ(c.refusals.size(), 1u);
  EXPECT_NE(c.refusals[0].find("another"), std::string::npos);
  EXPECT_FALSE(c.anyWorse());
  EXPECT_EQ(changeOf(c, "work.texel_reads"), Change::better);
}

TEST(CompareResults, AnotherTimerIsRefused) {
  JobRecord after = record("a", 20.0);
  after.time->timer = Clock::wall;
  EXPECT_EQ(compared(record("a"), after).refusals.size(), 1u);
}

TEST(CompareResults, ACounterThatRisesIsWorse) {
  JobRecord after = record("a");
  after.work.texelReads = 101;
  EXPECT_EQ(changeOf(compared(record("a"), after), "work.texel_reads"), Change::worse);
}

TEST(CompareResults, AFigureOfOneSideIsUnknownAndNotWorse) {
  JobRecord after = record("a");
  after.work.rays = 5;
  const ResultsComparison c = compared(record("a"), after);
  EXPECT_EQ(changeOf(c, "work.rays"), Change::unknown);
  EXPECT_FALSE(c.anyWorse());
}

TEST(CompareResults, SplitsHaveAGrain) {
  JobRecord before = record("a"), after = record("a");
  before.splits.emplace().acne = 0.1;
  after.splits.emplace().acne = 0.1005;
  EXPECT_EQ(changeOf(compared(before, after), "splits.acne"), Change::within);
  after.splits->acne = 0.102;
  EXPECT_EQ(changeOf(compared(before, after), "splits.acne"), Change::worse);
}

TEST(CompareResults, AJobThatFailsNowIsWorse) {
  JobRecord after = record("a");
  after.status = JobStatus::failed;
  EXPECT_TRUE(compared(record("a"), after).anyWorse());
  EXPECT_FALSE(compared(after, record("a")).anyWorse());
}

TEST(CompareResults, ANewParameterDoesNotPartJobs) {
  JobRecord after = record("b");
  after.parametersJson = R"({"taps":5,"kernel":"box"})";
  EXPECT_EQ(compared(record("a"), after).jobs.size(), 1u);
  after.parametersJson = R"({"taps":7})";
  const ResultsComparison c = compared(record("a"), after);
  EXPECT_EQ(c.jobs.size(), 0u);
  EXPECT_EQ(c.onlyBefore.size(), 1u);
  EXPECT_EQ(c.onlyAfter.size(), 1u);
}

TEST(CompareResults, TheSameKeyIsPreferredToTheFirstThatWouldDo) {
  const std::vector<JobRecord> before{record("x")}, after{record("y", 20.0), record("x")};
  const ResultsComparison c = compareResults(before, after);
  ASSERT_EQ(c.jobs.size(), 1u);
  EXPECT_EQ(c.jobs[0].after.job, "x");
}

}  // namespace
}  // namespace gnomon
