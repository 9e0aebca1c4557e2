#include "gnomon/scene/animation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>

#include "gnomon/scene/builtin.h"
#include "gnomon/scene/scene.h"

namespace gnomon {
namespace {

AnimationChannel channelOf(AnimatedProperty property, Interpolation interpolation, std::vector<double> times,
                           std::vector<glm::dvec4> values) {
  const double period = times.back();
  return {property, interpolation, period, std::move(times), std::move(values)};
}

/// A walk along X: 0 m at 0 s, 2 m at 1 s, 3 m at 4 s.
AnimationChannel walk(Interpolation interpolation) {
  return channelOf(AnimatedProperty::translation, interpolation, {0.0, 1.0, 4.0},
                   {{0.0, 0.0, 0.0, 0.0}, {2.0, 0.0, 0.0, 0.0}, {3.0, 0.0, 0.0, 0.0}});
}

glm::dvec4 turn(const glm::dvec3& axis, double degrees) {
  const double half = glm::radians(degrees) / 2.0;
  return {std::sin(half) * axis, std::cos(half)};
}

double xAt(const AnimationChannel& channel, double seconds) {
  return posed({}, {&channel, 1}, seconds).translation.x;
}

/// The angle about Z by which the channel turns X.
double degreesAt(const AnimationChannel& channel, double seconds) {
  const glm::dvec4 x = matrixOf(posed({}, {&channel, 1}, seconds))[0];
  return glm::degrees(std::atan2(x.y, x.x));
}

/// One instance for each node that is named, of one triangle.
Scene sceneWith(std::vector<Animation::Node> nodes, const std::vector<std::uint32_t>& ridden) {
  Scene scene;
  scene.meshes.push_back(quadMesh(1.0, 1.0));
  scene.materials.emplace_back();
  scene.animation.nodes = std::move(nodes);
  for (const std::uint32_t node : ridden) {
    scene.animation.riders.push_back({static_cast<std::uint32_t>(scene.instances.size()), node});
    scene.instances.emplace_back();
  }
  return scene;
}

std::vector<glm::dmat4> poseOf(const Scene& scene, double seconds) {
  std::vector<glm::dmat4> worlds;
  poseAt(scene, seconds, worlds);
  return worlds;
}

double distance(const glm::dmat4& a, const glm::dmat4& b) {
  double greatest = 0.0;
  for (int i = 0; i < 4; ++i) greatest = std::max(greatest, glm::length(a[i] - b[i]));
  return greatest;
}

TEST(AnimationChannel, LinearGoesStraightBetweenKeys) {
  const AnimationChannel channel = walk(Interpolation::linear);
  EXPECT_EQ(xAt(channel, 0.25), 0.5);
  EXPECT_EQ(xAt(channel, 1.0), 2.0);
  EXPECT_EQ(xAt(channel, 2.5), 2.5);
}

TEST(AnimationChannel, StepStaysUntilTheNextKey) {
  const AnimationChannel channel = walk(Interpolation::step);
  EXPECT_EQ(xAt(channel, 0.999), 0.0);
  EXPECT_EQ(xAt(channel, 1.0), 2.0);
  EXPECT_EQ(xAt(channel, 3.999), 2.0);
}

TEST(AnimationChannel, CubicSplinesReproduceCubics) {
  // x(t) = t^3 - 2 t has x' = 3 t^2 - 2; Hermite's interpolation of its keys is that polynomial itself.
  const auto x = [](double t) { return t * t * t - 2.0 * t; };
  AnimationChannel channel = channelOf(AnimatedProperty::translation, Interpolation::cubicSpline, {0.0, 0.5, 2.0}, {});
  for (const double t : channel.times)
    for (const double value : {3.0 * t * t - 2.0, x(t), 3.0 * t * t - 2.0}) channel.values.emplace_back(value, 0.0, 0.0, 0.0);
  for (double t = 0.0; t < 2.0; t += 0.0625) EXPECT_NEAR(xAt(channel, t), x(t), 1e-14) << t;
}

TEST(AnimationChannel, InTangentsBelongToTheKeyAhead) {
  // From 0 to 0 in 1 s, leaving with slope 0 and arriving with slope 8: x = 8 (t^3 - t^2), -1 half way.
  AnimationChannel channel = channelOf(AnimatedProperty::translation, Interpolation::cubicSpline, {0.0, 1.0},
                                       std::vector<glm::dvec4>(6, glm::dvec4(0.0)));
  channel.values[3].x = 8.0;
  EXPECT_EQ(xAt(channel, 0.5), -1.0);
}

TEST(AnimationChannel, RotationsKeepTheirSpeed) {
  const AnimationChannel channel = channelOf(AnimatedProperty::rotation, Interpolation::linear, {0.0, 1.0},
                                             {turn({0.0, 0.0, 1.0}, 20.0), turn({0.0, 0.0, 1.0}, 140.0)});
  EXPECT_NEAR(degreesAt(channel, 0.25), 50.0, 1e-12);
  EXPECT_NEAR(degreesAt(channel, 0.5), 80.0, 1e-12);
}

TEST(AnimationChannel, RotationsTakeTheShorterArc) {
  const AnimationChannel channel = channelOf(AnimatedProperty::rotation, Interpolation::linear, {0.0, 1.0},
                                             {turn({0.0, 0.0, 1.0}, 0.0), -turn({0.0, 0.0, 1.0}, 60.0)});
  EXPECT_NEAR(degreesAt(channel, 0.5), 30.0, 1e-12);
}

TEST(AnimationChannel, CubicRotationsAreUnitQuaternions) {
  const glm::dvec4 still(0.0);
  const AnimationChannel channel =
      channelOf(AnimatedProperty::rotation, Interpolation::cubicSpline, {0.0, 1.0},
                {still, turn({0.0, 0.0, 1.0}, 0.0), still, still, turn({0.0, 0.0, 1.0}, 90.0), still});
  const NodeTransform pose = posed({}, {&channel, 1}, 0.5);
  EXPECT_NEAR(glm::length(pose.rotation), 1.0, 1e-15);
  EXPECT_NEAR(degreesAt(channel, 0.5), 45.0, 1e-12);  // by symmetry
}

TEST(AnimationChannel, ACubicRotationThroughZeroIsStillOne) {
  const glm::dvec4 still(0.0);
  const glm::dvec4 key = turn({0.0, 0.0, 1.0}, 30.0);
  const AnimationChannel channel =
      channelOf(AnimatedProperty::rotation, Interpolation::cubicSpline, {0.0, 1.0}, {still, key, still, still, -key, still});
  EXPECT_NEAR(degreesAt(channel, 0.5), 30.0, 1e-12);
}

TEST(AnimationChannel, HoldsItsFirstAndLastValue) {
  AnimationChannel channel = walk(Interpolation::linear);
  channel.times = {1.0, 2.0, 3.0};
  EXPECT_EQ(xAt(channel, 0.5), 0.0);
  EXPECT_EQ(xAt(channel, 3.5), 3.0);
}

TEST(AnimationChannel, RepeatsWithItsPeriod) {
  const AnimationChannel channel = walk(Interpolation::linear);
  EXPECT_EQ(xAt(channel, 4.0), xAt(channel, 0.0));
  EXPECT_EQ(xAt(channel, 400.25), 0.5);
  EXPECT_EQ(xAt(channel, -3.75), 0.5);
}

TEST(AnimationChannel, WithoutPeriodIsConstant) {
  const AnimationChannel channel =
      channelOf(AnimatedProperty::translation, Interpolation::linear, {0.0}, {{5.0, 0.0, 0.0, 0.0}});
  EXPECT_EQ(xAt(channel, 3.0), 5.0);
}

TEST(Posed, LeavesWhatNoChannelNames) {
  const NodeTransform rest{{1.0, 2.0, 3.0}, {0.0, 1.0, 0.0, 0.0}, {4.0, 5.0, 6.0}};
  const AnimationChannel channel = channelOf(AnimatedProperty::scale, Interpolation::step, {0.0}, {{7.0, 8.0, 9.0, 0.0}});
  const NodeTransform pose = posed(rest, {&channel, 1}, 0.0);
  EXPECT_EQ(pose.translation, rest.translation);
  EXPECT_EQ(pose.rotation, rest.rotation);
  EXPECT_EQ(pose.scale, glm::dvec3(7.0, 8.0, 9.0));
}

TEST(PoseAt, OfAnUnanimatedSceneIsItsTransforms) {
  const Scene scene = findBuiltinScene("pillars")->make({});
  const std::vector<glm::dmat4> worlds = poseOf(scene, 7.3);
  ASSERT_EQ(worlds.size(), scene.instances.size());
  for (std::size_t i = 0; i < worlds.size(); ++i) EXPECT_EQ(worlds[i], scene.instances[i].world) << i;
  EXPECT_EQ(duration(scene), 0.0);
}

TEST(PoseAt, MultipliesTheHierarchy) {
  // A turntable of 90 degrees a second at (10, 0, 0); on it, 2 m out along X behind a scale of 3, a node that walks.
  Animation::Node table;
  table.before[3] = {10.0, 0.0, 0.0, 1.0};
  table.channels = {channelOf(AnimatedProperty::rotation, Interpolation::linear, {0.0, 1.0, 2.0},
                              {turn({0.0, 0.0, 1.0}, 0.0), turn({0.0, 0.0, 1.0}, 90.0), turn({0.0, 0.0, 1.0}, 180.0)})};
  Animation::Node walker;
  walker.parent = 0;
  walker.before = glm::dmat4(3.0);
  walker.before[3] = {2.0, 0.0, 0.0, 1.0};
  walker.channels = {walk(Interpolation::linear)};
  const Scene scene = sceneWith({table, walker}, {1});
  const std::vector<glm::dmat4> worlds = poseOf(scene, 1.0);  // the walker is 2 m on, in units of 3 m
  EXPECT_LT(glm::length(worlds[0][3] - glm::dvec4(10.0, 8.0, 0.0, 1.0)), 1e-14);
  EXPECT_LT(glm::length(worlds[0][0] - glm::dvec4(0.0, 3.0, 0.0, 0.0)), 1e-14);
  EXPECT_EQ(duration(scene), 4.0);
}

TEST(PoseAt, AddsTheOffsetInTheWorld) {
  Animation::Node node;
  node.rest.rotation = {std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)};
  node.channels = {walk(Interpolation::linear)};
  Scene scene = sceneWith({node}, {0});
  scene.animation.riders[0].offset = {0.0, 10.0, 0.5};
  EXPECT_EQ(poseOf(scene, 1.0)[0][3], glm::dvec4(2.0, 10.0, 0.5, 1.0));
}

TEST(PoseAt, KeepsTheTransformWhereAPoseIsNotUsable) {
  Animation::Node node;
  node.before *= 1e300;
  node.channels = {walk(Interpolation::linear)};
  Scene scene = sceneWith({node}, {0});
  scene.instances[0].world[3].x = 5.0;
  EXPECT_EQ(poseOf(scene, 1.0)[0], scene.instances[0].world);
}

TEST(PoseAt, WorksInTheMemoryOfItsResult) {
  std::vector<glm::dmat4> worlds;
  worlds.reserve(1000);
  const glm::dmat4* const memory = worlds.data();
  poseAt(findBuiltinScene("animated")->make({}), 1.0, worlds);
  EXPECT_EQ(worlds.data(), memory);
  EXPECT_EQ(worlds.capacity(), 1000u);
}

TEST(AnimatedScene, StandsInItsFirstPose) {
  const Scene scene = findBuiltinScene("animated")->make({});
  const std::vector<glm::dmat4> worlds = poseOf(scene, 0.0);
  for (std::size_t i = 0; i < worlds.size(); ++i) EXPECT_EQ(worlds[i], scene.instances[i].world) << i;
}

TEST(AnimatedScene, ClosesWithoutAJump) {
  const Scene scene = findBuiltinScene("animated")->make({});
  const double period = duration(scene);
  EXPECT_EQ(period, 4.0);
  const std::vector<glm::dmat4> first = poseOf(scene, 0.0);
  const std::vector<glm::dmat4> whole = poseOf(scene, period);
  const std::vector<glm::dmat4> justBefore = poseOf(scene, std::nextafter(period, 0.0));
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_LT(distance(first[i], whole[i]), 1e-12) << scene.instances[i].name;
    EXPECT_LT(distance(first[i], justBefore[i]), 1e-12) << scene.instances[i].name;
  }
}

TEST(AnimatedScene, MovesAllButFloorAndMast) {
  const Scene scene = findBuiltinScene("animated")->make({});
  const std::vector<glm::dmat4> later = poseOf(scene, 0.6);
  for (std::size_t i = 0; i < later.size(); ++i) {
    const std::string& name = scene.instances[i].name;
    EXPECT_EQ(distance(later[i], scene.instances[i].world) > 0.05, name != "floor" && name != "mast") << name;
  }
}

TEST(AnimatedScene, StaysAboveItsFloor) {
  Scene scene = findBuiltinScene("animated")->make({});
  for (double seconds = 0.0; seconds < 4.0; seconds += 0.05) {
    setPose(scene, seconds);
    EXPECT_GE(worldBounds(scene).min.y, -1e-12) << seconds;
    EXPECT_LE(worldBounds(scene).max.x, 4.0) << seconds;
  }
}

TEST(AnimatedScene, TheWalkerKeepsToItsCircle) {
  // A cubic through four points of a circle with its tangents there: Hermite's quarter is within 1 % of the radius.
  Scene scene = findBuiltinScene("animated")->make({});
  for (double seconds = 0.0; seconds < 4.0; seconds += 0.05) {
    setPose(scene, seconds);
    for (const Instance& instance : scene.instances) {
      if (instance.name != "walker") continue;
      const glm::dvec2 from = glm::dvec2(instance.world[3].x, instance.world[3].z) - glm::dvec2(0.9, 1.1);
      EXPECT_NEAR(glm::length(from), 1.2, 0.02) << seconds;
    }
  }
}

}  // namespace
}  // namespace gnomon
