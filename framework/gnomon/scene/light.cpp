#include "gnomon/scene/light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "gnomon/base/error.h"
#include "gnomon/scene/look_at.h"

namespace gnomon {
namespace {

/// Shirley and Chiu's concentric map of the unit square onto the unit disc: keeps areas, and strata compact.
glm::dvec2 concentricDisc(const glm::dvec2& u) {
  const glm::dvec2 p = 2.0 * u - 1.0;
  if (p.x == 0.0 && p.y == 0.0) return {0.0, 0.0};
  constexpr double quarter = 0.78539816339744830962;  // pi / 4
  const bool wide = std::abs(p.x) > std::abs(p.y);
  const double radius = wide ? p.x : p.y;
  const double angle = wide ? quarter * (p.y / p.x) : 2.0 * quarter - quarter * (p.x / p.y);
  return radius * glm::dvec2(std::cos(angle), std::sin(angle));
}

/// A unit vector of the spherical cap around `axes.z`, uniform in solid angle. `height` is 1 - cos(half angle): given so, and
/// not as an angle or a cosine, it keeps its digits for the smallest caps.
glm::dvec3 sampleCap(const Axes& axes, double height, const glm::dvec2& u) {
  // Archimedes: solid angle is proportional to height, and r^2 of an area-uniform disc is uniform (Lambert's map).
  const glm::dvec2 disc = concentricDisc(u);
  const double h = height * std::min(1.0, glm::dot(disc, disc));
  const glm::dvec2 lateral = disc * std::sqrt(height * std::max(0.0, 2.0 - h));  // |lateral|^2 = h (2 - h)
  return glm::normalize(axes.x * lateral.x + axes.y * lateral.y + axes.z * (1.0 - h));
}

/// A point of the sphere's side that `receiver` sees, uniform in the solid angle that the sphere subtends.
glm::dvec3 sampleSphere(const glm::dvec3& centre, double radius, const glm::dvec2& u, const glm::dvec3& receiver) {
  const glm::dvec3 towards = centre - receiver;
  const double distance = glm::length(towards);
  if (distance <= radius) return centre;  // inside: every direction meets the source, and none may be preferred
  const double sine = radius / distance;
  const double cosine = std::sqrt((1.0 - sine) * (1.0 + sine));
  const glm::dvec3 axis = towards / distance;
  const glm::dvec3 direction = sampleCap(axesAround(axis), sine * sine / (1.0 + cosine), u);
  // The nearer of the two points where the ray meets the sphere; at the rim rounding may make the root's argument negative.
  const double along = distance * glm::dot(direction, axis);
  const double across = glm::length(towards - direction * along);
  return receiver + direction * (along - std::sqrt(std::max(0.0, (radius - across) * (radius + across))));
}

void checkSource(const Source& source, const Location& where, Problems& problems) {
  const auto only = [&](bool present, const std::string& key, const std::string& shape) {
    if (present) problems.add(where.file, where.child(key).pointer, "means something only for a source of shape " + shape);
  };
  const bool rectangle = source.shape == SourceShape::rectangle;
  only(!rectangle && source.size != glm::dvec2(0.0, 0.0), "size", "rectangle");
  only(source.shape != SourceShape::disc && source.radius != 0.0, "radius", "disc");
  only(source.shape == SourceShape::none && source.rollDegrees != 0.0, "roll_degrees", "rectangle or disc");
}

void checkLight(const Light& light, const Location& where, Problems& problems) {
  const Light defaults;
  const auto report = [&](const std::string& key, const std::string& message) {
    problems.add(where.file, where.child(key).pointer, message);
  };
  const auto only = [&](bool present, const std::string& key, const std::string& type) {
    if (present) report(key, "means something only for a light of type " + type);
  };
  const bool spot = light.type == LightType::spot;
  only(!spot && light.coneHalfAngleDegrees != defaults.coneHalfAngleDegrees, "cone_half_angle_degrees", "spot");
  only(!spot && light.source.shape != SourceShape::none, "source", "spot");
  only(light.type != LightType::point && light.radius != 0.0, "radius", "point");
  only(light.type != LightType::directional && light.angularDiameterDegrees != 0.0, "angular_diameter_degrees", "directional");
  if (light.type == LightType::point) return;  // it has no direction
  if (light.position == light.target) report("target", "is the position: the light has no direction; move one of them");
  if (light.up == glm::dvec3(0.0)) report("up", "has no length; give a direction, as [0, 1, 0]");
}

std::shared_ptr<const FieldTable> sourceTable() {
  const double infinity = std::numeric_limits<double>::infinity();
  return ParameterTable<Source>{
      choice("shape", &Source::shape, {"none", "rectangle", "disc"}, Binding::structure, "the emitting surface's shape"),
      vector("size", &Source::size, {0.0, infinity, "m"}, "rectangle: extent along the light's X and Y"),
      real("radius", &Source::radius, {0.0, infinity, "m"}, Binding::uniform, "disc: its radius"),
      real("roll_degrees", &Source::rollDegrees, {-360.0, 360.0, "degrees"}, Binding::uniform,
           "turns the light's X and Y about its Z, counter-clockwise as seen along the light"),
  }
      .checked(checkSource)
      .table();
}

}  // namespace

Light withoutName(Light light) {
  light.name.clear();
  return light;
}

LightFrame lightFrame(const Light& light) {
  const Axes axes = lookAxes(light.position, light.target, light.up);
  const double roll = glm::radians(light.source.rollDegrees);
  const double c = std::cos(roll);
  const double s = std::sin(roll);
  return {light.position, c * axes.x + s * axes.y, c * axes.y - s * axes.x, axes.z};
}

bool hasExtent(const Light& light) {
  switch (light.type) {
    case LightType::directional:
      return light.angularDiameterDegrees > 0.0;
    case LightType::point:
    case LightType::spot:
      return sourceDiameter(light) > 0.0;
  }
  return false;
}

double sourceDiameter(const Light& light) {
  if (light.type == LightType::directional) return 0.0;
  if (light.type == LightType::point) return 2.0 * light.radius;
  switch (light.source.shape) {
    case SourceShape::none:
      return 0.0;
    case SourceShape::rectangle:
      return glm::length(light.source.size);
    case SourceShape::disc:
      return 2.0 * light.source.radius;
  }
  return 0.0;
}

glm::dvec3 sampleSource(const Light& light, const LightFrame& frame, glm::dvec2 u, const glm::dvec3& receiver) {
  if (light.type == LightType::directional) {
    const double sine = std::sin(glm::radians(light.angularDiameterDegrees) / 4.0);
    return sampleCap({frame.x, frame.y, frame.z}, 2.0 * sine * sine, u);  // 1 - cos t = 2 sin^2(t/2), t the half angle
  }
  if (light.type == LightType::point) return sampleSphere(frame.origin, light.radius, u, receiver);
  glm::dvec2 p{0.0, 0.0};
  if (light.source.shape == SourceShape::rectangle) p = (u - 0.5) * light.source.size;
  if (light.source.shape == SourceShape::disc) p = concentricDisc(u) * light.source.radius;
  return frame.origin + frame.x * p.x + frame.y * p.y;
}

double solidAngleWeight(const Light& light, const LightFrame& frame, const glm::dvec3& sample, const glm::dvec3& receiver) {
  if (light.type != LightType::spot) return 1.0;  // sampled by solid angle
  const glm::dvec3 towards = sample - receiver;
  const double distance = glm::length(towards);
  // dA cos / d^2, with distances relative to the centre's, so that no unit of length overflows.
  const double nearness = glm::length(frame.origin - receiver) / distance;
  const double weight = glm::dot(towards / distance, frame.z) * nearness * nearness;
  return std::isfinite(weight) ? std::max(weight, 0.0) : 0.0;
}

glm::dvec3 towardsCentre(const Light& light, const LightFrame& frame, const glm::dvec3& receiver) {
  if (light.type == LightType::directional) return frame.z;
  const glm::dvec3 towards = frame.origin - receiver;
  const double distance = glm::length(towards);
  return distance > 0.0 ? towards / distance : frame.z;
}

bool inReach(const Light& light, const LightFrame& frame, const glm::dvec3& receiver) {
  if (light.type != LightType::spot) return true;
  const glm::dvec3 from = receiver - frame.origin;
  const double front = -glm::dot(from, frame.z);
  return front > 0.0 && front >= std::cos(glm::radians(light.coneHalfAngleDegrees)) * glm::length(from);
}

std::shared_ptr<const FieldTable> lightTable() {
  const double infinity = std::numeric_limits<double>::infinity();
  static const std::shared_ptr<const FieldTable> table =
      ParameterTable<Light>{
          choice("type", &Light::type, {"directional", "point", "spot"}, Binding::structure, "what kind of light").mandatory(),
          vector("position", &Light::position, {-infinity, infinity, "m"},
                 "where the light is; of a directional light, only its direction to the target counts"),
          vector("target", &Light::target, {-infinity, infinity, "m"}, "what it looks at; without meaning for a point light"),
          vector("up", &Light::up, {}, "the source's X is perpendicular to this; [0, 0, -1] where parallel to the axis"),
          real("intensity", &Light::intensity, {0.0, infinity}, Binding::uniform, "radiance scale, without falloff"),
          real("cone_half_angle_degrees", &Light::coneHalfAngleDegrees, {0.0, 90.0, "degrees", true}, Binding::uniform,
               "spot: its hard edge; 90 is a bare area light"),
          object("source", &Light::source, sourceTable(), "spot: the emitting surface, centred on the position"),
          real("radius", &Light::radius, {0.0, infinity, "m"}, Binding::uniform, "point: radius of its sphere"),
          real("angular_diameter_degrees", &Light::angularDiameterDegrees, {0.0, 180.0, "degrees"}, Binding::uniform,
               "directional: diameter of the disc of directions; the sun's is 0.53"),
          text("name", &Light::name, "what people call the light"),
      }
          .checked(checkLight)
          .table();
  return table;
}

}  // namespace gnomon
