// What is provable of a receiver without a ray: that nothing stands between it and the source, or that one triangle hides all
// of the source (shaft culling: Haines and Wallace 1994).
#pragma once

#include <embree3/rtcore.h>

#include <array>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "gnomon/scene/light.h"
#include "tracer.h"

namespace gnomon {

enum class Verdict { open, lit, dark };

/// The pyramid from a receiver to a square or rectangle around the source, cut off behind the source and below the receiver's
/// horizon. Every ray that the tracer casts for the receiver lies in it.
class Shaft {
 public:
  /// `apex` is where the rays start, relative to `origin`; `rounding` is how far from their exact place, in metres, rays and
  /// triangles may be. None where no pyramid holds the source: too near, too wide, or without end.
  static std::optional<Shaft> to(const Light& light, const LightFrame& axes, const glm::dvec3& origin, const glm::dvec3& apex,
                                 const glm::dvec3& normal, double rounding);

  /// Whether the box (centre, half its size) certainly lies outside.
  bool misses(const glm::dvec3& centre, const glm::dvec3& half) const;
  bool misses(const CasterTriangle& triangle) const;
  /// Whether the triangle certainly stops every ray.
  bool isStoppedBy(const CasterTriangle& triangle) const;

 private:
  struct Plane {
    glm::dvec3 normal;  ///< unit, inwards
    double offset;      ///< of normal . (p - apex)
  };
  /// Between the triangle's edges and the apex; unit, inwards. None where the apex lies in the triangle's plane.
  struct Sides {
    std::array<glm::dvec3, 3> normals;
    double distance;  ///< of the triangle's plane from the apex
  };
  std::optional<Sides> sidesOf(const CasterTriangle& triangle) const;
  glm::dvec3 apex_{0.0};
  glm::dvec3 axis_{0.0};
  double nearest_ = 0.0;  ///< depth along the axis at which the source begins
  double rounding_ = 0.0;
  bool allAboveHorizon_ = false;
  std::array<glm::dvec3, 4> corners_{};  ///< unit directions
  std::array<Plane, 6> planes_{};
};

/// A bounding volume hierarchy over the casters' triangles, that shafts can be asked of.
class ShaftTree {
 public:
  /// Of the tracer's triangles; the tracer is not built again meanwhile.
  explicit ShaftTree(const Tracer& tracer);

  /// The receiver's own triangle never blocks it.
  Verdict verdict(const Shaft& shaft, const Receiver& receiver) const;
  /// Largest magnitude of the triangles' coordinates, metres.
  double magnitude() const { return magnitude_; }

 private:
  struct Node;
  struct Builder;
  const std::vector<CasterTriangle>& triangles_;
  struct Release {
    void operator()(RTCBVH tree) const { rtcReleaseBVH(tree); }
  };
  std::unique_ptr<RTCBVHTy, Release> tree_;  ///< owns the nodes
  const Node* root_ = nullptr;
  double magnitude_ = 0.0;
};

}  // namespace gnomon
