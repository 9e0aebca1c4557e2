#include "gnomon/scene/gltf.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>

#include "gnomon/scene/gltf_test.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using gltf_test::bytesOf;
using gltf_test::Json;

class Gltf : public gltf_test::GltfTest {};

TEST_F(Gltf, ReadsATriangle) {
  const Scene scene = load(triangle());
  ASSERT_EQ(scene.triangles(), 1u);
  EXPECT_EQ(scene.instances[0].name, "thing");
  EXPECT_EQ(scene.meshes[0].positions[1], glm::vec3(1.0f, 0.0f, 0.0f));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(Gltf, ComputesMissingNormals) {
  EXPECT_EQ(load(triangle()).meshes[0].normals[2], glm::vec3(0.0f, 0.0f, 1.0f));
}

TEST_F(Gltf, ComputedNormalsAreWeightedByArea) {
  // Two triangles share the edge 0-1: one in z = 0 of area 1/2, one in y = 0 of area 1: the sum of their area vectors is
  // (0, 2, 1) up to scale.
  const std::string positions = bytesOf<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, -2});
  const Scene scene = load(withData(positions, bytesOf<std::uint16_t>({0, 1, 2, 0, 1, 3}), 5123, 6));
  const glm::dvec3 expected = glm::normalize(glm::dvec3(0.0, 2.0, 1.0));
  EXPECT_LT(glm::length(glm::dvec3(scene.meshes[0].normals[0]) - expected), 1e-7);
}

TEST_F(Gltf, ReadsEveryWidthOfIndex) {
  const std::string positions = bytesOf<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const std::vector<std::uint32_t> expected{2, 0, 1};
  EXPECT_EQ(load(withData(positions, bytesOf<std::uint8_t>({2, 0, 1}), 5121, 3)).meshes[0].indices, expected);
  EXPECT_EQ(load(withData(positions, bytesOf<std::uint16_t>({2, 0, 1}), 5123, 3)).meshes[0].indices, expected);
  EXPECT_EQ(load(withData(positions, bytesOf<std::uint32_t>({2, 0, 1}), 5125, 3)).meshes[0].indices, expected);
}

TEST_F(Gltf, ReadsIndicesBeyond16Bits) {
  std::vector<float> positions(3 * 65537, 0.0f);
  positions.back() = 7.0f;
  const Scene scene = load(withData(bytesOf(positions), bytesOf<std::uint32_t>({0, 1, 65536}), 5125, 3));
  EXPECT_EQ(scene.meshes[0].positions.back().z, 7.0f);
}

TEST_F(Gltf, ReadsPlainTriangles) {
  Json json = triangle();
  json["meshes"][0]["primitives"][0].erase("indices");
  EXPECT_EQ(load(json).meshes[0].indices, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST_F(Gltf, ReadsStridedPositions) {
  Json json = withData(bytesOf<float>({0, 0, 0, 9, 1, 0, 0, 9, 0, 1, 0, 9}), bytesOf<std::uint16_t>({0, 1, 2}), 5123, 3);
  json["bufferViews"][0]["byteStride"] = 16;
  json["accessors"][0]["count"] = 3;
  EXPECT_EQ(load(json).meshes[0].positions[2], glm::vec3(0.0f, 1.0f, 0.0f));
}

TEST_F(Gltf, ReadsBinaryFiles) {
  Json json = triangle();
  json["buffers"][0].erase("uri");
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::string data = bytesOf<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}) + bytesOf<std::uint16_t>({0, 1, 2, 0});
  const auto u32 = [](std::size_t value) { return bytesOf<std::uint32_t>({static_cast<std::uint32_t>(value)}); };
  const std::string file = "glTF" + u32(2) + u32(28 + text.size() + data.size()) + u32(text.size()) + "JSON" + text +
                           u32(data.size()) + std::string("BIN\0", 4) + data;
  EXPECT_EQ(loadGltf(write("whole.glb", file)).triangles(), 1u);
  // A file cut anywhere is an error, and so is one whose last chunk claims to go beyond its end.
  for (std::size_t length = 4; length < file.size(); length += 7)
    EXPECT_EQ(faultOf(write("cut.glb", file.substr(0, length))), "") << length;
  std::string beyond = file;
  beyond.replace(20 + text.size(), 4, u32(data.size() + 8));
  EXPECT_EQ(faultOf(write("beyond.glb", beyond)), "");
}

TEST_F(Gltf, CombinesTransformsInDouble) {
  Json json = triangle();
  json["scenes"][0]["nodes"] = {1};
  json["nodes"] = {{{"mesh", 0}, {"translation", {-1e8, 0.0, 0.0}}},
                   {{"children", {0}}, {"translation", {1e8 + 0.25, 0.0, 0.0}}}};
  EXPECT_EQ(load(json).instances[0].world[3].x, 0.25);
}

TEST_F(Gltf, ParentsTransformTheirChildren) {
  Json json = triangle();
  json["scenes"][0]["nodes"] = {1};
  json["nodes"] = {{{"mesh", 0}, {"translation", {1.0, 0.0, 0.0}}}, {{"children", {0}}, {"scale", {2.0, 2.0, 2.0}}}};
  EXPECT_EQ(load(json).instances[0].world[3].x, 2.0);
}

TEST_F(Gltf, AppliesScaleThenRotationThenTranslation) {
  Json json = triangle();
  const double half = std::sqrt(0.5);
  json["nodes"][0]["scale"] = {2.0, 1.0, 1.0};
  json["nodes"][0]["rotation"] = {0.0, 0.0, half, half};  // 90 degrees about Z: x to y
  json["nodes"][0]["translation"] = {0.0, 0.0, 5.0};
  const Scene scene = load(json);
  EXPECT_LT(glm::length(worldTriangle(scene, scene.instances[0], 0).b - glm::dvec3(0.0, 2.0, 5.0)), 1e-15);
}

TEST_F(Gltf, MatricesAreColumnMajor) {
  Json json = triangle();
  json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1};
  EXPECT_EQ(load(json).instances[0].world[3], glm::dvec4(7.0, 8.0, 9.0, 1.0));
}

TEST_F(Gltf, NodesOfOneMeshShareIt) {
  Json json = triangle();
  json["nodes"].push_back({{"mesh", 0}});
  json["scenes"][0]["nodes"] = {0, 1};
  const Scene scene = load(json);
  EXPECT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.instances[1].name, "node_1");
}

TEST_F(Gltf, OnlyTheDefaultSceneIsShown) {
  Json json = triangle();
  json["nodes"].push_back({{"mesh", 0}, {"name", "other"}});
  json["scenes"].push_back({{"nodes", {1}}});
  json["scene"] = 1;
  EXPECT_EQ(load(json).instances[0].name, "other");
}

TEST_F(Gltf, ReadsMaterials) {
  Json json = triangle();
  json["materials"] = {
      {{"name", "red"}, {"doubleSided", true}, {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 0, 1}}}}}};
  json["meshes"][0]["primitives"][0]["material"] = 0;
  const Scene scene = load(json);
  EXPECT_EQ(scene.materials[scene.instances[0].material].albedo, glm::vec3(0.5f, 0.25f, 0.0f));
  EXPECT_TRUE(scene.materials[0].doubleSided);
}

TEST_F(Gltf, CountsAndDropsTrianglesThatAreNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::string positions = bytesOf<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, nan, 0, 0});
  const Scene scene = load(withData(positions, bytesOf<std::uint16_t>({0, 1, 2, 0, 1, 3}), 5123, 6));
  EXPECT_EQ(scene.triangles(), 1u);
  EXPECT_EQ(scene.meshes[0].positions.size(), 3u);
  EXPECT_EQ(scene.warnings, std::vector<std::string>{"1 triangles with a vertex that is not finite were dropped"});
}

TEST_F(Gltf, FramesASceneWithoutCamera) {
  const Scene scene = load(triangle());
  ASSERT_TRUE(scene.camera.has_value());
  const auto planes = frustumPlanes(*scene.camera, 1.0);
  const Triangle t = worldTriangle(scene, scene.instances[0], 0);
  for (const glm::dvec4& plane : planes)
    for (const glm::dvec3& p : {t.a, t.b, t.c})
      EXPECT_GT(glm::dot(glm::dvec3(plane), p - scene.camera->position) + plane.w, 0.0);
}

TEST_F(Gltf, ReadsACamera) {
  Json json = triangle();
  json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.5}}}}};
  json["nodes"].push_back({{"camera", 0}, {"translation", {1.0, 2.0, 3.0}}});
  json["scenes"][0]["nodes"] = {0, 1};
  const Camera camera = load(json).camera.value();
  EXPECT_DOUBLE_EQ(camera.verticalFovDegrees, glm::degrees(1.0));
  EXPECT_EQ(camera.target, glm::dvec3(1.0, 2.0, 2.0));
  EXPECT_EQ(camera.near, 0.5);
}

TEST_F(Gltf, NamesEveryCameraOfItsScene) {
  Json json = triangle();
  const Json perspective = {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.5}}}};
  json["cameras"] = {perspective, perspective, perspective};
  json["cameras"][1]["name"] = "own";
  json["nodes"].push_back({{"camera", 0}, {"name", "node"}, {"translation", {1.0, 2.0, 3.0}}});
  json["nodes"].push_back({{"camera", 1}});
  json["nodes"].push_back({{"camera", 2}});
  json["nodes"].push_back({{"camera", 2}, {"name", "of no scene"}});
  json["scenes"][0]["nodes"] = {0, 1, 2, 3};
  const Scene scene = load(json);
  ASSERT_EQ(scene.cameras.size(), 3u);
  EXPECT_EQ(scene.cameras[0].name, "node");
  EXPECT_EQ(scene.cameras[1].name, "own");
  EXPECT_EQ(scene.cameras[2].name, "camera_2");
  EXPECT_EQ(scene.camera->position, glm::dvec3(1.0, 2.0, 3.0));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(Gltf, LightsBearTheirNodesNameOrTheirOwn) {
  Json json = triangle();
  json["extensionsUsed"] = {"KHR_lights_punctual"};
  json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"name", "bulb"}}};
  const Json extensions = {{"KHR_lights_punctual", {{"light", 0}}}};
  json["nodes"].push_back({{"extensions", extensions}});
  json["nodes"][0]["extensions"] = extensions;
  json["scenes"][0]["nodes"] = {0, 1};
  const Scene scene = load(json);
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(scene.lights[0].name, "thing");
  EXPECT_EQ(scene.lights[1].name, "bulb");
}

TEST_F(Gltf, ReadsPunctualLights) {
  Json json = triangle();
  json["extensionsUsed"] = {"KHR_lights_punctual"};
  json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}, {"spot", {{"outerConeAngle", 0.5}}}}};
  json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  const Scene scene = load(json);
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_DOUBLE_EQ(scene.lights[0].coneHalfAngleDegrees, glm::degrees(0.5));
  EXPECT_EQ(scene.lights[0].target, glm::dvec3(0.0, 0.0, -1.0));
  json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 1;
  EXPECT_EQ(faultOf(json), "/nodes/0/extensions/KHR_lights_punctual/light");
}

TEST_F(Gltf, UnsupportedPrimitivesAreDroppedWithOneLine) {
  Json json = triangle();
  const Json primitive = json["meshes"][0]["primitives"][0];
  for (const int mode : {1, 5}) {
    Json other = primitive;
    other["mode"] = mode;
    json["meshes"][0]["primitives"].push_back(other);
  }
  const Scene scene = load(json);
  EXPECT_EQ(scene.triangles(), 1u);
  EXPECT_EQ(scene.warnings.size(), 1u);
}

TEST_F(Gltf, UnsupportedKindsAreNamed) {
  Json json = triangle();
  json["materials"] = {{{"alphaMode", "MASK"}}};
  json["skins"] = {{{"joints", {0}}, {"inverseBindMatrices", 0}}};
  const Scene scene = load(json);
  EXPECT_EQ(scene.warnings, (std::vector<std::string>{"skins are not supported: meshes stay in their bind pose",
                                                      "alphaMode MASK is not supported: the material is opaque"}));
}

TEST_F(Gltf, RequiredExtensionsThatAreNotSupportedAreErrors) {
  Json json = triangle();
  json["extensionsRequired"] = {"KHR_lights_punctual", "EXT_something"};
  EXPECT_EQ(faultOf(json), "/extensionsRequired/1");
}

TEST_F(Gltf, SparseAccessorsAreDropped) {
  Json json = triangle();
  json["accessors"][0]["sparse"] = {
      {"count", 1}, {"indices", {{"bufferView", 1}, {"componentType", 5123}}}, {"values", {{"bufferView", 0}}}};
  const Scene scene = load(json);
  EXPECT_EQ(scene.triangles(), 0u);
  EXPECT_EQ(scene.warnings.size(), 1u);
}

TEST_F(Gltf, AccessorsBeyondTheirBufferViewAreErrors) {
  Json json = triangle();
  json["accessors"][0]["count"] = 4;
  EXPECT_EQ(faultOf(json), "/accessors/0");
  json["accessors"][0]["count"] = 18446744073709551615u;
  EXPECT_EQ(faultOf(json), "/accessors/0");
  json["accessors"][0]["count"] = 3;
  json["accessors"][0]["byteOffset"] = 4;
  EXPECT_EQ(faultOf(json), "/accessors/0");
}

TEST_F(Gltf, BufferViewsBeyondTheirBufferAreErrors) {
  Json json = triangle();
  json["bufferViews"][1]["byteLength"] = 9;
  EXPECT_EQ(faultOf(json), "/bufferViews/1");
  json["bufferViews"][1]["byteOffset"] = 18446744073709551600u;
  EXPECT_EQ(faultOf(json), "/bufferViews/1");
}

TEST_F(Gltf, IndicesBeyondTheVerticesAreErrors) {
  const std::string positions = bytesOf<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
  EXPECT_EQ(faultOf(withData(positions, bytesOf<std::uint16_t>({0, 1, 3}), 5123, 3)), "/accessors/1");
}

TEST_F(Gltf, ReferencesOutOfRangeAreErrors) {
  const auto with = [&](const std::string& pointer, const Json& value) {
    Json json = triangle();
    json[Json::json_pointer(pointer)] = value;
    return faultOf(json);
  };
  EXPECT_EQ(with("/scene", 3), "/scene");
  EXPECT_EQ(with("/scenes/0/nodes/0", 7), "/scenes/0/nodes/0");
  EXPECT_EQ(with("/nodes/0/mesh", 1), "/nodes/0/mesh");
  EXPECT_EQ(with("/nodes/0/camera", 0), "/nodes/0/camera");
  EXPECT_EQ(with("/meshes/0/primitives/0/material", 0), "/meshes/0/primitives/0/material");
  EXPECT_EQ(with("/meshes/0/primitives/0/attributes/POSITION", 5), "/meshes/0/primitives/0/attributes/POSITION");
  EXPECT_EQ(with("/accessors/0/bufferView", 2), "/accessors/0/bufferView");
  EXPECT_EQ(with("/bufferViews/0/buffer", 1), "/bufferViews/0/buffer");
}

TEST_F(Gltf, CyclesAndSharedNodesAreErrors) {
  Json json = triangle();
  json["nodes"] = {{{"children", {1}}}, {{"children", {0}}}};
  EXPECT_EQ(faultOf(json), "/nodes/1/children/0");
  json["nodes"] = {{{"children", {1, 1}}}, {{"mesh", 0}}};
  EXPECT_EQ(faultOf(json), "/nodes/0/children/1");
}

TEST_F(Gltf, DeepTreesAreRead) {
  Json json = triangle();
  constexpr int depth = 20000;
  for (int i = 0; i < depth; ++i) json["nodes"][static_cast<std::size_t>(i)] = {{"children", {i + 1}}};
  json["nodes"][depth] = {{"mesh", 0}};
  EXPECT_EQ(load(json).triangles(), 1u);
}

TEST_F(Gltf, DeepJsonIsAnError) {
  Json json = triangle();
  std::string text = json.dump();
  text.insert(1, "\"extras\":" + std::string(100000, '[') + std::string(100000, ']') + ",");
  EXPECT_EQ(faultOf(write("deep.gltf", text)), "");
}

TEST_F(Gltf, FilesOutsideTheFolderAreNotRead) {
  // All these name the same good bytes, and only the first lies in the glTF's folder or below.
  triangle();
  fs::copy_file(folder_ / "data.bin", folder_ / "inner" / "good.bin");
  fs::create_symlink(folder_ / "data.bin", folder_ / "inner" / "link.bin");
  const auto fault = [&](const std::string& uri) { return faultOf(write("inner/test.gltf", triangle(uri).dump())); };
  EXPECT_EQ(fault("good.bin"), "none");
  EXPECT_EQ(fault("../data.bin"), "");
  EXPECT_EQ(fault("%2e%2e/data.bin"), "");
  EXPECT_EQ(fault((folder_ / "data.bin").string()), "");
  EXPECT_EQ(fault("link.bin"), "");
}

TEST_F(Gltf, WhatIsNotGltfIsAnError) {
  EXPECT_EQ(faultOf(write("empty.gltf", "")), "");
  EXPECT_EQ(faultOf(write("text.gltf", "hello, world")), "");
  Json json = triangle();
  json["asset"]["version"] = "1.0";
  EXPECT_EQ(faultOf(json), "/asset/version");
}

TEST_F(Gltf, TransformsOfTheWrongLengthAreErrors) {
  Json json = triangle();
  json["nodes"][0]["scale"] = {1.0, 2.0};
  EXPECT_EQ(faultOf(json), "/nodes/0/scale");
}

TEST_F(Gltf, TransformsThatOverflowAreErrors) {
  Json json = triangle();
  json["nodes"][0]["scale"] = {1e200, 1.0, 1.0};
  EXPECT_EQ(faultOf(json), "/nodes/0");
}

TEST_F(Gltf, AMissingFileIsAnError) {
  EXPECT_THROW(loadGltf(folder_ / "none.gltf"), Error);
}

}  // namespace
}  // namespace gnomon
