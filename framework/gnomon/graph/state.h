// Inside of the graph: passes with what they need to run. Not part of the contract.
#pragma once

#include <map>
#include <variant>

#include "gnomon/graph/graph.h"

namespace gnomon {

/// A program with its textures and blocks at their binding points.
struct BoundProgram {
  gl::ProgramObject program;
  std::vector<std::pair<GLuint, std::shared_ptr<TextureResource>>> textures;  ///< unit
  struct Block {
    GLenum target;  ///< GL_UNIFORM_BUFFER or GL_SHADER_STORAGE_BUFFER
    GLuint binding;
    std::shared_ptr<BufferResource> buffer;
  };
  std::vector<Block> blocks;
};

struct DrawListState {
  std::string name;
  std::shared_ptr<BufferResource> records;  ///< bound as "DrawRecords"
  std::vector<DrawRecord> scratchRecords;
  std::vector<DrawCommand> commands;
  gl::BufferObject commandBuffer;
  std::size_t commandCapacity = 0;
};

struct PassNode {
  std::string name;
  bool kept = false;
  InputSet inputs;
  std::vector<std::shared_ptr<TextureResource>> textureReads;
  std::vector<std::shared_ptr<BufferResource>> bufferReads;
  std::vector<Texture> writes;
  std::vector<std::shared_ptr<BufferResource>> bufferWrites;

  std::variant<FullscreenPass, RasterPass, CpuPass> kind;
  BoundProgram bound;  ///< of full-screen and raster passes
  gl::FramebufferObject framebuffer;
  glm::ivec2 size{0, 0};

  // What the pass saw when it last ran.
  bool everRan = false;
  Revisions seen;
  std::vector<std::uint64_t> seenRevisions;
};

/// What cpu passes read back of a texture, kept while its revision stays: copying it costs more than many a pass.
struct ReadBack {
  std::shared_ptr<TextureResource> texture;
  std::uint64_t revision = 0;  ///< that was read
  std::vector<float> floats;   ///< empty if none were read
  std::vector<std::uint32_t> integers;
};

inline constexpr int kNoWriter = -1;
inline constexpr int kImported = -2;  ///< written by another graph

struct Graph::State {
  std::string name;
  glm::ivec2 outputSize;
  gl::ShaderSources sources;
  std::vector<std::shared_ptr<TextureResource>> textures;
  std::vector<int> writer;  ///< index of the pass that writes the texture, or one of the two below
  std::vector<std::shared_ptr<BufferResource>> buffers;
  std::vector<bool> bufferImported;
  std::deque<DrawListState> drawLists;
  std::deque<PassNode> passes;
  std::map<std::string, Texture> providedTextures;
  std::map<std::string, Buffer> providedBuffers;
  std::vector<gl::Constant> constants;
  Facts facts;
  bool compiled = false;
  gl::VertexArrayObject emptyVertexArray;
  gl::SamplerObject nearest;
  std::unique_ptr<GraphBuilder> builder;
  std::unique_ptr<UniformWriter> uniforms;

  std::deque<ReadBack> readBacks;  ///< spans stay while it grows
  std::vector<float> readScratch;  ///< of what is checked
};

}  // namespace gnomon
