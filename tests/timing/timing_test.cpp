// Whether times can be believed: a technique of known cost shows it, on the clock that it spends it by.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "known_cost.h"

namespace gnomon::test {
namespace {

using testing::AllOf;
using testing::Ge;
using testing::HasSubstr;
using testing::Lt;

const PassTime& pass(const JobRecord& record, const std::string& name) {
  for (const PassTime& one : record.time.value().passes) {
    if (one.name == name) return one;
  }
  throw Error("no pass is named " + name);
}

constexpr const char* kThreeJobs = R"({"baseline": {"technique": "busy"},
  "measure": {"regimes": ["dynamic"], "frames": 24, "blocks": 2},
  "techniques": [{"technique": "busy"}, {"technique": "busy", "parameters": {"spin": 5}},
                 {"technique": "busy", "parameters": {"sleep": 5}}]})";

TEST_F(KnownCost, WhatSpinsIsInItsPassAndInTheTotalAndWhatSleepsInWallTimeAlone) {
  const std::vector<JobRecord> jobs = run(kThreeJobs);
  ASSERT_EQ(jobs.size(), 3U);
  const double idleMs = *dynamic(jobs[0]).medianMs;
  EXPECT_THAT(*pass(jobs[1], "spin and sleep").ms, AllOf(Ge(5.0), Lt(5.5)));
  EXPECT_THAT(*dynamic(jobs[1]).medianMs - idleMs, AllOf(Ge(4.5), Lt(6.0)));
  EXPECT_THAT(*pass(jobs[1], "draw").ms, Lt(2.0));

  EXPECT_THAT(*pass(jobs[2], "spin and sleep").ms, Lt(1.0));
  EXPECT_THAT(*pass(jobs[2], "spin and sleep").wallMs, Ge(5.0));
  EXPECT_THAT(*dynamic(jobs[2]).medianMs - idleMs, Lt(1.0));
  EXPECT_THAT(*dynamic(jobs[2]).wallMedianMs, Ge(5.0));
}

TEST_F(KnownCost, ATimerThatLiesIsRefusedBeforeAnythingIsLost) {
  run(kThreeJobs);
  const std::string before = identity(folder_ / "out" / "results.jsonl");
  const Outcome outcome = gnomonProgram({"batch", (folder_ / "run.json").string(), "--out", (folder_ / "out").string(),
                                         "--timer", "gpu", "--technique-dir", testPluginFolder("busy")});
  if (outcome.exitCode == 0) GTEST_SKIP() << "the GPU timer of this machine tells the truth";
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err, HasSubstr("timer 'gpu' is not to be believed here"));
  EXPECT_THAT(outcome.err, HasSubstr(" ms"));
  EXPECT_EQ(identity(folder_ / "out" / "results.jsonl"), before);
}

constexpr const char* kTwoJobs = R"({"baseline": {"technique": "busy"},
  "measure": {"regimes": ["dynamic", "static"], "frames": 8, "blocks": 2},
  "techniques": [{"technique": "busy"}, {"technique": "busy", "parameters": {"spin": 2}}]})";

TEST_F(KnownCost, RepeatsAreCountedAndTheirFramesAllEnterTheFigures) {
  const std::vector<JobRecord> jobs = run(kTwoJobs, {"--repeat", "3"});
  ASSERT_EQ(jobs.size(), 2U);
  for (const JobRecord& job : jobs) {
    EXPECT_EQ(job.time->repeats, 3);
    EXPECT_EQ(dynamic(job).n, 3 * 8);
    EXPECT_TRUE(job.error.has_value()) << "what the batch itself measured is kept";
    EXPECT_FALSE(job.time->regimes.at("static").ratio.has_value());
    EXPECT_NEAR(*job.time->gapMs, *job.time->passSumMs - *dynamic(job).medianMs, 1e-9);
  }
  EXPECT_EQ(namesIn(folder_ / "out" / "repeats"), (std::vector<std::string>{"2", "3"}));
}

TEST_F(KnownCost, ARepeatThatLacksAJobCostsAWarning) {
  run(kTwoJobs, {"--repeat", "2"});
  const std::string missing = results()[0].job + ".json";
  std::filesystem::remove(folder_ / "out" / "timing" / missing);
  const Outcome outcome = batch(kTwoJobs, {"--resume", "--repeat", "3"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
  EXPECT_THAT(outcome.lines("warning"), testing::ElementsAre(AllOf(HasSubstr(missing), HasSubstr("not counted"))));
  EXPECT_EQ(results()[0].time->repeats, 2);
  EXPECT_EQ(results()[1].time->repeats, 3);
}

TEST_F(KnownCost, RepeatsThatAreThereAreNotMeasuredAgain) {
  run(kTwoJobs, {"--repeat", "2"});
  const std::string before = identity(folder_ / "out" / "repeats" / "2" / "results.jsonl");
  EXPECT_EQ(batch(kTwoJobs, {"--resume", "--repeat", "2"}).exitCode, 0);
  EXPECT_EQ(identity(folder_ / "out" / "repeats" / "2" / "results.jsonl"), before);
}

TEST_F(KnownCost, TimesOnlyMeasuresNothingElse) {
  const std::vector<JobRecord> jobs = run(kTwoJobs, {"--times-only"});
  ASSERT_EQ(jobs.size(), 2U);
  EXPECT_FALSE(jobs[0].error.has_value());
  EXPECT_FALSE(jobs[0].work.texelsWritten.has_value());
  EXPECT_TRUE(dynamic(jobs[0]).ratio.has_value());
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / "images"));
}

}  // namespace
}  // namespace gnomon::test
