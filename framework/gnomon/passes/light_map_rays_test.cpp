// The map's fit against brute force: whatever a ray from a visible receiver to the light meets must be drawn.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "gnomon/passes/light_map.h"
#include "gnomon/scene/builtin.h"

namespace gnomon {
namespace {

struct Random {
  std::mt19937 engine;
  double between(double low, double high) { return low + (high - low) * static_cast<double>(engine()) * 0x1p-32; }
  glm::dvec3 inCube(double half) {
    const double x = between(-half, half);
    const double y = between(-half, half);
    return {x, y, between(-half, half)};
  }
};

struct World {
  Scene scene;
  std::vector<Bounds> bounds;
  Light light;
  Camera camera;
};

World randomWorld(Random& random) {
  World world;
  world.scene.meshes = {boxMesh(glm::dvec3(0.5))};
  world.scene.materials = {{}};
  for (int i = 0; i < 12; ++i) {
    const glm::dvec3 centre = random.inCube(5.0);
    // Some boxes are flat, some large enough to hold the light or the camera.
    glm::dvec3 size = glm::abs(random.inCube(random.between(0.5, 6.0)));
    if (random.between(0.0, 1.0) < 0.3) size.y = 0.0;
    Instance instance;
    instance.world = glm::scale(glm::translate(glm::dmat4(1.0), centre), size);
    instance.casts = random.between(0.0, 1.0) < 0.7;
    instance.receives = !instance.casts || random.between(0.0, 1.0) < 0.5;
    world.scene.instances.push_back(instance);
    world.bounds.push_back(Bounds{centre - size * 0.5, centre + size * 0.5});
  }
  world.light.type = random.between(0.0, 1.0) < 0.3 ? LightType::directional : LightType::spot;
  world.light.position = random.inCube(8.0);
  world.light.target = random.inCube(4.0);
  world.light.coneHalfAngleDegrees = random.between(5.0, 89.0);
  world.camera.position = random.inCube(10.0);
  world.camera.target = random.inCube(4.0);
  world.camera.verticalFovDegrees = random.between(5.0, 120.0);
  return world;
}

glm::dvec3 onSurface(const Bounds& box, Random& random) {
  glm::dvec3 p;
  for (int k = 0; k < 3; ++k) p[k] = random.between(box.min[k], box.max[k]);
  const auto side = static_cast<int>(random.between(0.0, 6.0));
  p[side / 2] = side % 2 == 0 ? box.min[side / 2] : box.max[side / 2];
  return p;
}

bool inView(const World& world, double aspect, const glm::dvec3& p) {
  const auto planes = frustumPlanes(world.camera, aspect);
  return std::all_of(planes.begin(), planes.end(), [&](const glm::dvec4& plane) {
    return glm::dot(glm::dvec3(plane), p - world.camera.position) + plane.w >= 0.0;
  });
}

/// Whether from + t direction, t in [0, end], passes through the inside of the box; touching does not count.
bool passesThrough(const Bounds& box, const glm::dvec3& from, const glm::dvec3& direction, double end) {
  double enter = 0.0;
  double leave = end;
  for (int k = 0; k < 3; ++k) {
    if (direction[k] == 0.0) {
      if (from[k] < box.min[k] || from[k] > box.max[k]) return false;
      continue;
    }
    const double a = (box.min[k] - from[k]) / direction[k];
    const double b = (box.max[k] - from[k]) / direction[k];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave - 1e-9;
}

struct Tally {
  std::size_t points = 0, hits = 0, leftOut = 0;
};

/// Rays from the places in the map that a filter of this margin reads for random visible points, towards the light.
void castRays(const World& world, const glm::dvec2& margin, Random& random, Tally& tally) {
  const MapSubject subject{world.scene, world.bounds, world.light, world.camera, 1.5};
  const MapPlane plane = mapPlane(subject);
  MapFit fit;
  fitMap(subject, plane, {.margin = margin}, fit);
  for (std::size_t i = 0; i < world.bounds.size(); ++i) {
    if (world.scene.instances[i].casts && fit.casters[i] == 0) ++tally.leftOut;
    if (!world.scene.instances[i].receives) continue;
    for (int n = 0; n < 20; ++n) {
      const glm::dvec3 point = onSurface(world.bounds[i], random);
      if (!inView(world, subject.aspect, point) || !inReach(world.light, lightFrame(world.light), point)) continue;
      ++tally.points;
      const glm::dvec3 p = point - plane.axes.origin;
      const double depth = -glm::dot(plane.axes.z, p);
      ASSERT_GE(depth, fit.near);
      ASSERT_LE(depth, fit.far);
      const double mx = random.between(-margin.x, margin.x);
      const glm::dvec2 metres =
          glm::dvec2(mx, random.between(-margin.y, margin.y)) * plane.halfExtent * (plane.perspective ? depth : 1.0);
      const glm::dvec3 from = point + plane.axes.x * metres.x + plane.axes.y * metres.y;
      const glm::dvec3 direction = plane.perspective ? plane.axes.origin - from : plane.axes.z;
      const double end = plane.perspective ? 1.0 : std::numeric_limits<double>::infinity();
      for (std::size_t c = 0; c < world.bounds.size(); ++c) {
        if (!world.scene.instances[c].casts || !passesThrough(world.bounds[c], from, direction, end)) continue;
        ++tally.hits;
        ASSERT_NE(fit.casters[c], 0) << "instance " << c << " blocks a visible receiver of instance " << i
                                     << " but is left out";
      }
    }
  }
}

TEST(MapRays, WhateverBlocksAVisibleReceiverIsDrawn) {
  Random random{std::mt19937(1)};
  Tally tally;
  for (int world = 0; world < 600; ++world) {
    SCOPED_TRACE(world);
    castRays(randomWorld(random), glm::dvec2(0.0), random, tally);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(tally.hits, 5000U);    // else the test says nothing
  EXPECT_GT(tally.leftOut, 500U);  // and an empty rule would pass
}

TEST(MapRays, WhateverBlocksWhatAFilterReadsIsDrawn) {
  Random random{std::mt19937(2)};
  Tally tally;
  for (int world = 0; world < 600; ++world) {
    SCOPED_TRACE(world);
    castRays(randomWorld(random), {0.05, 0.1}, random, tally);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(tally.hits, 5000U);
  EXPECT_GT(tally.leftOut, 300U);
}

}  // namespace
}  // namespace gnomon
