// From tinygltf's model to a scene.

#include "gnomon/scene/gltf.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>
#include <map>
#include <set>

#include "gnomon/base/error.h"
#include "gnomon/scene/gltf_animation.h"
#include "gnomon/scene/gltf_file.h"

namespace gnomon {
namespace {

using gltf::File;
using gltf::pointerTo;
using gltf::RawTriangles;

// A small file may name the same data many times over; beyond these it is an attack or a mistake.
constexpr std::size_t kMaxIndices = std::size_t{3} << 26;
constexpr std::size_t kMaxInstances = std::size_t{1} << 20;
const std::set<std::string> kSupportedExtensions = {"KHR_lights_punctual"};

bool finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Sums of the adjacent triangles' cross products (twice the area times the normal), normalised.
std::vector<glm::vec3> areaWeightedNormals(const Mesh& mesh) {
  std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const std::uint32_t* const corner = &mesh.indices[t];
    const glm::dvec3 a = mesh.positions[corner[0]];
    const glm::dvec3 weighted =
        glm::cross(glm::dvec3(mesh.positions[corner[1]]) - a, glm::dvec3(mesh.positions[corner[2]]) - a);
    for (int i = 0; i < 3; ++i) sums[corner[i]] += weighted;
  }
  std::vector<glm::vec3> normals;
  normals.reserve(sums.size());
  for (const glm::dvec3& sum : sums) {
    const double length = glm::length(sum);
    normals.push_back(length > 0.0 ? glm::vec3(sum / length) : glm::vec3(0.0f, 1.0f, 0.0f));
  }
  return normals;
}

/// Keeps the triangles whose corners are finite and the vertices that they use, in their order.
Mesh cleanMesh(const RawTriangles& raw, std::size_t& droppedTriangles) {
  constexpr std::uint32_t unused = 0xffffffffu;
  std::vector<std::uint32_t> place(raw.positions.size(), unused);
  Mesh mesh;
  for (std::size_t t = 0; t + 3 <= raw.indices.size(); t += 3) {
    const std::uint32_t* const corner = &raw.indices[t];
    if (!std::all_of(corner, corner + 3, [&](std::uint32_t i) { return finite(raw.positions[i]); })) {
      ++droppedTriangles;
      continue;
    }
    for (int i = 0; i < 3; ++i) place[corner[i]] = 0;
    mesh.indices.insert(mesh.indices.end(), corner, corner + 3);
  }
  bool normalsMissing = raw.normals.empty();
  for (std::size_t v = 0; v < place.size(); ++v) {
    if (place[v] == unused) continue;
    place[v] = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.push_back(raw.positions[v]);
    if (raw.normals.empty()) continue;
    const float length = glm::length(raw.normals[v]);
    const bool usable = std::isfinite(length) && length > 0.0f;
    normalsMissing = normalsMissing || !usable;
    mesh.normals.push_back(usable ? raw.normals[v] / length : glm::vec3(0.0f));
  }
  for (std::uint32_t& index : mesh.indices) index = place[index];
  if (normalsMissing) {
    const std::vector<glm::vec3> computed = areaWeightedNormals(mesh);
    mesh.normals.resize(mesh.positions.size(), glm::vec3(0.0f));
    for (std::size_t v = 0; v < computed.size(); ++v)
      if (mesh.normals[v] == glm::vec3(0.0f)) mesh.normals[v] = computed[v];
  }
  return mesh;
}

class Importer {
 public:
  explicit Importer(const std::filesystem::path& path)
      : file_(gltf::openFile(path)), model_(file_.model), animations_(gltf::readAnimations(file_)) {
    scene_.name = path.stem().string();
  }

  Scene import() {
    refuseRequired();
    warnUnsupported();
    for (const tinygltf::Material& material : model_.materials) importMaterial(material);
    importNodes();
    if (scene_.animation.riders.empty()) scene_.animation = {};  // nodes that move, and nothing on them
    if (scene_.cameras.empty())
      frameScene();
    else
      scene_.camera = scene_.cameras.front().camera;
    if (droppedTriangles_ > 0)
      warn(fmt::format("{} triangles with a vertex that is not finite were dropped", droppedTriangles_));
    return std::move(scene_);
  }

 private:
  /// One line for each kind, however often it occurs.
  void warn(const std::string& line) {
    if (warned_.insert(line).second) scene_.warnings.push_back(line);
  }

  /// A file may not be read at all without what it requires (glTF 2.0, 3.12).
  void refuseRequired() const {
    for (std::size_t i = 0; i < model_.extensionsRequired.size(); ++i) {
      const std::string& extension = model_.extensionsRequired[i];
      if (kSupportedExtensions.contains(extension)) continue;
      file_.fail(pointerTo("extensionsRequired", static_cast<int>(i)),
                 fmt::format("the file requires {}; supported: {}; export it without", extension,
                             fmt::join(kSupportedExtensions, ", ")));
    }
  }

  void warnUnsupported() {
    if (!file_.remarks.empty()) warn("the file is not quite valid: " + file_.remarks);
    if (!model_.skins.empty()) warn("skins are not supported: meshes stay in their bind pose");
    for (const std::string& line : animations_.warnings) warn(line);
    if (!model_.textures.empty()) warn("textures are not supported: materials have their base colour factor");
  }

  void importMaterial(const tinygltf::Material& from) {
    Material material;
    material.name = from.name;
    material.doubleSided = from.doubleSided;
    const std::vector<double>& colour = from.pbrMetallicRoughness.baseColorFactor;
    const std::string where = pointerTo("materials", static_cast<int>(scene_.materials.size()));
    if (colour.size() < 3 || !std::all_of(colour.begin(), colour.end(), [](double c) { return c >= 0.0 && c <= 1.0; }))
      file_.fail(where + "/pbrMetallicRoughness/baseColorFactor", "must be four numbers of 0 to 1");
    material.albedo = glm::vec3(glm::dvec3(colour[0], colour[1], colour[2]));
    if (from.alphaMode != "OPAQUE") warn("alphaMode " + from.alphaMode + " is not supported: the material is opaque");
    scene_.materials.push_back(std::move(material));
  }

  /// Of a primitive; made on demand for those without one, which glTF calls white.
  std::uint32_t materialIndex(int index, const std::string& pointer) {
    if (index >= 0) {
      if (static_cast<std::size_t>(index) >= model_.materials.size())
        file_.fail(pointer + "/material", fmt::format("is {}; the file has {}", index, model_.materials.size()));
      return static_cast<std::uint32_t>(index);
    }
    if (scene_.materials.size() == model_.materials.size()) scene_.materials.push_back({"default", glm::vec3(1.0f), false});
    return static_cast<std::uint32_t>(model_.materials.size());
  }

  const std::vector<int>& rootNodes() {
    static const std::vector<int> none;
    if (model_.scenes.empty()) {
      warn("the file has no scene: nothing is shown");
      return none;
    }
    const int index = std::max(model_.defaultScene, 0);
    if (static_cast<std::size_t>(index) >= model_.scenes.size())
      file_.fail("/scene", fmt::format("is {}; the file has {}", index, model_.scenes.size()));
    return model_.scenes[static_cast<std::size_t>(index)].nodes;
  }

  /// Where a node is at time 0, and what moves it.
  struct Place {
    glm::dmat4 world{1.0};
    int moving = -1;  // of Animation::nodes: its own, or none
  };

  /// Walks the default scene's trees with a stack of its own. A node that is met twice has two parents or is its own
  /// ancestor; glTF allows neither, so that the walk ends.
  void importNodes() {
    struct Visit {
      int node;
      Place parent;
      std::string pointer;  // of the entry that names the node
    };
    std::vector<Visit> open;
    std::vector<bool> seen(model_.nodes.size(), false);
    const auto push = [&](const std::vector<int>& nodes, const Place& parent, const std::string& pointer) {
      for (std::size_t i = nodes.size(); i-- > 0;) open.push_back({nodes[i], parent, pointer + "/" + std::to_string(i)});
    };
    push(rootNodes(), Place{}, pointerTo("scenes", std::max(model_.defaultScene, 0)) + "/nodes");
    while (!open.empty()) {
      const Visit visit = std::move(open.back());
      open.pop_back();
      if (visit.node < 0 || static_cast<std::size_t>(visit.node) >= model_.nodes.size())
        file_.fail(visit.pointer, fmt::format("names node {}; the file has {}", visit.node, model_.nodes.size()));
      const auto index = static_cast<std::size_t>(visit.node);
      if (seen[index])
        file_.fail(visit.pointer, fmt::format("names node {} again: it is in a cycle or has two parents", index));
      seen[index] = true;
      const tinygltf::Node& node = model_.nodes[index];
      const std::string where = pointerTo("nodes", visit.node);
      const Place place = placeOf(visit.node, visit.parent, where);
      importNode(node, place, where);
      push(node.children, place, where + "/children");
    }
  }

  /// Below a parent; joins the animation where the node or one above it is animated.
  Place placeOf(int index, const Place& parent, const std::string& where) {
    Animation::Node node;
    node.parent = parent.moving;
    const std::optional<glm::dmat4> matrix = ownTransform(model_.nodes[static_cast<std::size_t>(index)], where, node.rest);
    if (const auto found = animations_.channels.find(index); found != animations_.channels.end())
      node.channels = std::move(found->second);
    Place place{parent.world * matrix.value_or(matrixOf(posed(node.rest, node.channels, 0.0)))};
    if (!isUsableTransform(place.world)) file_.fail(where, "has a transform that is not finite, or beyond 1e100");
    if (parent.moving < 0 && node.channels.empty()) return place;
    if (parent.moving < 0) node.before = parent.world;
    if (matrix) node.before = node.before * *matrix;
    place.moving = static_cast<int>(scene_.animation.nodes.size());
    scene_.animation.nodes.push_back(std::move(node));
    return place;
  }

  /// A node's own transform: its matrix, or else what is written to `transform`.
  std::optional<glm::dmat4> ownTransform(const tinygltf::Node& node, const std::string& where, NodeTransform& transform) const {
    const auto check = [&](const std::vector<double>& values, std::size_t size, const char* key) {
      if (!values.empty() && values.size() != size)
        file_.fail(where + "/" + key, fmt::format("has {} numbers; {} are needed", values.size(), size));
      return !values.empty();
    };
    if (check(node.matrix, 16, "matrix")) {
      glm::dmat4 matrix;
      for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
      if (matrix[0][3] != 0.0 || matrix[1][3] != 0.0 || matrix[2][3] != 0.0 || matrix[3][3] != 1.0)
        file_.fail(where + "/matrix", "has a last row other than 0 0 0 1");
      return matrix;
    }
    if (check(node.rotation, 4, "rotation")) {
      const glm::dquat q(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
      if (!(glm::length(q) > 0.0)) file_.fail(where + "/rotation", "has no length; a unit quaternion is needed");
      transform.rotation = glm::normalize(q);
    }
    if (check(node.scale, 3, "scale")) transform.scale = {node.scale[0], node.scale[1], node.scale[2]};
    if (check(node.translation, 3, "translation"))
      transform.translation = {node.translation[0], node.translation[1], node.translation[2]};
    return std::nullopt;
  }

  void importNode(const tinygltf::Node& node, const Place& place, const std::string& where) {
    if (node.mesh >= 0) {
      if (static_cast<std::size_t>(node.mesh) >= model_.meshes.size())
        file_.fail(where + "/mesh", fmt::format("is {}; the file has {}", node.mesh, model_.meshes.size()));
      const std::string name = node.name.empty() ? "node_" + where.substr(where.rfind('/') + 1) : node.name;
      for (const auto& [mesh, material] : primitives(node.mesh)) {
        if (scene_.instances.size() == kMaxInstances)
          file_.fail(where, fmt::format("makes more than {} instances", kMaxInstances));
        if (place.moving >= 0)
          scene_.animation.riders.push_back(
              {static_cast<std::uint32_t>(scene_.instances.size()), static_cast<std::uint32_t>(place.moving)});
        scene_.instances.push_back({name, mesh, material, place.world, true, true});
      }
    }
    const std::size_t camerasAndLights = scene_.cameras.size() + scene_.lights.size();
    if (node.camera >= 0) importCamera(node, place.world, where);
    if (const auto found = node.extensions.find("KHR_lights_punctual"); found != node.extensions.end())
      importLight(node, found->second, place.world, where + "/extensions/KHR_lights_punctual/light");
    if (place.moving >= 0 && scene_.cameras.size() + scene_.lights.size() > camerasAndLights)
      warn("cameras and lights on animated nodes are not animated: they stay where they are at time 0");
  }

  struct Primitive {
    std::uint32_t mesh, material;
  };

  /// A mesh's primitives, read when first asked for.
  const std::vector<Primitive>& primitives(int index) {
    const auto [place, fresh] = primitives_.try_emplace(index);
    if (!fresh) return place->second;
    const tinygltf::Mesh& mesh = model_.meshes[static_cast<std::size_t>(index)];
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
      const std::string where = pointerTo("meshes", index) + "/primitives/" + std::to_string(i);
      const tinygltf::Primitive& primitive = mesh.primitives[i];
      if (!supported(primitive, where)) continue;
      const RawTriangles raw = gltf::readTriangles(file_, primitive, where);
      indices_ += raw.indices.size();
      if (indices_ > kMaxIndices) file_.fail(where, fmt::format("makes more than {} triangles in all", kMaxIndices / 3));
      if (raw.indices.size() % 3 != 0) warn("corners left over behind the last whole triangle were dropped");
      Mesh clean = cleanMesh(raw, droppedTriangles_);
      if (clean.indices.empty()) continue;
      clean.name = mesh.name;
      place->second.push_back({static_cast<std::uint32_t>(scene_.meshes.size()), materialIndex(primitive.material, where)});
      scene_.meshes.push_back(std::move(clean));
    }
    return place->second;
  }

  bool supported(const tinygltf::Primitive& primitive, const std::string& where) {
    const auto dropped = [&](const std::string& what) {
      warn(what + " are not supported: primitives with them were dropped");
      return false;
    };
    if (primitive.mode != TINYGLTF_MODE_TRIANGLES) {
      if (primitive.mode < 0 || primitive.mode > 6)
        file_.fail(where + "/mode", fmt::format("is {}; 0 to 6 are allowed", primitive.mode));
      return dropped("modes other than triangles");
    }
    if (primitive.extensions.contains("KHR_draco_mesh_compression")) return dropped("Draco-compressed meshes");
    if (primitive.indices < -1) file_.fail(where + "/indices", "is negative");
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end()) return dropped("primitives without POSITION");
    std::vector<int> used{position->second, primitive.indices};
    if (const auto normal = primitive.attributes.find("NORMAL"); normal != primitive.attributes.end())
      used.push_back(normal->second);
    for (const int accessor : used)
      if (const std::string why = gltf::unsupportedData(file_, accessor); !why.empty()) return dropped(why);
    if (!primitive.targets.empty()) warn("morph targets are not supported: the base shape is shown");
    return true;
  }

  /// Position, target one metre ahead and up of a node that looks along its -Z.
  template <class T>
  static void lookAlong(T& thing, const glm::dmat4& world) {
    thing.position = glm::dvec3(world[3]);
    const double length = glm::length(glm::dvec3(world[2]));
    thing.target = thing.position - (length > 0.0 ? glm::dvec3(world[2]) / length : glm::dvec3(0.0, 0.0, 1.0));
    thing.up = glm::dvec3(world[1]);
  }

  void importCamera(const tinygltf::Node& node, const glm::dmat4& world, const std::string& where) {
    const int index = node.camera;
    if (static_cast<std::size_t>(index) >= model_.cameras.size())
      file_.fail(where + "/camera", fmt::format("is {}; the file has {}", index, model_.cameras.size()));
    const tinygltf::Camera& from = model_.cameras[static_cast<std::size_t>(index)];
    Camera camera;
    lookAlong(camera, world);
    if (from.type == "orthographic") {
      camera.type = CameraType::orthographic;
      camera.height = 2.0 * from.orthographic.ymag;
      camera.near = std::max(from.orthographic.znear, 1e-6);  // 0 is allowed there, and not here
    } else {
      camera.verticalFovDegrees = glm::degrees(from.perspective.yfov);
      camera.near = from.perspective.znear;
    }
    const std::string pointer = pointerTo("cameras", index);
    if (!(camera.height > 0.0)) file_.fail(pointer, "has a ymag that is not above 0");
    if (!(camera.near > 0.0)) file_.fail(pointer, "has a znear that is not above 0");
    if (!(camera.verticalFovDegrees > 0.0 && camera.verticalFovDegrees < 180.0))
      file_.fail(pointer, "has a yfov that is not between 0 and pi");
    std::string name = node.name.empty() ? from.name : node.name;
    if (name.empty()) name = "camera_" + std::to_string(scene_.cameras.size());
    scene_.cameras.push_back({std::move(name), camera});
  }

  void importLight(const tinygltf::Node& node, const tinygltf::Value& extension, const glm::dmat4& world,
                   const std::string& pointer) {
    const int index = extension.Has("light") && extension.Get("light").IsInt() ? extension.Get("light").GetNumberAsInt() : -1;
    if (index < 0 || static_cast<std::size_t>(index) >= model_.lights.size())
      file_.fail(pointer, fmt::format("names light {}; the file has {}", index, model_.lights.size()));
    const tinygltf::Light& from = model_.lights[static_cast<std::size_t>(index)];
    Light light;
    light.name = node.name.empty() ? from.name : node.name;
    lookAlong(light, world);
    const std::string where = "/extensions/KHR_lights_punctual" + pointerTo("lights", index);
    if (from.type == "directional") {
      light.type = LightType::directional;
    } else if (from.type == "point") {
      light.type = LightType::point;
    } else if (from.type == "spot") {
      light.coneHalfAngleDegrees = glm::degrees(from.spot.outerConeAngle);
      if (!(light.coneHalfAngleDegrees > 0.0 && light.coneHalfAngleDegrees <= 90.0 + 1e-9))
        file_.fail(where + "/spot/outerConeAngle", "must be above 0 and at most pi / 2");
      light.coneHalfAngleDegrees = std::min(light.coneHalfAngleDegrees, 90.0);
    } else {
      file_.fail(where + "/type", "is \"" + from.type + "\"; directional, point and spot are allowed");
    }
    if (from.intensity != 1.0 || from.range > 0.0 || !from.color.empty())
      warn("intensity, colour and range of lights are not supported: all have intensity 1 without falloff");
    scene_.lights.push_back(light);
  }

  /// A camera that sees the sphere around the whole scene, from above and in front.
  void frameScene() {
    Camera camera;
    const Bounds bounds = worldBounds(scene_);
    if (!bounds.empty()) {
      const double radius = std::max(bounds.diagonal() / 2.0, 1e-6);
      const double distance = 1.05 * radius / std::sin(glm::radians(camera.verticalFovDegrees) / 2.0);
      camera.target = bounds.centre();
      camera.position = camera.target + distance * glm::normalize(glm::dvec3(0.5, 0.45, 1.0));
      camera.near = 1e-3 * distance;
    }
    scene_.camera = camera;
  }

  const File file_;
  const tinygltf::Model& model_;
  gltf::NodeAnimations animations_;  // of the nodes that were not met yet
  Scene scene_;
  std::map<int, std::vector<Primitive>> primitives_;  // by mesh
  std::set<std::string> warned_;
  std::size_t droppedTriangles_ = 0;
  std::size_t indices_ = 0;
};

}  // namespace

Scene loadGltf(const std::filesystem::path& path) {
  return Importer(path).import();
}

}  // namespace gnomon
