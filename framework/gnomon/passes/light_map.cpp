#include "gnomon/passes/light_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>

#include "gnomon/scene/camera.h"
#include "gnomon/scene/survey.h"

namespace gnomon {

namespace {

/// A box or polytope as the map sees it. Depths are along the light's axis; under perspective what is wholly behind the light's
/// plane has no image (an empty one), and what reaches behind it has no bounded one and covers the map.
struct Image2D {
  glm::dvec2 min{std::numeric_limits<double>::infinity()};
  glm::dvec2 max{-std::numeric_limits<double>::infinity()};
  double nearest = std::numeric_limits<double>::infinity();
  double farthest = -std::numeric_limits<double>::infinity();
  bool behind = false;

  void add(const MapPlane& plane, const glm::dvec3& point) {
    const glm::dvec3 p = point - plane.axes.origin;
    const double depth = -glm::dot(plane.axes.z, p);
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
    if (plane.perspective && depth <= 0.0) {
      behind = true;
      return;
    }
    const glm::dvec2 xy(glm::dot(plane.axes.x, p), glm::dot(plane.axes.y, p));
    const glm::dvec2 image = ((plane.perspective ? xy / depth : xy) - plane.centre) / plane.halfExtent;
    min = glm::min(min, image);
    max = glm::max(max, image);
  }
  void close() {
    if (behind && farthest > 0.0) {
      min = glm::dvec2(-std::numeric_limits<double>::infinity());
      max = glm::dvec2(std::numeric_limits<double>::infinity());
    }
  }
  bool overlaps(const Image2D& other, glm::dvec2 margin) const {
    return min.x <= other.max.x + margin.x && max.x >= other.min.x - margin.x && min.y <= other.max.y + margin.y &&
           max.y >= other.min.y - margin.y;
  }
};

Image2D imageOf(const MapPlane& plane, const Bounds& box) {
  Image2D image;
  for (int i = 0; i < 8; ++i) image.add(plane, box.corner(i));
  image.close();
  return image;
}

/// Half-spaces of the map's pyramid, as wide as the map with its margin, relative to `origin`: what a spot lights lies inside.
/// Without them a floor that passes under the light would pull near to the light's plane and spread over the whole map. A
/// directional map spans all receivers and needs none.
std::array<glm::dvec4, 4> pyramid(const MapPlane& plane, const glm::dvec2& margin, const glm::dvec3& origin) {
  const auto side = [&](const glm::dvec3& axis, double tangent) {  // axis.p <= tangent * depth
    const glm::dvec3 n = glm::normalize(-axis - plane.axes.z * tangent);
    return glm::dvec4(n, glm::dot(n, origin - plane.axes.origin));
  };
  const glm::dvec2 tangent = plane.halfExtent * (1.0 + margin);
  return {side(plane.axes.x, tangent.x), side(-plane.axes.x, tangent.x), side(plane.axes.y, tangent.y),
          side(-plane.axes.y, tangent.y)};
}

enum class Receivers { all, inView };

/// What of the map those receivers in its reach read, between which depths.
Image2D imageOfReceivers(const MapSubject& subject, const MapPlane& plane, const glm::dvec2& margin, Receivers which) {
  const glm::dvec3& eye = subject.camera.position;
  const std::array<glm::dvec4, 5> frustum = frustumPlanes(subject.camera, subject.aspect);
  const std::array<glm::dvec4, 4> reach = pyramid(plane, margin, eye);
  std::array<glm::dvec4, 9> planes;
  auto end = planes.begin();
  if (which == Receivers::inView) end = std::copy(frustum.begin(), frustum.end(), end);
  if (plane.perspective) end = std::copy(reach.begin(), reach.end(), end);

  Image2D all;
  const auto add = [&](std::size_t /*instance*/, std::span<const glm::dvec3> points) {
    Image2D image;
    for (const glm::dvec3& point : points) image.add(plane, point);
    image.close();
    if (plane.perspective && image.farthest <= 0.0) return;  // behind the light: out of its reach
    all.min = glm::min(all.min, image.min);
    all.max = glm::max(all.max, image.max);
    all.nearest = std::min(all.nearest, image.nearest);
    all.farthest = std::max(all.farthest, image.farthest);
  };
  visitReceiversWithin(subject.scene, subject.instanceBounds, eye, std::span(planes.begin(), end), std::cref(add));
  return all;
}

}  // namespace

MapSubject mapSubject(const FrameInputs& frame) {
  return {frame.scene, frame.instanceBounds, frame.light, frame.camera,
          static_cast<double>(frame.outputSize.x) / frame.outputSize.y};
}

MapPlane mapPlane(const MapSubject& subject) {
  MapPlane plane;
  plane.axes = lightFrame(subject.light);
  plane.perspective = subject.light.type != LightType::directional;
  if (plane.perspective) {
    plane.halfExtent = glm::dvec2(std::tan(glm::radians(subject.light.coneHalfAngleDegrees)));
    return plane;
  }
  // A directional map spans all receivers, not only those in view: it must not swim when the camera moves. Its origin is in
  // their middle: the light's position means nothing, and may be so far that float has no digits left for the scene.
  Bounds receivers;
  const auto isReceiver = [&](std::size_t i) {
    return subject.scene.instances[i].receives && !subject.instanceBounds[i].empty();
  };
  for (std::size_t i = 0; i < subject.scene.instances.size(); ++i) {
    if (isReceiver(i)) receivers.add(subject.instanceBounds[i]);
  }
  if (receivers.empty()) return plane;
  plane.axes.origin = receivers.centre();
  glm::dvec2 low(std::numeric_limits<double>::infinity());
  glm::dvec2 high(-std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < subject.scene.instances.size(); ++i) {
    if (!isReceiver(i)) continue;
    for (int c = 0; c < 8; ++c) {
      const glm::dvec3 p = subject.instanceBounds[i].corner(c) - plane.axes.origin;
      const glm::dvec2 xy(glm::dot(plane.axes.x, p), glm::dot(plane.axes.y, p));
      low = glm::min(low, xy);
      high = glm::max(high, xy);
    }
  }
  plane.centre = (low + high) * 0.5;
  const double widest = std::max({high.x - low.x, high.y - low.y, std::numeric_limits<double>::min()});
  // A hundredth of the width around, so that receivers at the border lie inside; never zero across.
  plane.halfExtent = glm::max((high - low) * 0.5, glm::dvec2(widest * 1e-3)) * 1.01;
  return plane;
}

void fitMap(const MapSubject& subject, const MapPlane& plane, const MapFitting& how, MapFit& result) {
  const Scene& scene = subject.scene;

  // The region of the map that visible receivers read, and the deepest of them.
  Image2D read = imageOfReceivers(subject, plane, how.margin, Receivers::inView);
  const glm::dvec2 whole = glm::dvec2(1.0) + how.margin;
  read.min = glm::max(read.min, -whole);
  read.max = glm::min(read.max, whole);

  result.casters.assign(scene.instances.size(), 0);
  result.idle.assign(scene.instances.size(), 0);
  double near = std::numeric_limits<double>::infinity();
  double sceneNear = std::numeric_limits<double>::infinity();
  double sceneFar = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Bounds& box = subject.instanceBounds[i];
    if (box.empty()) continue;
    const Image2D image = imageOf(plane, box);
    sceneNear = std::min(sceneNear, image.nearest);
    sceneFar = std::max(sceneFar, image.farthest);
    result.idle[i] = scene.instances[i].receives && !scene.instances[i].casts ? 1 : 0;
    if (!scene.instances[i].casts) continue;
    const bool reaches = image.nearest <= read.farthest && image.overlaps(read, how.margin);
    result.casters[i] = reaches || !how.cull ? 1 : 0;
    if (reaches) near = std::min(near, image.nearest);
  }

  double far = how.fit ? read.farthest : sceneFar;
  near = how.fit ? std::min(near, read.nearest) : sceneNear;
  if (!std::isfinite(far) || !std::isfinite(near) || (plane.perspective && far <= 0.0)) {
    near = plane.perspective ? 0.5 : -1.0;  // nothing to draw or to read: any volume serves
    far = 1.0;
  }
  // Room for rounding, so that what lies exactly at near or far is inside.
  const double room = 1e-6 * (plane.perspective ? far : std::max({far - near, std::abs(far), std::abs(near)}));
  far += room;
  near -= room;
  if (plane.perspective) {
    // Casters nearer than near are clamped to it and still block; receivers nearer than near would be lit.
    const double nearestReceiver =
        how.fit ? read.nearest : imageOfReceivers(subject, plane, how.margin, Receivers::all).nearest;
    near = std::max({near, std::min(std::max(nearestReceiver - room, 0.0), far * how.nearRatio), far * 1e-12});
  }
  result.near = near;
  result.far = std::max(far, near + room);
}

}  // namespace gnomon
