// Convex polyhedra against half-spaces, and distances to triangles, in double. Internal to scene/.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "gnomon/scene/scene.h"

namespace gnomon {

/// A convex polyhedron as its faces, which keeps its memory: fits run each frame. Flat boxes have faces without area, which is
/// no harm.
class ConvexPolyhedron {
 public:
  void setBox(const Bounds& bounds);
  /// Keeps the part with n.x + d >= -tolerance, closed by a face in the plane; nothing if there is none.
  void clip(const glm::dvec4& plane, double tolerance);

  std::size_t faces() const { return ends_.size(); }
  std::span<const glm::dvec3> face(std::size_t i) const;
  /// Corners of all faces, each as often as faces meet there.
  std::span<const glm::dvec3> corners() const { return corners_; }

 private:
  void closeFace();

  std::vector<glm::dvec3> corners_;  ///< face after face, around each
  std::vector<std::size_t> ends_;    ///< of each face, in `corners_`
  std::vector<glm::dvec3> whole_, cut_;
  std::vector<std::size_t> wholeEnds_;
};

/// From `p` to the nearest point of the triangle; degenerate ones are their segments.
double distanceToTriangle(const glm::dvec3& p, const Triangle& triangle);

}  // namespace gnomon
