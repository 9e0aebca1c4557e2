#include "gnomon/scene/builtin.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <set>

#include "gnomon/scene/builtin_dimensions.h"
#include "gnomon/scene/survey.h"

namespace gnomon {
namespace {

Mesh meshOf(int which) {
  if (which == 0) return quadMesh(2.0, 3.0);
  return which == 1 ? boxMesh({1.0, 2.0, 3.0}) : sphereMesh(1.5, 20, 20);
}

/// Cross product of a triangle's edges.
glm::dvec3 areaVector(const Mesh& mesh, std::size_t t) {
  const auto corner = [&](std::size_t i) { return glm::dvec3(mesh.positions[mesh.indices[3 * t + i]]); };
  return glm::cross(corner(1) - corner(0), corner(2) - corner(0));
}

class Meshes : public testing::TestWithParam<int> {};

TEST_P(Meshes, WindingAgreesWithNormals) {
  const Mesh mesh = meshOf(GetParam());
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (std::size_t t = 0; t < mesh.triangles(); ++t)
    ASSERT_GT(glm::dot(areaVector(mesh, t), glm::dvec3(mesh.normals[mesh.indices[3 * t]])), 0.0) << t;
}

TEST_P(Meshes, NormalsAreUnitVectors) {
  for (const glm::vec3& normal : meshOf(GetParam()).normals) ASSERT_NEAR(glm::length(normal), 1.0f, 1e-6f);
}

INSTANTIATE_TEST_SUITE_P(All, Meshes, testing::Values(0, 1, 2));

TEST(QuadMesh, FacesUp) {
  EXPECT_EQ(quadMesh(1.0, 1.0).normals[0], glm::vec3(0.0f, 1.0f, 0.0f));
}

TEST(BoxMesh, FacesOutward) {
  const Mesh mesh = boxMesh({1.0, 2.0, 3.0});
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) ASSERT_GT(glm::dot(mesh.positions[v], mesh.normals[v]), 0.0f) << v;
}

TEST(BoxMesh, HasItsSurface) {
  const Mesh mesh = boxMesh({1.0, 2.0, 3.0});
  double area = 0.0;
  for (std::size_t t = 0; t < mesh.triangles(); ++t) area += glm::length(areaVector(mesh, t)) / 2.0;
  EXPECT_NEAR(area, 88.0, 1e-6);  // 8 (1*2 + 2*3 + 3*1)
}

TEST(SphereMesh, HasTheSaidNumberOfTriangles) {
  EXPECT_EQ(sphereMesh(1.0, 20, 20).triangles(), 760u);
  EXPECT_EQ(sphereMesh(1.0, 3, 2).triangles(), 6u);
}

TEST(SphereMesh, IsClosed) {
  const Mesh mesh = sphereMesh(1.0, 7, 5);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const std::uint32_t a = mesh.indices[i];
    const std::uint32_t b = mesh.indices[i % 3 == 2 ? i - 2 : i + 1];
    balance[std::minmax(a, b)] += a < b ? 1 : -1;
  }
  EXPECT_TRUE(std::all_of(balance.begin(), balance.end(), [](const auto& edge) { return edge.second == 0; }));
}

TEST(SphereMesh, PolesLieOnY) {
  const Mesh mesh = sphereMesh(2.0, 8, 6);
  EXPECT_EQ(mesh.positions.front(), glm::vec3(0.0f, 2.0f, 0.0f));
  EXPECT_EQ(mesh.positions.back(), glm::vec3(0.0f, -2.0f, 0.0f));
}

TEST(BuiltinScenes, AreThese) {
  std::vector<std::string> names;
  for (const BuiltinScene& scene : builtinScenes()) names.push_back(scene.name);
  EXPECT_EQ(names,
            (std::vector<std::string>{"half_plane", "strips", "square", "sphere_grid", "pillars", "layers", "animated"}));
  EXPECT_EQ(findBuiltinScene("square")->name, "square");
  EXPECT_EQ(findBuiltinScene("sqare"), nullptr);
}

TEST(BuiltinScenes, TablesNameOnlyWhatTheSceneUses) {
  for (const BuiltinScene& builtin : builtinScenes()) {
    const std::string hash = contentHash(builtin.make(builtin.defaults));
    BuiltinParameters other = builtin.defaults;
    other.count += 1;
    EXPECT_EQ(contentHash(builtin.make(other)) != hash, builtin.table->find("count") != nullptr) << builtin.name;
    other = builtin.defaults;
    other.blockerHeight += 0.5;
    EXPECT_EQ(contentHash(builtin.make(other)) != hash, builtin.table->find("blocker_height") != nullptr) << builtin.name;
  }
}

TEST(BuiltinScenes, HaveOneLightWithTheSaidSource) {
  BuiltinParameters parameters;
  parameters.sourceSize = 0.7;
  for (const BuiltinScene& builtin : builtinScenes()) {
    const Scene scene = builtin.make(parameters);
    ASSERT_EQ(scene.lights.size(), 1u) << builtin.name;
    EXPECT_EQ(scene.lights[0].source.size, glm::dvec2(0.7, 0.7)) << builtin.name;
  }
}

TEST(BuiltinScenes, HaveReceiversThatFaceTheLightInView) {
  for (const BuiltinScene& builtin : builtinScenes()) {
    const Scene scene = builtin.make(builtin.defaults);
    ASSERT_TRUE(scene.camera.has_value()) << builtin.name;
    EXPECT_GT(survey(scene, scene.lights[0], *scene.camera, {800, 600}).facingTriangles, 0u) << builtin.name;
  }
}

TEST(BuiltinScenes, NamesOfInstancesAreDistinct) {
  for (const BuiltinScene& builtin : builtinScenes()) {
    const Scene scene = builtin.make(builtin.defaults);
    std::set<std::string> names;
    for (const Instance& instance : scene.instances) names.insert(instance.name);
    EXPECT_EQ(names.size(), scene.instances.size()) << builtin.name;
  }
}

TEST(SphereGrid, CountIsPerSideAndSpheresFloat) {
  const Scene scene = findBuiltinScene("sphere_grid")->make({});
  EXPECT_EQ(scene.instances.size(), 1u + 81u);
  EXPECT_EQ(scene.triangles(), 2u + 81u * 760u);
  for (std::size_t i = 1; i < scene.instances.size(); ++i) EXPECT_GT(worldBounds(scene, scene.instances[i]).min.y, 0.0);
}

/// Whether the floor point sees the whole source unless blocked by the blocker's near edge: the far edges' shadows, projected
/// on the source plane (x + (edge - x) H / h), must fall beside the source.
bool farEdgesAreBeside(double edge, double height, double sourceSize) {
  namespace d = dimensions;
  for (const double x : {-d::kFloorHalfSize, d::kFloorHalfSize})
    if (std::abs(x + (edge - x) * d::kSourceHeight / height) <= sourceSize / 2.0) return false;
  return true;
}

TEST(HalfPlane, OnlyItsEdgeMatters) {
  for (const double height : {0.01, 1.0, 2.0, dimensions::kMaxBlockerHeight})
    for (const double source : {0.1, 1.0, 5.0}) {
      BuiltinParameters parameters;
      parameters.blockerHeight = height;
      parameters.sourceSize = source;
      const Scene scene = findBuiltinScene("half_plane")->make(parameters);
      const Bounds bounds = worldBounds(scene, scene.instances[1]);
      EXPECT_DOUBLE_EQ(bounds.max.x, dimensions::kHalfPlaneEdge);
      EXPECT_DOUBLE_EQ(bounds.max.y, height);
      for (const double edge : {bounds.min.x, bounds.min.z, bounds.max.z})
        EXPECT_TRUE(farEdgesAreBeside(edge, height, source)) << height << " " << source << " " << edge;
    }
}

TEST(Strips, LieWhereTheDimensionsSay) {
  const Scene scene = findBuiltinScene("strips")->make({});
  for (const auto& [index, strip] : {std::pair{1u, dimensions::kLowerStrip}, std::pair{2u, dimensions::kUpperStrip}}) {
    const Bounds bounds = worldBounds(scene, scene.instances[index]);
    EXPECT_NEAR(bounds.min.x, strip.left, 1e-15);
    EXPECT_NEAR(bounds.max.x, strip.right, 1e-15);
    EXPECT_DOUBLE_EQ(bounds.min.y, strip.height);
  }
}

TEST(Square, LiesWhereTheDimensionsSay) {
  const Scene scene = findBuiltinScene("square")->make({});
  const Bounds bounds = worldBounds(scene, scene.instances[1]);
  EXPECT_EQ(bounds.min, glm::dvec3(-dimensions::kSquareEdge / 2.0, 1.0, -dimensions::kSquareEdge / 2.0));
  EXPECT_EQ(bounds.max, glm::dvec3(dimensions::kSquareEdge / 2.0, 1.0, dimensions::kSquareEdge / 2.0));
}

}  // namespace
}  // namespace gnomon
