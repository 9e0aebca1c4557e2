// The frame of what looks along -Z: cameras and lights.
#pragma once

#include <glm/vec3.hpp>

namespace gnomon {

/// Orthonormal and right-handed.
struct Axes {
  glm::dvec3 x{1.0, 0.0, 0.0};
  glm::dvec3 y{0.0, 1.0, 0.0};
  glm::dvec3 z{0.0, 0.0, 1.0};
};

/// Axes of a node at `position` that looks along -z at `target`, with x perpendicular to `up`. An `up` within 1e-6 (sine) of
/// the axis, or of no length, falls back to [0,0,-1], then to [1,0,0]. A target at the position looks straight down.
Axes lookAxes(const glm::dvec3& position, const glm::dvec3& target, const glm::dvec3& up);

/// Any axes around the unit vector `z`.
Axes axesAround(const glm::dvec3& z);

}  // namespace gnomon
