#include "gnomon/passes/light_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>
#include <random>

#include "gnomon/scene/builtin.h"
#include "gnomon/scene/camera.h"

namespace gnomon {
namespace {

constexpr glm::ivec2 kSize{200, 150};

/// Boxes only, so that an instance's bounds are its geometry and rays can be tested by slabs.
struct Boxes {
  Scene scene;
  std::vector<Bounds> bounds;
  Light light;
  Camera camera;

  Boxes() {
    scene.meshes = {boxMesh(glm::dvec3(0.5))};
    scene.materials = {{}};
    light.position = {0.0, 10.0, 0.0};
    light.coneHalfAngleDegrees = 45.0;
    camera.position = {0.0, 4.0, 8.0};
  }

  enum class Role { caster, receiver, both };

  std::size_t add(const glm::dvec3& centre, const glm::dvec3& size, Role role) {
    Instance instance;
    instance.world = glm::scale(glm::translate(glm::dmat4(1.0), centre), size);
    instance.casts = role != Role::receiver;
    instance.receives = role != Role::caster;
    scene.instances.push_back(instance);
    bounds.push_back(worldBounds(scene, instance));
    return bounds.size() - 1;
  }

  /// A flat receiver with its top at y = 0.
  std::size_t addFloor(double halfSize) { return add({0.0, -0.005, 0.0}, {2.0 * halfSize, 0.01, 2.0 * halfSize}, Role::receiver); }
};

MapFit fitOf(const Boxes& boxes, const MapFitting& how = {}) {
  // fitMap reads no GPU state: the reference is bound to storage that is never looked into.
  alignas(GpuScene) static const std::array<std::byte, sizeof(GpuScene)> noGpu{};
  const FrameInputs frame{boxes.scene,  boxes.bounds, reinterpret_cast<const GpuScene&>(noGpu), boxes.light, boxes.camera, kSize, 0.0};
  MapFit fit;
  fitMap(frame, mapPlane(boxes.light, boxes.scene, boxes.bounds), how, fit);
  return fit;
}
}
}
