#include "gnomon/measure/timing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

/// (A1+A2)/(B1+B2) of each pair, by block. Empty if any baseline took no time: the clock is too coarse for a ratio.
std::optional<std::vector<std::vector<double>>> ratiosByBlock(const std::vector<TimedPair>& pairs, const TimingPlan& plan) {
  std::vector<std::vector<double>> ratios(pairs.size() / static_cast<std::size_t>(plan.poses));
  for (const TimedPair& pair : pairs) {
    const double candidate = reading(pair.candidate[0], plan.clock) + reading(pair.candidate[1], plan.clock);
    const double baseline = reading(pair.baseline[0], plan.clock) + reading(pair.baseline[1], plan.clock);
    if (baseline <= 0.0) return std::nullopt;
    ratios[static_cast<std::size_t>(pair.block)].push_back(candidate / baseline);
  }
  return ratios;
}

std::optional<Interval> ratioInterval(const std::vector<TimedPair>& pairs, const TimingPlan& plan) {
  const auto ratios = ratiosByBlock(pairs, plan);
  return ratios ? bootstrapInterval(*ratios, medianInPlace, plan.bootstrap) : std::nullopt;
}

std::vector<double> flattened(const std::vector<std::vector<double>>& groups) {
  std::vector<double> all;
  for (const std::vector<double>& group : groups) all.insert(all.end(), group.begin(), group.end());
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

  TimingFigures figures;
  const double start = wallMs();
  const auto isEnough = [&] {
    if (plan.halfWidth <= 0.0 || wallMs() - start > 1e3 * plan.seconds) return true;
    const std::optional<Interval> interval = ratioInterval(figures.pairs, plan);
    return interval && 0.5 * (interval->high - interval->low) <= plan.halfWidth;
  };
  int blocks = 0;
  while (blocks < plan.blocks || !isEnough()) {
    const int block = blocks++;
    const std::vector<TimedPair> pairs = timeBlock(frame, plan.poses, block);
    figures.pairs.insert(figures.pairs.end(), pairs.begin(), pairs.end());
  }

  std::vector<std::vector<double>> timesByBlock(static_cast<std::size_t>(blocks));
  std::vector<double> wallTimes;
  for (const TimedPair& pair : figures.pairs) {
    for (const FrameTime& time : pair.candidate) {
      timesByBlock[static_cast<std::size_t>(pair.block)].push_back(reading(time, plan.clock));
      wallTimes.push_back(reading(time, Clock::wall));
    }
  }
  const std::vector<double> times = flattened(timesByBlock);
  figures.medianMs = median(times);
  figures.wallMedianMs = median(wallTimes);
  figures.madMs = medianAbsoluteDeviation(times);
  figures.p95Ms = percentile(times, 95.0);
  figures.n = static_cast<int>(times.size());
  figures.ci95Ms = bootstrapInterval(timesByBlock, medianInPlace, plan.bootstrap);
  if (const auto ratios = ratiosByBlock(figures.pairs, plan)) {
    figures.ratio = median(flattened(*ratios));
    figures.ratioCi95 = ratioInterval(figures.pairs, plan);
  }
  return figures;
}

}  // namespace gnomon
