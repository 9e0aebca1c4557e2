#include "gnomon/measure/clocks.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "gnomon/base/error.h"

namespace gnomon {
namespace {

/// Work 1 : 2 : 4 : 4 at 10 ms a unit; gpu and cpu as shares of the wall time.
std::vector<ClockTrial> trials(std::optional<double> gpuShare, double cpuShare) {
  std::vector<ClockTrial> result;
  for (const double work : {1.0, 2.0, 4.0, 4.0}) {
    ClockTrial trial{work, 10.0 * work, 10.0 * work * cpuShare};
    if (gpuShare) trial.gpuMs = trial.wallMs * *gpuShare;
    result.push_back(trial);
  }
  return result;
}

TEST(ChooseClock, AnHonestTimerIsTaken) {
  EXPECT_EQ(chooseClock(trials(0.97, 0.02)).clock, Clock::gpu);
}

TEST(ChooseClock, AnHonestTimerIsTakenWhereTheDriverSpins) {
  EXPECT_EQ(chooseClock(trials(0.97, 1.0)).clock, Clock::gpu);
}

TEST(ChooseClock, ATimerOfAHundredthIsRefused) {
  const ClockChoice choice = chooseClock(trials(0.01, 1.9));
  EXPECT_EQ(choice.clock, Clock::cpu);
  EXPECT_NE(choice.reason.find("GPU timer reports 0.1 ms where the finished wall clock shows 10 ms"), std::string::npos)
      << choice.reason;
}

TEST(ChooseClock, ATimerThatLiesInOneTrialIsRefused) {  // the first draw to a target takes all, the next report nothing
  std::vector<ClockTrial> lying = trials(0.97, 1.9);
  lying[2].gpuMs = 0.8;
  EXPECT_EQ(chooseClock(lying).clock, Clock::cpu);
}

TEST(ChooseClock, ATimerBeyondTheWallIsRefused) {
  EXPECT_EQ(chooseClock(trials(1.2, 1.9)).clock, Clock::cpu);
}

TEST(ChooseClock, ATimerThatDoesNotScaleIsRefused) {
  std::vector<ClockTrial> constant = trials(0.95, 0.01);
  for (ClockTrial& trial : constant) trial.wallMs = 20.0 + trial.work;  // so that only the scaling can tell
  for (ClockTrial& trial : constant) trial.gpuMs = 20.0;
  const ClockChoice choice = chooseClock(constant);
  EXPECT_EQ(choice.clock, Clock::wall);
  EXPECT_NE(choice.reason.find("does not scale"), std::string::npos) << choice.reason;
}

TEST(ChooseClock, NoTimerLeavesTheCpuWhereItCovers) {
  EXPECT_EQ(chooseClock(trials(std::nullopt, 1.9)).clock, Clock::cpu);
}

TEST(ChooseClock, TheCpuStillCoversOnABusyMachine) {
  EXPECT_EQ(chooseClock(trials(0.01, 0.28)).clock, Clock::cpu);
}

TEST(ChooseClock, AWaitingCpuWithALyingTimerLeavesTheWall) {
  EXPECT_EQ(chooseClock(trials(0.01, 0.02)).clock, Clock::wall);
}

TEST(ChooseClock, ACpuTimeThatDoesNotScaleIsRefused) {
  std::vector<ClockTrial> spinning = trials(std::nullopt, 1.0);
  for (ClockTrial& trial : spinning) trial.cpuMs = 20.0;
  EXPECT_EQ(chooseClock(spinning).clock, Clock::wall);
}

TEST(ChooseClock, NotANumberIsRefused) {
  std::vector<ClockTrial> broken = trials(0.97, 0.02);
  broken[1].gpuMs = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(chooseClock(broken).clock, Clock::wall);
}

TEST(ChooseClock, TooLightTrialsProveNothing) {
  std::vector<ClockTrial> light = trials(1.0, 1.0);
  light[0].wallMs = 0.5;
  EXPECT_EQ(chooseClock(light).clock, Clock::wall);
}

TEST(ChooseClock, TrialsOfOneSizeProveNothing) {
  std::vector<ClockTrial> alike = trials(1.0, 1.0);
  for (ClockTrial& trial : alike) trial = alike[0];
  EXPECT_EQ(chooseClock(alike).clock, Clock::wall);
}

TEST(ChooseClock, NoTrialsLeaveTheWall) {
  EXPECT_EQ(chooseClock({}).clock, Clock::wall);
}

TEST(ProvenClock, OneThatIsBorneOutIsTaken) {
  EXPECT_EQ(provenClock(trials(0.97, 1.0), Clock::gpu).clock, Clock::gpu);
  EXPECT_EQ(provenClock(trials(0.01, 1.9), Clock::cpu).clock, Clock::cpu);
  EXPECT_EQ(provenClock({}, Clock::wall).clock, Clock::wall);
}

TEST(ProvenClock, OneThatLiesIsRefusedWithTheNumbers) {
  try {
    provenClock(trials(0.01, 1.9), Clock::gpu);
    FAIL() << "was believed";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("0.1 ms where the finished wall clock shows 10 ms"), std::string::npos);
  }
  EXPECT_THROW(provenClock(trials(0.97, 0.02), Clock::cpu), Error);
  EXPECT_THROW(provenClock({}, Clock::gpu), Error);
}

TEST(ClockForPair, CpuPassesNeedAClockThatSeesThem) {
  EXPECT_EQ(clockForPair(Clock::gpu, CpuPasses::none, CpuPasses::none), Clock::gpu);
  EXPECT_EQ(clockForPair(Clock::gpu, CpuPasses::some, CpuPasses::none), Clock::wall);
  EXPECT_EQ(clockForPair(Clock::gpu, CpuPasses::none, CpuPasses::some), Clock::wall);
  EXPECT_EQ(clockForPair(Clock::cpu, CpuPasses::some, CpuPasses::some), Clock::cpu);
}

TEST(ClockNames, ReadBack) {
  for (const Clock clock : {Clock::gpu, Clock::cpu, Clock::wall}) EXPECT_EQ(clockFromName(clockName(clock)), clock);
  EXPECT_FALSE(clockFromName("sundial").has_value());
}

}  // namespace
}  // namespace gnomon
