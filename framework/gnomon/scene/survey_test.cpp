#include "gnomon/scene/survey.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "gnomon/scene/builtin.h"
#include "gnomon/scene/clip.h"

namespace gnomon {
namespace {

constexpr glm::ivec2 kSize{800, 600};

/// A floor of half size 1 that receives, and a quad of half size 0.5 above it that casts.
Scene twoQuads(double blockerHeight) {
  Scene scene;
  scene.meshes = {quadMesh(1.0, 1.0), quadMesh(0.5, 0.5)};
  scene.materials = {{}};
  scene.instances = {{"floor", 0, 0, glm::dmat4(1.0), false, true},
                     {"blocker", 1, 0, glm::translate(glm::dmat4(1.0), {0.0, blockerHeight, 0.0}), true, false}};
  return scene;
}

/// Straight above, so high that the perspective is mild, looking down with Z towards the picture's bottom.
Camera cameraAbove() {
  Camera camera;
  camera.position = {0.0, 10.0, 0.0};
  return camera;
}

Light spotAbove(double height, double sourceSize) {
  Light light;
  light.position = {0.0, height, 0.0};
  light.source.shape = SourceShape::rectangle;
  light.source.size = {sourceSize, sourceSize};
  return light;
}

std::vector<VisibleReceiver> receiversOf(const Scene& scene, const Camera& camera, double aspect = 1.0) {
  std::vector<Bounds> bounds;
  for (const Instance& instance : scene.instances) bounds.push_back(worldBounds(scene, instance));
  return visibleReceivers(scene, bounds, camera, aspect);
}

Scene boxScene(const glm::dvec3& halfSize) {
  Scene scene;
  scene.meshes = {boxMesh(halfSize)};
  scene.materials = {{}};
  scene.instances = {{"box", 0, 0, glm::dmat4(1.0), true, true}};
  return scene;
}

bool has(const std::vector<glm::dvec3>& points, const glm::dvec3& p) {
  return std::any_of(points.begin(), points.end(), [&](const glm::dvec3& q) { return glm::length(p - q) < 1e-9; });
}

TEST(ConvexPolyhedron, KeepsAWholeBoxInside) {
  Bounds box;
  box.add({-1.0, -1.0, -1.0});
  box.add({1.0, 1.0, 1.0});
  ConvexPolyhedron part;
  part.setBox(box);
  part.clip({1.0, 0.0, 0.0, 2.0}, 0.0);
  EXPECT_EQ(part.faces(), 6u);
  part.clip({1.0, 0.0, 0.0, -2.0}, 0.0);
  EXPECT_EQ(part.faces(), 0u);
  EXPECT_TRUE(part.corners().empty());
}

TEST(ConvexPolyhedron, ACornerCutOffLeavesATriangularCap) {
  Bounds box;
  box.add({0.0, 0.0, 0.0});
  box.add({1.0, 1.0, 1.0});
  const glm::dvec3 n = -glm::normalize(glm::dvec3(1.0));
  ConvexPolyhedron part;
  part.setBox(box);
  part.clip({n, 2.5 / std::sqrt(3.0)}, 0.0);  // x + y + z <= 2.5
  ASSERT_EQ(part.faces(), 7u);
  for (const glm::dvec3& p : part.face(6)) EXPECT_NEAR(p.x + p.y + p.z, 2.5, 1e-12);
}

TEST(DistanceToTriangle, OfFaceEdgeAndCorner) {
  const Triangle t{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}};
  EXPECT_DOUBLE_EQ(distanceToTriangle({0.25, 2.0, 0.25}, t), 2.0);
  EXPECT_DOUBLE_EQ(distanceToTriangle({0.5, 0.0, -3.0}, t), 3.0);
  EXPECT_DOUBLE_EQ(distanceToTriangle({-3.0, 0.0, -4.0}, t), 5.0);
}

TEST(DistanceToTriangle, OfADegenerateOne) {
  EXPECT_DOUBLE_EQ(distanceToTriangle({0.0, 2.0, 0.0}, {{-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}), 2.0);
}

TEST(VisibleReceivers, AWhollyVisibleBoxKeepsItsCorners) {
  const auto receivers = receiversOf(twoQuads(1.0), cameraAbove());
  ASSERT_EQ(receivers.size(), 1u);
  EXPECT_EQ(receivers[0].points.size(), 4u);
  EXPECT_TRUE(has(receivers[0].points, {-1.0, 0.0, 1.0}));
}

TEST(VisibleReceivers, LeaveOutWhatDoesNotReceive) {
  Scene scene = twoQuads(1.0);
  scene.instances[0].receives = false;
  EXPECT_TRUE(receiversOf(scene, cameraAbove()).empty());
}

TEST(VisibleReceivers, LeaveOutWhatIsBehindTheCamera) {
  Camera camera = cameraAbove();
  camera.target = {0.0, 20.0, 0.0};
  EXPECT_TRUE(receiversOf(twoQuads(1.0), camera).empty());
}

TEST(VisibleReceivers, OnBothSidesOfTheFrustumsEdge) {
  // 90 degrees at height 10 with aspect 1 sees |x| <= 10 of the floor; the floor's left edge is at offset - 1.
  Camera camera = cameraAbove();
  camera.verticalFovDegrees = 90.0;
  for (const auto& [offset, seen] : {std::pair{10.999, true}, std::pair{11.001, false}}) {
    Scene scene = twoQuads(1.0);
    scene.instances[0].world = glm::translate(glm::dmat4(1.0), {offset, 0.0, 0.0});
    EXPECT_EQ(!receiversOf(scene, camera).empty(), seen) << offset;
  }
}

TEST(VisibleReceivers, AreCutAtTheFrustum) {
  Camera camera = cameraAbove();
  camera.verticalFovDegrees = 90.0;
  Scene scene = twoQuads(1.0);
  scene.instances[0].world = glm::scale(glm::dmat4(1.0), glm::dvec3(100.0));
  const auto receivers = receiversOf(scene, camera);
  ASSERT_EQ(receivers.size(), 1u);
  EXPECT_TRUE(has(receivers[0].points, {10.0, 0.0, -10.0}));
  for (const glm::dvec3& p : receivers[0].points) EXPECT_LE(std::max(std::abs(p.x), std::abs(p.z)), 10.0 + 1e-9);
}

TEST(VisibleReceivers, ABoxAroundTheCameraIsCutToTheFrustumsPyramid) {
  Camera camera;
  camera.position = {0.0, 0.0, 0.0};
  camera.target = {0.0, 0.0, -1.0};
  camera.verticalFovDegrees = 90.0;
  camera.near = 0.5;
  const auto receivers = receiversOf(boxScene(glm::dvec3(4.0)), camera);
  ASSERT_EQ(receivers.size(), 1u);
  EXPECT_EQ(receivers[0].points.size(), 8u);
  EXPECT_TRUE(has(receivers[0].points, {0.5, 0.5, -0.5}));
  EXPECT_TRUE(has(receivers[0].points, {-4.0, 4.0, -4.0}));
}

TEST(VisibleReceivers, MissNoPointThatIsSeen) {
  // Every point of the box that the camera sees is within the hull's own bounds.
  const Scene scene = boxScene({3.0, 2.0, 1.0});
  Camera camera;
  camera.position = {2.0, 1.0, 2.5};
  camera.target = {0.0, 0.5, -1.0};
  const auto planes = frustumPlanes(camera, 1.0);
  Bounds hull;
  Bounds seen;
  for (const VisibleReceiver& receiver : receiversOf(scene, camera))
    for (const glm::dvec3& p : receiver.points) hull.add(p);
  for (int i = 0; i <= 60; ++i)
    for (int j = 0; j <= 40; ++j)
      for (int k = 0; k <= 20; ++k) {
        const glm::dvec3 p{-3.0 + 0.1 * i, -2.0 + 0.1 * j, -1.0 + 0.1 * k};
        if (std::all_of(planes.begin(), planes.end(), [&](const glm::dvec4& plane) {
              return glm::dot(glm::dvec3(plane), p - camera.position) + plane.w >= 0.0;
            }))
          seen.add(p);
      }
  ASSERT_FALSE(seen.empty());
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LE(hull.min[axis], seen.min[axis] + 1e-9);
    EXPECT_GE(hull.max[axis], seen.max[axis] - 1e-9);
    EXPECT_NEAR(hull.min[axis], seen.min[axis], 0.12);  // and not by more than the samples' spacing
    EXPECT_NEAR(hull.max[axis], seen.max[axis], 0.12);
  }
}

TEST(VisibleReceivers, AreTheSameUnderAWorldOffset) {
  Scene scene = twoQuads(1.0);
  scene.instances[0].world = glm::translate(glm::dmat4(1.0), glm::dvec3(1e6)) * glm::scale(glm::dmat4(1.0), glm::dvec3(100.0));
  Camera camera = cameraAbove();
  camera.verticalFovDegrees = 90.0;
  camera.position += 1e6;
  camera.target += 1e6;
  const auto receivers = receiversOf(scene, camera);
  ASSERT_EQ(receivers.size(), 1u);
  EXPECT_TRUE(has(receivers[0].points, glm::dvec3(10.0, 0.0, -10.0) + 1e6));
}

TEST(Survey, CountsTriangles) {
  const SceneSurvey s = survey(findBuiltinScene("half_plane")->make({}), Light{}, cameraAbove(), kSize);
  EXPECT_EQ(s.triangles, 4u);
  EXPECT_EQ(s.casterTriangles, 4u);
  EXPECT_EQ(s.receiverTriangles, 2u);
}

TEST(Survey, OfAnEmptyScene) {
  const SceneSurvey s = survey(Scene{}, spotAbove(4.0, 1.0), cameraAbove(), kSize);
  EXPECT_TRUE(s.bounds.empty());
  EXPECT_EQ(s.facingTriangles, 0u);
  EXPECT_EQ(s.widestPenumbraPixels, 0.0);
}

std::size_t facing(const Scene& scene, const Light& light) {
  return survey(scene, light, cameraAbove(), kSize).facingTriangles;
}

TEST(FacingTriangles, OnBothSidesOfThePlane) {
  Light light = spotAbove(1e-3, 1.0);
  light.target = {5.0, 0.0, 0.0};
  light.coneHalfAngleDegrees = 90.0;
  EXPECT_EQ(facing(twoQuads(1.0), light), 2u);
  light.position.y = -1e-3;
  EXPECT_EQ(facing(twoQuads(1.0), light), 0u);
}

TEST(FacingTriangles, ALightInThePlaneSeesNone) {
  Light light = spotAbove(0.0, 1.0);
  light.target = {5.0, 0.0, 0.0};
  EXPECT_EQ(facing(twoQuads(1.0), light), 0u);
}

TEST(FacingTriangles, DoubleSidedOnesFaceWithEitherSide) {
  Scene scene = twoQuads(1.0);
  scene.materials[0].doubleSided = true;
  Light light = spotAbove(-1.0, 1.0);
  EXPECT_EQ(facing(scene, light), 2u);
}

TEST(FacingTriangles, AMirrorTurnsNothingOver) {
  Scene scene = twoQuads(1.0);
  scene.instances[0].world = glm::scale(glm::dmat4(1.0), {-1.0, 1.0, 1.0});
  EXPECT_EQ(facing(scene, spotAbove(4.0, 1.0)), 2u);
}

TEST(FacingTriangles, OnBothSidesOfTheSpotsPlane) {
  // A vertical plane at x = 1.9 faces +X everywhere; the light at x = 2 faces away from it, or towards it.
  Scene scene = twoQuads(1.0);
  scene.instances[0].world =
      glm::translate(glm::dmat4(1.0), {1.9, 0.0, 0.0}) * glm::rotate(glm::dmat4(1.0), -std::numbers::pi / 2.0, {0.0, 0.0, 1.0});
  Light light;
  light.coneHalfAngleDegrees = 90.0;
  light.position = {2.0, 0.0, 0.0};
  light.target = {0.0, 0.0, 0.0};
  EXPECT_EQ(facing(scene, light), 2u);
  light.target = {5.0, 0.0, 0.0};
  EXPECT_EQ(facing(scene, light), 0u);
}

TEST(FacingTriangles, OutsideTheConeDoNotCount) {
  Light light = spotAbove(4.0, 1.0);
  light.target = {4.0, 0.0, 0.0};  // 45 degrees from the vertical; the floor ends at x = 1
  light.coneHalfAngleDegrees = 5.0;
  EXPECT_EQ(facing(twoQuads(1.0), light), 0u);
  light.coneHalfAngleDegrees = 40.0;
  EXPECT_EQ(facing(twoQuads(1.0), light), 2u);
}

TEST(FacingTriangles, OutsideTheViewDoNotCount) {
  Camera camera = cameraAbove();
  camera.position.x = 20.0;
  camera.target.x = 20.0;
  EXPECT_EQ(survey(twoQuads(1.0), spotAbove(4.0, 1.0), camera, kSize).facingTriangles, 0u);
}

TEST(FacingTriangles, OfAnInstanceInViewOnlyThoseInView) {
  // Over one corner of a large floor, whose diagonal runs along the picture's X: only one of its two triangles is seen.
  Scene scene = twoQuads(1.0);
  scene.instances[0].world = glm::scale(glm::dmat4(1.0), glm::dvec3(100.0));
  Camera camera = cameraAbove();
  camera.position = {80.0, 10.0, -80.0};
  camera.target = {80.0, 0.0, -80.0};
  camera.up = {1.0, 0.0, -1.0};
  Light light = spotAbove(4.0, 1.0);
  light.coneHalfAngleDegrees = 90.0;
  EXPECT_EQ(survey(scene, light, camera, kSize).facingTriangles, 1u);
}

double penumbra(const Scene& scene, const Light& light) {
  return survey(scene, light, cameraAbove(), kSize).widestPenumbraPixels;
}

TEST(WidestPenumbra, IsTheFormulaOverTheFootprint) {
  // Caster 2 m below the light, floor corners at sqrt(16 + 2) from it; diameter sqrt 2.
  const double a = std::sqrt(2.0);
  const double width = a * (std::sqrt(18.0) - 2.0) / (2.0 - a / 2.0);
  const double footprint = pixelFootprint(cameraAbove(), kSize.y, 10.0);
  EXPECT_NEAR(penumbra(twoQuads(2.0), spotAbove(4.0, 1.0)), 10.0 * width / footprint, 1e-9);
}

TEST(WidestPenumbra, IsAtLeastTheTrueWidth) {
  // techniques A.1: a h / (H - h), perpendicular receiver; the camera's footprint as small as it is anywhere on the floor.
  for (const double h : {0.01, 0.5, 1.0, 2.0, 3.0, 3.9}) {
    BuiltinParameters parameters;
    parameters.blockerHeight = h;
    const Scene scene = findBuiltinScene("half_plane")->make(parameters);
    const double truth = h / (4.0 - h) / pixelFootprint(cameraAbove(), kSize.y, 10.0);
    EXPECT_GE(penumbra(scene, scene.lights[0]), truth) << h;
  }
}

TEST(WidestPenumbra, IsProportionalToSmallSources) {
  const double one = penumbra(twoQuads(2.0), spotAbove(4.0, 1e-6));
  EXPECT_NEAR(penumbra(twoQuads(2.0), spotAbove(4.0, 2e-6)) / one, 2.0, 1e-5);
}

TEST(WidestPenumbra, IsZeroWithoutExtent) {
  EXPECT_EQ(penumbra(twoQuads(2.0), spotAbove(4.0, 0.0)), 0.0);
}

TEST(WidestPenumbra, IsZeroWithoutCasters) {
  Scene scene = twoQuads(2.0);
  scene.instances[1].casts = false;
  EXPECT_EQ(penumbra(scene, spotAbove(4.0, 1.0)), 0.0);
}

TEST(WidestPenumbra, IgnoresCastersBehindASpot) {
  EXPECT_EQ(penumbra(twoQuads(5.0), spotAbove(4.0, 1.0)), 0.0);
}

TEST(WidestPenumbra, IsInfiniteWhereACasterMayTouchTheSource) {
  Light light = spotAbove(4.0, 0.0);
  light.source = {SourceShape::disc, {0.0, 0.0}, 0.5, 0.0};
  EXPECT_TRUE(std::isinf(penumbra(twoQuads(3.5), light)));
  EXPECT_TRUE(std::isfinite(penumbra(twoQuads(3.49), light)));
}

TEST(WidestPenumbra, OfASphereUsesItsDiameter) {
  Light sphere = spotAbove(4.0, 0.0);
  sphere.type = LightType::point;
  sphere.source = {};
  sphere.radius = 0.25;
  Light disc = spotAbove(4.0, 0.0);
  disc.source = {SourceShape::disc, {0.0, 0.0}, 0.25, 0.0};
  EXPECT_DOUBLE_EQ(penumbra(twoQuads(2.0), sphere), penumbra(twoQuads(2.0), disc));
}

TEST(WidestPenumbra, OfADirectionalLightComesFromTheGap) {
  Light light;
  light.type = LightType::directional;
  light.angularDiameterDegrees = 2.0;
  const double width = 2.0 * 3.0 * std::tan(std::numbers::pi / 180.0);  // techniques A.7, gap 3 m
  EXPECT_NEAR(penumbra(twoQuads(3.0), light), 10.0 * width / pixelFootprint(cameraAbove(), kSize.y, 10.0), 1e-9);
}

TEST(WidestPenumbra, IsTheSameUnderAWorldOffset) {
  Scene scene = twoQuads(2.0);
  for (Instance& instance : scene.instances) instance.world = glm::translate(glm::dmat4(1.0), glm::dvec3(1e6)) * instance.world;
  Light light = spotAbove(4.0, 1.0);
  light.position += 1e6;
  light.target += 1e6;
  Camera camera = cameraAbove();
  camera.position += 1e6;
  camera.target += 1e6;
  const double offset = survey(scene, light, camera, kSize).widestPenumbraPixels;
  EXPECT_NEAR(offset / penumbra(twoQuads(2.0), spotAbove(4.0, 1.0)), 1.0, 1e-8);
}

TEST(ContentHash, SeesGeometryAndFlagsButNotNames) {
  const Scene scene = twoQuads(1.0);
  Scene other = scene;
  other.name = other.meshes[0].name = other.instances[0].name = "other";
  EXPECT_EQ(contentHash(scene), contentHash(other));
  other.instances[0].casts = true;
  EXPECT_NE(contentHash(scene), contentHash(other));
  other = scene;
  other.meshes[0].positions[0].x += 1e-6f;
  EXPECT_NE(contentHash(scene), contentHash(other));
}

TEST(Survey, CountsWhatRidesOnTheAnimation) {
  Scene scene = findBuiltinScene("animated")->make(findBuiltinScene("animated")->defaults);
  EXPECT_EQ(survey(scene, scene.lights.at(0), *scene.camera, {64, 48}).movingInstances, scene.animation.riders.size());
  EXPECT_GT(scene.animation.riders.size(), 0u);
}

}  // namespace
}  // namespace gnomon
