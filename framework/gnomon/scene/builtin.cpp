#include "gnomon/scene/builtin.h"

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/trigonometric.hpp>
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

/// A rotor, a walker and a pendulum: what turns about itself, what travels, and a chain of two joints.
class AnimatedScene {
 public:
  explicit AnimatedScene(const BuiltinParameters& p) : scene_(floorScene("animated", 4.0)) {
    box_ = addMesh(scene_, boxMesh(glm::dvec3(0.5)));
    ball_ = addMesh(scene_, sphereMesh(0.28, 24, 16));
    rotorMaterial_ = addMaterial(scene_, "rotor", kBlockerAlbedo, false);
    moverMaterial_ = addMaterial(scene_, "mover", kOtherAlbedo, false);
    addRotor({-1.3, 1.4, -0.6});
    addWalker({0.9, 0.0, 1.1});
    addPendulum({1.6, 2.8, -1.4});
    scene_.lights = {squareSpot({-3.0, 9.0, 4.0}, {0.2, 0.0, 0.0}, 45.0, p.sourceSize)};
    scene_.camera = cameraAt({2.2, 5.0, 7.4}, {0.1, 0.6, 0.0});
    setPose(scene_, 0.0);
  }

  Scene take() { return std::move(scene_); }

 private:
  static constexpr double kPeriod = 4.0;  // seconds
  static constexpr int kQuarters = 4;     // keys at each of them, the last as the first: all motions close

  template <class ValueAt>
  static AnimationChannel keyed(AnimatedProperty property, Interpolation interpolation, const ValueAt& valueAt) {
    AnimationChannel channel{property, interpolation, kPeriod, {}, {}};
    for (int i = 0; i <= kQuarters; ++i) {
      channel.times.push_back(kPeriod * i / kQuarters);
      valueAt(i % kQuarters, channel.values);
    }
    return channel;
  }

  static glm::dvec4 turned(const glm::dvec3& axis, double degrees) {
    const double half = glm::radians(degrees) / 2.0;
    return {std::sin(half) * axis, std::cos(half)};
  }

  std::uint32_t addNode(int parent, const glm::dmat4& before, std::vector<AnimationChannel> channels) {
    scene_.animation.nodes.push_back({parent, before, {}, std::move(channels)});
    return static_cast<std::uint32_t>(scene_.animation.nodes.size() - 1);
  }

  /// A part of a moving node: a mesh of this size, centred here in the node's space.
  void addPart(const std::string& name, std::uint32_t node, std::uint32_t mesh, std::uint32_t material,
               const glm::dvec3& centre, const glm::dvec3& size) {
    const std::uint32_t place = addNode(static_cast<int>(node), glm::scale(movedTo(centre), size), {});
    scene_.animation.riders.push_back({static_cast<std::uint32_t>(scene_.instances.size()), place});
    scene_.instances.push_back({name, mesh, material, glm::dmat4(1.0), true, true});
  }

  /// A cross that turns once about the vertical, on a mast that stands still.
  void addRotor(const glm::dvec3& hub) {
    const glm::dvec3 mast{0.12, hub.y, 0.12};
    scene_.instances.push_back(
        {"mast", box_, rotorMaterial_, glm::scale(movedTo(hub - glm::dvec3(0.0, hub.y / 2.0, 0.0)), mast), true, true});
    const auto quarterTurn = [](int i, std::vector<glm::dvec4>& values) {
      values.push_back(turned({0.0, 1.0, 0.0}, 360.0 / kQuarters * i));
    };
    const std::uint32_t node =
        addNode(-1, movedTo(hub), {keyed(AnimatedProperty::rotation, Interpolation::linear, quarterTurn)});
    addPart("rotor_x", node, box_, rotorMaterial_, {0.0, 0.1, 0.0}, {2.4, 0.1, 0.3});
    addPart("rotor_z", node, box_, rotorMaterial_, {0.0, 0.1, 0.0}, {0.3, 0.1, 2.4});
  }

  /// A box that walks round a centre, facing where it goes.
  void addWalker(const glm::dvec3& centre) {
    constexpr double radius = 1.2;
    const auto onCircle = [](int i, std::vector<glm::dvec4>& values) {
      const double angle = glm::radians(360.0) * i / kQuarters;
      const glm::dvec4 radial{std::cos(angle), 0.0, -std::sin(angle), 0.0};
      const glm::dvec4 along{-std::sin(angle), 0.0, -std::cos(angle), 0.0};
      const glm::dvec4 velocity = glm::radians(360.0) / kPeriod * radius * along;
      values.insert(values.end(), {velocity, radius * radial, velocity});
    };
    const auto heading = [](int i, std::vector<glm::dvec4>& values) {
      values.push_back(turned({0.0, 1.0, 0.0}, 360.0 / kQuarters * i));
    };
    const std::uint32_t node = addNode(-1, movedTo(centre),
                                       {keyed(AnimatedProperty::translation, Interpolation::cubicSpline, onCircle),
                                        keyed(AnimatedProperty::rotation, Interpolation::linear, heading)});
    addPart("walker", node, box_, moverMaterial_, {0.0, 0.45, 0.0}, {0.35, 0.9, 0.6});
  }

  /// Two joints that swing against each other, coming to rest at each side.
  void addPendulum(const glm::dvec3& pivot) {
    constexpr double length = 1.1;
    const auto swing = [](double degrees) {
      return [degrees](int i, std::vector<glm::dvec4>& values) {
        const glm::dvec4 still(0.0);
        values.insert(values.end(), {still, turned({0.0, 0.0, 1.0}, i % 2 == 0 ? degrees : -degrees), still});
      };
    };
    const std::uint32_t upper =
        addNode(-1, movedTo(pivot), {keyed(AnimatedProperty::rotation, Interpolation::cubicSpline, swing(35.0))});
    const std::uint32_t lower = addNode(static_cast<int>(upper), movedTo({0.0, -length, 0.0}),
                                        {keyed(AnimatedProperty::rotation, Interpolation::cubicSpline, swing(-20.0))});
    addPart("upper_rod", upper, box_, moverMaterial_, {0.0, -length / 2.0, 0.0}, {0.09, length, 0.09});
    addPart("lower_rod", lower, box_, moverMaterial_, {0.0, -length / 2.0, 0.0}, {0.09, length, 0.09});
    addPart("bob", lower, ball_, moverMaterial_, {0.0, -length, 0.0}, glm::dvec3(1.0));
  }

  Scene scene_;
  std::uint32_t box_ = 0, ball_ = 0;
  std::uint32_t rotorMaterial_ = 0, moverMaterial_ = 0;
};

Scene animated(const BuiltinParameters& p) {
  return AnimatedScene(p).take();
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
      entry("animated", "A rotor, a walker and a pendulum in a loop of 4 s: shadows whose casters turn, travel and swing.",
            {Key::sourceSize}, {}, animated),
  };
  return scenes;
}

const BuiltinScene* findBuiltinScene(const std::string& name) {
  const std::vector<BuiltinScene>& scenes = builtinScenes();
  const auto found = std::find_if(scenes.begin(), scenes.end(), [&](const BuiltinScene& scene) { return scene.name == name; });
  return found == scenes.end() ? nullptr : &*found;
}

}  // namespace gnomon
