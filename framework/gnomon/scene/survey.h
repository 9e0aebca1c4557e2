// The scene survey: facts measured from scene, light and camera, from which the effect plan is made.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "gnomon/scene/scene.h"

namespace gnomon {

/// The part of one receiver that the camera may see: its world box clipped to the view frustum.
struct VisibleReceiver {
  std::size_t instance = 0;
  std::vector<glm::dvec3> points;  ///< corners of the convex clipped box, world coordinates
};

/// Receivers inside the view frustum, conservatively (none is missed).
std::vector<VisibleReceiver> visibleReceivers(const Scene& scene, const std::vector<Bounds>& instanceBounds, const Camera& camera,
                                              double aspect);

struct SceneSurvey {
  Bounds bounds;                        ///< of everything
  std::vector<Bounds> instanceBounds;   ///< world boxes, as Scene::instances
  std::size_t triangles = 0;
  std::size_t casterTriangles = 0;
  std::size_t receiverTriangles = 0;
  bool sourceHasExtent = false;
  /// Receiver triangles with a corner in front of the light's horizon and a plane that faces the source's centre
  /// (tested on both sides for double-sided materials), in the view frustum and in reach by their boxes. 0: nothing to shadow.
  std::size_t facingTriangles = 0;
  /// Upper bound of the penumbra's width on any visible receiver, in pixels: a (dR - dB) / dB over the nearest caster and the
  /// farthest visible receiver, stretched by at most 10 at grazing receivers (N.L = 0.1, the terminator), over the footprint
  /// of a pixel at the nearest visible receiver. Infinity where a caster may touch the source.
  double widestPenumbraPixels = 0.0;
  double nearestCasterDistance = 0.0;     ///< from the light, metres, lower bound
  double farthestReceiverDistance = 0.0;  ///< from the light, metres, upper bound
};

SceneSurvey survey(const Scene& scene, const Light& light, const Camera& camera, glm::ivec2 outputSize);

}  // namespace gnomon
