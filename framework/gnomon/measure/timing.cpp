#include "gnomon/measure/timing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "gnomon/base/clock.h"
#include "gnomon/base/error.h"

namespace gnomon {
namespace {

double reading(const FrameTime& time, Clock clock) {
  if (clock == Clock::gpu && !time.gpuMs) throw Error("timing: the GPU clock was chosen, but a frame has no GPU time");
  const double ms = clock == Clock::gpu ? *time.gpuMs : clock == Clock::cpu ? time.cpuMs : time.wallMs;
  if (!std::isfinite(ms) || ms < 0.0) {
    throw Error(
        fmt::format("timing: the {} clock reports {} ms for a frame, must be finite and not negative", clockName(clock), ms));
  }
  return ms;
}

std::vector<TimedPair> timeBlock(const TimedFrame& frame, int poses, int block) {
  std::vector<TimedPair> pairs(static_cast<std::size_t>(poses));
  const auto time = [&](Side side, int pose, std::size_t half) {
    TimedPair& pair = pairs[static_cast<std::size_t>(pose)];
    (side == Side::candidate ? pair.candidate : pair.baseline)[half] = frame(side, pose);
  };
  const Side outer = block % 2 == 0 ? Side::candidate : Side::baseline;
  const Side inner = block % 2 == 0 ? Side::baseline : Side::candidate;
  for (int pose = 0; pose < poses; ++pose) time(outer, pose, 0);
  for (int pose = 0; pose < poses; ++pose) time(inner, pose, 0);
  for (int pose = poses - 1; pose >= 0; --pose) time(inner, pose, 1);
  for (int pose = poses - 1; pose >= 0; --pose) time(outer, pose, 1);
  for (int pose = 0; pose < poses; ++pose) {
    pairs[static_cast<std::size_t>(pose)].block = block;
    pairs[static_cast<std::size_t>(pose)].pose = pose;
  }
  return pairs;
}

/// The values of each pair, by block.
template <class Values>
GroupedValues byBlock(const std::vector<TimedPair>& pairs, const Values& valuesOf) {
  std::map<int, std::vector<double>> blocks;
  for (const TimedPair& pair : pairs) {
    std::vector<double>& block = blocks[pair.block];
    for (const double value : valuesOf(pair)) block.push_back(value);
  }
  GroupedValues groups;
  for (auto& [number, values] : blocks) groups.push_back(std::move(values));
  return groups;
}

/// (A1+A2)/(B1+B2); not finite where the baseline took no time: the clock is too coarse for a ratio.
double ratioOf(const TimedPair& pair, Clock clock) {
  return (reading(pair.candidate[0], clock) + reading(pair.candidate[1], clock)) /
         (reading(pair.baseline[0], clock) + reading(pair.baseline[1], clock));
}

/// By process and block; empty if any is not finite.
std::vector<GroupedValues> ratiosOf(std::span<const std::vector<TimedPair>> processes, Clock clock) {
  std::vector<GroupedValues> ratios;
  for (const std::vector<TimedPair>& pairs : processes) {
    if (!std::all_of(pairs.begin(), pairs.end(), [&](const TimedPair& pair) { return std::isfinite(ratioOf(pair, clock)); }))
      return {};
    ratios.push_back(byBlock(pairs, [&](const TimedPair& pair) { return std::array{ratioOf(pair, clock)}; }));
  }
  return ratios;
}

std::optional<Interval> ratioInterval(const std::vector<TimedPair>& pairs, const TimingPlan& plan) {
  return bootstrapInterval(ratiosOf(std::span(&pairs, 1), plan.clock), medianInPlace, plan.bootstrap);
}

std::vector<double> flattened(std::span<const GroupedValues> repeats) {
  std::vector<double> all;
  for (const GroupedValues& groups : repeats) {
    for (const std::vector<double>& group : groups) all.insert(all.end(), group.begin(), group.end());
  }
  return all;
}

}  // namespace

PoseSteps::PoseSteps(int poses) {
  for (std::vector<int>& visits : visits_) visits.assign(static_cast<std::size_t>(std::max(poses, 1)), 0);
}

int PoseSteps::next(Side side, int pose) {
  int& visits = visits_[static_cast<std::size_t>(side)].at(static_cast<std::size_t>(pose));
  return 2 * pose + visits++ % 2;
}

TimingFigures measurePaired(const TimedFrame& frame, const TimingPlan& plan) {
  if (plan.poses < 1 || plan.blocks < 1 || plan.warmup < 0) {
    throw Error(fmt::format("timing: {} poses, {} blocks, {} warm-up rounds; needs at least 1, 1 and 0", plan.poses,
                            plan.blocks, plan.warmup));
  }
  if (plan.halfWidth > 0.0 && !(plan.seconds > 0.0)) {
    throw Error(
        fmt::format("timing: {} seconds to reach a half width of {} in; needs more than 0", plan.seconds, plan.halfWidth));
  }
  for (int round = 0; round < plan.warmup; ++round) {
    for (const Side side : {Side::candidate, Side::baseline}) {
      for (int pose = 0; pose < plan.poses; ++pose) frame(side, pose);
    }
  }

  std::vector<TimedPair> all;
  const double start = wallMs();
  const auto isEnough = [&] {
    if (plan.halfWidth <= 0.0 || wallMs() - start > 1e3 * plan.seconds) return true;
    const std::optional<Interval> interval = ratioInterval(all, plan);
    return interval && 0.5 * (interval->high - interval->low) <= plan.halfWidth;
  };
  int blocks = 0;
  while (blocks < plan.blocks || !isEnough()) {
    const int block = blocks++;
    const std::vector<TimedPair> pairs = timeBlock(frame, plan.poses, block);
    all.insert(all.end(), pairs.begin(), pairs.end());
  }
  return timingFigures(std::span(&all, 1), plan.clock, plan.bootstrap);
}

TimingFigures timingFigures(std::span<const std::vector<TimedPair>> processes, Clock clock, const BootstrapPlan& plan) {
  std::vector<GroupedValues> candidate, wall;
  for (const std::vector<TimedPair>& pairs : processes) {
    const auto readings = [&pairs](Clock by) {
      return byBlock(pairs, [by](const TimedPair& pair) {
        return std::array{reading(pair.candidate[0], by), reading(pair.candidate[1], by)};
      });
    };
    candidate.push_back(readings(clock));
    wall.push_back(readings(Clock::wall));
  }
  const std::vector<double> times = flattened(candidate);
  if (times.empty()) throw Error("timing: no pair of frames was timed");
  TimingFigures figures;
  figures.medianMs = median(times);
  figures.wallMedianMs = median(flattened(wall));
  figures.madMs = medianAbsoluteDeviation(times);
  figures.p95Ms = percentile(times, 95.0);
  figures.n = static_cast<int>(times.size());
  figures.ci95Ms = bootstrapInterval(candidate, medianInPlace, plan);
  if (const std::vector<GroupedValues> ratios = ratiosOf(processes, clock); !ratios.empty()) {
    figures.ratio = median(flattened(ratios));
    figures.ratioCi95 = bootstrapInterval(ratios, medianInPlace, plan);
  }
  figures.pairs = processes.front();
  return figures;
}

}  // namespace gnomon
