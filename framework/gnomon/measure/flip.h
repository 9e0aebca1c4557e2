// HDR-FLIP: how visible the difference of two pictures is when they are flipped between.
#pragma once

#include <optional>

namespace gnomon {

/// On the shaded picture with white albedo at a fixed exposure, 67 pixels per degree. In [0,1]: 0 equal, 1 most visible.
struct FlipFigures {
  std::optional<double> mean;
  std::optional<double> p99;

  bool operator==(const FlipFigures&) const = default;
};

}  // namespace gnomon
