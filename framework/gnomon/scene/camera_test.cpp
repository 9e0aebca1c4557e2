#include "gnomon/scene/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "gnomon/base/error.h"
#include "gnomon/base/json.h"

namespace gnomon {
namespace {

constexpr double kAspect = 1.5;

Camera testCamera(CameraType type) {
  Camera camera;
  camera.type = type;
  camera.position = {1.0, 3.0, 6.0};
  camera.target = {0.5, 1.0, -2.0};
  camera.near = 0.25;
  return camera;
}

/// What is at these camera-axes coordinates, relative to the camera's position, in world axes.
glm::dvec3 fromCameraAxes(const Camera& camera, const glm::dvec3& p) {
  return glm::dvec3(glm::transpose(cameraRotation(camera)) * glm::dvec4(p, 0.0));
}

glm::dvec3 projected(const Camera& camera, const glm::dvec3& inCameraAxes) {
  const glm::dvec4 clip = cameraProjection(camera, kAspect) * glm::dvec4(inCameraAxes, 1.0);
  return glm::dvec3(clip) / clip.w;
}

TEST(CameraRotation, PutsTheTargetOnMinusZ) {
  const Camera camera = testCamera(CameraType::perspective);
  const glm::dvec3 seen(cameraRotation(camera) * glm::dvec4(camera.target - camera.position, 0.0));
  EXPECT_LT(glm::length(seen - glm::dvec3(0.0, 0.0, -glm::length(camera.target - camera.position))), 1e-14);
}

TEST(CameraRotation, KeepsUpInThePicturesUpperHalf) {
  const Camera camera = testCamera(CameraType::perspective);
  const glm::dvec4 up = cameraRotation(camera) * glm::dvec4(camera.up, 0.0);
  EXPECT_NEAR(up.x, 0.0, 1e-15);
  EXPECT_GT(up.y, 0.0);
}

TEST(CameraRotation, IsTheSameUnderAWorldOffset) {
  Camera camera = testCamera(CameraType::perspective);
  const glm::dmat4 near = cameraRotation(camera);
  camera.position += 1e6;
  camera.target += 1e6;
  const glm::dmat4 far = cameraRotation(camera);
  for (int i = 0; i < 4; ++i) EXPECT_LT(glm::length(near[i] - far[i]), 1e-15);
}

TEST(CameraProjection, DepthIsOneAtNearAndZeroAtInfinity) {
  const Camera camera = testCamera(CameraType::perspective);
  EXPECT_DOUBLE_EQ(projected(camera, {0.0, 0.0, -0.25}).z, 1.0);
  EXPECT_DOUBLE_EQ(projected(camera, {0.0, 0.0, -0.5}).z, 0.5);
  EXPECT_NEAR(projected(camera, {0.0, 0.0, -1e12}).z, 0.0, 1e-12);
}

TEST(CameraProjection, OrthographicDepthRunsFromOneToZero) {
  const Camera camera = testCamera(CameraType::orthographic);
  EXPECT_DOUBLE_EQ(projected(camera, {0.0, 0.0, -0.25}).z, 1.0);
  EXPECT_NEAR(projected(camera, {0.0, 0.0, -1e5}).z, 0.0, 1e-15);
}

TEST(CameraProjection, TheTopOfThePictureIsRowZero) {
  // Row 0 is at clip y = -1 under LOWER_LEFT.
  for (const CameraType type : {CameraType::perspective, CameraType::orthographic})
    EXPECT_LT(projected(testCamera(type), {0.0, 0.1, -2.0}).y, 0.0);
}

TEST(CameraProjection, FieldOfViewIsVertical) {
  const Camera camera = testCamera(CameraType::perspective);  // 45 degrees
  const double halfHeight = std::tan(22.5 * 3.14159265358979323846 / 180.0);
  const glm::dvec3 corner = projected(camera, {kAspect * halfHeight * 2.0, halfHeight * 2.0, -2.0});
  EXPECT_NEAR(corner.x, 1.0, 1e-14);
  EXPECT_NEAR(corner.y, -1.0, 1e-14);
}

TEST(FrustumPlanes, AgreeWithTheProjection) {
  // A plane's distance is zero exactly where the projection says the picture ends, with the inside on its positive side.
  for (const CameraType type : {CameraType::perspective, CameraType::orthographic}) {
    const Camera camera = testCamera(type);
    const auto planes = frustumPlanes(camera, kAspect);
    for (double x = -7.9; x < 8.0; x += 0.8)
      for (double y = -5.9; y < 6.0; y += 0.8)
        for (const double z : {-0.2, -0.3, -3.0, -9.0}) {
          const glm::dvec3 ndc = projected(camera, {x, y, z});
          const double expected[5] = {ndc.x + 1.0, 1.0 - ndc.x, 1.0 - ndc.y, ndc.y + 1.0, 1.0 - ndc.z};
          const glm::dvec3 p = fromCameraAxes(camera, {x, y, z});
          for (std::size_t i = 0; i < 5; ++i)
            ASSERT_EQ(glm::dot(glm::dvec3(planes[i]), p) + planes[i].w >= 0.0, expected[i] >= 0.0)
                << "plane " << i << " at " << x << ", " << y << ", " << z;
        }
  }
}

TEST(FrustumPlanes, HaveUnitNormals) {
  for (const CameraType type : {CameraType::perspective, CameraType::orthographic})
    for (const glm::dvec4& plane : frustumPlanes(testCamera(type), kAspect))
      EXPECT_NEAR(glm::length(glm::dvec3(plane)), 1.0, 1e-15);
}

TEST(PixelFootprint, GrowsWithDistanceOnlyInPerspective) {
  Camera camera;
  camera.verticalFovDegrees = 90.0;
  EXPECT_NEAR(pixelFootprint(camera, 100, 5.0), 0.1, 1e-15);
  camera.type = CameraType::orthographic;
  EXPECT_NEAR(pixelFootprint(camera, 100, 5.0), 0.1, 1e-15);
  EXPECT_NEAR(pixelFootprint(camera, 100, 50.0), 0.1, 1e-15);
}

std::vector<std::string> faults(const std::string& text) {
  Problems problems;
  Camera camera;
  readObject(Json::parse(text), *cameraTable(), &camera, {"f", "/camera"}, problems);
  std::vector<std::string> pointers;
  for (const Problem& problem : problems.list()) pointers.push_back(problem.pointer);
  return pointers;
}

using Pointers = std::vector<std::string>;

TEST(CameraTable, ReadsTheDesignsExample) {
  EXPECT_EQ(faults(R"({"position": [0, 9, 14], "target": [0, 0, 0], "vertical_fov_degrees": 45})"), Pointers{});
}

TEST(CameraTable, FieldsOfViewAreBetweenZeroAnd180) {
  EXPECT_EQ(faults(R"({"vertical_fov_degrees": 0})"), Pointers{"/camera/vertical_fov_degrees"});
  EXPECT_EQ(faults(R"({"vertical_fov_degrees": 180})"), Pointers{"/camera/vertical_fov_degrees"});
  EXPECT_EQ(faults(R"({"vertical_fov_degrees": 179.9})"), Pointers{});
}

TEST(CameraTable, NearIsAboveZero) {
  EXPECT_EQ(faults(R"({"near": 0})"), Pointers{"/camera/near"});
}

TEST(CameraTable, ACameraWithoutDirectionIsAnError) {
  EXPECT_EQ(faults(R"({"position": [1, 2, 3], "target": [1, 2, 3]})"), Pointers{"/camera/target"});
}

TEST(CameraTable, KeysOfTheOtherTypeAreErrors) {
  EXPECT_EQ(faults(R"({"type": "perspective", "height": 3})"), Pointers{"/camera/height"});
  EXPECT_EQ(faults(R"({"type": "orthographic", "vertical_fov_degrees": 3})"), Pointers{"/camera/vertical_fov_degrees"});
}

}  // namespace
}  // namespace gnomon
