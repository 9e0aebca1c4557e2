#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "gnomon/scene/gltf_test.h"

namespace gnomon {
namespace {

using gltf_test::bytesOf;
using gltf_test::Json;

/// The triangle's node 0 with animation 0, whose channel 0 has sampler 0: accessors 2 (times) and 3 (values) in keys.bin.
class GltfAnimation : public gltf_test::GltfTest {
 protected:
  Json animated(const std::string& path, const std::vector<float>& times, const std::vector<float>& values,
                const std::string& interpolation = "LINEAR") const {
    Json json = triangle();
    write("keys.bin", bytesOf(times) + bytesOf(values));
    json["buffers"].push_back({{"uri", "keys.bin"}, {"byteLength", 4 * (times.size() + values.size())}});
    json["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 4 * times.size()}});
    json["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", 4 * times.size()}, {"byteLength", 4 * values.size()}});
    const std::size_t components = path == "rotation" ? 4 : 3;
    json["accessors"].push_back({{"bufferView", 2}, {"componentType", 5126}, {"count", times.size()}, {"type", "SCALAR"}});
    json["accessors"].push_back({{"bufferView", 3},
                                 {"componentType", 5126},
                                 {"count", values.size() / components},
                                 {"type", path == "rotation" ? "VEC4" : "VEC3"}});
    json["animations"] = {{{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}},
                           {"samplers", {{{"input", 2}, {"output", 3}, {"interpolation", interpolation}}}}}};
    return json;
  }

  /// 1 m along X in 2 s.
  Json walk() const { return animated("translation", {0, 2}, {0, 0, 0, 1, 0, 0}); }

  static glm::dmat4 poseOf(const Scene& scene, double seconds, std::size_t instance = 0) {
    std::vector<glm::dmat4> worlds;
    poseAt(scene, seconds, worlds);
    return worlds.at(instance);
  }
};

TEST_F(GltfAnimation, ReadsTranslations) {
  const Scene scene = load(walk());
  EXPECT_EQ(duration(scene), 2.0);
  EXPECT_EQ(poseOf(scene, 0.5)[3], glm::dvec4(0.25, 0.0, 0.0, 1.0));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(GltfAnimation, ReadsRotations) {
  const float half = std::sqrt(0.5f);
  const Scene scene = load(animated("rotation", {0, 1}, {0, 0, 0, 1, 0, 0, half, half}));  // 90 degrees about Z
  const double cosine = std::sqrt(0.5);
  EXPECT_LT(glm::length(poseOf(scene, 0.5)[0] - glm::dvec4(cosine, cosine, 0.0, 0.0)), 1e-7);
}

TEST_F(GltfAnimation, ReadsScales) {
  const Scene scene = load(animated("scale", {0, 1}, {1, 1, 1, 3, 3, 3}));
  EXPECT_EQ(poseOf(scene, 0.5)[1], glm::dvec4(0.0, 2.0, 0.0, 0.0));
}

TEST_F(GltfAnimation, ReadsRotationsOfNormalisedIntegers) {
  Json json = animated("rotation", {0}, {0, 0, 0, 0});
  json["accessors"][3]["normalized"] = true;
  write("keys.bin", bytesOf<float>({0}) + bytesOf<std::int8_t>({0, 0, 127, 0}) + std::string(12, '\0'));
  json["accessors"][3]["componentType"] = 5120;
  EXPECT_EQ(load(json).instances[0].world[0].x, -1.0);  // 180 degrees about Z
  write("keys.bin", bytesOf<float>({0}) + bytesOf<std::int16_t>({0, 0, -32768, -32767}) + std::string(8, '\0'));
  json["accessors"][3]["componentType"] = 5122;
  EXPECT_NEAR(load(json).instances[0].world[0].x, 0.0, 1e-15);  // both are -1: 90 degrees
  json["accessors"][3]["normalized"] = false;
  EXPECT_EQ(faultOf(json), "/accessors/3");
}

TEST_F(GltfAnimation, ReadsStepsAndCubicSplines) {
  EXPECT_EQ(poseOf(load(animated("translation", {0, 2}, {0, 0, 0, 1, 0, 0}, "STEP")), 1.5)[3].x, 0.0);
  // From 0 to 1 with tangents of 0: half way at half time; a quarter at t: 3 t^2 - 2 t^3.
  const Json cubic = animated("translation", {0, 2}, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0}, "CUBICSPLINE");
  EXPECT_EQ(poseOf(load(cubic), 0.5)[3].x, 3.0 / 16.0 - 2.0 / 64.0);
}

TEST_F(GltfAnimation, InstancesStandAsAtTimeZero) {
  Json json = animated("translation", {0, 2}, {7, 0, 0, 1, 0, 0});
  json["nodes"][0]["translation"] = {1.0, 0.0, 0.0};
  EXPECT_EQ(load(json).instances[0].world[3].x, 7.0);
}

TEST_F(GltfAnimation, MovesWhatHangsOnTheNode) {
  Json json = walk();
  json["nodes"] = {{{"children", {1}}},
                   {{"children", {2}}, {"matrix", {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 5, 0, 1}}},
                   {{"mesh", 0}, {"translation", {0.0, 0.0, 1.0}}},
                   {{"children", {0, 4}}, {"translation", {10.0, 0.0, 0.0}}},
                   {{"mesh", 0}}};
  json["scenes"][0]["nodes"] = {3};
  const Scene scene = load(json);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[0].world, poseOf(scene, 0.0));
  EXPECT_EQ(poseOf(scene, 1.0)[3], glm::dvec4(10.5, 5.0, 2.0, 1.0));
  EXPECT_EQ(poseOf(scene, 1.0, 1)[3], glm::dvec4(10.0, 0.0, 0.0, 1.0));
}

TEST_F(GltfAnimation, AnimationsPlayTogetherEachAtItsOwnLength) {
  Json json = walk();
  json["nodes"].push_back({{"mesh", 0}});
  json["scenes"][0]["nodes"] = {0, 1};
  json["accessors"].push_back({{"bufferView", 2}, {"componentType", 5126}, {"count", 1}, {"type", "SCALAR"}});
  json["animations"].push_back(json["animations"][0]);
  json["animations"][1]["channels"][0]["target"]["node"] = 1;
  json["animations"][1]["samplers"][0]["input"] = 4;
  json["accessors"].push_back({{"bufferView", 3}, {"byteOffset", 12}, {"componentType", 5126}, {"count", 1}, {"type", "VEC3"}});
  json["animations"][1]["samplers"][0]["output"] = 5;
  const Scene scene = load(json);
  EXPECT_EQ(poseOf(scene, 3.0)[3].x, 0.5);
  EXPECT_EQ(poseOf(scene, 3.0, 1)[3].x, 1.0);  // of one key
  EXPECT_EQ(duration(scene), 2.0);
}

TEST_F(GltfAnimation, OfAlternativesTheFirstPlays) {
  Json json = walk();
  json["animations"].push_back(json["animations"][0]);
  json["animations"][1]["samplers"][0]["interpolation"] = "STEP";
  const Scene scene = load(json);
  EXPECT_EQ(poseOf(scene, 1.0)[3].x, 0.5);
  EXPECT_EQ(scene.warnings,
            std::vector<std::string>{"animations that move what an earlier one of the file moves are left out"});
}

TEST_F(GltfAnimation, WhatIsNotSupportedIsNamedAndStandsStill) {
  Json json = walk();
  json["animations"][0]["channels"][0]["target"]["path"] = "weights";
  const Scene weights = load(json);
  EXPECT_EQ(duration(weights), 0.0);
  EXPECT_EQ(weights.warnings, std::vector<std::string>{"animations of morph targets are not supported: they are left out"});
  json = walk();
  json["accessors"][3].erase("bufferView");
  EXPECT_EQ(duration(load(json)), 0.0);
}

TEST_F(GltfAnimation, CamerasOnAnimatedNodesStay) {
  Json json = animated("translation", {0, 2}, {7, 0, 0, 1, 0, 0});
  json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.5}}}}};
  json["nodes"][0]["camera"] = 0;
  const Scene scene = load(json);
  EXPECT_EQ(scene.camera->position.x, 7.0);
  EXPECT_EQ(scene.warnings.size(), 1u);
}

TEST_F(GltfAnimation, NodesWithoutMeshesMoveNothing) {
  Json json = walk();
  json["nodes"] = {Json::object(), {{"mesh", 0}}};
  json["scenes"][0]["nodes"] = {0, 1};
  const Scene scene = load(json);
  EXPECT_EQ(duration(scene), 0.0);
  EXPECT_TRUE(scene.animation.nodes.empty());
}

TEST_F(GltfAnimation, ReferencesOutOfRangeAreErrors) {
  const auto with = [&](const std::string& pointer, const Json& value) {
    Json json = walk();
    json[Json::json_pointer(pointer)] = value;
    return faultOf(json);
  };
  for (const int index : {-2, 99}) {
    EXPECT_EQ(with("/animations/0/channels/0/sampler", index), "/animations/0/channels/0/sampler");
    EXPECT_EQ(with("/animations/0/channels/0/target/node", index), "/animations/0/channels/0/target/node");
    EXPECT_EQ(with("/animations/0/samplers/0/input", index), "/animations/0/samplers/0/input");
    EXPECT_EQ(with("/animations/0/samplers/0/output", index), "/animations/0/samplers/0/output");
  }
}

TEST_F(GltfAnimation, UnknownWordsAreErrors) {
  Json json = walk();
  json["animations"][0]["channels"][0]["target"]["path"] = "colour";
  EXPECT_EQ(faultOf(json), "/animations/0/channels/0/target/path");
  json = walk();
  json["animations"][0]["samplers"][0]["interpolation"] = "CUBIC";
  EXPECT_EQ(faultOf(json), "/animations/0/samplers/0/interpolation");
}

TEST_F(GltfAnimation, OneAnimationMovesAPropertyOnce) {
  Json json = walk();
  json["animations"][0]["channels"].push_back(json["animations"][0]["channels"][0]);
  EXPECT_EQ(faultOf(json), "/animations/0/channels/1/target");
}

TEST_F(GltfAnimation, NodesWithAMatrixAreNotAnimated) {
  Json json = walk();
  json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_EQ(faultOf(json), "/animations/0/channels/0/target/node");
}

TEST_F(GltfAnimation, AccessorsOfTheWrongKindAreErrors) {
  Json json = walk();
  json["accessors"][2]["componentType"] = 5125;
  EXPECT_EQ(faultOf(json), "/accessors/2");
  json = walk();
  json["accessors"][3]["type"] = "VEC4";
  EXPECT_EQ(faultOf(json), "/accessors/3");
  json = animated("rotation", {0}, {0, 0, 0, 1});
  json["accessors"][3]["type"] = "VEC3";
  EXPECT_EQ(faultOf(json), "/accessors/3");
}

TEST_F(GltfAnimation, CountsThatDoNotFitAreErrors) {
  EXPECT_EQ(faultOf(animated("translation", {0, 1}, {0, 0, 0})), "/accessors/3");
  EXPECT_EQ(faultOf(animated("translation", {0}, {0, 0, 0, 1, 1, 1})), "/accessors/3");
  EXPECT_EQ(faultOf(animated("translation", {0}, {0, 0, 0, 1, 1, 1}, "CUBICSPLINE")), "/accessors/3");
  Json json = walk();
  json["accessors"][2]["count"] = 3;  // beyond its bufferView
  EXPECT_EQ(faultOf(json), "/accessors/2");
}

TEST_F(GltfAnimation, TimesAreFiniteAndStrictlyIncreasing) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  for (const std::vector<float>& times : {std::vector<float>{0, 0}, {1, 0}, {-1, 1}, {0, nan}, {nan, 1}, {0, infinity}})
    EXPECT_EQ(faultOf(animated("translation", times, {0, 0, 0, 1, 0, 0})), "/accessors/2") << times[0] << " " << times[1];
}

TEST_F(GltfAnimation, ValuesAreFinite) {
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(faultOf(animated("scale", {0, 1}, {1, 1, 1, 1, infinity, 1})), "/accessors/3");
}

TEST_F(GltfAnimation, QuaternionsHaveALength) {
  EXPECT_EQ(faultOf(animated("rotation", {0, 1}, {0, 0, 0, 1, 0, 0, 0, 0})), "/accessors/3");
  // Tangents may be zero, the value between them may not.
  EXPECT_EQ(faultOf(animated("rotation", {0}, {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0}, "CUBICSPLINE")), "none");
  EXPECT_EQ(faultOf(animated("rotation", {0}, {0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1}, "CUBICSPLINE")), "/accessors/3");
}

TEST_F(GltfAnimation, KeysOfQuaternionsNeedNoUnitLength) {
  const Scene scene = load(animated("rotation", {0}, {0, 0, 5, 0}));
  EXPECT_EQ(scene.instances[0].world[0].x, -1.0);
}

TEST_F(GltfAnimation, ValuesInAllAreBounded) {
  // 100 animations that name the same 100000 times over and over, as a small file may.
  constexpr std::size_t keys = 100000;
  std::vector<float> times(keys);
  for (std::size_t i = 0; i < keys; ++i) times[i] = static_cast<float>(i);
  Json json = animated("translation", times, std::vector<float>(3 * keys, 0.0f));
  for (int i = 1; i < 100; ++i) {
    json["animations"].push_back(json["animations"][0]);
    json["nodes"].push_back(Json::object());
    json["animations"][static_cast<std::size_t>(i)]["channels"][0]["target"]["node"] = i;
  }
  EXPECT_EQ(faultOf(json).rfind("/animations/", 0), 0u);
}

TEST_F(GltfAnimation, PosesThatOverflowAreErrorsAtTimeZeroAndLeftOutLater) {
  // 10^38 times itself three times is beyond 10^100.
  const auto chain = [&](float first) {
    Json json = animated("scale", {0, 1, 2}, {first, 1, 1, 1e38f, 1, 1, 1, 1, 1});
    json["nodes"] = {{{"children", {1}}}, {{"children", {2}}}, {{"mesh", 0}}};
    json["animations"][0]["channels"].push_back(json["animations"][0]["channels"][0]);
    json["animations"][0]["channels"].push_back(json["animations"][0]["channels"][0]);
    json["animations"][0]["channels"][1]["target"]["node"] = 1;
    json["animations"][0]["channels"][2]["target"]["node"] = 2;
    return json;
  };
  EXPECT_EQ(faultOf(chain(1e38f)), "/nodes/2");
  const Scene scene = load(chain(2.0f));
  EXPECT_EQ(poseOf(scene, 1.0)[0].x, 8.0);
}

}  // namespace
}  // namespace gnomon
