// A float image in memory; row 0 is the top, as in every file.
#pragma once

#include <cstddef>
#include <vector>

namespace gnomon {

/// width x height x channels floats, rows from the top, channels interleaved.
struct Image {
  int width = 0;
  int height = 0;
  int channels = 1;
  std::vector<float> data;

  Image() = default;
  Image(int w, int h, int c = 1, float value = 0.0f)
      : width(w),
        height(h),
        channels(c),
        data(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(c), value) {}

  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  std::size_t index(int x, int y, int c = 0) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(channels) +
           static_cast<std::size_t>(c);
  }
  float& at(int x, int y, int c = 0) { return data[index(x, y, c)]; }
  float at(int x, int y, int c = 0) const { return data[index(x, y, c)]; }
};

}  // namespace gnomon
