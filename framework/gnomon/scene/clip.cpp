#include "gnomon/scene/clip.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "gnomon/scene/look_at.h"

namespace gnomon {
namespace {

double signedDistance(const glm::dvec4& plane, const glm::dvec3& p) {
  return glm::dot(glm::dvec3(plane), p) + plane.w;
}

/// The convex polygon of points in a plane: by angle around their mean.
std::vector<glm::dvec3> capOf(std::vector<glm::dvec3> points, const glm::dvec3& normal) {
  glm::dvec3 mean(0.0);
  for (const glm::dvec3& p : points) mean += p / static_cast<double>(points.size());
  const Axes axes = axesAround(glm::normalize(normal));
  const auto angle = [&](const glm::dvec3& p) { return std::atan2(glm::dot(p - mean, axes.y), glm::dot(p - mean, axes.x)); };
  std::sort(points.begin(), points.end(), [&](const glm::dvec3& a, const glm::dvec3& b) { return angle(a) < angle(b); });
  return points;
}

}  // namespace

Polyhedron boxPolyhedron(const Bounds& bounds) {
  const auto face = [&](int a, int b, int c, int d) {
    return std::vector<glm::dvec3>{bounds.corner(a), bounds.corner(b), bounds.corner(c), bounds.corner(d)};
  };
  return {face(0, 2, 6, 4), face(1, 3, 7, 5), face(0, 1, 5, 4), face(2, 3, 7, 6), face(0, 1, 3, 2), face(4, 5, 7, 6)};
}

Polyhedron clipped(const Polyhedron& polyhedron, const glm::dvec4& plane, double tolerance) {
  Polyhedron result;
  std::vector<glm::dvec3> cut;
  for (const std::vector<glm::dvec3>& face : polyhedron) {
    // Sutherland and Hodgman 1974
    std::vector<glm::dvec3> kept;
    for (std::size_t i = 0; i < face.size(); ++i) {
      const glm::dvec3& a = face[i];
      const glm::dvec3& b = face[(i + 1) % face.size()];
      const double da = signedDistance(plane, a);
      const double db = signedDistance(plane, b);
      if (da >= -tolerance) kept.push_back(a);
      if ((da >= -tolerance) != (db >= -tolerance)) {
        kept.push_back(glm::mix(a, b, std::clamp(da / (da - db), 0.0, 1.0)));
        cut.push_back(kept.back());
      }
    }
    if (!kept.empty()) result.push_back(std::move(kept));
  }
  if (cut.size() > 2) result.push_back(capOf(std::move(cut), glm::dvec3(plane)));
  return result;
}

double distanceToTriangle(const glm::dvec3& p, const Triangle& triangle) {
  const auto& [a, b, c] = triangle;
  const auto distanceToSegment = [&](const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 along = to - from;
    const double length2 = glm::dot(along, along);
    const double t = length2 > 0.0 ? std::clamp(glm::dot(p - from, along) / length2, 0.0, 1.0) : 0.0;
    return glm::length(from + along * t - p);
  };
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const auto inside = [&](const glm::dvec3& from, const glm::dvec3& to) {
    return glm::dot(glm::cross(to - from, p - from), normal) >= 0.0;
  };
  const double area = glm::length(normal);
  if (area > 0.0 && inside(a, b) && inside(b, c) && inside(c, a)) return std::abs(glm::dot(p - a, normal)) / area;
  return std::min({distanceToSegment(a, b), distanceToSegment(b, c), distanceToSegment(c, a)});
}

}  // namespace gnomon
