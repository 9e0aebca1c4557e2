#include "plain_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>

#include "gnomon/base/error.h"
#include "gnomon/stability/brute_force.h"

namespace gnomon::plain {

namespace {

/// Axes of a light by its definition: z away from the target, x to the right as seen along the light, rolled about z.
struct Plane {
  glm::dvec3 centre, x, y, z;
};

Plane sourcePlane(const Light& light) {
  const glm::dvec3 z = glm::normalize(light.position - light.target);
  const glm::dvec3 right = glm::normalize(glm::cross(light.up, z));
  const glm::dvec3 above = glm::cross(z, right);
  const double roll = glm::radians(light.source.rollDegrees);
  return {light.position, right * std::cos(roll) + above * std::sin(roll), above * std::cos(roll) - right * std::sin(roll), z};
}

/// A direction within `halfAngle` of a unit axis, uniform in solid angle: its height over the axis is.
glm::dvec3 inCone(const glm::dvec3& axis, double halfAngle, RandomStream& random) {
  const double least = std::cos(halfAngle);
  const glm::dvec3 some = std::abs(axis.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(some, axis));
  const glm::dvec3 y = glm::cross(axis, x);
  const double height = least + (1.0 - least) * random.uniform();  // Archimedes: caps have the area of their height
  const double angle = 2.0 * std::numbers::pi * random.uniform();
  const double across = std::sqrt(std::max(0.0, 1.0 - height * height));
  return axis * height + (x * std::cos(angle) + y * std::sin(angle)) * across;
}

/// The way to a point of the source, as far as it matters, and how much solid angle the point stands for.
struct Ray {
  glm::dvec3 way;
  double weight;
};

Ray toSource(const Light& light, const glm::dvec3& receiver, RandomStream& random) {
  constexpr double endless = 1e3;  // metres: beyond all blockers of the tests
  if (light.type == LightType::directional) {
    const glm::dvec3 axis = glm::normalize(light.position - light.target);
    return {inCone(axis, glm::radians(0.5 * light.angularDiameterDegrees), random) * endless, 1.0};
  }
  const glm::dvec3 towards = light.position - receiver;
  const double distance = glm::length(towards);
  if (light.type == LightType::point) {
    const glm::dvec3 direction = inCone(towards / distance, std::asin(light.radius / distance), random);
    const double along = glm::dot(direction, towards);  // to the sphere's near side
    const double depth = std::sqrt(std::max(0.0, light.radius * light.radius - distance * distance + along * along));
    return {direction * (along - depth), 1.0};
  }
  const Plane plane = sourcePlane(light);
  glm::dvec2 at{2.0};
  if (light.source.shape == SourceShape::rectangle) {
    at = light.source.size * glm::dvec2(random.uniform() - 0.5, random.uniform() - 0.5);
  } else {
    do {
      at = light.source.radius * glm::dvec2(2.0 * random.uniform() - 1.0, 2.0 * random.uniform() - 1.0);
    } while (glm::dot(at, at) > light.source.radius * light.source.radius);
  }
  const glm::dvec3 way = towards + plane.x * at.x + plane.y * at.y;
  const double square = glm::dot(way, way);
  return {way, glm::dot(way, plane.z) / (square * std::sqrt(square))};  // cosine at the source over the square of the distance
}

/// Whether the way from `from` passes through the triangle: it crosses the plane inside all three edges (Pluecker's sides).
bool isStopped(const Triangle& triangle, const glm::dvec3& from, const glm::dvec3& way) {
  const glm::dvec3 a = triangle.a - from;
  const glm::dvec3 b = triangle.b - from;
  const glm::dvec3 c = triangle.c - from;
  const double sideA = glm::dot(way, glm::cross(b, c));
  const double sideB = glm::dot(way, glm::cross(c, a));
  const double sideC = glm::dot(way, glm::cross(a, b));
  const bool isInside = (sideA >= 0.0 && sideB >= 0.0 && sideC >= 0.0) || (sideA <= 0.0 && sideB <= 0.0 && sideC <= 0.0);
  const double sum = sideA + sideB + sideC;
  if (!isInside || sum == 0.0) return false;
  const double along = glm::dot(a, glm::cross(b, c)) / sum;  // of the way
  return along > 0.0 && along < 1.0;
}

/// Lengths of [low, high] pairs together, overlaps once.
double unionLength(std::vector<std::pair<double, double>> intervals) {
  std::sort(intervals.begin(), intervals.end());
  double length = 0.0;
  double reached = -1e300;
  for (const auto& [low, high] : intervals) {
    length += std::max(0.0, high - std::max(low, reached));
    reached = std::max(reached, high);
  }
  return length;
}

void addCrossings(const Polygon2& p, const Polygon2& q, std::vector<double>& xs) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    const glm::dvec2 a = p[i];
    const glm::dvec2 d = p[(i + 1) % p.size()] - a;
    for (std::size_t j = 0; j < q.size(); ++j) {
      const glm::dvec2 b = q[j];
      const glm::dvec2 e = q[(j + 1) % q.size()] - b;
      const double determinant = d.x * e.y - d.y * e.x;
      if (determinant == 0.0) continue;
      const double t = ((b.x - a.x) * e.y - (b.y - a.y) * e.x) / determinant;
      if (t > 0.0 && t < 1.0) xs.push_back(a.x + t * d.x);
    }
  }
}

}  // namespace

std::vector<Triangle> blockersOf(const Scene& scene, std::size_t receiver) {
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    if (i == receiver || !instance.casts) continue;
    for (std::size_t t = 0; t < scene.meshes[instance.mesh].triangles(); ++t) {
      triangles.push_back(worldTriangle(scene, instance, t));
    }
  }
  return triangles;
}

Share visibility(std::span<const Triangle> blockers, const Light& light, const glm::dvec3& receiver, const glm::dvec3& normal,
                 int samples, RandomStream& random) {
  int all = 0;
  int seen = 0;
  double allWeights = 0.0;
  double seenWeights = 0.0;
  for (int i = 0; i < samples; ++i) {
    const auto [way, weight] = toSource(light, receiver, random);
    const double cosine = glm::dot(way, normal) / glm::length(way);
    if (cosine <= 0.0) continue;
    const bool isSeen =
        std::none_of(blockers.begin(), blockers.end(), [&](const Triangle& t) { return isStopped(t, receiver, way); });
    ++all;
    allWeights += weight * cosine;
    if (!isSeen) continue;
    ++seen;
    seenWeights += weight * cosine;
  }
  if (all == 0) return {};
  return {static_cast<double>(seen) / all, seenWeights / allWeights};
}

double unionArea(std::span<const Polygon2> polygons) {
  std::vector<double> xs;
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    for (const glm::dvec2& corner : polygons[i]) xs.push_back(corner.x);
    for (std::size_t j = i + 1; j < polygons.size(); ++j) addCrossings(polygons[i], polygons[j], xs);
  }
  std::sort(xs.begin(), xs.end());
  double area = 0.0;
  for (std::size_t s = 0; s + 1 < xs.size(); ++s) {
    const double x = 0.5 * (xs[s] + xs[s + 1]);
    std::vector<std::pair<double, double>> intervals;
    for (const Polygon2& polygon : polygons) {
      double low = 1e300;
      double high = -1e300;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec2 a = polygon[i];
        const glm::dvec2 b = polygon[(i + 1) % polygon.size()];
        if ((a.x < x) == (b.x < x)) continue;
        const double y = a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x);
        low = std::min(low, y);
        high = std::max(high, y);
      }
      if (low < high) intervals.emplace_back(low, high);
    }
    area += (xs[s + 1] - xs[s]) * unionLength(std::move(intervals));
  }
  return area;
}

double rectangleVisibility(std::span<const Triangle> blockers, const Light& light, const glm::dvec3& receiver) {
  const Plane plane = sourcePlane(light);
  const glm::dvec3 towards = plane.centre - receiver;
  const double depth = glm::dot(towards, plane.z);
  const glm::dvec2 half = 0.5 * light.source.size;
  std::array<glm::dvec3, 4> corners{};
  for (std::size_t i = 0; i < 4; ++i) {
    const double x = i == 0 || i == 3 ? -half.x : half.x;
    corners[i] = towards + plane.x * x + plane.y * (i < 2 ? -half.y : half.y);
  }
  std::vector<stability::HalfSpace> pyramid{{plane.z, 0.0}, {-plane.z, depth}};  // between receiver and source
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec3 side = glm::normalize(glm::cross(corners[i], corners[(i + 1) % 4]));
    pyramid.push_back({glm::dot(side, towards) < 0.0 ? -side : side, 0.0});
  }
  std::vector<Polygon2> shadows;
  for (const Triangle& t : blockers) {
    Polygon2 shadow;
    for (const glm::dvec3& p : stability::clippedTriangle(t.a - receiver, t.b - receiver, t.c - receiver, pyramid)) {
      const double along = glm::dot(p, plane.z);
      if (!(along > 0.0)) throw Error("a blocker touches the receiver: its projection has no bound");
      const glm::dvec3 onPlane = p * (depth / along) - towards;
      shadow.emplace_back(glm::dot(onPlane, plane.x), glm::dot(onPlane, plane.y));
    }
    if (shadow.size() >= 3) shadows.push_back(std::move(shadow));
  }
  return 1.0 - unionArea(shadows) / (light.source.size.x * light.source.size.y);
}

}  // namespace gnomon::plain
