// The planar projection of one light: where the map lies in space, what it must hold, and between which depths.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <vector>

#include "gnomon/graph/types.h"
#include "gnomon/scene/camera.h"
#include "gnomon/scene/light.h"
#include "gnomon/scene/scene.h"

namespace gnomon {

/// Coordinates in the map: xy in [-1,1] across it, and depth along the light's axis in metres.
struct MapPlane {
  LightFrame axes;  ///< of the light; a directional light's origin is in the middle of the receivers
  bool perspective = true;
  glm::dvec2 halfExtent{1.0, 1.0};  ///< of the map: tangent of the half angle, or metres (directional)
  glm::dvec2 centre{0.0, 0.0};      ///< directional: in the light's XY plane, metres
};

/// What a map is placed and fitted by. References hold for the call.
struct MapSubject {
  const Scene& scene;
  const std::vector<Bounds>& instanceBounds;  ///< world boxes, as Scene::instances
  const Light& light;
  const Camera& camera;
  double aspect = 1.0;  ///< of the picture: width over height
};

MapSubject mapSubject(const FrameInputs& frame);

MapPlane mapPlane(const MapSubject& subject);

/// What a map must hold for the receivers in view.
struct MapFit {
  double near = 0.0;
  double far = 0.0;
  std::vector<std::uint8_t> casters;  ///< flag for each instance
  std::vector<std::uint8_t> idle;     ///< the same of receivers that cast nothing: all of them
};

struct MapFitting {
  glm::dvec2 margin{0.0, 0.0};  ///< the filter's radius, in [-1,1] units of the map
  bool cull = true;             ///< off: every caster is drawn
  bool fit = true;              ///< off: near and far hold the whole scene
  double nearRatio = 1e-10;     ///< near is at least this part of far, unless a receiver in reach (fit: in view) is nearer
};

/// Conservative: whatever casts onto a visible receiver is kept, whether or not the camera sees it. Near and far do not depend
/// on `cull`, so that switching it leaves the same picture. Reuses the memory of `result`.
void fitMap(const MapSubject& subject, const MapPlane& plane, const MapFitting& how, MapFit& result);

}  // namespace gnomon
