// The last pass: a session's picture, or any texture of it, into a framebuffer to be looked at.
#pragma once

#include <glm/vec2.hpp>

#include "gnomon/gl/objects.h"
#include "gnomon/graph/graph.h"

namespace gnomon {

enum class PresentMode : int {
  picture,     ///< linear colour, sRGB-encoded
  difference,  ///< left - right of the first channel: blue below, white at 0, red above, full colour at +-`scale`
  values       ///< one channel from `low` (black) to `high` (white); outside that range blue and red, non-finite magenta
};

struct PresentView {
  PresentMode mode = PresentMode::picture;
  const TextureResource* left = nullptr;
  const TextureResource* right = nullptr;  ///< of difference; of picture beyond the divider
  float divider = 1.0f;                    ///< share of the width that shows `left`
  float scale = 0.5f;
  glm::vec2 range{0.0f, 1.0f};  ///< of values: low, high
  int channel = 0;              ///< of values; -1: the first three as colours
  /// Where in the window it lies: pixels of the upper left corner, and of the extent. No extent: the whole window.
  glm::ivec2 at{0, 0};
  glm::ivec2 extent{0, 0};
};

class Presenter {
 public:
  Presenter();
  /// Fills its part of the bound framebuffer of `size` pixels, whose row 0 is the bottom, as windows have it. Textures keep
  /// their top.
  void draw(const PresentView& view, glm::ivec2 size) const;

 private:
  gl::ProgramObject program_;
  gl::VertexArrayObject vertexArray_;
  gl::SamplerObject nearest_;
};

}  // namespace gnomon
