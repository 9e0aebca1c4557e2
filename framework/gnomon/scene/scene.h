// A scene: meshes, materials, instances; with the camera and lights it came with.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "gnomon/scene/animation.h"
#include "gnomon/scene/camera.h"
#include "gnomon/scene/light.h"

namespace gnomon {

/// Indexed triangles in object space. Positions and indices are finite and in range (importers drop what is not).
struct Mesh {
  std::string name;
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;  ///< shading normals, as many as positions
  std::vector<std::uint32_t> indices;

  std::size_t triangles() const { return indices.size() / 3; }
};

struct Material {
  std::string name;
  glm::vec3 albedo{0.8f, 0.8f, 0.8f};  ///< linear
  /// Back faces of single-sided materials are not seen by the camera. Every triangle casts from both sides.
  bool doubleSided = false;
};

struct Instance {
  std::string name;
  std::uint32_t mesh = 0;
  std::uint32_t material = 0;
  glm::dmat4 world{1.0};  ///< object to world, metres; may mirror, shear, be singular
  bool casts = true;
  bool receives = true;
};

/// Axis-aligned box; empty until something is added.
struct Bounds {
  glm::dvec3 min{std::numeric_limits<double>::infinity()};
  glm::dvec3 max{-std::numeric_limits<double>::infinity()};

  bool empty() const { return !(min.x <= max.x); }
  void add(const glm::dvec3& p);
  void add(const Bounds& other);
  glm::dvec3 centre() const { return (min + max) * 0.5; }
  double diagonal() const;
  glm::dvec3 corner(int i) const {
    return {(i & 1) != 0 ? max.x : min.x, (i & 2) != 0 ? max.y : min.y, (i & 4) != 0 ? max.z : min.z};
  }
};

struct NamedCamera {
  std::string name;
  Camera camera;
};

struct Scene {
  std::string name;
  std::vector<Mesh> meshes;
  std::vector<Material> materials;
  std::vector<Instance> instances;  ///< in their pose at time 0, where something moves
  std::vector<Light> lights;
  std::optional<Camera> camera;      ///< what the scene is looked at with
  std::vector<NamedCamera> cameras;  ///< those that a file names, the first being `camera`; names may occur twice
  Animation animation;
  std::vector<std::string> warnings;  ///< what an importer dropped or does not support, a line each

  std::size_t triangles() const;  ///< over all instances
};

/// Of the mesh under the instance's transform: the tight box of the transformed vertices, in double.
Bounds worldBounds(const Scene& scene, const Instance& instance);
Bounds worldBounds(const Scene& scene);

/// The three corners of triangle `t` of an instance, in world space, in double.
struct Triangle {
  glm::dvec3 a, b, c;
};
Triangle worldTriangle(const Scene& scene, const Instance& instance, std::size_t t);

/// No entry's magnitude goes beyond this: times any float, and squared, it is still finite.
inline constexpr double kMaxTransform = 1e100;

/// Whether all entries are finite and at most kMaxTransform.
bool isUsableTransform(const glm::dmat4& world);

/// A hash of all that decides a picture of the scene: geometry, transforms, materials, flags. Not names, not lights; of what
/// moves only the pose that the instances have.
std::string contentHash(const Scene& scene);

}  // namespace gnomon
