// Paired timing: a candidate against a baseline in blocks whose order cancels drift.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "gnomon/base/statistics.h"
#include "gnomon/measure/clocks.h"

namespace gnomon {

/// What each clock said of one frame, milliseconds.
struct FrameTime {
  double cpuMs = 0.0;
  double wallMs = 0.0;
  std::optional<double> gpuMs = std::nullopt;

  bool operator==(const FrameTime&) const = default;
};

enum class Side { candidate, baseline };

/// Renders one frame of one side at a pose (0..poses-1) and reports its time, finished.
using TimedFrame = std::function<FrameTime(Side, int pose)>;

struct TimingPlan {
  int poses = 6;
  int blocks = 5;
  int warmup = 2;  ///< rounds over the poses of each side before anything is timed: first draws compile
  Clock clock = Clock::wall;
  BootstrapPlan bootstrap = {};
  /// After `blocks`, more are added until half the width of the ratio's interval is at most this, or `seconds` of wall time
  /// have passed since the first. Stopping by the interval makes it narrow by luck now and then: it covers a little less than
  /// it claims. 0: no more than `blocks`.
  double halfWidth = 0.0;
  double seconds = 0.0;
};

/// Where on a path the frames of measurePaired stand. Each side comes to a pose twice in a block, and to the last pose twice
/// running: on the same spot nothing would have changed since, and nothing would be run. So the path has two steps for each
/// pose, and the visits to a pose take turns between them; both sides stand on the same steps equally often.
class PoseSteps {
 public:
  explicit PoseSteps(int poses);

  /// 2 pose or 2 pose + 1.
  int next(Side side, int pose);
  int count() const { return 2 * static_cast<int>(visits_[0].size()); }

 private:
  std::array<std::vector<int>, 2> visits_;
};

/// The two frames of each side at one pose of one block: raw values for the side file.
struct TimedPair {
  int block = 0;
  int pose = 0;
  std::array<FrameTime, 2> candidate;
  std::array<FrameTime, 2> baseline;

  bool operator==(const TimedPair&) const = default;
};

/// What was not or could not be measured is absent. Medians, p95 and n are over the candidate's frames, on the plan's clock.
struct TimingFigures {
  std::optional<double> medianMs = {};
  std::optional<double> wallMedianMs = {};
  std::optional<double> madMs = {};     ///< median absolute deviation, unscaled
  std::optional<Interval> ci95Ms = {};  ///< of the median
  std::optional<double> p95Ms = {};
  std::optional<int> n = {};
  /// Median over pairs of (A1+A2)/(B1+B2); none where a baseline pair took no time by this clock.
  std::optional<double> ratio = {};
  std::optional<Interval> ratioCi95 = {};
  std::vector<TimedPair> pairs = {};

  bool operator==(const TimingFigures&) const = default;
};

/// The figures of pairs that were measured by one process or several, each with blocks of its own. Intervals by bootstrap over
/// processes, blocks, then pairs. Throws Error without pairs, on a clock that a frame lacks, and on a time that is negative or
/// not finite. `pairs` are those of the first process.
TimingFigures timingFigures(std::span<const std::vector<TimedPair>> processes, Clock clock, const BootstrapPlan& plan = {});

/// One block renders the poses in order with one side (A), in order with the other (B), then B reversed and A reversed. Each
/// pose's two frames of either side lie symmetric about the block's centre, so drift that is linear in time cancels within
/// every pair. Blocks take turns in which side is outermost (A is the candidate in even blocks, the baseline in odd ones), so
/// that the rest, drift's curvature, changes sign from block to block. Intervals by bootstrap over blocks, then pairs.
/// Throws Error on a plan without poses or blocks, or with a half width but no time to reach it in, on a clock that a frame
/// lacks, and on a time that is negative or not finite.
TimingFigures measurePaired(const TimedFrame& frame, const TimingPlan& plan);

}  // namespace gnomon
