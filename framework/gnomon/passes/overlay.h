// Text, panels and bars over a picture: one pass, one draw.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "gnomon/gl/objects.h"

namespace gnomon {

/// Collects shapes in pixels from the top left corner, then draws them into whatever framebuffer is bound.
class Overlay {
 public:
  /// Needs a current context. `fontPixels` is the height of a line's letters.
  explicit Overlay(float fontPixels);
  ~Overlay();

  /// Makes the letters anew, sharp at that height. No work when it is unchanged.
  void setFontPixels(float pixels);

  void rectangle(glm::vec2 min, glm::vec2 max, glm::vec4 colour);
  /// A straight stroke between two points.
  void line(glm::vec2 from, glm::vec2 to, float width, glm::vec4 colour);
  /// `at` is the top left of the first line; '\n' begins another. Characters outside the font's set are drawn as '?'.
  void text(glm::vec2 at, std::string_view utf8, glm::vec4 colour);

  /// Of the longest line, in pixels.
  float textWidth(std::string_view utf8) const;
  float lineHeight() const;

  /// Breaks lines so that none is wider than `pixels`: between words where there are any, else within a word.
  std::string wrapped(std::string_view utf8, float pixels) const;

  /// Draws all that was collected into the bound framebuffer of `size` pixels and forgets it.
  void draw(glm::ivec2 size);

 private:
  struct Font;
  struct Vertex {
    glm::vec2 position, atlas;  ///< atlas.x < 0: a plain colour
    glm::vec4 colour;
  };
  void quad(glm::vec2 min, glm::vec2 max, glm::vec2 atlasMin, glm::vec2 atlasMax, glm::vec4 colour);

  std::unique_ptr<Font> font_;
  gl::ProgramObject program_;
  gl::VertexArrayObject vertexArray_;
  gl::BufferObject buffer_;
  std::size_t capacity_ = 0;
  std::vector<Vertex> vertices_;
};

}  // namespace gnomon
