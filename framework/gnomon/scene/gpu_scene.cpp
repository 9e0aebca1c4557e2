#include "gnomon/scene/gpu_scene.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numeric>

namespace gnomon {

namespace {
template <class T>
gl::BufferObject upload(const std::vector<T>& values, const char* label, std::size_t& bytes) {
  bytes += values.size() * sizeof(T);
  return gl::makeBuffer(values.size() * sizeof(T), values.data(), label);
}
}  // namespace

GpuScene::GpuScene(const Scene& scene) {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<std::uint32_t> indices;
  std::vector<glm::vec4> triangleNormals;
  for (const Mesh& mesh : scene.meshes) {
    meshes_.push_back({static_cast<std::uint32_t>(indices.size()), static_cast<std::uint32_t>(mesh.indices.size()),
                       static_cast<std::uint32_t>(triangleNormals.size()), static_cast<std::int32_t>(positions.size())});
    positions.insert(positions.end(), mesh.positions.begin(), mesh.positions.end());
    normals.insert(normals.end(), mesh.normals.begin(), mesh.normals.end());
    indices.insert(indices.end(), mesh.indices.begin(), mesh.indices.end());
    for (std::size_t t = 0; t < mesh.triangles(); ++t) {
      const glm::dvec3 a = mesh.positions[mesh.indices[3 * t]];
      const glm::dvec3 b = mesh.positions[mesh.indices[3 * t + 1]];
      const glm::dvec3 c = mesh.positions[mesh.indices[3 * t + 2]];
      const glm::dvec3 n = glm::cross(b - a, c - a);
      const double length = glm::length(n);
      triangleNormals.emplace_back(length > 0.0 ? glm::vec3(n / length) : glm::vec3(0.0f), 0.0f);
    }
  }
  std::vector<std::uint32_t> counter(scene.instances.size());
  std::iota(counter.begin(), counter.end(), 0U);
  byMesh_ = counter;
  std::stable_sort(byMesh_.begin(), byMesh_.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return scene.instances[a].mesh < scene.instances[b].mesh; });

  positions_ = upload(positions, "scene positions", bytes_);
  normals_ = upload(normals, "scene normals", bytes_);
  indices_ = upload(indices, "scene indices", bytes_);
  triangleNormals_ = upload(triangleNormals, "scene triangle normals", bytes_);
  counter_ = upload(counter, "scene draw counter", bytes_);

  vertexArray_ = gl::makeVertexArray("scene");
  const GLuint vao = vertexArray_.name();
  const auto attribute = [vao](GLuint index, GLuint buffer, GLsizei stride) {
    glVertexArrayVertexBuffer(vao, index, buffer, 0, stride);
    glEnableVertexArrayAttrib(vao, index);
    glVertexArrayAttribBinding(vao, index, index);
  };
  attribute(0, positions_.name(), sizeof(glm::vec3));
  glVertexArrayAttribFormat(vao, 0, 3, GL_FLOAT, GL_FALSE, 0);
  attribute(1, normals_.name(), sizeof(glm::vec3));
  glVertexArrayAttribFormat(vao, 1, 3, GL_FLOAT, GL_FALSE, 0);
  attribute(2, counter_.name(), sizeof(std::uint32_t));
  glVertexArrayAttribIFormat(vao, 2, 1, GL_UNSIGNED_INT, 0);
  glVertexArrayBindingDivisor(vao, 2, 1);
  glVertexArrayElementBuffer(vao, indices_.name());
}

void GpuScene::select(const Scene& scene, std::span<const std::uint8_t> chosen, const glm::dvec3& origin,
                      std::vector<DrawRecord>& records, std::vector<DrawCommand>& commands) const {
  records.clear();
  commands.clear();
  std::uint32_t drawnMesh = 0;
  for (const std::uint32_t index : byMesh_) {
    const Instance& instance = scene.instances[index];
    const MeshRange& range = meshes_[instance.mesh];
    if (chosen[index] == 0 || range.indexCount == 0) continue;
    if (commands.empty() || drawnMesh != instance.mesh) {
      commands.push_back({range.indexCount, 0, range.firstIndex, range.baseVertex, static_cast<std::uint32_t>(records.size())});
      drawnMesh = instance.mesh;
    }
    ++commands.back().instanceCount;
    const Material& material = scene.materials[instance.material];
    const glm::dmat4& m = instance.world;
    const auto row = [&](int r) { return glm::vec4(glm::dvec4(m[0][r], m[1][r], m[2][r], m[3][r] - origin[r])); };
    records.push_back({row(0), row(1), row(2), glm::vec4(material.albedo, material.doubleSided ? 1.0f : 0.0f), index,
                       range.firstTriangle, instance.receives ? 1U : 0U, glm::determinant(glm::dmat3(m)) < 0.0 ? 1U : 0U,
                       glm::vec4(0.0f)});
  }
}

}  // namespace gnomon
