#include "gnomon/scene/scene.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <span>

#include "gnomon/base/files.h"

namespace gnomon {
namespace {

glm::dvec3 transformed(const glm::dmat4& world, const glm::vec3& p) {
  return glm::dvec3(world * glm::dvec4(glm::dvec3(p), 1.0));
}

template <class T>
std::string hashOf(const std::vector<T>& values) {
  return hashHex(std::as_bytes(std::span(values)));
}

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

}  // namespace

void Bounds::add(const glm::dvec3& p) {
  min = glm::min(min, p);
  max = glm::max(max, p);
}

void Bounds::add(const Bounds& other) {
  min = glm::min(min, other.min);
  max = glm::max(max, other.max);
}

double Bounds::diagonal() const {
  return empty() ? 0.0 : glm::length(max - min);
}

std::size_t Scene::triangles() const {
  std::size_t count = 0;
  for (const Instance& instance : instances) count += meshes[instance.mesh].triangles();
  return count;
}

Bounds worldBounds(const Scene& scene, const Instance& instance) {
  const Mesh& mesh = scene.meshes[instance.mesh];
  Bounds bounds;
  for (const glm::vec3& p : mesh.positions) bounds.add(transformed(instance.world, p));
  return bounds;
}

Bounds worldBounds(const Scene& scene) {
  Bounds bounds;
  for (const Instance& instance : scene.instances) bounds.add(worldBounds(scene, instance));
  return bounds;
}

Triangle worldTriangle(const Scene& scene, const Instance& instance, std::size_t t) {
  const Mesh& mesh = scene.meshes[instance.mesh];
  const auto corner = [&](std::size_t i) { return transformed(instance.world, mesh.positions[mesh.indices[3 * t + i]]); };
  return {corner(0), corner(1), corner(2)};
}

bool isUsableTransform(const glm::dmat4& world) {
  for (int i = 0; i < 16; ++i)
    if (!(std::abs(world[i / 4][i % 4]) <= kMaxTransform)) return false;
  return true;
}

std::string contentHash(const Scene& scene) {
  std::string bytes;
  append(bytes, scene.meshes.size());
  for (const Mesh& mesh : scene.meshes) bytes += hashOf(mesh.positions) + hashOf(mesh.normals) + hashOf(mesh.indices);
  append(bytes, scene.materials.size());
  for (const Material& material : scene.materials) {
    append(bytes, material.albedo);
    append(bytes, material.doubleSided);
  }
  for (const Instance& instance : scene.instances) {
    append(bytes, instance.mesh);
    append(bytes, instance.material);
    append(bytes, instance.world);
    append(bytes, instance.casts);
    append(bytes, instance.receives);
  }
  return hashHex(std::string_view(bytes));
}

}  // namespace gnomon
