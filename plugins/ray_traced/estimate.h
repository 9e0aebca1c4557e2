// Visibility of one receiver from its rays, with a standard error: by a fixed number of them, or until they suffice.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <utility>

#include "gnomon/base/random.h"
#include "tracer.h"

namespace gnomon {

struct Estimate {
  double visibility = 1.0;
  double cosineVisibility = 1.0;  ///< V_cos
  double standardError = 0.0;     ///< of `visibility`; 0: no ray could have said otherwise
};

/// Into how many runs a pixel's samples are split for their standard error. Runs of a power of two of samples, from a multiple
/// of it on, are nets of their own; together they are a finer one, more even than independent runs would be. Their spread is
/// therefore an upper estimate: by 8^(1/4) = 1.7 times across a straight edge, by 8^(1/2) = 2.8 along an axis of the source, by
/// nothing where V varies finely. Runs that all agree have no spread, but what lies between two of n samples may hide 1/n of
/// the source: where half of that is seen in every second picture, the standard error is half a step, 1/(2n). It is never said
/// to be less.
inline constexpr std::size_t kRuns = 8;

/// Of runs of equally many samples each. A single run has no spread: its standard error is 1/2, the most there is.
Estimate estimateOf(std::span<const Tally> runs);

/// Stops when the standard error is at most `target`. Two sequences of a pixel run side by side, and how many samples one of
/// them may use is decided by the samples of the other alone, so that no choice favours a sample: whatever the target, each
/// sequence's mean is as unbiased as with a fixed number. (A sequence that stops by its own samples is not: it stops early
/// where chance hides the rare event.)
class Adaptive {
 public:
  /// `most` samples in each sequence.
  Adaptive(std::uint32_t seed, int most, double target);

  /// `trace(u, tally)` for each point of the source, then `finish()` before the tallies are looked at.
  template <class Trace, class Finish>
  Estimate run(const Trace& trace, const Finish& finish) {
    while (!done()) {
      const auto [from, to] = next();
      for (std::size_t s = 0; s < sequences_.size(); ++s) {
        for (int i = from; i < to; ++i) trace(sequences_[s].points(static_cast<std::uint32_t>(i)), tally(s, i));
      }
      finish();
      decide();
    }
    return result();
  }

 private:
  struct Sequence {
    SobolOwen2 points;
    std::array<Tally, kRuns> runs{};
    Estimate taken{};
    bool isTaken = false;
  };
  bool done() const { return sequences_[0].isTaken && sequences_[1].isTaken; }
  /// The next stage's samples [from, to): as many as there were.
  std::pair<int, int> next();
  Tally& tally(std::size_t sequence, int sample);
  void decide();
  Estimate result() const;

  std::array<Sequence, 2> sequences_;
  int most_;
  double target_;  ///< of one sequence
  int samples_ = 0;
  int stage_ = 0;  ///< samples before this stage
};

}  // namespace gnomon
