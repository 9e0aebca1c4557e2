// Lights and their sources, and the two functions every technique needs of them: the light's frame, and points on the source.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <string>

#include "gnomon/base/table.h"

namespace gnomon {

enum class LightType : int { directional, point, spot };
enum class SourceShape : int { none, rectangle, disc };

/// The emitting surface of a spot, in the light's XY plane, centred on its position; emits towards -Z only.
struct Source {
  SourceShape shape = SourceShape::none;
  glm::dvec2 size{0.0, 0.0};  ///< of a rectangle: metres along the light's X and Y
  double radius = 0.0;        ///< of a disc: metres
  double rollDegrees = 0.0;   ///< turns X and Y about +Z of the light: counter-clockwise as seen along the light, from behind
};

/// Right-handed, metres. A light looks along -Z of its frame, from `position` to `target`.
struct Light {
  LightType type = LightType::spot;
  glm::dvec3 position{0.0, 10.0, 0.0};
  glm::dvec3 target{0.0, 0.0, 0.0};
  glm::dvec3 up{0.0, 1.0, 0.0};
  double intensity = 1.0;
  double coneHalfAngleDegrees = 30.0;   ///< spot: hard edge, at most 90 (a bare area light)
  Source source;                        ///< spot
  double radius = 0.0;                  ///< point: of its sphere, metres
  double angularDiameterDegrees = 0.0;  ///< directional: of the disc of directions
  std::string name = {};                ///< for people; may be empty, and occur twice
};

/// The same light: what keys of results and references are made of, since a name changes no picture.
Light withoutName(Light light);

/// Orthonormal axes; the light looks along -z. `up` parallel to the axis falls back to [0,0,-1], then to [1,0,0].
struct LightFrame {
  glm::dvec3 origin, x, y, z;
};

LightFrame lightFrame(const Light& light);

/// Whether the light has extent in space or in directions; without it V is 0 or 1 everywhere.
bool hasExtent(const Light& light);

/// Diameter of the smallest disc around the source, metres (0 for directional lights: see angularDiameterDegrees).
double sourceDiameter(const Light& light);

/// Where on the source the unit-square point `u` lies, such that uniform u is uniform in what V averages over:
/// area for rectangles and discs (concentric map), solid angle as seen from `receiver` for spheres,
/// solid angle of directions for directional lights. A receiver inside a sphere gets its centre. Returns a world position, or,
/// for directional lights, the unit direction towards the light.
glm::dvec3 sampleSource(const Light& light, const LightFrame& frame, glm::dvec2 u, const glm::dvec3& receiver);

/// Solid angle that a point of sampleSource (a position, or a direction) stands for, up to a factor that all points of the
/// source share for this receiver: sums of it over samples make means over solid angle out of V's own measure. Finite, >= 0.
double solidAngleWeight(const Light& light, const LightFrame& frame, const glm::dvec3& sample, const glm::dvec3& receiver);

/// Unit vector from `receiver` towards the source's centre.
glm::dvec3 towardsCentre(const Light& light, const LightFrame& frame, const glm::dvec3& receiver);

/// Whether `receiver` is in the light's reach: inside a spot's cone and in front of it. N.L is not looked at.
bool inReach(const Light& light, const LightFrame& frame, const glm::dvec3& receiver);

std::shared_ptr<const FieldTable> lightTable();

}  // namespace gnomon
