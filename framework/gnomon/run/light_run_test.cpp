#include "gnomon/run/light_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace gnomon {
namespace {

constexpr int kPoses = 30;

Light someLight() {
  Light light;
  light.position = {3.0, 8.0, -2.0};
  light.target = {1.0, 0.5, 0.0};
  return light;
}

TEST(LightPoses, TheFirstIsTheNominalOne) {
  const Light light = someLight();
  EXPECT_NEAR(glm::length(lightAtPose(light, 0, kPoses).position - light.position), 0.0, 1e-12);
}

TEST(LightPoses, ThePathIsClosed) {
  const Light light = someLight();
  EXPECT_NEAR(glm::length(lightAtPose(light, kPoses, kPoses).position - light.position), 0.0, 1e-12);
}

TEST(LightPoses, TheLightKeepsItsTargetAndItsDistance) {
  const Light light = someLight();
  for (int p = 0; p < kPoses; ++p) {
    const Light turned = lightAtPose(light, p, kPoses);
    EXPECT_EQ(turned.target, light.target);
    EXPECT_NEAR(glm::length(turned.position - light.target), glm::length(light.position - light.target), 1e-12);
  }
}

TEST(LightPoses, EachTurnStaysWithinHalfADegree) {  // about two axes: the angle between poses stays within sqrt(2) of that
  const Light light = someLight();
  for (int p = 0; p < kPoses; ++p) {
    const glm::dvec3 turned = glm::normalize(lightAtPose(light, p, kPoses).position - light.target);
    const glm::dvec3 nominal = glm::normalize(light.position - light.target);
    EXPECT_LE(glm::degrees(std::asin(glm::length(glm::cross(turned, nominal)))), 0.5 * std::sqrt(2.0));
  }
}

TEST(LightPoses, EveryPoseMovesTheLight) {  // else a frame of the dynamic regime would skip its passes
  const Light light = someLight();
  for (int p = 0; p < kPoses; ++p) {
    EXPECT_NE(lightAtPose(light, p, kPoses).position, lightAtPose(light, p + 1, kPoses).position);
  }
}

}  // namespace
}  // namespace gnomon
