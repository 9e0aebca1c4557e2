// Which clock may be believed on this machine, found by measurement and never by a renderer's name.
#pragma once

#include <optional>
#include <span>
#include <string>

namespace gnomon {

/// gpu: timer queries. cpu: time of the whole process, all threads. wall: monotonic clock with a finish before and after.
enum class Clock { gpu, cpu, wall };

/// "gpu", "cpu" or "wall".
std::string clockName(Clock clock);
/// The reverse; empty for any other text.
std::optional<Clock> clockFromName(const std::string& name);

/// One known heavy piece of drawing, timed by every clock at once. All in milliseconds; wall from a finish to a finish.
struct ClockTrial {
  double work = 1.0;  ///< amount of drawing in any one unit; trials must differ in it (1 : 2 : 4), several to one target
  double wallMs = 0.0;
  double cpuMs = 0.0;
  std::optional<double> gpuMs = std::nullopt;  ///< sum of the trial's timer queries; none without a timer
};

struct ClockChoice {
  Clock clock = Clock::wall;
  std::string reason;  ///< one sentence with the numbers that decided
};

/// A trial is heavy enough when it takes this long: a finish costs up to 0.1 ms, which then is 5 % at most.
inline constexpr double kHeavyTrialMs = 2.0;
/// Bounds of gpu / finished wall in *each* trial. The query's interval lies within the wall's, so more than 1 is a lie but for
/// the grain of the clocks; less than half cannot be explained by a finish's cost in a trial that is heavy.
inline constexpr double kLeastGpuShare = 0.5;
inline constexpr double kMostGpuShare = 1.05;
/// A clock scales when its time per unit of work differs by less than this factor between trials whose work spans at least
/// kLeastWorkSpan: a clock that reports a constant differs by that span.
inline constexpr double kScalingFactor = 1.5;
inline constexpr double kLeastWorkSpan = 2.0;
/// Process CPU time covers the work when the median of cpu / wall is at least this. A processor that waits for a GPU shows a
/// few percent; a software renderer shows 1 and more when alone, and 0.3 on a machine seven times overcommitted.
inline constexpr double kLeastCpuShare = 0.2;

/// gpu when it agrees with the finished wall clock in each trial and scales with the work; else cpu when it covers the work and
/// scales; else wall. Never throws: trials that prove nothing leave the wall clock, and the reason says why.
ClockChoice chooseClock(std::span<const ClockTrial> trials);

/// `wanted`, where the trials bear it out as chooseClock asks; the wall clock needs no proof. Else throws Error with the
/// numbers that speak against it.
ClockChoice provenClock(std::span<const ClockTrial> trials, Clock wanted);

/// Whether a technique has passes on the CPU.
enum class CpuPasses { none, some };

/// The clock for a pair of techniques: a GPU timer does not see CPU passes, so a pair with any is compared by finished wall
/// time; the other clocks see both kinds.
Clock clockForPair(Clock chosen, CpuPasses candidate, CpuPasses baseline);

}  // namespace gnomon
