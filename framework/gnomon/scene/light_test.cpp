#include "gnomon/scene/light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <numbers>

#include "gnomon/base/error.h"
#include "gnomon/base/json.h"

namespace gnomon {
namespace {

constexpr double kPi = std::numbers::pi;

Light spotWith(SourceShape shape) {
  Light light;
  light.source.shape = shape;
  light.source.size = shape == SourceShape::rectangle ? glm::dvec2(2.0, 1.0) : glm::dvec2(0.0);
  light.source.radius = shape == SourceShape::disc ? 1.5 : 0.0;
  return light;
}

/// The mean of f over an n x n grid of sample points.
template <class F>
auto meanOver(int n, const F& f) {
  decltype(f(glm::dvec2())) sum{};
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) sum += f((glm::dvec2(i, j) + 0.5) / static_cast<double>(n));
  return sum / static_cast<double>(n * n);
}

void expectNear(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
  EXPECT_LT(glm::length(a - b), tolerance);
}

void expectOrthonormal(const LightFrame& f) {
  expectNear(glm::cross(f.x, f.y), f.z, 1e-14);
  expectNear(glm::cross(f.y, f.z), f.x, 1e-14);
  EXPECT_NEAR(glm::length(f.z), 1.0, 1e-14);
}

TEST(LightFrame, LooksAlongMinusZWithXPerpendicularToUp) {
  Light light;
  light.position = {3.0, 4.0, 0.0};
  const LightFrame frame = lightFrame(light);
  expectOrthonormal(frame);
  expectNear(frame.z, {0.6, 0.8, 0.0}, 1e-15);
  expectNear(frame.x, {0.0, 0.0, -1.0}, 1e-15);
}

TEST(LightFrame, ParallelUpFallsBackToMinusZ) {
  const LightFrame frame = lightFrame(Light{});  // straight down, up straight up
  expectNear(frame.x, {1.0, 0.0, 0.0}, 1e-15);
  expectNear(frame.y, {0.0, 0.0, -1.0}, 1e-15);
}

TEST(LightFrame, ParallelUpAlongMinusZFallsBackToX) {
  Light light;
  light.position = {0.0, 0.0, 5.0};
  light.up = {0.0, 0.0, 2.0};
  const LightFrame frame = lightFrame(light);
  expectOrthonormal(frame);
  EXPECT_NEAR(glm::dot(frame.x, {1.0, 0.0, 0.0}), 0.0, 1e-15);
}

TEST(LightFrame, NearlyParallelUpStaysOrthonormal) {
  for (const double tilt : {1e-12, 1e-7, 1e-6, 1.1e-6, 1e-5}) {
    Light light;
    light.up = {tilt, 1.0, 0.0};
    expectOrthonormal(lightFrame(light));
  }
}

TEST(LightFrame, UpCountsFromASineOfAMillionth) {
  Light light;  // straight down
  light.up = {2e-6, 1.0, 0.0};
  expectNear(lightFrame(light).x, {0.0, 0.0, 1.0}, 1e-9);
  light.up = {5e-7, 1.0, 0.0};
  expectNear(lightFrame(light).x, {1.0, 0.0, 0.0}, 1e-9);
}

TEST(LightFrame, IsTheSameUnderAWorldOffset) {
  Light light;
  light.position = {3.0, 4.0, 1.0};
  const LightFrame near = lightFrame(light);
  light.position += 1e6;
  light.target += 1e6;
  const LightFrame far = lightFrame(light);
  expectNear(near.z, far.z, 1e-15);
  expectNear(near.x, far.x, 1e-15);
}

TEST(LightFrame, RollTurnsXTowardsY) {
  Light light;
  const LightFrame plain = lightFrame(light);
  light.source.rollDegrees = 90.0;
  const LightFrame rolled = lightFrame(light);
  expectNear(rolled.x, plain.y, 1e-15);
  expectNear(rolled.y, -plain.x, 1e-15);
}

TEST(HasExtent, NeedsASizeThatBelongsToTheType) {
  Light light;
  light.radius = 1.0;
  light.angularDiameterDegrees = 1.0;
  EXPECT_FALSE(hasExtent(light));  // a spot without source
  light.type = LightType::point;
  EXPECT_TRUE(hasExtent(light));
  light.type = LightType::directional;
  EXPECT_TRUE(hasExtent(light));
  light.angularDiameterDegrees = 0.0;
  EXPECT_FALSE(hasExtent(light));
}

TEST(HasExtent, OneSideOfARectangleIsEnough) {
  Light light = spotWith(SourceShape::rectangle);
  light.source.size = {0.0, 1.0};
  EXPECT_TRUE(hasExtent(light));
  light.source.size = {0.0, 0.0};
  EXPECT_FALSE(hasExtent(light));
}

TEST(SourceDiameter, IsTheSmallestDiscs) {
  EXPECT_DOUBLE_EQ(sourceDiameter(spotWith(SourceShape::rectangle)), std::sqrt(5.0));
  EXPECT_DOUBLE_EQ(sourceDiameter(spotWith(SourceShape::disc)), 3.0);
}

TEST(SampleSource, RectangleSpansItsSizeAlongXAndY) {
  const Light light = spotWith(SourceShape::rectangle);
  const LightFrame frame = lightFrame(light);
  expectNear(sampleSource(light, frame, {1.0, 0.0}, {}), frame.origin + frame.x * 1.0 - frame.y * 0.5, 1e-15);
}

TEST(SampleSource, DiscIsUniformInArea) {
  const Light light = spotWith(SourceShape::disc);
  const LightFrame frame = lightFrame(light);
  // Uniform over a disc: mean of r^2 is R^2 / 2, mean of x^2 is R^2 / 4, mean of r is 2 R / 3.
  const auto local = [&](const glm::dvec2& u) { return sampleSource(light, frame, u, {}) - frame.origin; };
  EXPECT_NEAR(meanOver(200, [&](auto u) { return glm::dot(local(u), local(u)); }), 1.125, 1e-4);
  EXPECT_NEAR(meanOver(200, [&](auto u) { return std::pow(glm::dot(local(u), frame.x), 2.0); }), 0.5625, 1e-4);
  EXPECT_NEAR(meanOver(200, [&](auto u) { return glm::length(local(u)); }), 1.0, 1e-4);
}

TEST(SampleSource, DirectionsAreUniformInSolidAngle) {
  Light light;
  light.type = LightType::directional;
  light.angularDiameterDegrees = 120.0;
  const LightFrame frame = lightFrame(light);
  // Uniform over a cap of half angle t: cosines are uniform in [cos t, 1], so their mean is (1 + cos t) / 2 and their mean
  // square (1 + cos t + cos^2 t) / 3.
  const auto cosine = [&](const glm::dvec2& u) { return glm::dot(sampleSource(light, frame, u, {}), frame.z); };
  EXPECT_NEAR(meanOver(200, cosine), 0.75, 1e-4);
  EXPECT_NEAR(meanOver(200, [&](auto u) { return cosine(u) * cosine(u); }), 1.75 / 3.0, 1e-4);
  EXPECT_NEAR(cosine({0.0, 0.5}), 0.5, 1e-12);  // the rim
}

TEST(SampleSource, ATinySunKeepsItsShape) {
  Light light;
  light.type = LightType::directional;
  light.angularDiameterDegrees = 2e-7;  // half angle 1.75e-9: its cosine is 1 in double
  const LightFrame frame = lightFrame(light);
  const glm::dvec3 rim = sampleSource(light, frame, {1.0, 0.5}, {});
  EXPECT_NEAR(glm::dot(rim, frame.x) / (1e-7 * kPi / 180.0), 1.0, 1e-9);
}

TEST(SampleSource, SphereIsUniformInSolidAngleFromTheReceiver) {
  Light light;
  light.type = LightType::point;
  light.radius = 3.0;
  const LightFrame frame = lightFrame(light);
  const glm::dvec3 receiver = frame.origin + glm::dvec3(0.0, 0.0, 5.0);  // sine of the half angle 0.6, cosine 0.8
  const auto cosine = [&](const glm::dvec2& u) {
    return -glm::normalize(sampleSource(light, frame, u, receiver) - receiver).z;
  };
  EXPECT_NEAR(meanOver(200, cosine), 0.9, 1e-4);
  EXPECT_NEAR(meanOver(200, [&](auto u) { return cosine(u) * cosine(u); }), (1.0 + 0.8 + 0.64) / 3.0, 1e-4);
}

TEST(SampleSource, SpherePointsLieOnItsNearSide) {
  Light light;
  light.type = LightType::point;
  light.radius = 2.0;
  const LightFrame frame = lightFrame(light);
  const glm::dvec3 receiver{1.0, -3.0, 4.0};
  const glm::dvec3 outward = receiver - frame.origin;
  const double worst = meanOver(50, [&](auto u) {
    const glm::dvec3 p = sampleSource(light, frame, u, receiver) - frame.origin;
    const bool visible = glm::dot(p, outward) >= light.radius * light.radius - 1e-9;  // the polar plane of the receiver
    return std::abs(glm::length(p) - light.radius) + (visible ? 0.0 : 1.0);
  });
  EXPECT_LT(worst, 1e-12);
}

TEST(SampleSource, InsideASphereEverySampleIsItsCentre) {
  Light light;
  light.type = LightType::point;
  light.radius = 2.0;
  const LightFrame frame = lightFrame(light);
  EXPECT_EQ(sampleSource(light, frame, {0.1, 0.9}, frame.origin + 1.0), frame.origin);
}

TEST(InReach, ConeAndFrontDecide) {
  Light light;  // at height 10, 30 degrees: radius 5.7735 on the ground
  const LightFrame frame = lightFrame(light);
  EXPECT_TRUE(inReach(light, frame, {5.77, 0.0, 0.0}));
  EXPECT_FALSE(inReach(light, frame, {5.78, 0.0, 0.0}));
  EXPECT_FALSE(inReach(light, frame, {0.0, 20.0, 0.0}));
}

TEST(InReach, NinetyDegreesIsAllInFront) {
  Light light;
  light.coneHalfAngleDegrees = 90.0;
  const LightFrame frame = lightFrame(light);
  EXPECT_TRUE(inReach(light, frame, {1e6, 9.0, 0.0}));
  EXPECT_FALSE(inReach(light, frame, {1e6, 10.0, 0.0}));
}

TEST(InReach, TheLightItselfIsNot) {
  const Light light;
  EXPECT_FALSE(inReach(light, lightFrame(light), light.position));
}

TEST(TowardsCentre, IsFiniteAtTheLightItself) {
  const Light light;
  EXPECT_EQ(towardsCentre(light, lightFrame(light), light.position), glm::dvec3(0.0, 1.0, 0.0));
}

/// The pointers that reading this text as a light complains of.
std::vector<std::string> faults(const std::string& text, Light* light = nullptr) {
  Problems problems;
  Light read;
  readObject(Json::parse(text), *lightTable(), &read, {"f", "/lights/0"}, problems);
  if (light != nullptr) *light = read;
  std::vector<std::string> pointers;
  for (const Problem& problem : problems.list()) pointers.push_back(problem.pointer);
  return pointers;
}

using Pointers = std::vector<std::string>;

TEST(LightTable, ReadsTheDesignsExample) {
  Light light;
  EXPECT_EQ(faults(R"({"type": "spot", "position": [6, 10, 4], "target": [0, 0, 0], "cone_half_angle_degrees": 30,
                       "source": {"shape": "rectangle", "size": [1, 2], "roll_degrees": 5}})",
                   &light),
            Pointers{});
  EXPECT_EQ(light.source.size, glm::dvec2(1.0, 2.0));
  EXPECT_EQ(light.source.rollDegrees, 5.0);
}

TEST(LightTable, NamesAreAnyTextAndCanBeTakenOff) {
  Light light;
  EXPECT_EQ(faults(R"({"type": "spot", "intensity": 2, "name": "Küche, \"links\""})", &light), Pointers{});
  EXPECT_EQ(light.name, "Küche, \"links\"");
  const Light bare = withoutName(light);
  EXPECT_EQ(bare.name, "");
  EXPECT_EQ(bare.intensity, 2.0);
}

TEST(LightTable, SourcesWithoutExtentAreLegal) {
  EXPECT_EQ(faults(R"({"type": "spot", "source": {"shape": "rectangle", "size": [0, 0]}})"), Pointers{});
}

TEST(LightTable, ALightWithoutDirectionIsAnError) {
  EXPECT_EQ(faults(R"({"type": "directional", "position": [1, 1, 1], "target": [1, 1, 1]})"), Pointers{"/lights/0/target"});
}

TEST(LightTable, APointLightNeedsNoTarget) {
  EXPECT_EQ(faults(R"({"type": "point", "position": [0, 0, 0], "radius": 1})"), Pointers{});
}

TEST(LightTable, ConesAreAboveZeroAndAtMostNinety) {
  EXPECT_EQ(faults(R"({"type": "spot", "cone_half_angle_degrees": 90})"), Pointers{});
  EXPECT_EQ(faults(R"({"type": "spot", "cone_half_angle_degrees": 0})"), Pointers{"/lights/0/cone_half_angle_degrees"});
  EXPECT_EQ(faults(R"({"type": "spot", "cone_half_angle_degrees": 90.1})"), Pointers{"/lights/0/cone_half_angle_degrees"});
}

TEST(LightTable, KeysOfOtherTypesAreErrors) {
  EXPECT_EQ(faults(R"({"type": "point", "angular_diameter_degrees": 1})"), Pointers{"/lights/0/angular_diameter_degrees"});
  EXPECT_EQ(faults(R"({"type": "directional", "radius": 1})"), Pointers{"/lights/0/radius"});
  EXPECT_EQ(faults(R"({"type": "point", "source": {"shape": "disc", "radius": 1}})"), Pointers{"/lights/0/source"});
}

TEST(LightTable, KeysOfOtherShapesAreErrors) {
  EXPECT_EQ(faults(R"({"type": "spot", "source": {"shape": "none", "size": [1, 1]}})"), Pointers{"/lights/0/source/size"});
  EXPECT_EQ(faults(R"({"type": "spot", "source": {"shape": "rectangle", "radius": 1}})"), Pointers{"/lights/0/source/radius"});
}

}  // namespace
}  // namespace gnomon
