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

/// Points in a plane, into the order of a convex polygon: by angle around their mean.
void sortAround(std::span<glm::dvec3> points, const glm::dvec3& normal) {
  glm::dvec3 mean(0.0);
  for (const glm::dvec3& p : points) mean += p / static_cast<double>(points.size());
  const Axes axes = axesAround(glm::normalize(normal));
  const auto angle = [&](const glm::dvec3& p) { return std::atan2(glm::dot(p - mean, axes.y), glm::dot(p - mean, axes.x)); };
  std::sort(points.begin(), points.end(), [&](const glm::dvec3& a, const glm::dvec3& b) { return angle(a) < angle(b); });
}

}  // namespace

std::span<const glm::dvec3> ConvexPolyhedron::face(std::size_t i) const {
  const std::size_t begin = i == 0 ? 0 : ends_[i - 1];
  return std::span(corners_).subspan(begin, ends_[i] - begin);
}

void ConvexPolyhedron::closeFace() {
  if (corners_.size() > (ends_.empty() ? 0 : ends_.back())) ends_.push_back(corners_.size());
}

void ConvexPolyhedron::setBox(const Bounds& bounds) {
  corners_.clear();
  ends_.clear();
  constexpr int kFaces[6][4] = {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}};
  for (const auto& face : kFaces) {
    for (const int corner : face) corners_.push_back(bounds.corner(corner));
    closeFace();
  }
}

void ConvexPolyhedron::clip(const glm::dvec4& plane, double tolerance) {
  std::swap(corners_, whole_);
  std::swap(ends_, wholeEnds_);
  corners_.clear();
  ends_.clear();
  cut_.clear();
  std::size_t begin = 0;
  for (const std::size_t end : wholeEnds_) {
    // Sutherland and Hodgman 1974
    for (std::size_t i = begin; i < end; ++i) {
      const glm::dvec3& a = whole_[i];
      const glm::dvec3& b = whole_[i + 1 < end ? i + 1 : begin];
      const double da = signedDistance(plane, a);
      const double db = signedDistance(plane, b);
      if (da >= -tolerance) corners_.push_back(a);
      if ((da >= -tolerance) != (db >= -tolerance)) {
        corners_.push_back(glm::mix(a, b, std::clamp(da / (da - db), 0.0, 1.0)));
        cut_.push_back(corners_.back());
      }
    }
    closeFace();
    begin = end;
  }
  if (cut_.size() < 3) return;
  sortAround(cut_, glm::dvec3(plane));
  corners_.insert(corners_.end(), cut_.begin(), cut_.end());
  closeFace();
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
