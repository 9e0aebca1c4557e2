// What the viewer says on screen.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app.h"

namespace gnomon {

class Panels {
 public:
  explicit Panels(App& app) : app_(app), o_(*app.overlay_) {}

  /// Largest size of letters, at most `pixels`, at which the whole help fits into the window.
  float fittingHelp(float pixels);
  /// All panels for the technique that is shown.
  void draw(std::size_t shown);
  /// Chooses the mapping from a texture's values to colours: its own smallest and largest finite value.
  void lookInto(const TextureResource& texture, PresentView& view);
  /// What lookInto() saw under the cursor; empty without it.
  const std::string& inspected() const { return inspected_; }
  /// What the picture is compared with, or why with nothing; empty where nothing was asked for.
  std::string comparison() const;

 private:
  /// A translucent box with lines of text, a leading '!' marking those that matter; returns its lower right corner.
  glm::vec2 box(glm::vec2 at, const std::vector<std::string>& lines);
  glm::vec2 boxSize(const std::vector<std::string>& lines) const;
  /// Adds `text`, broken into lines no wider than what is left of the window.
  void addWrapped(std::vector<std::string>& lines, const std::string& text, float width) const;

  /// Returns where its box ends.
  float technique(std::size_t shown);
  std::string errorLine(const ViewerTechnique& t) const;
  void parameters(float belowTechnique);
  void plan();
  void times();
  void help();
  std::vector<std::vector<std::string>> helpColumns() const;
  void bottomLine();
  void legend(float top);
  void troubles();
  /// The light as it lies in the picture: its source and the line to its target.
  void lightMarker();
  void nodeMarker();
  /// Where a world position is in the window; none behind the camera.
  std::optional<glm::vec2> project(const glm::dvec3& world) const;
  void stroke(const glm::dvec3& from, const glm::dvec3& to, const glm::vec4& colour);

  App& app_;
  Overlay& o_;
  struct Rectangle {
    glm::vec2 min, max;
  };
  bool isFree(const Rectangle& wanted) const;
  /// The box, where it hides no panel that is there already and lies inside the window. Whether it was drawn.
  bool boxIfFree(glm::vec2 at, const std::vector<std::string>& lines);

  std::string inspected_;
  std::vector<Rectangle> taken_;
};

}  // namespace gnomon
