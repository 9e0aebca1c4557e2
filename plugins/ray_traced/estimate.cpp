#include "estimate.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

/// Samples of each sequence in the first stage: a packet of rays.
constexpr int kFirstStage = 16;

}  // namespace

Estimate estimateOf(std::span<const Tally> runs) {
  Tally all;
  double sum = 0.0;
  double squares = 0.0;
  for (const Tally& run : runs) {
    all += run;
    sum += run.visibility();
    squares += run.visibility() * run.visibility();
  }
  const auto n = static_cast<double>(runs.size());
  const double variance = std::max(0.0, squares - sum * sum / n) / (n - 1.0);
  const double least = all.rays == 0 ? 0.0 : 0.5 / all.rays;
  return {all.visibility(), all.weightedVisibility(), n < 2.0 ? 0.5 : std::max(std::sqrt(variance / n), least)};
}

Adaptive::Adaptive(std::uint32_t seed, int most, double target)
    : sequences_{Sequence{SobolOwen2(seed)}, Sequence{SobolOwen2(pixelSeed(seed, 0, 1))}},
      most_(most),
      target_(target * std::sqrt(2.0)) {}

std::pair<int, int> Adaptive::next() {
  stage_ = samples_;
  if (stage_ > 0) {  // twice as long runs: two and two become one
    for (Sequence& s : sequences_) {
      for (std::size_t r = 0; r < kRuns / 2; ++r) {
        s.runs[r] = s.runs[2 * r];
        s.runs[r] += s.runs[2 * r + 1];
      }
      std::fill(s.runs.begin() + kRuns / 2, s.runs.end(), Tally{});
    }
  }
  samples_ = std::min(most_, stage_ == 0 ? kFirstStage : 2 * stage_);
  return {stage_, samples_};
}

Tally& Adaptive::tally(std::size_t sequence, int sample) {
  const std::size_t first = stage_ == 0 ? 0 : kRuns / 2;
  const auto runs = static_cast<int>(kRuns - first);
  return sequences_[sequence].runs[first + static_cast<std::size_t>((sample - stage_) * runs / (samples_ - stage_))];
}

void Adaptive::decide() {
  const std::array<Estimate, 2> now{estimateOf(sequences_[0].runs), estimateOf(sequences_[1].runs)};
  for (std::size_t s = 0; s < 2; ++s) {
    Sequence& sequence = sequences_[s];
    if (sequence.isTaken || (now[1 - s].standardError > target_ && samples_ < most_)) continue;
    sequence.taken = now[s];
    sequence.isTaken = true;
  }
}

Estimate Adaptive::result() const {
  const Estimate& a = sequences_[0].taken;
  const Estimate& b = sequences_[1].taken;
  // Equal weights: weights by numbers of samples would let each sequence's samples choose the other's weight.
  return {0.5 * (a.visibility + b.visibility), 0.5 * (a.cosineVisibility + b.cosineVisibility),
          0.5 * std::hypot(a.standardError, b.standardError)};
}

}  // namespace gnomon
