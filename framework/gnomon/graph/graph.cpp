// The graph from outside: what is kept of it, and what it holds.
#include "gnomon/graph/graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "gnomon/base/error.h"
#include "gnomon/graph/state.h"

namespace gnomon {

namespace {

class Uniforms final : public UniformWriter {
 public:
  explicit Uniforms(const std::vector<BufferSlot>& buffers) : buffers_(buffers) {}
  void write(Buffer buffer, std::span<const std::byte> bytes) override {
    if (buffer.id < 0 || static_cast<std::size_t>(buffer.id) >= buffers_.size())
      throw Error("update writes a buffer that was never declared");
    const BufferSlot& slot = buffers_[static_cast<std::size_t>(buffer.id)];
    if (slot.imported) throw Error("update writes buffer '" + slot.resource->name + "', which belongs to others");
    writeBuffer(*slot.resource, bytes);
  }

 private:
  const std::vector<BufferSlot>& buffers_;
};

}  // namespace

GraphBuilder& Graph::builder() {
  return *state_->builder;
}

void Graph::compile(std::span<const Texture> outputs) {
  State& s = *state_;
  if (s.compiled) throw Error("graph '" + s.name + "' is compiled already");
  for (const Texture texture : outputs) {
    if (texture.id < 0 || static_cast<std::size_t>(texture.id) >= s.textures.size()) {
      throw Error("graph '" + s.name + "': an output was never declared");
    }
    TextureSlot& slot = s.at(texture);
    const std::string& name = slot.resource->name;
    if (!slot.imported && std::any_of(slot.writers.begin(), slot.writers.end(), [](int writer) { return writer < 0; })) {
      throw Error(
          fmt::format("graph '{}': nothing writes its output '{}'; "
                      "declare a pass that does",
                      s.name, name));
    }
    if (slot.resource->info.transient) {
      throw Error(
          fmt::format("graph '{}': its output '{}' is transient, and "
                      "would not keep its contents",
                      s.name, name));
    }
    slot.isOutput = true;
    s.outputs.push_back(texture);
  }
  layOut(s);
  s.compiled = true;
}

void Graph::specialise(const std::vector<Constant>& constants) {
  State& s = *state_;
  const std::vector<gl::Constant> before = s.specialised;
  s.specialised.clear();
  for (const Constant& constant : constants) s.specialised.push_back({constant.name, constant.value});
  std::vector<std::pair<PassNode*, BoundProgram>> others;
  try {
    for (std::size_t i = 0; i < s.passes.size(); ++i) {
      PassNode& node = s.passes[i];
      if (!node.bound.program) continue;
      BoundProgram bound = bindProgram(s, node, i);
      if (bound.program != node.bound.program) others.emplace_back(&node, std::move(bound));
    }
  } catch (...) {
    s.specialised = before;
    throw;
  }
  if (others.empty()) return;
  for (auto& [node, bound] : others) {
    useProgram(*node, std::move(bound));
    if (node->shared) {
      node->memory = std::make_shared<PassMemory>();  // the others go on with theirs
    } else {
      *node->memory = {};
    }
  }
  if (s.compiled) layOut(s);
}

void Graph::refreshSharing() {
  if (state_->compiled && state_->shares.passes) layOut(*state_);
}

void Graph::cut() {
  State& s = *state_;
  for (const PassNode& node : s.passes) {
    const auto* pass = std::get_if<HistoryPass>(&node.kind);
    if (pass == nullptr || !node.kept) continue;
    TextureSlot& slot = s.at(pass->history);
    clearTexture(*slot.resource, slot.reset);
    slot.resource->revision = nextRevision();
    node.memory->everRan = false;
  }
}

UniformWriter& Graph::uniforms() {
  if (!state_->uniforms) state_->uniforms = std::make_unique<Uniforms>(state_->buffers);
  return *state_->uniforms;
}

void Graph::touch(Buffer buffer) {
  resource(buffer)->revision = nextRevision();
}

const Facts& Graph::facts() const {
  return state_->facts;
}

std::shared_ptr<TextureResource> Graph::resource(Texture texture) const {
  if (texture.id < 0 || static_cast<std::size_t>(texture.id) >= state_->textures.size()) {
    throw Error("graph '" + state_->name + "': a texture was never declared");
  }
  return state_->at(texture).resource;
}
std::shared_ptr<BufferResource> Graph::resource(Buffer buffer) const {
  return state_->buffers.at(static_cast<std::size_t>(buffer.id)).resource;
}

Image Graph::read(Texture texture) const {
  return readTexture(*resource(texture));
}

std::size_t Graph::memoryBytes() const {
  const State& s = *state_;
  std::size_t total = 0;
  for (std::size_t i = 0; i < s.textures.size(); ++i) {
    const TextureResource& texture = *s.textures[i].resource;
    if (s.textures[i].imported || !texture.object) continue;
    const auto first = s.textures.begin();
    const bool counted = std::any_of(first, std::next(first, static_cast<std::ptrdiff_t>(i)), [&](const TextureSlot& other) {
      return !other.imported && other.resource->object == texture.object;
    });
    if (!counted) total += bytesOf(texture.info);
  }
  for (const BufferSlot& slot : s.buffers) {
    if (!slot.imported) total += slot.resource->bytes;
  }
  for (const DrawListState& list : s.drawLists) total += list.storage->commandCapacity * sizeof(DrawCommand);
  return total;
}

std::vector<std::string> Graph::passNames() const {
  std::vector<std::string> names;
  for (const PassNode& node : state_->passes) {
    if (node.kept) names.push_back(node.name);
  }
  return names;
}

bool Graph::hasCpuPasses() const {
  return std::any_of(state_->passes.begin(), state_->passes.end(),
                     [](const PassNode& node) { return node.kept && std::holds_alternative<CpuPass>(node.kind); });
}

std::vector<std::shared_ptr<TextureResource>> Graph::textures() const {
  std::vector<std::shared_ptr<TextureResource>> owned;
  for (const TextureSlot& slot : state_->textures) {
    if (!slot.imported && slot.resource->object && !slot.resource->info.transient) owned.push_back(slot.resource);
  }
  return owned;
}

}  // namespace gnomon
