#include "gnomon/graph/read_counter.h"

#include <algorithm>

#include "gnomon/base/error.h"

namespace gnomon {

namespace {

bool hasOutputSize(const Graph::State& s, const PassNode& node) {
  return !node.writes.empty() && std::all_of(node.writes.begin(), node.writes.end(), [&](const Target& target) {
    const TextureInfo& info = s.texture(target.texture).info;
    return info.size == s.outputSize && info.layers == 0;
  });
}

gl::ReadCounting countingOf(const Graph::State& s, const PassNode& node) {
  gl::ReadCounting counting;
  const auto* screen = std::get_if<FullscreenPass>(&node.kind);
  // A map may have the output's size by chance: a full-screen pass over the output gives no size.
  if (hasOutputSize(s, node) && (screen == nullptr || !screen->size)) counting.pixels = s.outputSize;
  if (const auto* raster = std::get_if<RasterPass>(&node.kind))
    counting.writesDepth = (raster->depth && raster->depthWrite) || raster->stencil;
  return counting;
}

std::size_t indexOf(const Graph::State& s, const PassNode& node) {
  const auto found = std::find_if(s.passes.begin(), s.passes.end(), [&](const PassNode& each) { return &each == &node; });
  return static_cast<std::size_t>(found - s.passes.begin());
}

/// The format of what is read through a name; none if the program uses no such.
std::optional<Format> formatOf(const Graph::State& s, const BoundProgram& bound, const std::string& name) {
  const auto among = [&](const std::vector<gl::Program::Point>& points,
                         const std::vector<Texture>& textures) -> std::optional<Format> {
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (points[i].name == name) return s.texture(textures[i]).info.format;
    }
    return std::nullopt;
  };
  const auto sampled = among(bound.program->samplers, bound.textures);
  return sampled ? sampled : among(bound.program->images, bound.images);
}

}  // namespace

ReadCounter::ReadCounter(BoundProgram bound, const std::optional<glm::ivec2>& pixels)
    : bound_(std::move(bound)), pixels_(pixels), words_(2 * bound_.program->readable.size()) {
  if (pixels_) words_ += static_cast<std::size_t>(pixels_->x) * static_cast<std::size_t>(pixels_->y);
  counts_ = gl::makeBuffer(std::max<std::size_t>(words_, 1) * sizeof(std::uint32_t), nullptr, "texel reads");
  glClearNamedBufferData(counts_.name(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

std::optional<ReadCounter> ReadCounter::of(const Graph::State& s, const PassNode& node, PassReport& report) {
  if (node.recipe.stages.empty()) return std::nullopt;
  const gl::ReadCounting counting = countingOf(s, node);
  try {
    return ReadCounter(bindProgram(s, node, indexOf(s, node), counting), counting.pixels);
  } catch (const Error& error) {
    report.uncounted = error.what();
    return std::nullopt;
  }
}

void ReadCounter::finish(const Graph::State& s, PassReport& report, Image& pixelReads) const {
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  std::vector<std::uint32_t> words(words_);
  glGetNamedBufferSubData(counts_.name(), 0, static_cast<GLsizeiptr>(words.size() * sizeof(std::uint32_t)), words.data());
  const std::vector<std::string>& names = bound_.program->readable;
  if (!report.reads) report.reads.emplace();  // a pass that is made again counts twice
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::uint64_t texels = words[2 * i] | std::uint64_t{words[2 * i + 1]} << 32U;
    if (const std::optional<Format> format = formatOf(s, bound_, names[i]); format && texels > 0)
      (*report.reads)[*format] += texels;
  }
  if (!pixels_) return;
  // As in every texture of a graph, rows run from the top.
  const std::size_t first = 2 * names.size();
  for (std::size_t i = 0; i < pixelReads.pixels(); ++i) pixelReads.data[i] += static_cast<float>(words[first + i]);
}

}  // namespace gnomon
