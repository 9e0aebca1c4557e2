// The scene on the GPU: one vertex stream of positions, one of normals, one index buffer, and instanced indirect draws.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "gnomon/gl/objects.h"
#include "gnomon/scene/scene.h"

namespace gnomon {

/// One drawn instance, as shaders see it (std430, 96 bytes). Rows of the affine map from object space to world axes
/// *relative to the view's origin*: combined in double, so that a world offset of 10^6 loses nothing.
struct DrawRecord {
  glm::vec4 row0, row1, row2;
  glm::vec4 albedo;             ///< w: 1 double-sided, 0 single-sided
  std::uint32_t instance;       ///< index in Scene::instances
  std::uint32_t firstTriangle;  ///< of the mesh in the triangle-normal buffer
  std::uint32_t receives;
  std::uint32_t mirrored;  ///< the transform turns front faces into back faces
  glm::vec4 padding;
};
static_assert(sizeof(DrawRecord) == 96);

/// glMultiDrawElementsIndirect's command.
struct DrawCommand {
  std::uint32_t count, instanceCount, firstIndex;
  std::int32_t baseVertex;
  std::uint32_t baseInstance;
};

class GpuScene {
 public:
  explicit GpuScene(const Scene& scene);

  /// Positions (0), normals (1), indices, and at attribute 2 the draw record's index (an instanced counter).
  GLuint vertexArray() const { return vertexArray_.name(); }
  /// vec4 per triangle of each mesh: geometric normal in object space (0 where the area is 0).
  GLuint triangleNormals() const { return triangleNormals_.name(); }
  std::size_t bytes() const { return bytes_; }

  /// Fills `records` and `commands` for drawing the instances whose flag in `chosen` (as Scene::instances) is not 0, seen from
  /// `origin`; one command a mesh. Reuses the vectors' memory.
  void select(const Scene& scene, std::span<const std::uint8_t> chosen, const glm::dvec3& origin,
              std::vector<DrawRecord>& records, std::vector<DrawCommand>& commands) const;

 private:
  struct MeshRange {
    std::uint32_t firstIndex, indexCount, firstTriangle;
    std::int32_t baseVertex;
  };
  std::vector<MeshRange> meshes_;
  std::vector<std::uint32_t> byMesh_;  ///< instances, those of one mesh together
  gl::BufferObject positions_, normals_, indices_, triangleNormals_, counter_;
  gl::VertexArrayObject vertexArray_;
  std::size_t bytes_ = 0;
};

}  // namespace gnomon
