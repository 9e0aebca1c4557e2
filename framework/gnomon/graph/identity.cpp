#include "gnomon/graph/identity.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace gnomon {

namespace {

/// Exact.
std::string textOf(const glm::vec4& v) {
  return fmt::format("{:a},{:a},{:a},{:a}", v.x, v.y, v.z, v.w);
}

template <class Enum>
int number(Enum value) {
  return static_cast<int>(value);
}

std::string textOf(const StencilFace& face) {
  return fmt::format("{} {} {} {}", number(face.compare), number(face.fail), number(face.depthFail), number(face.pass));
}

std::string textOf(const Indirect& indirect) {
  return fmt::format("indirect {} {}", indirect.offset, indirect.commands);
}

/// State of a pass beside program and resources; nothing where it cannot be
/// told.
std::optional<std::string> stateOf(const FullscreenPass& pass) {
  if (pass.region) return std::nullopt;
  std::string text = fmt::format("screen {} ", number(pass.blend));
  if (pass.clear) text += "clear " + textOf(*pass.clear);
  if (pass.from) text += " from";
  if (pass.stencil) {
    text += fmt::format(" stencil {} {} {}", number(pass.stencil->compare), pass.stencil->reference, pass.stencil->mask);
  }
  return text;
}

std::optional<std::string> stateOf(const RasterPass& pass) {
  std::string text =
      fmt::format("raster {} {} {} {} {} {} {} {} ", pass.colours.size(), pass.layer.value_or(-1), number(pass.depthTest),
                  pass.depthWrite, pass.depthClamp, number(pass.blend), number(pass.cull), pass.depth.has_value());
  if (pass.depthFrom) text += "from ";
  if (pass.depthRead) text += "tested ";
  for (const glm::vec4& clear : pass.clears) text += "clear " + textOf(clear);
  if (pass.indirect) text += textOf(*pass.indirect);
  if (pass.vertices) {
    text +=
        fmt::format(" vertices {} {} {} ", number(pass.vertices->topology), pass.vertices->vertices, pass.vertices->instances);
    if (pass.vertices->indirect) text += textOf(*pass.vertices->indirect);
  }
  if (pass.stencil) {
    text += fmt::format(" stencil {} / {} / {} {} {}", textOf(pass.stencil->counterClockwise), textOf(pass.stencil->clockwise),
                        pass.stencil->reference, pass.stencil->readMask, pass.stencil->writeMask);
  }
  return text;
}

std::optional<std::string> stateOf(const ComputePass& pass) {
  std::string text = fmt::format("compute {} {} {} ", pass.groups.x, pass.groups.y, pass.groups.z);
  if (pass.clear) text += "clear " + textOf(*pass.clear);
  if (pass.indirect) text += textOf(*pass.indirect);
  return text;
}

std::optional<std::string> stateOf(const CpuPass& pass) {
  const std::string identity = pass.identity && pass.writes.empty() ? pass.identity() : std::string();
  if (identity.empty()) return std::nullopt;
  return "cpu " + identity;
}

std::optional<std::string> stateOf(const HistoryPass& /*pass*/) {
  return std::nullopt;
}

/// A resource as others name it: who imported it, or the shared pass that
/// writes it; nothing if it is this graph's alone.
std::optional<std::string> nameOf(const Graph::State& s, Texture texture) {
  const TextureSlot& slot = s.at(texture);
  if (slot.imported) return fmt::format(" texture {}", static_cast<const void*>(slot.resource.get()));
  if (slot.isHistory) return std::nullopt;
  std::string text = " texture";
  for (const int writer : slot.writers) {
    const PassNode& node = s.passes[static_cast<std::size_t>(writer)];
    if (!node.shared) return std::nullopt;
    const auto at = std::find_if(node.writes.begin(), node.writes.end(), [&](const Target& t) { return t.texture == texture; });
    text += fmt::format(" {}.{}", node.shared->serial, at - node.writes.begin());
  }
  return text;
}

std::optional<std::string> nameOf(const Graph::State& s, Buffer buffer) {
  const BufferSlot& slot = s.at(buffer);
  if (slot.imported) return fmt::format(" buffer {}", static_cast<const void*>(slot.resource.get()));
  if (slot.writer < 0) return std::nullopt;
  const PassNode& node = s.passes[static_cast<std::size_t>(slot.writer)];
  if (!node.shared) return std::nullopt;
  const auto at = std::find(node.bufferWrites.begin(), node.bufferWrites.end(), buffer);
  return fmt::format(" buffer {}.{}", node.shared->serial, at - node.bufferWrites.begin());
}

}  // namespace

std::string identityOf(const Graph::State& s, const PassNode& node) {
  const std::optional<std::string> state = std::visit([](const auto& kind) { return stateOf(kind); }, node.kind);
  if (!state) return {};
  std::string text = *state + "\ninputs";
  for (std::size_t i = 0; i < kInputCount; ++i) text += node.inputs.has(static_cast<Input>(i)) ? " 1" : " 0";
  for (const Target& target : node.writes) {
    const TextureSlot& slot = s.at(target.texture);
    const TextureInfo& info = slot.resource->info;
    // Layers of one texture by several passes: sharing some of them would need
    // one texture in two places.
    const bool alone = std::all_of(slot.writers.begin(), slot.writers.end(), [&](int w) { return w == slot.writers[0]; });
    if (slot.isOutput || slot.isHistory || info.transient || !alone) return {};
    text += fmt::format("\nwrites {}x{}x{} {}", info.size.x, info.size.y, info.layers, number(info.format));
  }
  for (const Buffer buffer : node.bufferWrites) {
    const bool records =
        std::any_of(s.drawLists.begin(), s.drawLists.end(), [&](const auto& l) { return l.records == buffer; });
    text += records ? "\nwrites records" : fmt::format("\nwrites {} bytes", s.buffer(buffer).bytes);
  }
  for (const NamedTexture& image : node.recipe.images) text += '\n' + image.name;
  for (const NamedBuffer& written : node.recipe.writes) text += '\n' + written.name;
  text += "\nreads";
  for (const Texture read : node.textureReads) {
    const std::optional<std::string> name = nameOf(s, read);
    if (!name) return {};
    text += *name;
  }
  const bool tells = std::holds_alternative<CpuPass>(node.kind);  // its identity holds the parameters' values
  for (const Buffer read : node.bufferReads) {
    if (tells && !s.at(read).imported && s.at(read).writer < 0) continue;
    const std::optional<std::string> name = nameOf(s, read);
    if (!name) return {};
    text += *name;
  }
  if (node.bound.program) text += '\n' + node.bound.program->text;
  return text;
}

}  // namespace gnomon
