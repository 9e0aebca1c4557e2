// Ground truth without shortcuts: every triangle of the scene, in double precision, by clipping. Where rays would only sample
// a beam of light, clipping decides for all of it whether anything reaches into it and whether all of it is blocked.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "gnomon/scene/scene.h"

namespace gnomon::stability {

/// A triangle of the scene in world space.
struct Face {
  glm::dvec3 a, b, c;
  glm::dvec3 normal;  ///< unit, counter-clockwise side; 0 for a triangle without area
  bool casts = true;
  bool receives = true;
};

std::vector<Face> worldFaces(const Scene& scene);

struct NearestFace {
  std::size_t face = 0;
  glm::dvec3 point{0.0};  ///< on the face
  double distance = 0.0;  ///< metres; infinite where there is no face
};

/// The face nearest to `point` among those whose normal is within 8 degrees of `normal` or of its opposite; among all where
/// there is none.
NearestFace nearestFace(std::span<const Face> faces, const glm::dvec3& point, const glm::dvec3& normal);

/// The points p with normal.p + offset >= 0.
struct HalfSpace {
  glm::dvec3 normal{0.0};
  double offset = 0.0;
  double at(const glm::dvec3& p) const { return normal.x * p.x + normal.y * p.y + normal.z * p.z + offset; }
};

/// Convex and planar; without corners it is empty.
using Polygon = std::vector<glm::dvec3>;

/// The part of the triangle that lies in all the half-spaces, their borders included.
Polygon clippedTriangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, std::span<const HalfSpace> within);

/// Keeps of a convex polygon what lies in the half-space.
void clip(Polygon& polygon, const HalfSpace& within);

/// Whether convex polygons together cover a convex region of the plane z = 0. What stays uncovered counts from a millionth of
/// the region's area: less is rounding along edges that two triangles share.
bool covers(std::span<const Polygon> polygons, const Polygon& region);

}  // namespace gnomon::stability
