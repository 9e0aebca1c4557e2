// Pixels of a screenshot.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

namespace gnomon::test {

/// 8 bits a channel, rows from the top.
struct Picture {
  using Pixel = std::array<int, 3>;

  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> bytes;  ///< red, green and blue of each pixel

  Pixel at(int x, int y) const;
  /// How many pixels are of that kind.
  int count(const std::function<bool(const Pixel&)>& wanted) const;
};

/// A PNG as this project writes it: RGB without interlacing. Throws Error on any other file.
Picture readPicture(const std::filesystem::path& png);

/// How many pixels differ in the rectangle from (left, top) up to, not including, (right, bottom).
int differing(const Picture& a, const Picture& b, int left, int top, int right, int bottom);
/// In the whole picture.
int differing(const Picture& a, const Picture& b);

}  // namespace gnomon::test
