// The choice of a clock, on this machine, from real drawing.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <vector>

#include "gnomon/measure/clock_trials.h"
#include "render.h"

namespace gnomon::test {
namespace {

class ClockHere : public testing::Test {
 protected:
  ClockHere() {
    ensureContext();
    trials_ = runClockTrials();
    choice_ = chooseClock(trials_);
  }
  static double reading(const ClockTrial& trial, Clock clock) {
    return clock == Clock::gpu ? trial.gpuMs.value() : clock == Clock::cpu ? trial.cpuMs : trial.wallMs;
  }
  std::vector<ClockTrial> trials_;
  ClockChoice choice_;
};

TEST_F(ClockHere, TrialsSpanTheWorkThatProvesScaling) {
  const auto [least, most] = std::minmax_element(trials_.begin(), trials_.end(),
                                                 [](const ClockTrial& a, const ClockTrial& b) { return a.work < b.work; });
  EXPECT_GE(most->work, kLeastWorkSpan * least->work);
}

TEST_F(ClockHere, ATimerThatIsTakenScalesAndAgreesWithTheWall) {
  if (choice_.clock == Clock::wall) {  // the fallback claims nothing but that the others failed
    EXPECT_FALSE(choice_.reason.empty());
    return;
  }
  double least = std::numeric_limits<double>::infinity();
  double most = 0.0;
  for (const ClockTrial& trial : trials_) {
    const double rate = reading(trial, choice_.clock) / trial.work;
    least = std::min(least, rate);
    most = std::max(most, rate);
    if (choice_.clock == Clock::gpu) {
      EXPECT_GE(*trial.gpuMs, kLeastGpuShare * trial.wallMs);
      EXPECT_LE(*trial.gpuMs, kMostGpuShare * trial.wallMs);
    }
  }
  EXPECT_LE(most, kScalingFactor * least) << choice_.reason;
}

TEST_F(ClockHere, OneThatSaysAHundredthOfTheTruthIsRefused) {
  for (ClockTrial& trial : trials_) trial.gpuMs = 0.01 * trial.wallMs;
  EXPECT_NE(chooseClock(trials_).clock, Clock::gpu);
}

TEST(ClockChoiceInCode, NoSourceAsksForARenderersName) {
  // Split, so that this file does not hold what it looks for. Comments may tell what was seen where: only code is read.
  const std::vector<std::string> names{std::string("llvm") + "pipe", std::string("soft") + "pipe",
                                       std::string("swift") + "shader", std::string("swr") + "ast"};
  const std::filesystem::path root(GNOMON_SOURCE_DIR);
  std::size_t files = 0;
  for (const char* folder : {"framework", "viewer", "plugins"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      const std::string extension = entry.path().extension();
      const std::string file = entry.path().filename();
      if (!entry.is_regular_file() || file.find("_test.") != std::string::npos) continue;
      if (extension != ".cpp" && extension != ".h" && extension != ".glsl" && extension != ".frag" && extension != ".vert")
        continue;
      ++files;
      std::ifstream stream(entry.path());
      std::string line;
      for (int number = 1; std::getline(stream, line); ++number) {
        std::string code = line.substr(0, line.find("//"));
        std::transform(code.begin(), code.end(), code.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        for (const std::string& name : names) {
          EXPECT_EQ(code.find(name), std::string::npos) << entry.path() << ":" << number << " asks for " << name;
        }
      }
    }
  }
  EXPECT_GT(files, 50U);
}

}  // namespace
}  // namespace gnomon::test
