#include "shaft.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>
#include <new>

#include "gnomon/base/error.h"
#include "gnomon/scene/look_at.h"

namespace gnomon {

namespace {

/// Sine of the widest half angle of a cone that is put into a pyramid: beyond, its corners would come near 90 degrees.
constexpr double kWidest = 0.8;
/// Metres beyond which a source's distance leaves the pyramid's corners without digits.
constexpr double kFarthest = 1e12;
/// Triangles that reach into a shaft before it is said to be open.
constexpr int kMostPartial = 64;

/// What a pyramid is made around: four corners of a rectangle, relative to the apex, and depths along the axis between which
/// the source lies.
struct Base {
  glm::dvec3 axis;
  std::array<glm::dvec3, 4> corners;
  double nearest, farthest;
};

std::array<glm::dvec3, 4> rectangle(const glm::dvec3& centre, const glm::dvec3& x, const glm::dvec3& y) {
  return {centre - x - y, centre + x - y, centre + x + y, centre - x + y};
}

/// Around the cone of half angle asin(sine) about a unit axis.
std::array<glm::dvec3, 4> aroundCone(const Axes& axes, double sine) {
  const double tangent = sine / std::sqrt(1.0 - sine * sine);
  return rectangle(axes.z, axes.x * tangent, axes.y * tangent);
}

std::optional<Base> baseOf(const Light& light, const LightFrame& axes, const glm::dvec3& toCentre) {
  const double distance = glm::length(toCentre);
  if (light.type == LightType::directional) {
    const double sine = std::sin(glm::radians(0.5 * light.angularDiameterDegrees));
    if (!(sine > 0.0 && sine < kWidest)) return std::nullopt;
    constexpr double endless = std::numeric_limits<double>::infinity();
    return Base{axes.z, aroundCone({axes.x, axes.y, axes.z}, sine), endless, endless};
  }
  if (!(distance > 0.0 && distance < kFarthest)) return std::nullopt;
  if (light.type == LightType::point) {
    const double sine = light.radius / distance;
    if (!(sine > 0.0 && sine < kWidest)) return std::nullopt;
    const glm::dvec3 axis = toCentre / distance;
    return Base{axis, aroundCone(axesAround(axis), sine), distance - light.radius, distance};
  }
  const bool isDisc = light.source.shape == SourceShape::disc;
  const glm::dvec2 half = isDisc ? glm::dvec2(light.source.radius) : 0.5 * light.source.size;
  const double depth = glm::dot(toCentre, axes.z);
  if (!(half.x > 0.0 && half.y > 0.0 && depth > 1e-3 * (distance + half.x + half.y))) return std::nullopt;
  return Base{axes.z, rectangle(toCentre, axes.x * half.x, axes.y * half.y), depth, depth};
}

}  // namespace

std::optional<Shaft> Shaft::to(const Light& light, const LightFrame& axes, const glm::dvec3& origin, const glm::dvec3& apex,
                               const glm::dvec3& normal, double rounding) {
  const std::optional<Base> base = baseOf(light, axes, axes.origin - origin - apex);
  if (!base) return std::nullopt;
  Shaft shaft;
  shaft.apex_ = apex;
  shaft.axis_ = base->axis;
  shaft.nearest_ = base->nearest;
  shaft.rounding_ = rounding;
  shaft.allAboveHorizon_ = true;
  for (std::size_t i = 0; i < 4; ++i) {
    shaft.corners_[i] = glm::normalize(base->corners[i]);
    shaft.allAboveHorizon_ = shaft.allAboveHorizon_ && glm::dot(normal, shaft.corners_[i]) > 1e-6;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec3 across = glm::cross(shaft.corners_[i], shaft.corners_[(i + 1) % 4]);
    const double length = glm::length(across);
    if (!(length > 1e-9)) return std::nullopt;  // a source that thin has no side
    const double inwards = glm::dot(across, shaft.corners_[(i + 2) % 4]) < 0.0 ? -1.0 : 1.0;
    shaft.planes_[i] = {across * (inwards / length), 0.0};
  }
  shaft.planes_[4] = {normal, 0.0};
  shaft.planes_[5] = {-base->axis, base->farthest};
  return shaft;
}

bool Shaft::misses(const glm::dvec3& centre, const glm::dvec3& half) const {
  return std::any_of(planes_.begin(), planes_.end(), [&](const Plane& plane) {
    return glm::dot(plane.normal, centre - apex_) + glm::dot(glm::abs(plane.normal), half) + plane.offset < -rounding_;
  });
}

std::optional<Shaft::Sides> Shaft::sidesOf(const CasterTriangle& triangle) const {
  std::array<glm::dvec3, 3> v{};
  for (std::size_t k = 0; k < 3; ++k) v[k] = glm::dvec3(triangle.corners[k]) - apex_;
  const glm::dvec3 across = glm::cross(v[1] - v[0], v[2] - v[0]);
  const double volume = glm::dot(across, v[0]);
  Sides sides{{}, std::abs(volume) / glm::length(across)};
  if (!(sides.distance > rounding_)) return std::nullopt;  // or the triangle is none
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 side = glm::cross(v[k], v[(k + 1) % 3]);
    sides.normals[k] = side * ((volume < 0.0 ? -1.0 : 1.0) / glm::length(side));
  }
  return sides;
}

bool Shaft::misses(const CasterTriangle& triangle) const {
  const bool isOutside = std::any_of(planes_.begin(), planes_.end(), [&](const Plane& plane) {
    return std::all_of(triangle.corners.begin(), triangle.corners.end(), [&](const glm::vec3& corner) {
      return glm::dot(plane.normal, glm::dvec3(corner) - apex_) + plane.offset < -rounding_;
    });
  });
  if (isOutside) return true;
  const std::optional<Sides> sides = sidesOf(triangle);
  return sides && std::any_of(sides->normals.begin(), sides->normals.end(), [&](const glm::dvec3& inwards) {
           return std::all_of(corners_.begin(), corners_.end(), [&](const glm::dvec3& corner) {
             return glm::dot(inwards, corner) * sides->distance < -rounding_;
           });
         });
}

bool Shaft::isStoppedBy(const CasterTriangle& triangle) const {
  if (!allAboveHorizon_) return false;  // a receiver none of whose rays count is lit
  const bool isBetween = std::all_of(triangle.corners.begin(), triangle.corners.end(), [&](const glm::vec3& corner) {
    const double depth = glm::dot(axis_, glm::dvec3(corner) - apex_);
    return depth > rounding_ && depth < nearest_ - rounding_;
  });
  const std::optional<Sides> sides = isBetween ? sidesOf(triangle) : std::nullopt;
  // The source lies in the cone from the apex through the triangle if its corners do: both are convex.
  return sides && std::all_of(sides->normals.begin(), sides->normals.end(), [&](const glm::dvec3& inwards) {
           return std::all_of(corners_.begin(), corners_.end(), [&](const glm::dvec3& corner) {
             return glm::dot(inwards, corner) * sides->distance > rounding_;
           });
         });
}

struct ShaftTree::Node {
  std::array<RTCBounds, 2> bounds;           // of an inner node's children
  std::array<const Node*, 2> children{};     // null of a leaf
  std::array<std::uint32_t, 8> triangles{};  // of a leaf
  std::uint32_t count = 0;

  bool isLeaf() const { return children[0] == nullptr; }
};

/// What Embree's builder calls, from several threads.
struct ShaftTree::Builder {
  static Node* make(RTCThreadLocalAllocator allocator) { return new (rtcThreadLocalAlloc(allocator, sizeof(Node), 16)) Node(); }
  static void* inner(RTCThreadLocalAllocator allocator, unsigned /*children*/, void* /*user*/) { return make(allocator); }
  static void setChildren(void* node, void** children, unsigned count, void* /*user*/) {
    for (unsigned i = 0; i < count; ++i) static_cast<Node*>(node)->children[i] = static_cast<const Node*>(children[i]);
  }
  static void setBounds(void* node, const RTCBounds** bounds, unsigned count, void* /*user*/) {
    for (unsigned i = 0; i < count; ++i) static_cast<Node*>(node)->bounds[i] = *bounds[i];
  }
  static void* leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, std::size_t count, void* /*user*/) {
    Node* node = make(allocator);
    for (std::size_t i = 0; i < count; ++i) node->triangles[i] = primitives[i].primID;
    node->count = static_cast<std::uint32_t>(count);
    return node;
  }
};

ShaftTree::ShaftTree(const Tracer& tracer) : triangles_(tracer.triangles()), tree_(rtcNewBVH(tracer.device())) {
  std::vector<RTCBuildPrimitive> primitives(triangles_.size());
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const auto& [a, b, c] = triangles_[i].corners;
    const glm::vec3 low = glm::min(a, glm::min(b, c));
    const glm::vec3 high = glm::max(a, glm::max(b, c));
    primitives[i] = {low.x, low.y, low.z, 0, high.x, high.y, high.z, static_cast<unsigned>(i)};
    const glm::vec3 magnitudes = glm::max(glm::abs(low), glm::abs(high));
    magnitude_ = std::max(
        {magnitude_, static_cast<double>(magnitudes.x), static_cast<double>(magnitudes.y), static_cast<double>(magnitudes.z)});
  }
  if (primitives.empty()) return;
  RTCBuildArguments arguments = rtcDefaultBuildArguments();
  arguments.maxBranchingFactor = 2;
  arguments.minLeafSize = 1;
  arguments.maxLeafSize = static_cast<unsigned>(Node{}.triangles.size());
  arguments.bvh = tree_.get();
  arguments.primitives = primitives.data();
  arguments.primitiveCount = primitives.size();
  arguments.primitiveArrayCapacity = primitives.size();
  arguments.createNode = Builder::inner;
  arguments.setNodeChildren = Builder::setChildren;
  arguments.setNodeBounds = Builder::setBounds;
  arguments.createLeaf = Builder::leaf;
  root_ = tree_ ? static_cast<const Node*>(rtcBuildBVH(&arguments)) : nullptr;
  if (root_ == nullptr) throw Error("Embree could not build the hierarchy that shafts are asked of");
}

Verdict ShaftTree::verdict(const Shaft& shaft, const Receiver& receiver) const {
  std::array<const Node*, 128> stack{};  // deeper than any tree that the builder makes (arguments.maxDepth is 32)
  std::size_t depth = 0;
  if (root_ != nullptr) stack[depth++] = root_;
  int partial = 0;
  while (depth > 0 && partial < kMostPartial) {
    const Node& node = *stack[--depth];
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const CasterTriangle& triangle = triangles_[node.triangles[i]];
      const bool isOwn = triangle.instance == receiver.instance && triangle.triangle == receiver.triangle;
      if (isOwn || shaft.misses(triangle)) continue;
      if (shaft.isStoppedBy(triangle)) return Verdict::dark;
      ++partial;
    }
    if (node.isLeaf()) continue;
    for (std::size_t i = 0; i < 2; ++i) {
      const RTCBounds& b = node.bounds[i];
      const glm::dvec3 low(b.lower_x, b.lower_y, b.lower_z);
      const glm::dvec3 high(b.upper_x, b.upper_y, b.upper_z);
      if (!shaft.misses(0.5 * (low + high), 0.5 * (high - low))) stack[depth++] = node.children[i];
    }
  }
  return partial > 0 ? Verdict::open : Verdict::lit;
}

}  // namespace gnomon
