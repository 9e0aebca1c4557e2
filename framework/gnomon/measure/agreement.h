// Whether measurements agree, judged by their own intervals, many at once.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "gnomon/base/statistics.h"

namespace gnomon {

/// A figure with its 95 % interval, which holds the value.
struct Estimate {
  double value = 0.0;
  Interval ci95;
};

enum class Verdict : std::uint8_t { same, lower, higher };

/// What became of each second figure against its first. A difference counts when its z = (b - a) / sqrt(s_a^2 + s_b^2), with s
/// the interval's half towards the other figure over 1.96, is rejected at `familyWiseSignificance` among all of them (Holm
/// 1979): of a family in which nothing changed, that share of the time something is said to have. Intervals without width are
/// exact. Not finite: same.
std::vector<Verdict> compareFamily(std::span<const std::pair<Estimate, Estimate>> pairs, double familyWiseSignificance = 0.05);

}  // namespace gnomon
