// Inside of the graph: passes with what they need to run. Not part of the
// contract.
#pragma once

#include <deque>
#include <map>
#include <variant>

#include "gnomon/graph/graph.h"

namespace gnomon {

/// A number that no resource of any graph has had as its revision.
std::uint64_t nextRevision();

/// What shaders are declared in: it is copied when it changes, so that each
/// pass keeps that of its declaration.
struct ShaderContext {
  gl::ShaderSources sources;
  std::map<std::string, Texture> textures;
  std::map<std::string, Buffer> buffers;
  std::vector<gl::Constant> constants;
};

/// All that a pass's program is made of, and what it is given.
struct Recipe {
  std::shared_ptr<const ShaderContext> context;
  std::vector<gl::ShaderStage> stages;
  std::vector<gl::Constant> constants;
  std::vector<NamedTexture> reads, images;
  std::vector<NamedBuffer> buffers, writes;
};

/// A program with what lies at its binding points.
struct BoundProgram {
  enum class Source : std::uint8_t { buffer, triangleNormals, readCounts };
  struct Block {
    GLenum target;  ///< GL_UNIFORM_BUFFER or GL_SHADER_STORAGE_BUFFER
    GLuint binding;
    Source source;
    Buffer buffer;
  };
  std::shared_ptr<const gl::Program> program;
  std::vector<Texture> textures;  ///< by texture unit
  std::vector<Texture> images;    ///< by image unit
  std::vector<Block> blocks;
};

/// What a draw list holds besides its records.
struct DrawStorage {
  std::vector<DrawRecord> records;
  std::vector<DrawCommand> commands;
  gl::BufferObject commandBuffer;
  std::size_t commandCapacity = 0;
};

struct DrawListState {
  std::string name;
  Buffer records;  ///< bound as "DrawRecords"
  std::shared_ptr<DrawStorage> storage;
};

/// Copies last frame's contents; declared by GraphBuilder::remember.
struct HistoryPass {
  Texture history, current;
};

struct Target {
  Texture texture;
  int layer = -1;  ///< -1: all
};

/// What a pass saw when it last ran. Passes that graphs share have one.
struct PassMemory {
  bool everRan = false;
  Revisions seen;
  std::vector<std::uint64_t> seenRevisions;
};

/// A pass that several graphs run: its targets belong to all of them.
struct SharedPass {
  std::uint64_t serial = 0;
  std::string identity;
  std::vector<std::shared_ptr<TextureResource>> textures;  ///< as PassNode::writes
  std::vector<std::shared_ptr<BufferResource>> buffers;    ///< as PassNode::bufferWrites
  std::vector<std::shared_ptr<DrawStorage>> draws;         ///< of cpu passes, as CpuPass::draws
  std::shared_ptr<PassMemory> memory;
};

class SharedPasses {
 public:
  std::map<std::string, std::weak_ptr<SharedPass>> byIdentity;
  std::uint64_t made = 0;
};

struct PassNode {
  std::string name;
  bool kept = false;
  InputSet inputs;
  std::vector<Texture> ownTextures;  ///< reads that are declared
  std::vector<Buffer> ownBuffers;
  std::vector<Texture> textureReads;  ///< those, and what the program uses
  std::vector<Buffer> bufferReads;
  std::vector<Target> writes;
  std::vector<Buffer> bufferWrites;

  std::variant<FullscreenPass, RasterPass, ComputePass, CpuPass, HistoryPass> kind;
  Recipe recipe;  ///< of those with a program
  BoundProgram bound;
  gl::FramebufferObject framebuffer;
  std::vector<GLuint> attached;  ///< to it
  glm::ivec2 size{0, 0};

  std::shared_ptr<PassMemory> memory = std::make_shared<PassMemory>();
  std::shared_ptr<SharedPass> shared;  ///< null: this graph's alone
  std::vector<std::size_t> remakes;    ///< passes that make the transient textures
                                       ///< it reads, theirs before them
  std::size_t report = 0;              ///< index in GraphReport::passes
};

struct TextureSlot {
  std::shared_ptr<TextureResource> resource = {};
  bool imported = false;
  bool isHistory = false;
  bool isOutput = false;
  glm::vec4 reset{0.0f};          ///< of a history
  std::vector<int> writers = {};  ///< indices of passes, one for each layer (one if it has none)
};

struct BufferSlot {
  std::shared_ptr<BufferResource> resource;
  bool imported = false;
  int writer = -1;
};

/// What cpu passes read back of a texture, kept while its revision stays:
/// copying it costs more than many a pass.
struct ReadBack {
  const TextureResource* texture = nullptr;
  std::uint64_t revision = 0;  ///< that was read
  std::vector<float> floats;   ///< empty if none were read
  std::vector<std::uint32_t> integers;
};

struct Graph::State {
  std::string name;
  glm::ivec2 outputSize;
  GraphShares shares;
  std::shared_ptr<ShaderContext> context;
  std::vector<gl::Constant> specialised;
  std::vector<TextureSlot> textures;
  std::vector<BufferSlot> buffers;
  std::deque<DrawListState> drawLists;
  std::deque<PassNode> passes;
  std::vector<Texture> outputs;
  Facts facts;
  bool compiled = false;
  gl::VertexArrayObject emptyVertexArray;
  gl::SamplerObject nearest;
  std::unique_ptr<GraphBuilder> builder;
  std::unique_ptr<UniformWriter> uniforms;
  GraphReport report;

  std::deque<ReadBack> readBacks;  ///< spans stay while it grows
  std::vector<float> readScratch;  ///< of what is checked
  std::vector<std::uint8_t> byteScratch;
  std::vector<std::byte> bufferScratch;

  TextureSlot& at(Texture texture) { return textures[static_cast<std::size_t>(texture.id)]; }
  const TextureSlot& at(Texture texture) const { return textures[static_cast<std::size_t>(texture.id)]; }
  BufferSlot& at(Buffer buffer) { return buffers[static_cast<std::size_t>(buffer.id)]; }
  const BufferSlot& at(Buffer buffer) const { return buffers[static_cast<std::size_t>(buffer.id)]; }
  TextureResource& texture(Texture texture) const { return *at(texture).resource; }
  BufferResource& buffer(Buffer buffer) const { return *at(buffer).resource; }
};

// bind.cpp
/// Compiles, then finds by introspection which textures and blocks the program
/// really uses: listed ones first, then provided ones. Only those are reads, so
/// that an unused include makes no dependency. With `counting`, a program that counts its reads. Throws Error.
BoundProgram bindProgram(const Graph::State& state, const PassNode& node, std::size_t index,
                         const std::optional<gl::ReadCounting>& counting = {});
/// Gives the node the program, and the reads that follow from it.
void useProgram(PassNode& node, BoundProgram bound);
/// Throws Error unless an earlier pass than `index` has written all of the
/// texture.
void requireWritten(const Graph::State& state, const PassNode& node, std::size_t index, Texture texture);

// layout.cpp
/// Who is kept, who shares, what lies where; whatever need not change stays.
/// Throws Error.
void layOut(Graph::State& state);

// texels.cpp
std::size_t texelCount(const TextureInfo& info);  ///< of all layers
void readInto(const TextureResource& texture, std::vector<float>& out, std::vector<std::uint8_t>& bytes);
void readIntegersInto(const TextureResource& texture, std::vector<std::uint32_t>& out);
/// As many values as the texture has; throws Error otherwise.
void uploadTexels(const TextureResource& texture, std::span<const float> values);
/// Colour, or depth (x) and stencil (y).
void clearTexture(const TextureResource& texture, const glm::vec4& value);
void copyTexture(const TextureResource& from, const TextureResource& to);
/// Throws Error that names target, pixel and layer of the first value that is
/// not finite.
void requireFinite(const TextureResource& texture, std::vector<float>& scratch, std::vector<std::uint8_t>& bytes);
/// Writes and raises the revision only if the bytes differ.
void writeBuffer(BufferResource& buffer, std::span<const std::byte> bytes);

}  // namespace gnomon
