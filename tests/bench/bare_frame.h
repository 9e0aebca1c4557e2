// A frame of a depth-map technique in bare OpenGL: G-buffer, receiver mask, light depth, filter; and nothing around them.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "gnomon/gl/objects.h"
#include "gnomon/session.h"

namespace gnomon::bench {

/// What the program uploads for one pose of light and camera.
struct BarePose {
  std::vector<std::pair<GLuint, std::vector<std::byte>>> blocks;  ///< uniform buffer and its bytes
  std::vector<DrawRecord> visible, casters;
};

/// Textures, buffers, framebuffers and state are its own; programs and the bytes of uniform blocks are the session's, which are
/// found by their debug labels: the same shaders on the same numbers.
class BareFrame {
 public:
  /// After a frame of the session, whose passes it draws too. Throws Error where they are not those that it knows.
  BareFrame(const Session& session, Slot slot, const std::string& technique);

  /// For the session's last frame, which must have drawn all instances and all casters.
  BarePose pose(const Session& session) const;
  void draw(const BarePose& pose);

  /// Triangles that a frame submits.
  std::uint64_t primitives() const;
  Image visibility() const;

 private:
  struct Pass {
    GLuint program = 0;
    gl::FramebufferObject framebuffer;
    glm::ivec2 size{0, 0};
    std::vector<std::pair<GLuint, GLuint>> textures;  ///< unit, texture
    struct Block {
      GLenum target;
      GLuint binding, buffer;
    };
    std::vector<Block> blocks;
  };
  /// An instanced draw of some of the scene's instances.
  struct Draws {
    gl::BufferObject records, commands;
    GLsizei count = 0;
    std::uint64_t primitives = 0;
  };

  const TextureResource& add(const std::string& sampler, const TextureInfo& info);
  Draws makeDraws(const std::vector<DrawRecord>& records, const std::vector<DrawCommand>& commands) const;
  Pass makePass(const std::string& name, const std::vector<const TextureResource*>& targets, GLuint drawRecords);
  void bindSamplers(Pass& pass) const;
  void bindBlocks(Pass& pass, GLenum interface, GLenum target, GLuint drawRecords);
  GLuint block(const std::string& name);
  void begin(const Pass& pass, GLuint vertexArray) const;
  void drawScene(const Draws& draws) const;

  std::string technique_;
  GpuScene gpu_;
  std::vector<std::pair<std::string, std::unique_ptr<TextureResource>>> textures_;  ///< by the name of their sampler
  struct NamedBlock {
    std::string name;
    GLuint source;  ///< the session's
    gl::BufferObject own;
  };
  std::vector<NamedBlock> blocks_;
  gl::VertexArrayObject emptyVertexArray_;
  gl::SamplerObject nearest_;
  Draws visible_, casters_;
  Pass gbuffer_, mask_, lightDepth_, filter_;
  const TextureResource* visibility_ = nullptr;
};

}  // namespace gnomon::bench
