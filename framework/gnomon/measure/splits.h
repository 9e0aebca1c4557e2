// Error split by what people see. Each figure answers to one fault and to little else.
#pragma once

#include <optional>

namespace gnomon {

/// With T the technique and R the reference. None of the figures exists where the picture has nothing to measure it on.
struct ErrorSplits {
  std::optional<double> acne;        ///< root mean square of min(T-R, 0) over lit pixels far from every edge of a shadow
  std::optional<double> leak;        ///< root mean square of T over umbra
  std::optional<double> detachment;  ///< mean length of the lit gap between a caster and its shadow at contacts, metres
  std::optional<double> penumbra;    ///< mean |log2(width / the reference's width)| over edges of shadows
  std::optional<double> shimmer;     ///< root mean square of what T changes from frame to frame beyond what R does

  bool operator==(const ErrorSplits&) const = default;
};

}  // namespace gnomon
