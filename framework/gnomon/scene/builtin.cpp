#include "gnomon/scene/builtin.h"

#include <algorithm>
#include <glm/ext/matrix_transform.hpp>
#include <limits>

#include "gnomon/scene/builtin_dimensions.h"

namespace gnomon {
namespace {

constexpr glm::vec3 kFloorAlbedo{0.72f, 0.70f, 0.66f};
constexpr glm::vec3 kBlockerAlbedo{0.55f, 0.33f, 0.22f};
constexpr glm::vec3 kOtherAlbedo{0.24f, 0.42f, 0.52f};

std::uint32_t addMesh(Scene& scene, Mesh mesh) {
  scene.meshes.push_back(std::move(mesh));
  return static_cast<std::uint32_t>(scene.meshes.size() - 1);
}

std::uint32_t addMaterial(Scene& scene, const std::string& name, const glm::vec3& albedo, bool doubleSided) {
  scene.materials.push_back({name, albedo, doubleSided});
  return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

glm::dmat4 movedTo(const glm::dvec3& position) {
  return glm::translate(glm::dmat4(1.0), position);
}

/// A horizontal quad over [left, right] x [-halfZ, halfZ]. The scene's mesh 0 is the quad of half size 1: its size and place
/// are in the transform, in double, so that edges lie where builtin_dimensions.h says to the last bits.
Instance& addQuad(Scene& scene, const std::string& name, std::uint32_t material, double height, double left, double right,
                  double halfZ) {
  Instance quad;
  quad.name = name;
  quad.material = material;
  quad.world = glm::scale(movedTo({(left + right) / 2.0, height, 0.0}), glm::dvec3((right - left) / 2.0, 1.0, halfZ));
  scene.instances.push_back(quad);
  return scene.instances.back();
}

/// A scene with a floor of this half size at y = 0.
Scene floorScene(const std::string& name, double halfSize) {
  Scene scene;
  scene.name = name;
  addMesh(scene, quadMesh(1.0, 1.0));
  addQuad(scene, "floor", addMaterial(scene, "floor", kFloorAlbedo, false), 0.0, -halfSize, halfSize, halfSize);
  return scene;
}

Light squareSpot(const glm::dvec3& position, const glm::dvec3& target, double coneHalfAngleDegrees, double sourceSize) {
  Light light;
  light.position = position;
  light.target = target;
  light.coneHalfAngleDegrees = coneHalfAngleDegrees;
  light.source.shape = SourceShape::rectangle;
  light.source.size = {sourceSize, sourceSize};
  return light;
}

Camera cameraAt(const glm::dvec3& position, const glm::dvec3& target) {
  Camera camera;
  camera.position = position;
  camera.target = target;
  return camera;
}

/// The source of the scenes with a closed form. 60 degrees reach 6.9 m of the floor, whose corners are at 4.2 m.
Light overheadSource(double sourceSize) {
  return squareSpot({0.0, dimensions::kSourceHeight, 0.0}, glm::dvec3(0.0), 60.0, sourceSize);
}

/// How far blockers must reach so that no line from the floor to the source passes their ends. Such a line meets the
/// source plane at x + (x_b - x) H / h; with x_b = floor + source and H > h that is beyond source / 2 for every x on the floor.
double endless(double sourceSize) {
  return dimensions::kFloorHalfSize + sourceSize;
}

Scene halfPlane(const BuiltinParameters& p) {
  Scene scene = floorScene("half_plane", dimensions::kFloorHalfSize);
  const double end = endless(p.sourceSize);
  const std::uint32_t material = addMaterial(scene, "blocker", kBlockerAlbedo, true);
  addQuad(scene, "blocker", material, p.blockerHeight, -end, dimensions::kHalfPlaneEdge, end).receives = false;
  scene.lights = {overheadSource(p.sourceSize)};
  // From the open side, so low that the line of sight to the penumbra passes under the blocker's edge or beside it:
  // x / y = 1.2 of the camera exceeds (a / 2) / (H - h), which the penumbra's dark end asks for, wherever y > h.
  scene.camera = cameraAt({2.2, 1.8, 1.4}, {0.1, 0.0, 0.0});
  return scene;
}

Scene strips(const BuiltinParameters& p) {
  Scene scene = floorScene("strips", dimensions::kFloorHalfSize);
  const double end = endless(p.sourceSize);
  const dimensions::Strip lower = dimensions::kLowerStrip;
  const dimensions::Strip upper = dimensions::kUpperStrip;
  const std::uint32_t lowerMaterial = addMaterial(scene, "lower", kBlockerAlbedo, true);
  const std::uint32_t upperMaterial = addMaterial(scene, "upper", kOtherAlbedo, true);
  addQuad(scene, "lower", lowerMaterial, lower.height, lower.left, lower.right, end).receives = false;
  addQuad(scene, "upper", upperMaterial, upper.height, upper.left, upper.right, end).receives = false;
  scene.lights = {overheadSource(p.sourceSize)};
  scene.camera = cameraAt({1.8, 0.95, 1.0}, glm::dvec3(0.0));  // below both, so that neither hides the floor
  return scene;
}

Scene square(const BuiltinParameters& p) {
  Scene scene = floorScene("square", dimensions::kFloorHalfSize);
  const double half = dimensions::kSquareEdge / 2.0;
  const std::uint32_t material = addMaterial(scene, "blocker", kBlockerAlbedo, true);
  addQuad(scene, "blocker", material, p.blockerHeight, -half, half, half).receives = false;
  scene.lights = {overheadSource(p.sourceSize)};
  scene.camera = cameraAt({2.4, 1.9, 1.8}, glm::dvec3(0.0));
  return scene;
}

/// After Forest, Barthe and Paulin 2006: spheres of 762 triangles; 2 * 20 * (20 - 1) = 760 is nearest with round rings.
Scene sphereGrid(const BuiltinParameters& p) {
  constexpr double extent = 9.0;
  Scene scene = floorScene("sphere_grid", 6.0);
  const double cell = std::min(1.0, extent / p.count);
  const double radius = 0.33 * cell;
  const std::uint32_t mesh = addMesh(scene, sphereMesh(radius, 20, 20));
  const std::uint32_t material = addMaterial(scene, "sphere", kBlockerAlbedo, false);
  const double first = -0.5 * cell * (p.count - 1);
  for (int row = 0; row < p.count; ++row)
    for (int column = 0; column < p.count; ++column) {
      const glm::dvec3 centre{first + cell * column, radius + 0.2 * cell, first + cell * row};
      scene.instances.push_back(
          {"sphere_" + std::to_string(row) + "_" + std::to_string(column), mesh, material, movedTo(centre), true, true});
    }
  scene.lights = {squareSpot({6.0, 10.0, 4.0}, glm::dvec3(0.0), 45.0, p.sourceSize)};
  scene.camera = cameraAt({0.0, 9.0, 14.0}, glm::dvec3(0.0));
  return scene;
}

Scene pillars(const BuiltinParameters& p) {
  constexpr double extent = 9.0;
  Scene scene = floorScene("pillars", 6.0);
  const std::uint32_t box = addMesh(scene, boxMesh(glm::dvec3(0.5)));
  const std::uint32_t pillar = addMaterial(scene, "pillar", kBlockerAlbedo, false);
  const std::uint32_t bar = addMaterial(scene, "bar", kOtherAlbedo, false);
  const double cell = extent / p.count;
  const auto add = [&](const std::string& name, std::uint32_t material, const glm::dvec3& centre, const glm::dvec3& size) {
    scene.instances.push_back({name, box, material, glm::scale(movedTo(centre), size), true, true});
  };
  for (int i = 0; i < p.count; ++i) {
    // From low to high: pillars touch the floor, and bars float, the gap growing from contact to 2.4 m.
    const double fraction = p.count > 1 ? static_cast<double>(i) / (p.count - 1) : 0.5;
    const double x = -extent / 2.0 + cell * (i + 0.5);
    const double width = std::min(0.25, 0.3 * cell);
    const double height = 0.4 + 2.4 * fraction;
    const std::string suffix = "_" + std::to_string(i);
    add("pillar" + suffix, pillar, {x, height / 2.0, -1.6}, {width, height, width});
    add("bar" + suffix, bar, {x, 0.06 + 2.4 * fraction, 1.6}, {width, 0.12, 1.6});
  }
  scene.lights = {squareSpot({-5.0, 9.0, 5.0}, {0.0, 0.0, 0.0}, 50.0, p.sourceSize)};
  scene.camera = cameraAt({3.0, 6.5, 9.5}, {0.2, 0.3, 0.2});
  return scene;
}

/// Bavoil 2008: two quads over a floor whose shadows overlap in part, where variance shadow maps leak light.
Scene layers(const BuiltinParameters& p) {
  Scene scene = floorScene("layers", 4.0);
  const std::uint32_t lower = addMaterial(scene, "lower", kBlockerAlbedo, true);
  const std::uint32_t upper = addMaterial(scene, "upper", kOtherAlbedo, true);
  addQuad(scene, "lower", lower, 0.7, -1.3, 0.5, 1.1);
  addQuad(scene, "upper", upper, 2.2, -0.4, 0.9, 0.8);
  scene.lights = {squareSpot({-1.0, 7.0, 0.6}, {0.0, 0.0, 0.0}, 45.0, p.sourceSize)};
  scene.camera = cameraAt({4.5, 4.2, 5.2}, {0.1, 0.5, 0.0});
  return scene;
}

enum class Key { count, blockerHeight, sourceSize };

BuiltinScene entry(std::string name, std::string purpose, std::initializer_list<Key> keys, BuiltinParameters defaults,
                   Scene (*make)(const BuiltinParameters&)) {
  std::vector<Field> fields;
  for (const Key key : keys) {
    if (key == Key::count)
      fields.push_back(integer("count", &BuiltinParameters::count, {1.0, 64.0}, Binding::structure,
                               name == "pillars" ? "number of pillars and of bars" : "spheres along each side"));
    if (key == Key::blockerHeight)
      fields.push_back(real("blocker_height", &BuiltinParameters::blockerHeight,
                            {0.0, dimensions::kMaxBlockerHeight, "m", true}, Binding::structure,
                            "of the blocker above the floor; the source is at 4"));
    if (key == Key::sourceSize)
      fields.push_back(real("source_size", &BuiltinParameters::sourceSize, {0.0, 100.0, "m"}, Binding::structure,
                            "edge of the square source; 0 is a point"));
  }
  auto table = std::make_shared<const FieldTable>(std::move(fields));
  return {std::move(name), std::move(purpose), std::move(table), defaults, make};
}

}  // namespace

const std::vector<BuiltinScene>& builtinScenes() {
  static const std::vector<BuiltinScene> scenes = {
      entry("half_plane", "One straight edge under a square source: the penumbra is a linear ramp of known width.",
            {Key::blockerHeight, Key::sourceSize}, {}, halfPlane),
      entry("strips", "Two strips that overlap as seen from the source: adding or multiplying their shadows is wrong.",
            {Key::sourceSize}, {}, strips),
      entry("square", "A square under a square source: visibility is a product of two ramps, with umbra and outer corners.",
            {Key::blockerHeight, Key::sourceSize}, {}, square),
      entry("sphere_grid", "A grid of spheres just above a floor: many curved silhouettes whose penumbrae overlap.",
            {Key::count, Key::sourceSize}, {}, sphereGrid),
      entry("pillars", "Pillars and floating bars: shadows harden towards contact and soften with distance.",
            {Key::count, Key::sourceSize}, {}, pillars),
      entry("layers", "Two quads one above the other: their shadows overlap, where variance shadow maps leak light.",
            {Key::sourceSize}, {}, layers),
  };
  return scenes;
}

const BuiltinScene* findBuiltinScene(const std::string& name) {
  const std::vector<BuiltinScene>& scenes = builtinScenes();
  const auto found = std::find_if(scenes.begin(), scenes.end(), [&](const BuiltinScene& scene) { return scene.name == name; });
  return found == scenes.end() ? nullptr : &*found;
}

}  // namespace gnomon
