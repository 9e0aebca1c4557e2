// The scene survey: facts measured from scene, light and camera, from which the effect plan is made.
#pragma once

#include <cstddef>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "gnomon/scene/scene.h"

namespace gnomon {

/// The part of one receiver that the camera may see: its world box clipped to the view frustum.
struct VisibleReceiver {
  std::size_t instance = 0;
  std::vector<glm::dvec3> points;  ///< corners of the convex clipped box, world coordinates
};

/// Receivers inside the view frustum, conservatively (none is missed). `aspect` is width over height.
std::vector<VisibleReceiver> visibleReceivers(const Scene& scene, const std::vector<Bounds>& instanceBounds,
                                              const Camera& camera, double aspect);

/// Corners of the convex part of one receiver's world box that lies within, world coordinates; valid during the call.
using ReceiverVisitor = std::function<void(std::size_t instance, std::span<const glm::dvec3> points)>;

/// Visits the receivers inside all half-spaces n.x + d >= 0 (unit normals, x relative to `origin`), conservatively.
void visitReceiversWithin(const Scene& scene, const std::vector<Bounds>& instanceBounds, const glm::dvec3& origin,
                          std::span<const glm::dvec4> planes, const ReceiverVisitor& visit);

struct SceneSurvey {
  Bounds bounds;                       ///< of everything
  std::vector<Bounds> instanceBounds;  ///< world boxes, as Scene::instances
  std::size_t triangles = 0;
  std::size_t casterTriangles = 0;
  std::size_t receiverTriangles = 0;
  std::size_t idleReceiverTriangles = 0;  ///< of receivers that cast nothing
  std::size_t movingInstances = 0;        ///< that ride on the scene's animation
  bool sourceHasExtent = false;
  /// Receiver triangles with a corner in front of the spot's plane and a plane that faces the source's centre (on either side
  /// for double-sided materials), not wholly outside the view frustum nor, by their bounding spheres, outside the light's
  /// reach. 0: nothing to shadow.
  std::size_t facingTriangles = 0;
  /// Upper bound of the penumbra's width on any visible receiver, in pixels: a (dR - dB) / (dB - a / 2) with the source's
  /// diameter a, over the nearest caster and the farthest visible receiver (a / 2, since a caster may be nearer to one end of
  /// the source than to its centre); for directional lights 2 (dR - dB) tan(delta / 2). Stretched by 10 for grazing receivers
  /// (N.L = 0.1, the terminator), over the footprint of a pixel at the nearest visible receiver. Infinity where a caster may
  /// touch the source. 0 without extent, casters or visible receivers.
  double widestPenumbraPixels = 0.0;
  /// From the light's position, metres; for directional lights depths along its axis, which may be negative.
  /// 0 where there is none.
  double nearestCasterDistance = 0.0;     ///< lower bound; a spot's casters have a corner in front of its plane
  double farthestReceiverDistance = 0.0;  ///< upper bound over the visible receivers' clipped boxes
};

SceneSurvey survey(const Scene& scene, const Light& light, const Camera& camera, glm::ivec2 outputSize);

}  // namespace gnomon
