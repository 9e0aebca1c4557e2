// Convex polyhedra against half-spaces, and distances to triangles, in double. Internal to scene/.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "gnomon/scene/scene.h"

namespace gnomon {

/// A convex polyhedron as its faces; flat boxes have faces without area, which is no harm.
using Polyhedron = std::vector<std::vector<glm::dvec3>>;

Polyhedron boxPolyhedron(const Bounds& bounds);

/// The part with n.x + d >= -tolerance. Empty if there is none.
Polyhedron clipped(const Polyhedron& polyhedron, const glm::dvec4& plane, double tolerance);

/// From `p` to the nearest point of the triangle; degenerate ones are their segments.
double distanceToTriangle(const glm::dvec3& p, const Triangle& triangle);

}  // namespace gnomon
