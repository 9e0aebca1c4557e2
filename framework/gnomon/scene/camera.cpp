#include "gnomon/scene/camera.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "gnomon/base/error.h"
#include "gnomon/scene/look_at.h"

namespace gnomon {
namespace {

Axes cameraAxes(const Camera& camera) {
  return lookAxes(camera.position, camera.target, camera.up);
}

/// Half of what a perspective camera sees vertically at distance 1.
double halfHeightAtOne(const Camera& camera) {
  return std::tan(glm::radians(camera.verticalFovDegrees) / 2.0);
}

void checkCamera(const Camera& camera, const Location& where, Problems& problems) {
  const Camera defaults;
  const auto report = [&](const std::string& key, const std::string& message) {
    problems.add(where.file, where.child(key).pointer, message);
  };
  const bool perspective = camera.type == CameraType::perspective;
  if (perspective && !(camera.verticalFovDegrees < 180.0)) report("vertical_fov_degrees", "must be less than 180 degrees");
  if (!perspective && camera.verticalFovDegrees != defaults.verticalFovDegrees)
    report("vertical_fov_degrees", "means something only for a camera of type perspective");
  if (perspective && camera.height != defaults.height)
    report("height", "means something only for a camera of type orthographic");
  if (camera.position == camera.target) report("target", "is the position: the camera has no direction; move one of them");
  if (camera.up == glm::dvec3(0.0)) report("up", "has no length; give a direction, as [0, 1, 0]");
}

}  // namespace

glm::dmat4 cameraRotation(const Camera& camera) {
  const Axes a = cameraAxes(camera);
  return {glm::dvec4(a.x.x, a.y.x, a.z.x, 0.0), glm::dvec4(a.x.y, a.y.y, a.z.y, 0.0), glm::dvec4(a.x.z, a.y.z, a.z.z, 0.0),
          glm::dvec4(0.0, 0.0, 0.0, 1.0)};
}

glm::dmat4 cameraProjection(const Camera& camera, double aspect, double orthographicFar) {
  glm::dmat4 projection(0.0);
  if (camera.type == CameraType::perspective) {
    const double t = halfHeightAtOne(camera);
    projection[0][0] = 1.0 / (t * aspect);
    projection[1][1] = -1.0 / t;
    projection[2][3] = -1.0;         // w = distance along the view axis
    projection[3][2] = camera.near;  // depth = near / w
  } else {
    const double depth = orthographicFar - camera.near;
    projection[0][0] = 2.0 / (camera.height * aspect);
    projection[1][1] = -2.0 / camera.height;
    projection[2][2] = 1.0 / depth;
    projection[3][2] = orthographicFar / depth;
    projection[3][3] = 1.0;
  }
  return projection;
}

std::array<glm::dvec4, 5> frustumPlanes(const Camera& camera, double aspect) {
  const Axes axes = cameraAxes(camera);
  const bool perspective = camera.type == CameraType::perspective;
  const double halfHeight = perspective ? halfHeightAtOne(camera) : camera.height / 2.0;
  // In camera axes: |x| <= aspect * halfHeight * -z, or without the -z.
  const auto side = [&](const glm::dvec3& axis, double half) {
    if (!perspective) return glm::dvec4(axis, half);
    return glm::dvec4(glm::normalize(axis - axes.z * half), 0.0);
  };
  return {side(axes.x, halfHeight * aspect), side(-axes.x, halfHeight * aspect), side(axes.y, halfHeight),
          side(-axes.y, halfHeight), glm::dvec4(-axes.z, -camera.near)};
}

double pixelFootprint(const Camera& camera, int outputHeight, double distance) {
  const double height = camera.type == CameraType::perspective ? 2.0 * halfHeightAtOne(camera) * distance : camera.height;
  return height / outputHeight;
}

std::shared_ptr<const FieldTable> cameraTable() {
  const double infinity = std::numeric_limits<double>::infinity();
  static const std::shared_ptr<const FieldTable> table =
      ParameterTable<Camera>{
          choice("type", &Camera::type, {"perspective", "orthographic"}, Binding::structure, "how it projects"),
          vector("position", &Camera::position, {-infinity, infinity, "m"}, "where the camera is"),
          vector("target", &Camera::target, {-infinity, infinity, "m"}, "what is in the picture's middle"),
          vector("up", &Camera::up, {}, "points up in the picture; [0, 0, -1] where parallel to the view"),
          real("vertical_fov_degrees", &Camera::verticalFovDegrees, {0.0, 180.0, "degrees", true}, Binding::uniform,
               "perspective: angle from bottom to top, less than 180"),
          real("height", &Camera::height, {0.0, infinity, "m", true}, Binding::uniform,
               "orthographic: what it sees from bottom to top"),
          real("near", &Camera::near, {0.0, infinity, "m", true}, Binding::uniform,
               "nothing nearer is seen; there is no far plane"),
      }
          .checked(checkCamera)
          .table();
  return table;
}

}  // namespace gnomon
