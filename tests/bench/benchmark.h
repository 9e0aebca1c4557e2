// What is measured against a limit: ratios of process CPU time in one run, and one absolute cost.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "gnomon/base/error.h"
#include "gnomon/measure/timing.h"
#include "gnomon/session.h"

namespace gnomon::bench {

/// How much work a benchmark may do.
struct Effort {
  bool smoke = false;      ///< one tiny iteration: only what is compared is checked
  double seconds = 120.0;  ///< of wall time for each, after its first blocks
};

enum class Bound { atMost, atLeast };

/// Thrown by a benchmark that this machine cannot make: no failure.
class NotHere : public Error {
 public:
  using Error::Error;
};

struct Benchmark {
  std::string name;
  std::string meaning;  ///< what the figure is, one sentence
  std::string unit;     ///< empty for a ratio
  Bound bound = Bound::atMost;
  double limit = 1.0;
  /// Throws Error where the two sides do not do the same: then the comparison is void.
  std::function<TimingFigures(const Effort&)> run;
};

/// Half the width of the 95 % interval at which no more blocks are added.
inline constexpr double kHalfWidth = 0.02;

/// Blocks on process CPU time until the interval is narrow enough or the time is spent.
TimingPlan timingPlan(const Effort& effort, int poses);

/// A built-in scene with its own camera and light, as a session's set-up.
SessionSetup sceneSetup(const std::string& name, glm::ivec2 size);

/// Puts a session on a step of the path (PoseSteps): the light turns as in the dynamic regime and the camera steps aside, so
/// that every pass has to run.
void moveTo(Session& session, const Light& light, const Camera& camera, int step, int steps);

/// Does the work finished before and after, and times it.
FrameTime timed(const std::function<void()>& work);

std::vector<Benchmark> frameBenchmarks();
std::vector<Benchmark> cullingBenchmarks();
std::vector<Benchmark> graphBenchmarks();
std::vector<Benchmark> rayBenchmarks();

}  // namespace gnomon::bench
