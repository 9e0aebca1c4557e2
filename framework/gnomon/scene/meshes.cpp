// Generated meshes: quad, box, sphere.

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "gnomon/scene/builtin.h"

namespace gnomon {
namespace {

/// Appends the quad centre +- u +- v, which faces cross(u, v).
void addQuad(Mesh& mesh, const glm::dvec3& centre, const glm::dvec3& u, const glm::dvec3& v) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const glm::dvec3 normal = glm::normalize(glm::cross(u, v));
  for (const glm::dvec3& corner : {centre - u - v, centre + u - v, centre + u + v, centre - u + v}) {
    mesh.positions.emplace_back(corner);
    mesh.normals.emplace_back(normal);
  }
  for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + i);
}

}  // namespace

Mesh quadMesh(double halfX, double halfZ) {
  Mesh mesh;
  mesh.name = "quad";
  addQuad(mesh, glm::dvec3(0.0), {0.0, 0.0, halfZ}, {halfX, 0.0, 0.0});
  return mesh;
}

Mesh boxMesh(const glm::dvec3& halfSize) {
  Mesh mesh;
  mesh.name = "box";
  const glm::dvec3 x{halfSize.x, 0.0, 0.0};
  const glm::dvec3 y{0.0, halfSize.y, 0.0};
  const glm::dvec3 z{0.0, 0.0, halfSize.z};
  addQuad(mesh, x, y, z);
  addQuad(mesh, -x, z, y);
  addQuad(mesh, y, z, x);
  addQuad(mesh, -y, x, z);
  addQuad(mesh, z, x, y);
  addQuad(mesh, -z, y, x);
  return mesh;
}

Mesh sphereMesh(double radius, int segments, int rings) {
  Mesh mesh;
  mesh.name = "sphere";
  const auto add = [&](const glm::dvec3& normal) {
    mesh.positions.emplace_back(normal * radius);
    mesh.normals.emplace_back(normal);
  };
  // Vertices: north pole, rings - 1 circles from north to south, south pole.
  add({0.0, 1.0, 0.0});
  for (int ring = 1; ring < rings; ++ring) {
    const double polar = std::numbers::pi * ring / rings;
    for (int segment = 0; segment < segments; ++segment) {
      const double around = 2.0 * std::numbers::pi * segment / segments;
      add({std::sin(polar) * std::sin(around), std::cos(polar), std::sin(polar) * std::cos(around)});
    }
  }
  add({0.0, -1.0, 0.0});

  const auto south = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  const auto vertex = [&](int ring, int segment) {
    return static_cast<std::uint32_t>(1 + (ring - 1) * segments + segment % segments);
  };
  const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.indices.insert(mesh.indices.end(), {a, b, c});
  };
  for (int s = 0; s < segments; ++s) {
    triangle(0, vertex(1, s), vertex(1, s + 1));
    for (int ring = 1; ring < rings - 1; ++ring) {
      triangle(vertex(ring, s), vertex(ring + 1, s), vertex(ring + 1, s + 1));
      triangle(vertex(ring, s), vertex(ring + 1, s + 1), vertex(ring, s + 1));
    }
    triangle(vertex(rings - 1, s), south, vertex(rings - 1, s + 1));
  }
  return mesh;
}

}  // namespace gnomon
