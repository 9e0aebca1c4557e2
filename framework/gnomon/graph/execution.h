// One frame of a graph. Not part of the contract.
#pragma once

#include "gnomon/graph/read_counter.h"
#include "gnomon/graph/state.h"

namespace gnomon {

class GraphExecution final : public CpuContext {
 public:
  GraphExecution(Graph::State& state, const FrameInputs& frame, const Revisions& revisions, const GraphRun& options)
      : s_(state), frame_(frame), revisions_(revisions), options_(options) {}

  /// Leaves what it did in the state's report.
  void execute();

  // --- CpuContext ---
  const FrameInputs& frame() const override { return frame_; }
  std::span<const float> read(Texture texture) override;
  std::span<const std::uint32_t> readIntegers(Texture texture) override;
  std::span<const std::byte> readBytes(Buffer buffer) override;
  void write(Texture texture, std::span<const float> values) override;
  void write(Buffer buffer, std::span<const std::byte> bytes) override;
  void draw(DrawList list, std::span<const std::uint8_t> chosen, const glm::dvec3& origin) override;
  Facts& facts() override { return s_.facts; }
  FrameCounters& counters() override { return s_.report.counters; }

 private:
  const TextureResource& declaredRead(Texture texture) const;
  ReadBack& readBack(const TextureResource& texture);
  void requireDeclared(Buffer buffer) const;
  static void upload(DrawListState& list, BufferResource& records);

  bool changed(const PassNode& node) const;
  void remember(PassNode& node) const;
  void forget(PassNode& node) const;
  void step(PassNode& node);
  void remake(const PassNode& node);
  void runTimed(PassNode& node);

  // draw.cpp
  void perform(const PassNode& node, const FullscreenPass& pass);
  void perform(const PassNode& node, const RasterPass& pass);
  void perform(const PassNode& node, const ComputePass& pass);
  void perform(const PassNode& node, const CpuPass& pass);
  void perform(const PassNode& node, const HistoryPass& pass);
  void prepare(const PassNode& node, GLuint vertexArray, Blend blend);
  void bind(const PassNode& node);
  void clearStorage(const PassNode& node);
  void clearTargets(const PassNode& node, const RasterPass& pass);
  void drawScene(const RasterPass& pass);
  void drawVertices(const VertexDraw& draw);
  void countWritten(const PassNode& node, const std::optional<glm::ivec4>& region = {});
  GLuint bufferOf(const BoundProgram::Block& block) const;

  Graph::State& s_;
  const FrameInputs& frame_;
  const Revisions& revisions_;
  const GraphRun& options_;
  PassNode* node_ = nullptr;
  std::optional<ReadCounter> counter_;  ///< of the pass that runs, where its reads are counted
};

}  // namespace gnomon
