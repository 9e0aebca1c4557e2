#include "gnomon/stability/brute_force.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace gnomon::stability {

namespace {

constexpr double kSameDirection = 0.99;  // cosine of 8 degrees
constexpr double kNegligibleArea = 1e-6;
constexpr double kSameCorner = 1e-12;     // relative to a polygon's size
constexpr std::size_t kMostPieces = 512;  // of an uncovered rest: beyond, it is said to be uncovered

/// Ericson, Real-Time Collision Detection, 5.1.5: by the Voronoi regions of corners, edges and the inside.
glm::dvec3 nearestPoint(const Face& f, const glm::dvec3& p) {
  const glm::dvec3 ab = f.b - f.a;
  const glm::dvec3 ac = f.c - f.a;
  const glm::dvec3 ap = p - f.a;
  const double d1 = glm::dot(ab, ap);
  const double d2 = glm::dot(ac, ap);
  if (d1 <= 0.0 && d2 <= 0.0) return f.a;
  const glm::dvec3 bp = p - f.b;
  const double d3 = glm::dot(ab, bp);
  const double d4 = glm::dot(ac, bp);
  if (d3 >= 0.0 && d4 <= d3) return f.b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return f.a + ab * (d1 / (d1 - d3));
  const glm::dvec3 cp = p - f.c;
  const double d5 = glm::dot(ab, cp);
  const double d6 = glm::dot(ac, cp);
  if (d6 >= 0.0 && d5 <= d6) return f.c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return f.a + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) return f.b + (f.c - f.b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  return p - f.normal * glm::dot(f.normal, ap);
}

/// Twice the signed area in the plane z = 0.
double doubleArea(const Polygon& polygon) {
  double sum = 0.0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const glm::dvec3 u = polygon[i - 1] - polygon[0];
    const glm::dvec3 v = polygon[i] - polygon[0];
    sum += u.x * v.y - u.y * v.x;
  }
  return sum;
}

/// `piece` without the convex, counter-clockwise `hole`: convex pieces, one beyond each edge.
void subtract(Polygon piece, const Polygon& hole, double negligible, std::vector<Polygon>& rest) {
  double shortest = 0.0;
  for (const glm::dvec3& p : hole)
    shortest = std::max(shortest, glm::dot(p - hole[0], p - hole[0]) * kSameCorner * kSameCorner);
  for (std::size_t i = 0; i < hole.size(); ++i) {
    const glm::dvec3 edge = hole[(i + 1) % hole.size()] - hole[i];
    if (glm::dot(edge, edge) <= shortest) continue;  // a corner twice has no direction
    const glm::dvec3 inward(-edge.y, edge.x, 0.0);
    const HalfSpace inside{inward, -glm::dot(inward, hole[i])};
    Polygon beyond = piece;
    clip(beyond, {-inside.normal, -inside.offset});
    if (std::abs(doubleArea(beyond)) > negligible) rest.push_back(std::move(beyond));
    clip(piece, inside);
    if (piece.empty()) return;
  }
}

}  // namespace

std::vector<Face> worldFaces(const Scene& scene) {
  std::vector<Face> faces;
  faces.reserve(scene.triangles());
  for (const Instance& instance : scene.instances) {
    for (std::size_t t = 0; t < scene.meshes[instance.mesh].triangles(); ++t) {
      const Triangle triangle = worldTriangle(scene, instance, t);
      const glm::dvec3 n = glm::cross(triangle.b - triangle.a, triangle.c - triangle.a);
      const double length = glm::length(n);
      faces.push_back(
          {triangle.a, triangle.b, triangle.c, length > 0.0 ? n / length : glm::dvec3(0.0), instance.casts, instance.receives});
    }
  }
  return faces;
}

NearestFace nearestFace(std::span<const Face> faces, const glm::dvec3& point, const glm::dvec3& normal) {
  NearestFace best{0, point, std::numeric_limits<double>::infinity()};
  for (const bool anyDirection : {false, true}) {
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (!anyDirection && !(std::abs(glm::dot(faces[i].normal, normal)) > kSameDirection)) continue;
      const glm::dvec3 nearest = nearestPoint(faces[i], point);
      const double distance = glm::length(nearest - point);
      if (distance < best.distance) best = {i, nearest, distance};
    }
    if (std::isfinite(best.distance)) break;
  }
  return best;
}

void clip(Polygon& polygon, const HalfSpace& within) {
  Polygon kept;
  kept.reserve(polygon.size() + 1);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3& p = polygon[i];
    const glm::dvec3& q = polygon[(i + 1) % polygon.size()];
    const double atP = within.at(p);
    const double atQ = within.at(q);
    if (atP >= 0.0) kept.push_back(p);
    if ((atP > 0.0 && atQ < 0.0) || (atP < 0.0 && atQ > 0.0)) kept.push_back(glm::mix(p, q, atP / (atP - atQ)));
  }
  polygon = std::move(kept);
}

Polygon clippedTriangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, std::span<const HalfSpace> within) {
  // Most triangles lie wholly outside one of the half-spaces: no polygon is made for them.
  for (const HalfSpace& h : within) {
    if (h.at(a) < 0.0 && h.at(b) < 0.0 && h.at(c) < 0.0) return {};
  }
  Polygon polygon{a, b, c};
  for (const HalfSpace& h : within) {
    clip(polygon, h);
    if (polygon.empty()) break;
  }
  return polygon;
}

bool covers(std::span<const Polygon> polygons, const Polygon& region) {
  const double negligible = kNegligibleArea * std::abs(doubleArea(region));
  std::vector<Polygon> rest{region};
  std::vector<Polygon> next;
  for (Polygon hole : polygons) {
    const double area = doubleArea(hole);
    if (area == 0.0) continue;
    if (area < 0.0) std::reverse(hole.begin(), hole.end());
    next.clear();
    for (Polygon& piece : rest) subtract(std::move(piece), hole, negligible, next);
    std::swap(rest, next);
    if (rest.empty()) return true;
    if (rest.size() > kMostPieces) return false;
  }
  return false;
}

}  // namespace gnomon::stability
