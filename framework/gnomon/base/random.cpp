#include "gnomon/base/random.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gnomon {

// The seed is mixed so that streams of near seeds are far apart on the counter.
RandomStream::RandomStream(std::uint64_t seed) : counter_(mixBits(seed)) {}

std::size_t RandomStream::below(std::size_t count) {
  // The product may round up to `count` for enormous counts only; the clamp makes that safe.
  return std::min(static_cast<std::size_t>(uniform() * static_cast<double>(count)), count - 1);
}

double RandomStream::normal() {  // Box and Muller 1958; 1 - u is in (0,1], so the logarithm is finite
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

}  // namespace gnomon
