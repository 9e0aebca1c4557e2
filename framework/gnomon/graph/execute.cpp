// Execution: what changed is run, the rest is skipped; every pass sets all the state it needs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

#include "gnomon/base/clock.h"
#include "gnomon/base/error.h"
#include "gnomon/graph/state.h"

namespace gnomon {

namespace {

/// Writes and raises the revision only if the bytes differ.
void writeBuffer(BufferResource& buffer, std::span<const std::byte> bytes) {
  if (bytes.size() > buffer.contents.size()) {
    throw Error(fmt::format("buffer '{}' holds {} bytes, {} were written", buffer.name, buffer.contents.size(), bytes.size()));
  }
  if (std::memcmp(buffer.contents.data(), bytes.data(), bytes.size()) == 0) return;
  std::memcpy(buffer.contents.data(), bytes.data(), bytes.size());
  glNamedBufferSubData(buffer.object.name(), 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
  ++buffer.revision;
}

std::uint64_t texels(glm::ivec2 size) {
  return static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y);
}

GLenum channelLayout(const FormatFacts& facts) {
  if (facts.depth) return GL_DEPTH_COMPONENT;
  return facts.channels == 1 ? GL_RED : facts.channels == 2 ? GL_RG : GL_RGBA;
}

void readInto(const TextureResource& texture, std::vector<float>& out) {
  const FormatFacts& facts = formatFacts(texture.info.format);
  out.resize(texels(texture.info.size) * static_cast<std::size_t>(facts.channels));
  if (texture.info.format == Format::r8) {  // several times as fast as the driver's conversion
    std::vector<std::uint8_t> bytes(out.size());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureImage(texture.object.name(), 0, GL_RED, GL_UNSIGNED_BYTE, static_cast<GLsizei>(bytes.size()), bytes.data());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    std::transform(bytes.begin(), bytes.end(), out.begin(), [](std::uint8_t b) { return static_cast<float>(b) / 255.0f; });
    return;
  }
  glGetTextureImage(texture.object.name(), 0, channelLayout(facts), GL_FLOAT, static_cast<GLsizei>(out.size() * sizeof(float)),
                    out.data());
}

/// What a pass draws, under its name, for debuggers. Ends however the pass ends.
class DebugGroup {
 public:
  explicit DebugGroup(const std::string& name) {
    glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, static_cast<GLsizei>(std::min<std::size_t>(name.size(), 255)),
                     name.c_str());
  }
  ~DebugGroup() { glPopDebugGroup(); }
  DebugGroup(const DebugGroup&) = delete;
  DebugGroup& operator=(const DebugGroup&) = delete;
};

class Uniforms final : public UniformWriter {
 public:
  explicit Uniforms(const std::vector<std::shared_ptr<BufferResource>>& buffers) : buffers_(buffers) {}
  void write(Buffer buffer, std::span<const std::byte> bytes) override {
    writeBuffer(*buffers_.at(static_cast<std::size_t>(buffer.id)), bytes);
  }

 private:
  const std::vector<std::shared_ptr<BufferResource>>& buffers_;
};

}  // namespace

/// Runs one frame.
class GraphExecution final : public CpuContext {
 public:
  GraphExecution(Graph::State& state, const FrameInputs& frame, const Revisions& revisions, const GraphRun& options)
      : s_(state), frame_(frame), revisions_(revisions), options_(options) {}

  GraphReport execute() {
    report_.passes.reserve(s_.passes.size());
    for (PassNode& node : s_.passes) {
      if (node.kept) step(node);
    }
    return std::move(report_);
  }

  // --- CpuContext ---
  const FrameInputs& frame() const override { return frame_; }
  std::span<const float> read(Texture texture) override {
    ReadBack& back = readBack(declaredRead(texture));
    if (back.floats.empty()) readInto(*back.texture, back.floats);
    return back.floats;
  }
  std::span<const std::uint32_t> readIntegers(Texture texture) override {
    ReadBack& back = readBack(declaredRead(texture));
    if (back.integers.empty()) {
      back.integers.resize(texels(back.texture->info.size) * 2);
      glGetTextureImage(back.texture->object.name(), 0, GL_RG_INTEGER, GL_UNSIGNED_INT,
                        static_cast<GLsizei>(back.integers.size() * 4), back.integers.data());
    }
    return back.integers;
  }
  void write(Texture texture, std::span<const float> values) override {
    bool declared = false;
    for (const Texture t : node_->writes) declared = declared || t == texture;
    TextureResource& resource = *s_.textures.at(static_cast<std::size_t>(texture.id));
    if (!declared) throw Error(fmt::format("it writes texture '{}', which it did not declare", resource.name));
    const FormatFacts& facts = formatFacts(resource.info.format);
    if (values.size() != texels(resource.info.size) * static_cast<std::size_t>(facts.channels)) {
      throw Error(fmt::format("texture '{}' has {} values, {} were written", resource.name,
                              texels(resource.info.size) * static_cast<std::size_t>(facts.channels), values.size()));
    }
    glTextureSubImage2D(resource.object.name(), 0, 0, 0, resource.info.size.x, resource.info.size.y, channelLayout(facts),
                        GL_FLOAT, values.data());
  }
  void write(Buffer buffer, std::span<const std::byte> bytes) override {
    BufferResource& resource = *s_.buffers.at(static_cast<std::size_t>(buffer.id));
    requireDeclared(resource);
    writeBuffer(resource, bytes);
  }
  void draw(DrawList list, std::span<const std::uint8_t> chosen, const glm::dvec3& origin) override {
    DrawListState& state = s_.drawLists.at(static_cast<std::size_t>(list.id));
    requireDeclared(*state.records);
    frame_.gpu.select(frame_.scene, chosen, origin, state.scratchRecords, state.commands);
    upload(state);
  }
  Facts& facts() override { return s_.facts; }
  FrameCounters& counters() override { return report_.counters; }

 private:
  const std::shared_ptr<TextureResource>& declaredRead(Texture texture) const {
    const auto& resource = s_.textures.at(static_cast<std::size_t>(texture.id));
    for (const auto& read : node_->textureReads) {
      if (read == resource) return resource;
    }
    throw Error(fmt::format("it reads texture '{}', which it did not declare", resource->name));
  }

  /// Its values are cleared, but keep their memory, when the texture has changed since they were read.
  ReadBack& readBack(const std::shared_ptr<TextureResource>& texture) {
    auto found =
        std::find_if(s_.readBacks.begin(), s_.readBacks.end(), [&](const ReadBack& b) { return b.texture == texture; });
    if (found == s_.readBacks.end()) {
      s_.readBacks.emplace_back().texture = texture;
      found = std::prev(s_.readBacks.end());
    }
    if (found->revision != texture->revision) {
      found->revision = texture->revision;
      found->floats.clear();
      found->integers.clear();
    }
    return *found;
  }

  void requireDeclared(const BufferResource& resource) const {
    for (const auto& write : node_->bufferWrites) {
      if (write.get() == &resource) return;
    }
    throw Error(fmt::format("it writes buffer '{}', which it did not declare", resource.name));
  }

  /// Uploads records and commands; storage grows by doubling and is kept.
  static void upload(DrawListState& state) {
    const std::size_t bytes = state.scratchRecords.size() * sizeof(DrawRecord);
    const std::span<const std::byte> content(reinterpret_cast<const std::byte*>(state.scratchRecords.data()), bytes);
    BufferResource& records = *state.records;
    const bool same = std::equal(content.begin(), content.end(), records.contents.begin(), records.contents.end());
    if (same && records.object) return;
    if (bytes > records.bytes || !records.object) {
      records.bytes = std::max<std::size_t>(bytes, records.bytes * 2);
      records.object = gl::makeBuffer(records.bytes, nullptr, records.name);
    }
    records.contents.assign(content.begin(), content.end());
    if (bytes > 0) glNamedBufferSubData(records.object.name(), 0, static_cast<GLsizeiptr>(bytes), content.data());
    if (state.commands.size() > state.commandCapacity || !state.commandBuffer) {
      state.commandCapacity = std::max<std::size_t>(state.commands.size(), 1);
      state.commandBuffer = gl::makeBuffer(state.commandCapacity * sizeof(DrawCommand), nullptr, state.name + " commands");
    }
    if (!state.commands.empty()) {
      glNamedBufferSubData(state.commandBuffer.name(), 0, static_cast<GLsizeiptr>(state.commands.size() * sizeof(DrawCommand)),
                           state.commands.data());
    }
    ++records.revision;
  }

  bool changed(const PassNode& node) const {
    if (!node.everRan || !options_.skipUnchanged) return true;
    for (std::size_t i = 0; i < kInputCount; ++i) {
      if (node.inputs.has(static_cast<Input>(i)) && node.seen.of[i] != revisions_.of[i]) return true;
    }
    std::size_t k = 0;
    for (const auto& read : node.textureReads) {
      if (node.seenRevisions[k++] != read->revision) return true;
    }
    for (const auto& read : node.bufferReads) {
      if (node.seenRevisions[k++] != read->revision) return true;
    }
    return false;
  }

  void remember(PassNode& node) const {
    node.everRan = true;
    node.seen = revisions_;
    node.seenRevisions.clear();
    for (const auto& read : node.textureReads) node.seenRevisions.push_back(read->revision);
    for (const auto& read : node.bufferReads) node.seenRevisions.push_back(read->revision);
  }

  /// After a failure: what it wrote is of no known revision, and what it read may have come with an error.
  void forget(PassNode& node) const {
    node.everRan = false;
    for (const Texture written : node.writes) ++s_.textures[static_cast<std::size_t>(written.id)]->revision;
    s_.readBacks.clear();
  }

  void step(PassNode& node) {
    PassReport pass{node.name};
    if (changed(node)) {
      node_ = &node;
      const double cpu = options_.timePasses ? processCpuMs() : 0.0;
      const double wall = options_.timePasses ? wallMs() : 0.0;
      try {
        const DebugGroup group(node.name);
        std::visit([&](const auto& kind) { perform(node, kind); }, node.kind);
        if (options_.messages != nullptr) options_.messages->throwIfError("while it ran");
        if (options_.checkFinite) checkFinite(node);
      } catch (const std::exception& error) {
        forget(node);
        throw Error(fmt::format("pass '{}': {}", node.name, error.what()));
      } catch (...) {
        forget(node);
        throw Error(fmt::format("pass '{}': it threw something that is no std::exception", node.name));
      }
      for (const Texture written : node.writes) ++s_.textures[static_cast<std::size_t>(written.id)]->revision;
      remember(node);
      if (options_.timePasses) {
        glFinish();
        pass.cpuMs = processCpuMs() - cpu;
        pass.wallMs = wallMs() - wall;
      }
      pass.ran = true;
      ++report_.counters.passesRun;
    } else {
      ++report_.counters.passesSkipped;
    }
    report_.passes.push_back(std::move(pass));
  }

  void prepare(const PassNode& node, GLuint vertexArray) {
    glBindFramebuffer(GL_FRAMEBUFFER, node.framebuffer.name());
    glViewport(0, 0, node.size.x, node.size.y);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glDepthRangef(0.0f, 1.0f);
    for (const GLenum off :
         {GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_CULL_FACE, GL_BLEND, GL_COLOR_LOGIC_OP, GL_POLYGON_OFFSET_FILL,
          GL_FRAMEBUFFER_SRGB, GL_RASTERIZER_DISCARD, GL_SAMPLE_MASK, GL_SAMPLE_ALPHA_TO_COVERAGE}) {
      glDisable(off);
    }
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glUseProgram(node.bound.program.name());
    glBindVertexArray(vertexArray);
    for (const auto& [unit, texture] : node.bound.textures) {
      glBindTextureUnit(unit, texture->object.name());
      glBindSampler(unit, s_.nearest.name());
    }
    for (const BoundProgram::Block& block : node.bound.blocks) {
      const GLuint buffer = block.buffer ? block.buffer->object.name() : frame_.gpu.triangleNormals();
      glBindBufferBase(block.target, block.binding, buffer);
    }
  }

  void perform(const PassNode& node, const FullscreenPass& pass) {
    prepare(node, s_.emptyVertexArray.name());
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_DEPTH_CLAMP);
    if (pass.clear) glClearNamedFramebufferfv(node.framebuffer.name(), GL_COLOR, 0, &pass.clear->x);
    glm::ivec4 region(0, 0, node.size);
    if (pass.region) {  // after the clear, which a scissor would hold back too
      region = pass.region();
      glEnable(GL_SCISSOR_TEST);
      glScissor(region.x, region.y, region.z, region.w);
    }
    glDrawArrays(GL_TRIANGLES, 0, 3);
    ++report_.counters.draws;
    report_.counters.texelsWritten += texels({region.z, region.w});
  }

  void perform(const PassNode& node, const RasterPass& pass) {
    const DrawListState& list = s_.drawLists[static_cast<std::size_t>(pass.draws.id)];
    prepare(node, frame_.gpu.vertexArray());
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_GREATER);
    if (pass.depthClamp) {
      glEnable(GL_DEPTH_CLAMP);
    } else {
      glDisable(GL_DEPTH_CLAMP);
    }
    for (std::size_t i = 0; i < pass.colours.size(); ++i) clearColour(node, pass, i);
    const float farthest = 0.0f;
    const bool stencil = pass.depth && s_.textures[static_cast<std::size_t>(pass.depth->id)]->info.format == Format::d32f_s8;
    if (stencil) {
      glStencilMask(0xff);
      glClearNamedFramebufferfi(node.framebuffer.name(), GL_DEPTH_STENCIL, 0, farthest, 0);
    } else if (pass.depth) {
      glClearNamedFramebufferfv(node.framebuffer.name(), GL_DEPTH, 0, &farthest);
    }
    if (!list.commands.empty()) {
      glBindBuffer(GL_DRAW_INDIRECT_BUFFER, list.commandBuffer.name());
      glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, nullptr, static_cast<GLsizei>(list.commands.size()), 0);
    }
    for (const DrawCommand& command : list.commands) {
      ++report_.counters.draws;
      report_.counters.primitives += std::uint64_t{command.count} / 3 * command.instanceCount;
    }
    report_.counters.texelsWritten += texels(node.size) * node.writes.size();
  }

  void clearColour(const PassNode& node, const RasterPass& pass, std::size_t i) const {
    const glm::vec4 value = i < pass.clears.size() ? pass.clears[i] : glm::vec4(0.0f);
    if (s_.textures[static_cast<std::size_t>(pass.colours[i].id)]->info.format == Format::rg32ui) {
      const std::array<GLuint, 4> none{~0U, ~0U, 0U, 0U};
      glClearNamedFramebufferuiv(node.framebuffer.name(), GL_COLOR, static_cast<GLint>(i), none.data());
    } else {
      glClearNamedFramebufferfv(node.framebuffer.name(), GL_COLOR, static_cast<GLint>(i), &value.x);
    }
  }

  void perform(const PassNode& node, const CpuPass& pass) {
    pass.run(*this);
    for (const Texture texture : node.writes) {
      report_.counters.texelsWritten += texels(s_.textures[static_cast<std::size_t>(texture.id)]->info.size);
    }
  }

  void checkFinite(const PassNode& node) {
    for (const Texture texture : node.writes) {
      const TextureResource& resource = *s_.textures[static_cast<std::size_t>(texture.id)];
      if (resource.info.format == Format::rg32ui) continue;
      readInto(resource, s_.readScratch);
      const auto channels = static_cast<std::size_t>(formatFacts(resource.info.format).channels);
      for (std::size_t i = 0; i < s_.readScratch.size(); ++i) {
        if (std::isfinite(s_.readScratch[i])) continue;
        const std::size_t pixel = i / channels;
        const auto width = static_cast<std::size_t>(resource.info.size.x);
        throw Error(fmt::format("target '{}' holds {} at pixel ({}, {}), channel {}", resource.name, s_.readScratch[i],
                                pixel % width, pixel / width, i % channels));
      }
    }
  }

  Graph::State& s_;
  const FrameInputs& frame_;
  const Revisions& revisions_;
  const GraphRun& options_;
  PassNode* node_ = nullptr;
  GraphReport report_;
};

GraphReport Graph::run(const FrameInputs& frame, Revisions revisions, const GraphRun& options) {
  if (!state_->compiled) throw Error("graph '" + state_->name + "' runs before it was compiled");
  return GraphExecution(*state_, frame, revisions, options).execute();
}

UniformWriter& Graph::uniforms() {
  if (!state_->uniforms) state_->uniforms = std::make_unique<Uniforms>(state_->buffers);
  return *state_->uniforms;
}

Image readTexture(const TextureResource& texture) {
  const FormatFacts& facts = formatFacts(texture.info.format);
  if (texture.info.format == Format::rg32ui) throw Error(fmt::format("texture '{}' holds integers", texture.name));
  Image image(texture.info.size.x, texture.info.size.y, facts.channels);
  readInto(texture, image.data);
  return image;
}

Image Graph::read(Texture texture) const {
  return readTexture(*resource(texture));
}

}  // namespace gnomon
