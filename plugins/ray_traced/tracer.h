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

/// Every caster's triangles, in float, relative to one origin: a world offset costs no digits.
class Tracer {
 public:
  Tracer();
  /// `source` is given where casters may be so near to the light that their distance from it has no digits left in a float
  /// of the scene's size: it is the origin then, and each ray is traced in two halves, from both its ends. Otherwise the
  /// origin is the middle of the scene.
  void build(const Scene& scene, const std::optional<glm::dvec3>& source);
  int builds() const { return builds_; }

  RTCScene scene() const { return scene_.get(); }
  const glm::dvec3& origin() const { return origin_; }
  bool packets() const { return packets_; }
  bool halvesRays() const { return halvesRays_; }
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

/// Collects the rays of many receivers into packets. One a thread.
class ShadowRays {
 public:
  explicit ShadowRays(const Tracer& tracer);

  /// The rays that follow are of this receiver; its visibility is written by finish(). 1 where none counts (0/0).
  void start(const Receiver& receiver, float& visibility);
  /// A ray to a point of the source, or towards a direction. One at or below the receiver's horizon does not count.
  void add(const glm::dvec3& sample, bool direction);
  void finish();
  std::uint64_t traced() const { return traced_; }

 private:
  static constexpr std::size_t kWidth = 16;  // even: both halves of a ray are in one packet
  struct Count {
    float* visibility;
    std::uint32_t rays = 0;
    std::uint32_t blocked = 0;
  };
  struct Context {
    RTCIntersectContext base;  // first: Embree's filter gets its address
    std::array<std::uint32_t, kWidth> instance, triangle;
  };

  static void rejectOwnTriangle(const RTCFilterFunctionNArguments* arguments);
  void push(const glm::dvec3& origin, const glm::dvec3& towards, bool endless);
  void flush();

  const Tracer& tracer_;
  std::vector<Count> counts_;
  glm::dvec3 origin_{0.0};
  glm::dvec3 normal_{0.0};
  std::uint32_t instance_ = 0;
  std::uint32_t triangle_ = 0;
  alignas(64) RTCRay16 rays_{};
  std::array<std::size_t, kWidth> owner_{};
  Context context_{};
  std::size_t filled_ = 0;
  std::uint64_t traced_ = 0;
};

}  // namespace gnomon
