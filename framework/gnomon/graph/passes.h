// How passes are declared. Every pass says what it reads and writes; the graph
// orders, prunes, skips, labels and counts them.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "gnomon/graph/pass_state.h"
#include "gnomon/graph/types.h"

namespace gnomon {

/// Written into the shader as `const TYPE NAME = value;`. Parameters bound as
/// `specialise` reach every shader by themselves.
struct Constant {
  std::string name;
  std::variant<bool, int, float> value;
};

struct NamedTexture {
  std::string name;  ///< of the sampler in the shader
  Texture texture;
};
struct NamedBuffer {
  std::string name;  ///< of the uniform or storage block in the shader
  Buffer buffer;
};

/// A fragment shader over every pixel of a texture of its own.
struct FullscreenPass {
  std::string shader = {};
  std::vector<NamedTexture> reads = {};
  std::vector<NamedBuffer> buffers = {};
  std::vector<Constant> constants = {};
  Format format = Format::r32f;
  std::optional<glm::ivec2> size = {};  ///< the output's size when not given
  std::optional<glm::vec4> clear = {};  ///< what pixels hold that the shader discards
  /// x, y, width, height of the only pixels that are drawn, asked for at each
  /// run; empty: all. The others hold `clear`.
  std::function<glm::ivec4()> region = {};
  int layers = 0;                    ///< as TextureInfo, at most 32: the shader runs in each, and
                                     ///< reads gl_Layer
  bool transient = false;            ///< as TextureInfo
  std::optional<Texture> from = {};  ///< the target begins as a copy of this: same size, format and layers
  Blend blend = Blend::none;         ///< into `clear` or `from`
  std::optional<StencilTest> stencil = {};
};

/// Geometry into colour and depth targets. Depth is reversed: cleared to 0,
/// nearer is greater.
struct RasterPass {
  std::string vertex = {};
  std::string geometry = {};                ///< empty: none
  std::string fragment = {};                ///< empty: depth only
  DrawList draws = {};                      ///< scene geometry
  std::optional<Indirect> indirect = {};    ///< DrawCommand records instead of the list's; the list still gives
                                            ///< the records
  std::optional<VertexDraw> vertices = {};  ///< instead of scene geometry
  std::vector<Texture> colours = {};
  std::vector<glm::vec4> clears = {};  ///< per colour target
  std::optional<Texture> depth = {};
  std::optional<Texture> depthFrom = {};  ///< depth and stencil begin as a copy of this instead of cleared
  std::optional<Texture> depthRead = {};  ///< instead of `depth`: tested against, never written
  std::optional<int> layer = {};          ///< the only one of the targets that is drawn;
                                          ///< else the geometry shader says gl_Layer
  Compare depthTest = Compare::greater;
  bool depthWrite = true;
  bool depthClamp = false;  ///< what lies nearer than near keeps near's depth
                            ///< and is not clipped
  Blend blend = Blend::none;
  Cull cull = Cull::none;
  std::optional<Stencil> stencil = {};
  std::vector<NamedTexture> reads = {};
  std::vector<NamedBuffer> buffers = {};
  std::vector<NamedBuffer> writes = {};  ///< storage blocks that the shaders write; zero when the pass starts
  std::vector<Constant> constants = {};
};

/// A compute shader.
struct ComputePass {
  std::string shader = {};
  std::vector<NamedTexture> reads = {};
  std::vector<NamedTexture> images = {};  ///< written through image variables of the texture's own format; no
                                          ///< depth formats
  std::optional<glm::vec4> clear = {};    ///< what the images hold when the pass starts; not given: the shader
                                          ///< writes every texel
  std::vector<NamedBuffer> buffers = {};  ///< read
  std::vector<NamedBuffer> writes = {};   ///< storage blocks that it writes; zero when the pass starts
  std::vector<Constant> constants = {};
  glm::ivec3 groups{1, 1, 1};
  std::optional<Indirect> indirect = {};  ///< three counts in a buffer, instead of `groups`
};

class CpuContext;

/// Work on the CPU. Textures it reads are read back, those it writes are
/// uploaded.
struct CpuPass {
  InputSet inputs = {};
  std::vector<Texture> reads = {};
  std::vector<Texture> writes = {};
  std::vector<Buffer> after = {};    ///< runs after, and whenever, these change; may read their bytes
  std::vector<Buffer> buffers = {};  ///< written
  std::vector<DrawList> draws = {};  ///< written
  std::function<void(CpuContext&)> run = {};
  /// Everything that decides what it writes besides its inputs and what it
  /// reads: its own name, set-up values, the values *now* of uniform and
  /// specialise parameters. Graphs of a session may then share what passes of
  /// one identity write, where a session shares passes (each still runs its
  /// own). Asked again when parameters change. Empty: nothing is shared; nor is
  /// it for a pass that writes textures.
  std::function<std::string()> identity = {};
};

/// What a cpu pass may touch while it runs: only what it declared.
class CpuContext {
 public:
  virtual ~CpuContext() = default;
  virtual const FrameInputs& frame() const = 0;
  /// Texels of a declared read, rows from the top, channels interleaved, layers
  /// one after the other. Valid until the pass returns.
  virtual std::span<const float> read(Texture texture) = 0;
  virtual std::span<const std::uint32_t> readIntegers(Texture texture) = 0;
  /// Bytes of a buffer named in CpuPass::after, as an earlier pass of any kind
  /// left them. Valid until the pass returns.
  virtual std::span<const std::byte> readBytes(Buffer buffer) = 0;
  /// Size as the texture's, rows from the top, layers one after the other.
  virtual void write(Texture texture, std::span<const float> texels) = 0;
  virtual void write(Buffer buffer, std::span<const std::byte> bytes) = 0;
  /// Chooses what a raster pass draws: instances whose flag is not 0, relative
  /// to `origin` (world).
  virtual void draw(DrawList list, std::span<const std::uint8_t> chosen, const glm::dvec3& origin) = 0;
  virtual Facts& facts() = 0;
  virtual FrameCounters& counters() = 0;

  template <class Block>
  void writeBlock(Buffer buffer, const Block& block) {
    write(buffer, std::as_bytes(std::span(&block, 1)));
  }
};

/// Values a technique sets every frame; see Technique::update.
class UniformWriter {
 public:
  virtual ~UniformWriter() = default;
  virtual void write(Buffer buffer, std::span<const std::byte> bytes) = 0;
  template <class Block>
  void writeBlock(Buffer buffer, const Block& block) {
    write(buffer, std::as_bytes(std::span(&block, 1)));
  }
};

/// A texture or buffer that another graph owns, such as the session's G-buffer.
struct TextureResource;
struct BufferResource;

/// Declares a graph. Handles given here are the only way to name what passes
/// share.
class GraphBuilder {
 public:
  virtual ~GraphBuilder() = default;

  /// A texture that one later pass will write; of an array, one pass for each
  /// layer or one for all.
  virtual Texture texture(const std::string& name, const TextureInfo& info) = 0;
  /// What a texture held at the end of the last frame: readable from here on,
  /// the same texture written later is named by `remember`. Holds `reset` in
  /// the first frame after set-up and after Session::cut. Who reads it runs
  /// again in the frame after one that changed it.
  virtual Texture history(const std::string& name, const TextureInfo& info, const glm::vec4& reset) = 0;
  virtual void remember(Texture history, Texture current) = 0;
  /// A uniform or storage block that one pass or Technique::update will write.
  virtual Buffer buffer(const std::string& name, std::size_t bytes) = 0;
  virtual DrawList drawList(const std::string& name) = 0;

  /// Every later shader that uses a sampler or block of this name gets it, and
  /// depends on it, without listing it.
  virtual void provide(const std::string& name, Texture texture) = 0;
  virtual void provide(const std::string& name, Buffer buffer) = 0;
  /// A text that shaders may #include under this name.
  virtual void include(const std::string& name, const std::string& text) = 0;
  /// A constant of every later shader.
  virtual void constant(const Constant& constant) = 0;

  virtual Texture fullscreen(const std::string& name, const FullscreenPass& pass) = 0;
  virtual void raster(const std::string& name, const RasterPass& pass) = 0;
  virtual void compute(const std::string& name, const ComputePass& pass) = 0;
  virtual void cpu(const std::string& name, const CpuPass& pass) = 0;

  virtual Facts& facts() = 0;

  virtual Texture import(const std::string& name, const std::shared_ptr<TextureResource>& resource) = 0;
  virtual Buffer import(const std::string& name, const std::shared_ptr<BufferResource>& resource) = 0;
};

}  // namespace gnomon
