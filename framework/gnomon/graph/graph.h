// The pass graph: built once, run every frame, running only what something asks
// for and something changed.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gnomon/base/image.h"
#include "gnomon/gl/context.h"
#include "gnomon/gl/program_cache.h"
#include "gnomon/graph/passes.h"
#include "gnomon/scene/gpu_scene.h"

namespace gnomon {

/// A texture object that several transient textures may share.
class TextureMemory {
 public:
  TextureMemory() = default;
  TextureMemory(gl::TextureObject object)  // NOLINT(google-explicit-constructor)
      : block_(std::make_shared<Block>(Block{std::move(object)})) {}
  GLuint name() const { return block_ ? block_->object.name() : 0; }
  explicit operator bool() const { return block_ != nullptr; }
  bool operator==(const TextureMemory& other) const { return block_ == other.block_; }
  /// Whose contents lie there; null: nobody's.
  const void* holder() const { return block_->holder; }
  void hold(const void* holder) const { block_->holder = holder; }

 private:
  struct Block {
    gl::TextureObject object;
    const void* holder = nullptr;
  };
  std::shared_ptr<Block> block_;
};

/// Contents, and a number that rises whenever they change. Shared with graphs
/// that import it. Graphs take their revisions from one counter, so that
/// another resource in a handle's place has another revision too.
struct TextureResource {
  std::string name;
  TextureInfo info;
  TextureMemory object;
  std::uint64_t revision = 0;
};
struct BufferResource {
  std::string name;
  std::size_t bytes = 0;
  gl::BufferObject object;
  std::vector<std::byte> contents;  ///< as last written by the CPU, so that equal bytes are no
                                    ///< change; empty: zero, or the GPU's
  std::uint64_t revision = 0;
};

struct PassReport {
  std::string name;
  bool ran = false;
  double cpuMs = 0.0;  ///< process CPU time with a finish after the pass; only
                       ///< where asked for
  double wallMs = 0.0;
  FrameCounters work = {};  ///< its part of the frame's counters
  /// Samples that passed, where asked for; none for compute and the CPU.
  std::optional<std::uint64_t> fragments = std::nullopt;
  /// Texels that its shaders read, by the textures' formats, where asked for; none for the CPU, and where `uncounted` says why.
  std::optional<std::map<Format, std::uint64_t>> reads = std::nullopt;
  std::string uncounted = {};
};

struct GraphReport {
  FrameCounters counters;
  std::vector<PassReport> passes;
  /// Texels that passes over the output's pixels read for each, where reads were counted; else empty. Full-screen passes
  /// without a size of their own, and raster and compute passes whose targets have the output's.
  Image pixelReads = {};
};

struct GraphRun {
  bool skipUnchanged = true;              ///< the plan's rule `skipping`
  bool timePasses = false;                ///< finish and time after each pass
  bool countFragments = false;            ///< by a query around each pass that draws
  bool countReads = false;                ///< by other programs (gl/instrument.h), which are made for it
  bool checkFinite = false;               ///< throw at the first non-finite texel of a target
  gl::DebugMessages* messages = nullptr;  ///< where the driver's errors are looked up after each pass
};

class SharedPasses;

/// What graphs may have in common; each graph has its own where not given.
struct GraphShares {
  std::shared_ptr<gl::ProgramCache> programs = {};
  std::shared_ptr<SharedPasses> passes = {};  ///< null: this graph shares no pass
};

/// Passes that may be shared among graphs that are given the same one.
std::shared_ptr<SharedPasses> makeSharedPasses();

/// Runs passes in the order of their declaration; a pass that reads what no
/// earlier pass wrote is refused.
///
/// Passes are shared when their program, state, formats, sizes and all that
/// they read are the same, down to the scene or to what one graph imported for
/// both; the first that runs does the work for all. Never shared: what a
/// graph's output is, what is transient, or depends on a history, on a buffer
/// that only Technique::update writes (the parameters' block), on a cpu pass
/// without an identity, on a region.
class Graph {
 public:
  /// `outputSize` is the size of full-screen passes that do not give one.
  Graph(std::string name, glm::ivec2 outputSize, gl::ShaderSources sources, GraphShares shares = {});
  ~Graph();
  Graph(const Graph&) = delete;
  Graph& operator=(const Graph&) = delete;

  GraphBuilder& builder();
  /// Ends the declaration: drops passes that no output needs, allocates, makes
  /// framebuffers. Throws Error.
  void compile(std::span<const Texture> outputs);

  /// Constants that every shader gets, earlier ones included, in place of those
  /// of the last call. After `compile`: programs that mention a changed one are
  /// made anew or found among those made before, and run in the next frame;
  /// nothing else is. Throws Error for one that does not compile, and all stays
  /// as it was.
  void specialise(const std::vector<Constant>& constants);
  /// Asks cpu passes for their identities again, since parameters changed, and
  /// shares passes accordingly.
  void refreshSharing();
  /// Histories hold their reset value again.
  void cut();

  /// `revisions` as of this frame. Throws Error with the pass's name; the graph
  /// can be run again. The report is overwritten by the next run; a frame takes
  /// no memory once the graph has run with what it draws.
  const GraphReport& run(const FrameInputs& frame, Revisions revisions, const GraphRun& options);
  UniformWriter& uniforms();
  /// Passes that read it run again.
  void touch(Buffer buffer);

  const Facts& facts() const;
  std::shared_ptr<TextureResource> resource(Texture texture) const;
  std::shared_ptr<BufferResource> resource(Buffer buffer) const;
  /// Texels as floats, rows from the top, layers below one another.
  Image read(Texture texture) const;
  /// Of textures and buffers that this graph uses and does not import; memory
  /// that several share counts once.
  std::size_t memoryBytes() const;
  std::vector<std::string> passNames() const;  ///< those kept
  bool hasCpuPasses() const;                   ///< among those kept
  /// Those it does not import and keeps, in the order of their declaration;
  /// without transient ones, which hold nothing for long.
  std::vector<std::shared_ptr<TextureResource>> textures() const;

  struct State;  ///< state.h, of the graph's own files

 private:
  std::unique_ptr<State> state_;
};

/// The texture as floats, rows from the top, layers below one another; integer
/// textures are refused.
Image readTexture(const TextureResource& texture);

}  // namespace gnomon
