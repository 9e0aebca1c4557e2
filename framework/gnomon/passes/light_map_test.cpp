#include "gnomon/passes/light_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "gnomon/scene/builtin.h"

namespace gnomon {
namespace {

enum class Role { caster, receiver, both };

/// Axis-aligned boxes: an instance's bounds are its geometry. A spot of 45 degrees 10 m above the origin, looking down.
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
    camera.position = {0.0, 20.0, 0.1};  // looks down on all of it
    camera.verticalFovDegrees = 90.0;
  }

  std::size_t add(Role role, const glm::dvec3& low, const glm::dvec3& high) {
    Instance instance;
    instance.world = glm::scale(glm::translate(glm::dmat4(1.0), (low + high) * 0.5), high - low);
    instance.casts = role != Role::receiver;
    instance.receives = role != Role::caster;
    scene.instances.push_back(instance);
    bounds.push_back(Bounds{low, high});
    return bounds.size() - 1;
  }
  /// A square without thickness at y = 0.
  std::size_t addFloor(double halfSize) { return add(Role::receiver, {-halfSize, 0.0, -halfSize}, {halfSize, 0.0, halfSize}); }

  MapSubject subject() const { return {scene, bounds, light, camera, 4.0 / 3.0}; }
  MapPlane plane() const { return mapPlane(subject()); }
  MapFit fit(const MapFitting& how = {}) const {
    MapFit result;
    fitMap(subject(), plane(), how, result);
    return result;
  }
  bool casts(std::size_t instance, const MapFitting& how = {}) const { return fit(how).casters.at(instance) != 0; }

  /// Sees the square |x - centre|, |z| <= 1 on the floor, a little less to each side.
  void lookAtFloor(double centre) {
    camera.type = CameraType::orthographic;
    camera.position = {centre, 20.0, 0.0};
    camera.target = {centre, 0.0, 0.0};
    camera.height = 2.0 * 3.0 / 4.0;
  }
};

/// fitMap gives near and far this much room, relative to far.
constexpr double kRoom = 2e-6;

// --- where the map lies ---

TEST(MapPlane, OfASpotIsItsCone) {
  Boxes boxes;
  boxes.light.coneHalfAngleDegrees = 60.0;
  const MapPlane plane = boxes.plane();
  EXPECT_TRUE(plane.perspective);
  EXPECT_NEAR(plane.halfExtent.x, std::sqrt(3.0), 1e-12);
}

TEST(MapPlane, OfADirectionalLightSpansAllReceiversAndNoCaster) {
  Boxes boxes;
  boxes.light.type = LightType::directional;
  boxes.addFloor(3.0);
  boxes.add(Role::caster, {50.0, 1.0, 0.0}, {51.0, 2.0, 1.0});
  EXPECT_NEAR(boxes.plane().halfExtent.x, 3.0 * 1.01, 1e-12);
  EXPECT_NEAR(boxes.plane().halfExtent.y, 3.0 * 1.01, 1e-12);
}

TEST(MapPlane, OfADirectionalLightDoesNotMoveWithTheCamera) {
  Boxes boxes;
  boxes.light.type = LightType::directional;
  boxes.addFloor(3.0);
  const MapPlane before = boxes.plane();
  boxes.lookAtFloor(2.0);
  EXPECT_EQ(boxes.plane().halfExtent, before.halfExtent);
  EXPECT_EQ(boxes.plane().centre, before.centre);
}

TEST(MapPlane, OfADirectionalLightDoesNotDependOnWhereTheLightIs) {
  Boxes boxes;
  boxes.light.type = LightType::directional;
  boxes.addFloor(3.0);
  boxes.light.position += 1e6;
  boxes.light.target += 1e6;
  EXPECT_EQ(boxes.plane().axes.origin, glm::dvec3(0.0));
}

// --- which casters are drawn ---

TEST(MapCasters, OneBetweenLightAndFloorIsKept) {
  Boxes boxes;
  boxes.addFloor(3.0);
  EXPECT_TRUE(boxes.casts(boxes.add(Role::caster, {-1, 1, -1}, {1, 2, 1})));
}

TEST(MapCasters, OneBehindTheLightIsLeftOut) {
  Boxes boxes;
  boxes.addFloor(3.0);
  EXPECT_FALSE(boxes.casts(boxes.add(Role::caster, {-1, 10.5, -1}, {1, 11, 1})));
}

TEST(MapCasters, OneBeyondTheFarthestReceiverIsLeftOut) {
  Boxes boxes;
  boxes.addFloor(3.0);
  EXPECT_FALSE(boxes.casts(boxes.add(Role::caster, {-1, -2, -1}, {1, -1, 1})));
}

TEST(MapCasters, WhatOnlyReceivesIsNeverDrawn) {
  Boxes boxes;
  EXPECT_FALSE(boxes.casts(boxes.addFloor(3.0), {.cull = false}));
}

TEST(MapCasters, OneWhoseShadowFallsBesideTheViewIsLeftOut) {
  Boxes boxes;
  boxes.addFloor(9.0);
  boxes.lookAtFloor(-5.0);
  EXPECT_FALSE(boxes.casts(boxes.add(Role::caster, {2, 1, -0.5}, {3, 2, 0.5})));
}

TEST(MapCasters, OneOutsideTheViewWhoseShadowFallsInsideIsKept) {
  Boxes boxes;
  boxes.addFloor(9.0);
  boxes.lookAtFloor(-5.0);  // sees x in [-6, -4] from straight above; a box at half the height shadows twice its x
  const std::size_t caster = boxes.add(Role::caster, {-2.6, 5.0, -0.1}, {-2.4, 5.1, 0.1});
  EXPECT_TRUE(boxes.casts(caster));
}

TEST(MapCasters, OneAroundTheLightIsKept) {
  Boxes boxes;
  boxes.addFloor(3.0);
  EXPECT_TRUE(boxes.casts(boxes.add(Role::caster, {-0.1, 9.9, -0.1}, {0.1, 10.1, 0.1})));
}

TEST(MapCasters, OneThroughTheLightsPlaneIsKept) {
  Boxes boxes;  // its corners in front of the light shadow x = 2 to 4 m, but its sides go on up to the light's plane
  boxes.light.coneHalfAngleDegrees = 80.0;
  boxes.addFloor(40.0);
  boxes.lookAtFloor(7.0);
  EXPECT_TRUE(boxes.casts(boxes.add(Role::caster, {1, 5, -1}, {2, 15, 1})));
}

TEST(MapCasters, MarginIsAsWideAsItSays) {
  Boxes boxes;
  boxes.addFloor(9.0);
  boxes.lookAtFloor(-5.0);  // the floor in view ends at x = -4: at -0.4 of the map; the box begins at -3.5 / 10 = -0.35
  const std::size_t caster = boxes.add(Role::caster, {-3.5, 0.0, -0.5}, {-3, 0.0, 0.5});
  EXPECT_FALSE(boxes.casts(caster, {.margin = {0.049, 1.0}}));
  EXPECT_TRUE(boxes.casts(caster, {.margin = {0.051, 0.0}}));
}

TEST(MapCasters, ForcedOffCullingKeepsAllAndTheSameRange) {
  Boxes boxes;
  boxes.addFloor(9.0);
  boxes.lookAtFloor(-5.0);
  boxes.add(Role::caster, {-2.6, 5.0, -0.1}, {-2.4, 5.1, 0.1});
  const std::size_t beside = boxes.add(Role::caster, {3, 9.0, -0.1}, {3.1, 9.1, 0.1});
  const MapFit on = boxes.fit();
  const MapFit off = boxes.fit({.cull = false});
  EXPECT_EQ(on.casters[beside], 0);
  EXPECT_EQ(off.casters[beside], 1);
  EXPECT_EQ(on.near, off.near);
  EXPECT_EQ(on.far, off.far);
}

TEST(MapCasters, AFloorThatReachesBehindTheLightDoesNotFillTheMap) {
  Boxes boxes;  // looks along +X, 2 m above a floor that begins far behind it
  boxes.light.position = {0.0, 2.0, 0.0};
  boxes.light.target = {1.0, 2.0, 0.0};
  boxes.addFloor(100.0);
  const std::size_t above = boxes.add(Role::caster, {5, 3, -1}, {6, 4, 1});
  const std::size_t below = boxes.add(Role::caster, {5, 0.5, -1}, {6, 1.5, 1});
  EXPECT_FALSE(boxes.casts(above));
  EXPECT_TRUE(boxes.casts(below));
}

// --- near and far ---

TEST(MapRange, HoldsTheCasterAndTheFloor) {
  Boxes boxes;
  boxes.addFloor(3.0);
  boxes.add(Role::caster, {-1, 1, -1}, {1, 2, 1});
  const MapFit fit = boxes.fit();
  EXPECT_NEAR(fit.near, 8.0, kRoom * 10.0);
  EXPECT_NEAR(fit.far, 10.0, kRoom * 10.0);
  EXPECT_LT(fit.near, 8.0);
  EXPECT_GT(fit.far, 10.0);
}

TEST(MapRange, EndsAtTheDeepestReceiverInView) {
  Boxes boxes;
  boxes.addFloor(9.0);
  boxes.add(Role::receiver, {5, -3, -1}, {6, -2, 1});
  boxes.lookAtFloor(-5.0);
  EXPECT_NEAR(boxes.fit().far, 10.0, kRoom * 10.0);
  EXPECT_NEAR(boxes.fit({.fit = false}).far, 13.0, kRoom * 13.0);
}

TEST(MapRange, IsNotPulledByCastersThatReachNothing) {
  Boxes boxes;
  boxes.addFloor(9.0);
  boxes.lookAtFloor(-5.0);
  boxes.add(Role::caster, {-2.6, 5.0, -0.1}, {-2.4, 5.1, 0.1});
  boxes.add(Role::caster, {0.2, 9.0, -0.1}, {0.3, 9.1, 0.1});
  EXPECT_NEAR(boxes.fit().near, 4.9, kRoom * 10.0);
}

TEST(MapRange, NearIsNoLessThanItsPartOfFar) {
  Boxes boxes;
  boxes.addFloor(3.0);
  boxes.add(Role::caster, {-0.001, 9.99, -0.001}, {0.001, 9.995, 0.001});
  EXPECT_NEAR(boxes.fit({.nearRatio = 1e-2}).near, 0.1, kRoom * 10.0);
  EXPECT_NEAR(boxes.fit({.nearRatio = 1e-10}).near, 0.005, kRoom * 10.0);
}

TEST(MapRange, NearIsNoFartherThanAnyReceiverInReach) {
  Boxes boxes;
  boxes.addFloor(3.0);
  boxes.add(Role::both, {-0.001, 9.99, -0.001}, {0.001, 9.995, 0.001});
  EXPECT_LE(boxes.fit({.nearRatio = 1e-2}).near, 0.005);
  boxes.lookAtFloor(-2.0);  // not in view now, but without fitting nothing may depend on that
  EXPECT_LE(boxes.fit({.fit = false, .nearRatio = 1e-2}).near, 0.005);
}

TEST(MapRange, BeginsWhereAFloorThatReachesBehindTheLightEntersItsCone) {
  Boxes boxes;
  boxes.light.position = {0.0, 2.0, 0.0};
  boxes.light.target = {1.0, 2.0, 0.0};
  boxes.light.coneHalfAngleDegrees = 30.0;
  boxes.addFloor(100.0);
  EXPECT_NEAR(boxes.fit().near, 2.0 * std::sqrt(3.0), 1e-3);  // the view cuts far at less than 100 m: room is below that
}

TEST(MapRange, OfADirectionalLightMayBeNegative) {
  Boxes boxes;
  boxes.light.type = LightType::directional;
  boxes.addFloor(3.0);
  boxes.add(Role::caster, {-1, 20, -1}, {1, 21, 1});  // above the "position", which means nothing
  const MapFit fit = boxes.fit();
  EXPECT_EQ(fit.casters[1], 1);
  EXPECT_NEAR(fit.near, -21.0, kRoom * 21.0);
  EXPECT_NEAR(fit.far, 0.0, kRoom * 21.0);
}

TEST(MapRange, WithoutReceiversInViewIsFiniteAndNothingIsDrawn) {
  Boxes boxes;
  boxes.addFloor(3.0);
  boxes.lookAtFloor(50.0);
  const std::size_t caster = boxes.add(Role::caster, {-1, 1, -1}, {1, 2, 1});
  const MapFit fit = boxes.fit();
  EXPECT_EQ(fit.casters[caster], 0);
  EXPECT_TRUE(std::isfinite(fit.near) && std::isfinite(fit.far) && fit.near > 0.0 && fit.near < fit.far);
}

TEST(MapRange, OfNothingIsFinite) {
  const MapFit fit = Boxes().fit();
  EXPECT_TRUE(std::isfinite(fit.near) && std::isfinite(fit.far) && fit.near > 0.0 && fit.near < fit.far);
}

}  // namespace
}  // namespace gnomon
