// The pass graph: built once, run every frame, running only what something asks for and something changed.
#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "gnomon/base/image.h"
#include "gnomon/gl/context.h"
#include "gnomon/gl/program.h"
#include "gnomon/graph/passes.h"
#include "gnomon/scene/gpu_scene.h"

namespace gnomon {

/// Contents and how often they changed. Shared with graphs that import it.
struct TextureResource {
  std::string name;
  TextureInfo info;
  gl::TextureObject object;
  std::uint64_t revision = 0;
};
struct BufferResource {
  std::string name;
  std::size_t bytes = 0;
  gl::BufferObject object;
  std::vector<std::byte> contents;  ///< as last written, so that equal bytes are no change
  std::uint64_t revision = 0;
};

struct PassReport {
  std::string name;
  bool ran = false;
  double cpuMs = 0.0;  ///< process CPU time with a finish after the pass; only where asked for
  double wallMs = 0.0;
};

struct GraphReport {
  FrameCounters counters;
  std::vector<PassReport> passes;
};

struct GraphRun {
  bool skipUnchanged = true;              ///< the plan's rule `skipping`
  bool timePasses = false;                ///< finish and time after each pass
  bool checkFinite = false;               ///< throw at the first non-finite texel of a target
  gl::DebugMessages* messages = nullptr;  ///< where the driver's errors are looked up after each pass
};

/// Runs passes in the order of their declaration; a pass that reads what no earlier pass wrote is refused.
class Graph {
 public:
  /// `outputSize` is the size of full-screen passes that do not give one.
  Graph(std::string name, glm::ivec2 outputSize, gl::ShaderSources sources);
  ~Graph();
  Graph(const Graph&) = delete;
  Graph& operator=(const Graph&) = delete;

  GraphBuilder& builder();
  /// Ends the declaration: drops passes that no output needs, allocates, makes framebuffers. Throws Error.
  void compile(std::span<const Texture> outputs);

  /// `revisions` as of this frame. Throws Error with the pass's name; the graph can be run again.
  GraphReport run(const FrameInputs& frame, Revisions revisions, const GraphRun& options);
  UniformWriter& uniforms();

  const Facts& facts() const;
  std::shared_ptr<TextureResource> resource(Texture texture) const;
  std::shared_ptr<BufferResource> resource(Buffer buffer) const;
  /// Texels as floats, rows from the top.
  Image read(Texture texture) const;
  /// Of textures and buffers that this graph owns.
  std::size_t memoryBytes() const;
  std::vector<std::string> passNames() const;  ///< those kept
  bool hasCpuPasses() const;                   ///< among those kept
  /// Those it owns and keeps, in the order of their declaration.
  std::vector<std::shared_ptr<TextureResource>> textures() const;

 private:
  friend class GraphDeclaration;
  friend class GraphExecution;
  struct State;
  std::unique_ptr<State> state_;
};

/// The graph's texture as floats, rows from the top; integer textures are refused.
Image readTexture(const TextureResource& texture);

}  // namespace gnomon
