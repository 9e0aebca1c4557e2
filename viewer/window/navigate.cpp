#include "navigate.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

namespace gnomon {

namespace {

/// A drag across the window's height turns half way round.
constexpr double kTurn = glm::pi<double>();
constexpr double kPole = 0.02;  // radians from straight up or down

struct Axes {
  glm::dvec3 right, up, look;
};

Axes axesOf(const Camera& camera) {
  const glm::dmat4 r = cameraRotation(camera);
  return {{r[0][0], r[1][0], r[2][0]}, {r[0][1], r[1][1], r[2][1]}, -glm::dvec3(r[0][2], r[1][2], r[2][2])};
}

/// `offset` turned about `up` by drag.x, and towards or away from it by drag.y.
glm::dvec3 turnedOffset(const glm::dvec3& offset, const glm::dvec3& up, glm::dvec2 drag) {
  const glm::dvec3 about = glm::normalize(up);
  const glm::dvec3 yawed = glm::angleAxis(-drag.x * kTurn, about) * offset;
  if (!(glm::length(offset) > 0.0)) return offset;  // a point light may be where its target is
  glm::dvec3 side = glm::cross(about, yawed);
  // Straight above or below, any side will do: else a light overhead could never be turned.
  if (glm::length(side) < 1e-9 * glm::length(offset))
    side = glm::cross(about, std::abs(about.x) < 0.9 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 0.0, 1.0));
  const double polar = std::acos(std::clamp(glm::dot(about, glm::normalize(yawed)), -1.0, 1.0));
  const double wanted = std::clamp(polar - drag.y * kTurn, kPole, glm::pi<double>() - kPole);
  return glm::angleAxis(wanted - polar, glm::normalize(side)) * yawed;
}

/// A tenth nearer a step; the length stays where steps back still mean something.
double boundedFactor(double length, double steps) {
  constexpr double kNearest = 1e-6;
  constexpr double kFarthest = 1e9;
  if (!(length > 0.0)) return 1.0;
  return std::clamp(length * std::pow(0.9, std::clamp(steps, -1000.0, 1000.0)), std::min(kNearest, length),
                    std::max(kFarthest, length)) /
         length;
}

}  // namespace

Camera orbited(const Camera& camera, glm::dvec2 drag) {
  Camera moved = camera;
  moved.position = camera.target + turnedOffset(camera.position - camera.target, camera.up, drag);
  return moved;
}

glm::dvec3 viewShift(const Camera& camera, const glm::dvec3& point, glm::dvec2 drag) {
  const Axes axes = axesOf(camera);
  const double distance = std::max(glm::dot(point - camera.position, axes.look), camera.near);
  const double height = camera.type == CameraType::orthographic
                            ? camera.height
                            : 2.0 * distance * std::tan(glm::radians(camera.verticalFovDegrees) * 0.5);
  return (axes.right * drag.x - axes.up * drag.y) * height;
}

glm::dvec3 viewDirection(const Camera& camera) {
  return -axesOf(camera).look;
}

Camera panned(const Camera& camera, glm::dvec2 drag) {
  const glm::dvec3 by = viewShift(camera, camera.target, drag);
  Camera moved = camera;
  moved.position -= by;
  moved.target -= by;
  return moved;
}

Camera zoomed(const Camera& camera, double steps) {
  const bool flat = camera.type == CameraType::orthographic;
  const double factor = boundedFactor(flat ? camera.height : glm::length(camera.position - camera.target), steps);
  Camera moved = camera;
  moved.position = camera.target + (camera.position - camera.target) * factor;
  if (flat) moved.height *= factor;
  return moved;
}

Camera flown(const Camera& camera, const glm::dvec3& metres) {
  const Axes axes = axesOf(camera);
  const glm::dvec3 by = axes.right * metres.x + axes.up * metres.y + axes.look * metres.z;
  Camera moved = camera;
  moved.position += by;
  moved.target += by;
  return moved;
}

Camera framing(const Camera& camera, const Bounds& bounds, double aspect) {
  if (bounds.empty()) return camera;
  const double radius = std::max(bounds.diagonal() * 0.5, 1e-9);
  const double half = glm::radians(camera.verticalFovDegrees) * 0.5;
  const double narrowest = std::min(half, std::atan(std::tan(half) * aspect));
  Camera moved = camera;
  moved.target = bounds.centre();
  moved.position = moved.target - axesOf(camera).look * (radius / std::sin(narrowest));
  if (camera.type == CameraType::orthographic) moved.height = 2.0 * radius / std::min(aspect, 1.0);
  return moved;
}

Light shifted(const Light& light, const glm::dvec3& metres) {
  Light moved = light;
  moved.position += metres;
  moved.target += metres;
  return moved;
}

Light nearer(const Light& light, double steps) {
  Light moved = light;
  moved.position =
      light.target + (light.position - light.target) * boundedFactor(glm::length(light.position - light.target), steps);
  return moved;
}

Light turned(const Light& light, glm::dvec2 drag) {
  Light moved = light;
  moved.position = light.target + turnedOffset(light.position - light.target, {0.0, 1.0, 0.0}, drag);
  return moved;
}

Light scaledSource(const Light& light, double factor) {
  Light scaled = light;
  scaled.source.size *= factor;
  scaled.source.radius *= factor;
  scaled.radius *= factor;
  scaled.angularDiameterDegrees = std::min(scaled.angularDiameterDegrees * factor, 179.0);
  return scaled;
}

}  // namespace gnomon
