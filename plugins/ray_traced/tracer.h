// Shadow rays through Embree, sixteen at a time where the processor has packets of that width.
#pragma once

#include <embree3/rtcore.h>

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "gnomon/scene/scene.h"

namespace gnomon {

/// Half a unit in the last place of a float, relative.
inline constexpr double kRoundoff = 0.5 * 1.1920929e-7;

/// Of a caster, relative to the tracer's origin, as rays meet it.
struct CasterTriangle {
  std::array<glm::vec3, 3> corners;
  std::uint32_t instance, triangle;
};

/// Every caster's triangles, in float, relative to one origin: a world offset costs no digits.
class Tracer {
 public:
  Tracer();
  /// `source` is given where casters may be so near to the light that their distance from it has no digits left in a float
  /// of the scene's size: it is the origin then, and each ray is traced in two halves, from both its ends. Otherwise the
  /// origin is the middle of the scene.
  void build(const Scene& scene, const std::optional<glm::dvec3>& source);
  int builds() const { return builds_; }

  RTCDevice device() const { return device_.get(); }
  RTCScene scene() const { return scene_.get(); }
  const glm::dvec3& origin() const { return origin_; }
  bool packets() const { return packets_; }
  bool halvesRays() const { return halvesRays_; }
  const std::vector<CasterTriangle>& triangles() const { return triangles_; }
  /// Bound of the coordinates' magnitude of a caster's or receiver's triangle, relative to origin(), metres.
  double magnitude(std::uint32_t instance, std::uint32_t triangle) const;

 private:
  struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  };
  std::unique_ptr<RTCDeviceTy, Release> device_;
  std::unique_ptr<RTCSceneTy, Release> scene_;
  std::vector<std::vector<float>> magnitudes_;  ///< by instance and triangle
  std::vector<CasterTriangle> triangles_;
  glm::dvec3 origin_{0.0};
  bool packets_ = false;
  bool halvesRays_ = false;
  int builds_ = 0;
};

struct Receiver {
  glm::dvec3 position;  ///< world
  glm::dvec3 normal;    ///< geometric, unit
  std::uint32_t instance, triangle;
  double toCamera;  ///< metres: the position was rounded relative to the camera
};

/// What some of a receiver's rays found.
struct Tally {
  std::uint32_t rays = 0;  ///< above the receiver's horizon
  std::uint32_t blocked = 0;
  double all = 0.0;   ///< sum of the rays' weights
  double seen = 0.0;  ///< of those that reach the source

  Tally& operator+=(const Tally& other) {
    rays += other.rays;
    blocked += other.blocked;
    all += other.all;
    seen += other.seen;
    return *this;
  }
  /// 1 where no ray counts (0/0).
  double visibility() const { return rays == 0 ? 1.0 : static_cast<double>(rays - blocked) / rays; }
  double weightedVisibility() const { return all > 0.0 ? seen / all : 1.0; }
};

/// Collects the rays of many receivers into packets. One a thread.
class ShadowRays {
 public:
  explicit ShadowRays(const Tracer& tracer);

  /// The rays that follow are of this receiver.
  void start(const Receiver& receiver);
  /// Where they start, relative to the tracer's origin: off the receiver's plane by the rounding error of positions.
  const glm::dvec3& origin() const { return origin_; }
  /// A ray to a point of the source, or towards a direction. One at or below the receiver's horizon does not count. It weighs
  /// `solidAngle` times the cosine to the receiver's normal. The tally is whole after the next finish().
  void add(const glm::dvec3& sample, bool direction, double solidAngle, Tally& tally);
  void finish() { flush(); }
  std::uint64_t traced() const { return traced_; }

 private:
  static constexpr std::size_t kWidth = 16;  // even: both halves of a ray are in one packet
  struct Owner {
    Tally* tally;
    double weight;
  };
  struct Context {
    RTCIntersectContext base;  // first: Embree's filter gets its address
    std::array<std::uint32_t, kWidth> instance, triangle;
  };

  static void rejectOwnTriangle(const RTCFilterFunctionNArguments* arguments);
  void push(const glm::dvec3& origin, const glm::dvec3& towards, bool endless, const Owner& owner);
  void flush();

  const Tracer& tracer_;
  glm::dvec3 origin_{0.0};
  glm::dvec3 normal_{0.0};
  std::uint32_t instance_ = 0;
  std::uint32_t triangle_ = 0;
  alignas(64) RTCRay16 rays_{};
  std::array<Owner, kWidth> owner_{};
  Context context_{};
  std::size_t filled_ = 0;
  std::uint64_t traced_ = 0;
};

}  // namespace gnomon
