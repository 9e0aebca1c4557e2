// What the viewer says on screen.
#pragma once

#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "app.h"

namespace gnomon {

class Panels {
 public:
  explicit Panels(App& app) : app_(app), o_(*app.overlay_) {}

  /// All panels for the technique that is shown.
  void draw(std::size_t shown);
  /// Chooses the mapping from a texture's values to colours: its own smallest and largest finite value.
  void lookInto(const TextureResource& texture, PresentView& view);

 private:
  /// A translucent box with lines of text; returns its lower right corner.
  glm::vec2 box(glm::vec2 at, const std::vector<std::string>& lines);
  /// Returns where its box ends.
  float technique(std::size_t shown);
  void parameters(float belowTechnique);
  void plan();
  void times();
  void help();
  void bottomLine();
  void legend(float top);
  glm::vec2 textSize(const std::vector<std::string>& lines) const;

  App& app_;
  Overlay& o_;
  std::string inspected_;
  float techniqueRight_ = 0.0f;
};

}  // namespace gnomon
