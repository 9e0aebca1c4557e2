#include "gnomon/measure/clocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "gnomon/base/error.h"
#include "gnomon/base/statistics.h"

namespace gnomon {
namespace {

using Reading = std::function<double(const ClockTrial&)>;

/// Why the trials cannot prove anything, or "".
std::string whyNoProof(std::span<const ClockTrial> trials) {
  if (trials.size() < 2) return fmt::format("{} clock trials, needs at least 2", trials.size());
  for (const ClockTrial& trial : trials) {
    if (!(trial.work > 0.0) || !std::isfinite(trial.work)) return "a clock trial has no positive work";
    if (!(trial.wallMs >= kHeavyTrialMs)) {
      return fmt::format("a clock trial took {:.3g} ms, too light to judge by (needs {:.3g})", trial.wallMs, kHeavyTrialMs);
    }
  }
  const auto [least, most] = std::minmax_element(trials.begin(), trials.end(),
                                                 [](const ClockTrial& a, const ClockTrial& b) { return a.work < b.work; });
  if (most->work < kLeastWorkSpan * least->work) return "the clock trials differ too little in work";
  return {};
}

/// Why `reading` does not scale with the work, or "".
std::string whyNotScaling(std::span<const ClockTrial> trials, const Reading& reading) {
  double least = reading(trials[0]) / trials[0].work;
  double most = least;
  for (const ClockTrial& trial : trials) {
    const double rate = reading(trial) / trial.work;
    if (!(rate > 0.0) || !std::isfinite(rate)) return fmt::format("reports {:.3g} ms for a heavy trial", reading(trial));
    least = std::min(least, rate);
    most = std::max(most, rate);
  }
  if (most <= kScalingFactor * least) return {};
  return fmt::format("does not scale: {:.3g} to {:.3g} ms per unit of work", least, most);
}

/// Why the GPU timer is refused, or "".
std::string whyNotGpu(std::span<const ClockTrial> trials) {
  for (const ClockTrial& trial : trials) {
    if (!trial.gpuMs) return "there is no GPU timer";
    const double share = *trial.gpuMs / trial.wallMs;
    if (!(share >= kLeastGpuShare && share <= kMostGpuShare)) {
      return fmt::format("the GPU timer reports {:.3g} ms where the finished wall clock shows {:.3g} ms", *trial.gpuMs,
                         trial.wallMs);
    }
  }
  const std::string scaling = whyNotScaling(trials, [](const ClockTrial& trial) { return *trial.gpuMs; });
  return scaling.empty() ? scaling : "the GPU timer " + scaling;
}

double medianCpuShare(std::span<const ClockTrial> trials) {
  std::vector<double> shares;
  for (const ClockTrial& trial : trials) shares.push_back(trial.cpuMs / trial.wallMs);
  return medianInPlace(shares);
}

/// Why process CPU time is refused, or "".
std::string whyNotCpu(std::span<const ClockTrial> trials) {
  const double share = medianCpuShare(trials);
  if (!(share >= kLeastCpuShare)) {
    return fmt::format("process CPU time covers {:.0f} % of the finished wall time", 100.0 * share);
  }
  const std::string scaling = whyNotScaling(trials, [](const ClockTrial& trial) { return trial.cpuMs; });
  return scaling.empty() ? scaling : "process CPU time " + scaling;
}

}  // namespace

std::string clockName(Clock clock) {
  return clock == Clock::gpu ? "gpu" : clock == Clock::cpu ? "cpu" : "wall";
}

std::optional<Clock> clockFromName(const std::string& name) {
  for (const Clock clock : {Clock::gpu, Clock::cpu, Clock::wall}) {
    if (clockName(clock) == name) return clock;
  }
  return std::nullopt;
}

ClockChoice chooseClock(std::span<const ClockTrial> trials) {
  const std::string noProof = whyNoProof(trials);
  if (!noProof.empty()) return {Clock::wall, "wall: " + noProof};
  const std::string notGpu = whyNotGpu(trials);
  if (notGpu.empty()) {
    return {Clock::gpu, fmt::format("gpu: agrees with the finished wall clock in each of {} trials", trials.size())};
  }
  const std::string notCpu = whyNotCpu(trials);
  if (notCpu.empty()) {
    return {Clock::cpu, fmt::format("cpu: {}; process CPU time is {:.0f} % of the finished wall time and scales with the work",
                                    notGpu, 100.0 * medianCpuShare(trials))};
  }
  return {Clock::wall, fmt::format("wall: {}; {}", notGpu, notCpu)};
}

ClockChoice provenClock(std::span<const ClockTrial> trials, Clock wanted) {
  if (wanted == Clock::wall) return {wanted, "wall: asked for"};
  std::string against = whyNoProof(trials);
  if (against.empty()) against = wanted == Clock::gpu ? whyNotGpu(trials) : whyNotCpu(trials);
  if (against.empty()) return {wanted, clockName(wanted) + ": asked for, and its trials bear it out"};
  throw Error(fmt::format("timer '{}' is not to be believed here: {}; leave the timer open to take one that proves itself",
                          clockName(wanted), against));
}

Clock clockForPair(Clock chosen, CpuPasses candidate, CpuPasses baseline) {
  const bool onGpuAlone = candidate == CpuPasses::none && baseline == CpuPasses::none;
  return chosen == Clock::gpu && !onGpuAlone ? Clock::wall : chosen;
}

}  // namespace gnomon
