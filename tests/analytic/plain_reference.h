// References of another make than the ray tracer's: a plain loop over all triangles in double precision, with its own points on
// the source; and for rectangles the exact share, as an area. They share neither acceleration structure, sampling, packets nor
// rounding with it.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "gnomon/base/random.h"
#include "gnomon/scene/scene.h"

namespace gnomon::plain {

/// Triangles in world space of the scene's casters, but for those of the instance `receiver`, whose plane must hold all its
/// receivers: it cannot shadow itself.
std::vector<Triangle> blockersOf(const Scene& scene, std::size_t receiver);

struct Share {
  double visibility = 1.0;
  double cosineVisibility = 1.0;  ///< V_cos: weighted by the cosine to the receiver's normal, over solid angle
};

/// From `samples` independent points of the source, which the light must have.
Share visibility(std::span<const Triangle> blockers, const Light& light, const glm::dvec3& receiver, const glm::dvec3& normal,
                 int samples, RandomStream& random);

/// Exact, for a rectangle wholly above the receiver's horizon: what lies in the pyramid from the receiver to the source is
/// projected onto the source's plane, and the area of its union taken.
double rectangleVisibility(std::span<const Triangle> blockers, const Light& light, const glm::dvec3& receiver);

using Polygon2 = std::vector<glm::dvec2>;
/// Area of the union of convex polygons: slabs between all their corners and crossings, in each the length of a union of
/// intervals at its middle, which is exact since it is linear in between.
double unionArea(std::span<const Polygon2> polygons);

}  // namespace gnomon::plain
