#include "gnomon/stability/promises.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

namespace gnomon {

bool sameBits(const Image& a, const Image& b) {
  return a.data.size() == b.data.size() && std::memcmp(a.data.data(), b.data.data(), a.data.size() * sizeof(float)) == 0;
}

std::string visibilityFault(const Image& visibility, const Image& mask) {
  if (visibility.data.size() != mask.data.size()) return "V is not of the output's size";
  const auto wrong = [&](std::size_t i) -> const char* {
    const float v = visibility.data[i];
    if (!std::isfinite(v)) return "not finite; look for divisions by zero, roots and logarithms of negative numbers";
    if (v < 0.0f || v > 1.0f) return "out of [0,1]; V is the lit part of the source: clamp it";
    if (mask.data[i] == 0.0f && v != 1.0f) return "not 1 outside the receiver mask; discard there and clear to 1";
    return nullptr;
  };
  std::size_t count = 0;
  std::size_t first = 0;
  for (std::size_t i = visibility.data.size(); i-- > 0;) {
    if (wrong(i) == nullptr) continue;
    ++count;
    first = i;
  }
  if (count == 0) return {};
  const auto width = static_cast<std::size_t>(visibility.width);
  return fmt::format("V is {:.6g} at pixel ({}, {}), wrong at {} pixels in all: {}", visibility.data[first], first % width,
                     first / width, count, wrong(first));
}

}  // namespace gnomon
