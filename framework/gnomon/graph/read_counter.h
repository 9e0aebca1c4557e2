// Counts the texels that a pass reads, by running it with another program. Not part of the contract.
#pragma once

#include <optional>

#include "gnomon/graph/state.h"

namespace gnomon {

class ReadCounter {
 public:
  /// Of a pass with a program. Empty for others, and where its reads cannot be counted: then the report says why.
  static std::optional<ReadCounter> of(const Graph::State& state, const PassNode& node, PassReport& report);

  const BoundProgram& bound() const { return bound_; }
  GLuint buffer() const { return counts_.name(); }
  /// After the pass has run: adds its counts to the report, and those of pixels to the image.
  void finish(const Graph::State& state, PassReport& report, Image& pixelReads) const;

 private:
  ReadCounter(BoundProgram bound, const std::optional<glm::ivec2>& pixels);

  BoundProgram bound_;
  std::optional<glm::ivec2> pixels_;
  std::size_t words_;
  gl::BufferObject counts_;
};

}  // namespace gnomon
