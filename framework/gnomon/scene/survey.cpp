#include "gnomon/scene/survey.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <limits>

#include "gnomon/scene/clip.h"

namespace gnomon {
namespace {

using Planes = std::array<glm::dvec4, 5>;

/// Shadows on receivers with N.L below the terminator's 0.1 are not reckoned with.
constexpr double kGrazingStretch = 10.0;

/// In front of a spot's plane; other lights have none.
bool hasCornerInFront(const Light& light, const LightFrame& frame, const Triangle& t) {
  const auto front = [&](const glm::dvec3& p) { return glm::dot(p - frame.origin, frame.z) < 0.0; };
  return light.type != LightType::spot || front(t.a) || front(t.b) || front(t.c);
}

/// False only if the triangle's bounding sphere is wholly outside the spot's cone.
bool mayBeInCone(const Light& light, const LightFrame& frame, const Triangle& t) {
  if (light.type != LightType::spot) return true;
  const glm::dvec3 centre = (t.a + t.b + t.c) / 3.0;
  const double radius = std::max({glm::length(t.a - centre), glm::length(t.b - centre), glm::length(t.c - centre)});
  const glm::dvec3 from = centre - frame.origin;
  const double along = -glm::dot(from, frame.z);
  const double across = glm::length(from + frame.z * along);
  const double angle = glm::radians(light.coneHalfAngleDegrees);
  // Signed distance of the centre from the cone's side line in their common plane: never more than that from the cone.
  return across * std::cos(angle) - along * std::sin(angle) <= radius;
}

bool mayBeSeen(const Planes& planes, const glm::dvec3& eye, const Triangle& t) {
  const auto outside = [&](const glm::dvec4& plane, const glm::dvec3& p) {
    return glm::dot(glm::dvec3(plane), p - eye) + plane.w < 0.0;
  };
  return std::none_of(planes.begin(), planes.end(), [&](const glm::dvec4& plane) {
    return outside(plane, t.a) && outside(plane, t.b) && outside(plane, t.c);
  });
}

/// Positive where the front side of the triangle's plane faces the source's centre; the size is of no meaning.
double facing(const Light& light, const LightFrame& frame, const Triangle& t) {
  const glm::dvec3 normal = glm::cross(t.b - t.a, t.c - t.a);
  return glm::dot(normal, light.type == LightType::directional ? frame.z : frame.origin - t.a);
}

std::size_t countFacing(const Scene& scene, const Light& light, const LightFrame& frame, const Camera& camera, double aspect,
                        const std::vector<VisibleReceiver>& receivers) {
  const Planes planes = frustumPlanes(camera, aspect);
  std::size_t count = 0;
  for (const VisibleReceiver& receiver : receivers) {
    const Instance& instance = scene.instances[receiver.instance];
    const bool doubleSided = scene.materials[instance.material].doubleSided;
    const double winding = glm::determinant(glm::dmat3(instance.world)) < 0.0 ? -1.0 : 1.0;  // a mirror turns triangles over
    const std::size_t triangles = scene.meshes[instance.mesh].triangles();
    for (std::size_t i = 0; i < triangles; ++i) {
      const Triangle t = worldTriangle(scene, instance, i);
      const double side = winding * facing(light, frame, t);
      if ((side > 0.0 || (doubleSided && side < 0.0)) && hasCornerInFront(light, frame, t) && mayBeInCone(light, frame, t) &&
          mayBeSeen(planes, camera.position, t))
        ++count;
    }
  }
  return count;
}

/// How near a caster comes to the light; infinity if there is none.
double nearestCaster(const Scene& scene, const Light& light, const LightFrame& frame) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Instance& instance : scene.instances) {
    if (!instance.casts) continue;
    const std::size_t triangles = scene.meshes[instance.mesh].triangles();
    for (std::size_t i = 0; i < triangles; ++i) {
      const Triangle t = worldTriangle(scene, instance, i);
      if (light.type == LightType::directional) {
        for (const glm::dvec3& p : {t.a, t.b, t.c}) nearest = std::min(nearest, -glm::dot(p - frame.origin, frame.z));
      } else if (hasCornerInFront(light, frame, t)) {
        nearest = std::min(nearest, distanceToTriangle(frame.origin, t));
      }
    }
  }
  return nearest;
}

/// Rounding of a plane's distance is some 1e-16 of the coordinates' size: 1e-12 keeps what touches the plane.
double clipTolerance(const Bounds& box, const glm::dvec4& plane) {
  return 1e-12 * std::max({glm::length(box.min), glm::length(box.max), std::abs(plane.w)});
}

enum class BoxSide { inside, cut, outside };

/// Most boxes are wholly on one side of every plane and need not be clipped.
BoxSide sideOf(const Bounds& box, std::span<const glm::dvec4> planes) {
  BoxSide side = BoxSide::inside;
  for (const glm::dvec4& plane : planes) {
    const glm::dvec3 n(plane);
    const double middle = glm::dot(n, box.centre()) + plane.w;
    const double reach = glm::dot(glm::abs(n), box.max - box.min) / 2.0;
    const double tolerance = clipTolerance(box, plane);
    if (middle + reach < -tolerance) return BoxSide::outside;
    if (middle - reach < tolerance) side = BoxSide::cut;
  }
  return side;
}

double penumbraWidth(const Light& light, double nearestCaster, double farthestReceiver) {
  const double gap = farthestReceiver - nearestCaster;
  if (!(gap > 0.0)) return 0.0;
  if (light.type == LightType::directional) return 2.0 * gap * std::tan(glm::radians(light.angularDiameterDegrees) / 2.0);
  const double diameter = sourceDiameter(light);
  const double clearance = nearestCaster - diameter / 2.0;
  return clearance > 0.0 ? diameter * gap / clearance : std::numeric_limits<double>::infinity();
}

}  // namespace

std::vector<VisibleReceiver> visibleReceivers(const Scene& scene, const std::vector<Bounds>& instanceBounds,
                                              const Camera& camera, double aspect) {
  std::vector<VisibleReceiver> visible;
  visitReceiversWithin(scene, instanceBounds, camera.position, frustumPlanes(camera, aspect),
                       [&](std::size_t instance, std::span<const glm::dvec3> points) {
                         visible.push_back({instance, {points.begin(), points.end()}});
                       });
  return visible;
}

void visitReceiversWithin(const Scene& scene, const std::vector<Bounds>& instanceBounds, const glm::dvec3& origin,
                          std::span<const glm::dvec4> planes, const ReceiverVisitor& visit) {
  thread_local std::vector<glm::dvec3> points;  // kept, so that frames take no memory; a visitor starts no other visit
  thread_local ConvexPolyhedron part;
  const auto add = [&](const glm::dvec3& p) {
    const glm::dvec3 corner = p + origin;
    if (std::find(points.begin(), points.end(), corner) == points.end()) points.push_back(corner);
  };
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    if (!scene.instances[i].receives || instanceBounds[i].empty()) continue;
    Bounds relative;
    relative.add(instanceBounds[i].min - origin);
    relative.add(instanceBounds[i].max - origin);
    points.clear();
    switch (sideOf(relative, planes)) {
      case BoxSide::outside:
        continue;
      case BoxSide::inside:
        for (int c = 0; c < 8; ++c) add(relative.corner(c));
        break;
      case BoxSide::cut: {
        part.setBox(relative);
        for (const glm::dvec4& plane : planes) part.clip(plane, clipTolerance(relative, plane));
        for (const glm::dvec3& corner : part.corners()) add(corner);
      }
    }
    if (!points.empty()) visit(i, points);
  }
}

SceneSurvey survey(const Scene& scene, const Light& light, const Camera& camera, glm::ivec2 outputSize) {
  SceneSurvey result;
  for (const Instance& instance : scene.instances) {
    result.instanceBounds.push_back(worldBounds(scene, instance));
    result.bounds.add(result.instanceBounds.back());
    const std::size_t triangles = scene.meshes[instance.mesh].triangles();
    result.triangles += triangles;
    if (instance.casts) result.casterTriangles += triangles;
    if (instance.receives) result.receiverTriangles += triangles;
    if (instance.receives && !instance.casts) result.idleReceiverTriangles += triangles;
  }
  result.movingInstances = scene.animation.riders.size();
  result.sourceHasExtent = hasExtent(light);

  const LightFrame frame = lightFrame(light);
  const double aspect = static_cast<double>(outputSize.x) / outputSize.y;
  const std::vector<VisibleReceiver> receivers = visibleReceivers(scene, result.instanceBounds, camera, aspect);
  result.facingTriangles = countFacing(scene, light, frame, camera, aspect, receivers);

  const double casterDistance = nearestCaster(scene, light, frame);
  if (std::isfinite(casterDistance)) result.nearestCasterDistance = casterDistance;

  // The farthest visible receiver from the light, and the nearest along the view.
  const double infinity = std::numeric_limits<double>::infinity();
  const glm::dmat4 rotation = cameraRotation(camera);
  double farthest = -infinity;
  double viewDistance = infinity;
  for (const VisibleReceiver& receiver : receivers)
    for (const glm::dvec3& p : receiver.points) {
      const glm::dvec3 from = p - frame.origin;
      farthest = std::max(farthest, light.type == LightType::directional ? -glm::dot(from, frame.z) : glm::length(from));
      viewDistance = std::min(viewDistance, -(rotation * glm::dvec4(p - camera.position, 0.0)).z);
    }
  if (!receivers.empty()) result.farthestReceiverDistance = farthest;

  if (result.sourceHasExtent && std::isfinite(casterDistance) && !receivers.empty()) {
    const double footprint = pixelFootprint(camera, outputSize.y, std::max(viewDistance, camera.near));
    result.widestPenumbraPixels = kGrazingStretch * penumbraWidth(light, casterDistance, farthest) / footprint;
  }
  return result;
}

}  // namespace gnomon
