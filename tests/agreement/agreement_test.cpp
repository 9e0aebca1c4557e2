// Whether intervals hold what they claim: for the same technique under two names, on a busy machine, and from run to run.
// Statistics of real times: not among the tests that run on every change.
#include <gmock/gmock.h>

#include <atomic>
#include <nlohmann/json.hpp>
#include <thread>

#include "gnomon/measure/agreement.h"
#include "known_cost.h"

namespace gnomon::test {
namespace {

/// Numbers from `first` to `last` as a JSON array.
std::string numbers(int first, int last) {
  Json list = Json::array();
  for (int i = first; i <= last; ++i) list.push_back(i);
  return list.dump();
}

/// What became of every ratio, at a family-wise level.
std::vector<Verdict> verdicts(const std::vector<JobRecord>& before, const std::vector<JobRecord>& after) {
  std::vector<std::pair<Estimate, Estimate>> ratios;
  for (std::size_t i = 0; i < before.size(); ++i) {
    for (const auto& [regime, figures] : before[i].time.value().regimes) {
      const TimingFigures& other = after.at(i).time.value().regimes.at(regime);
      ratios.push_back({{figures.ratio.value(), figures.ratioCi95.value()}, {other.ratio.value(), other.ratioCi95.value()}});
    }
  }
  return compareFamily(ratios);
}

TEST_F(KnownCost, TheIntervalOfATechniqueAgainstItsTwinHoldsOne) {
  const std::vector<JobRecord> jobs = run(R"({"baseline": {"technique": "busy"},
    "measure": {"regimes": ["dynamic"], "frames": 60, "blocks": 5},
    "techniques": [{"technique": "busy_twin", "sweep": {"label": )" +
                                          numbers(1, 20) + "}}]}");
  ASSERT_EQ(jobs.size(), 20U);
  int holding = 0;
  for (const JobRecord& job : jobs) holding += dynamic(job).ratioCi95.value().contains(1.0) ? 1 : 0;
  EXPECT_GE(holding, 17);
}

/// Keeps all processors busy while it lives.
class BurningCores {
 public:
  BurningCores() {
    for (unsigned i = 0; i < std::thread::hardware_concurrency(); ++i) {
      threads_.emplace_back([this] {
        while (!done_) continue;
      });
    }
  }
  ~BurningCores() {
    done_ = true;
    for (std::thread& thread : threads_) thread.join();
  }
  BurningCores(const BurningCores&) = delete;
  BurningCores& operator=(const BurningCores&) = delete;

 private:
  std::atomic<bool> done_ = false;
  std::vector<std::thread> threads_;
};

TEST_F(KnownCost, AnotherProcessThatBurnsAllCoresMovesNoRatio) {
  // Real drawing: a pass of a fixed time does not grow with the machine's load, and its ratio to one that does would move.
  const std::string config = R"({"scene": {"builtin": "sphere_grid"}, "output": {"size": [96, 72]},
    "baseline": {"technique": "shadow_map"}, "measure": {"regimes": ["dynamic", "camera"], "frames": 24, "blocks": 2},
    "techniques": [{"technique": "shadow_map"}, {"technique": "pcf"}, {"technique": "pcss"}]})";
  ASSERT_EQ(batch(config, {"--repeat", "4"}, "quiet").exitCode, 0);
  {
    const BurningCores burning;
    ASSERT_EQ(batch(config, {"--repeat", "4"}, "burning").exitCode, 0);
  }
  EXPECT_THAT(verdicts(results("quiet"), results("burning")), testing::Each(Verdict::same));
}

TEST_F(KnownCost, TwoRunsOfOneBatchAgreeWithinTheirIntervals) {
  const std::string config = R"({"baseline": {"technique": "busy"},
    "measure": {"regimes": ["dynamic", "camera"], "frames": 24, "blocks": 2},
    "techniques": [{"technique": "busy", "parameters": {"spin": 1}}, {"technique": "busy", "parameters": {"loops": 256}},
                   {"technique": "shadow_map"}, {"technique": "pcf"}]})";
  ASSERT_EQ(batch(config, {"--repeat", "4"}, "first").exitCode, 0);
  ASSERT_EQ(batch(config, {"--repeat", "4"}, "second").exitCode, 0);
  EXPECT_THAT(verdicts(results("first"), results("second")), testing::Each(Verdict::same));
}

}  // namespace
}  // namespace gnomon::test
