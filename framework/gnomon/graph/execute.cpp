// Execution: what changed is run, the rest is skipped.
#include "gnomon/graph/execution.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "gnomon/base/clock.h"
#include "gnomon/base/error.h"

namespace gnomon {

namespace {

/// What a pass draws, under its name, for debuggers. Ends however the pass
/// ends.
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

/// Counts the samples that pass, if it is to. (Pipeline statistics of fragment shaders are wrong on software renderers.)
class SampleCount {
 public:
  explicit SampleCount(bool counts) {
    if (!counts) return;
    query_ = gl::makeQuery(GL_SAMPLES_PASSED);
    glBeginQuery(GL_SAMPLES_PASSED, query_.name());
  }
  ~SampleCount() { end(); }
  SampleCount(const SampleCount&) = delete;
  SampleCount& operator=(const SampleCount&) = delete;

  /// Waits for it; none where it was not to count.
  std::optional<std::uint64_t> finished() {
    if (!query_) return std::nullopt;
    end();
    GLuint64 passed = 0;
    glGetQueryObjectui64v(query_.name(), GL_QUERY_RESULT, &passed);
    return passed;
  }

 private:
  void end() {
    if (query_ && counting_) glEndQuery(GL_SAMPLES_PASSED);
    counting_ = false;
  }

  gl::QueryObject query_;
  bool counting_ = true;
};

template <class Handles, class Handle>
bool contains(const Handles& handles, Handle handle) {
  return std::find(handles.begin(), handles.end(), handle) != handles.end();
}

}  // namespace

void GraphExecution::execute() {
  s_.report.counters = {};
  s_.report.pixelReads = options_.countReads ? Image(s_.outputSize.x, s_.outputSize.y) : Image();
  for (PassReport& pass : s_.report.passes) {
    pass.ran = false;
    pass.work = {};
    pass.fragments.reset();
    pass.reads.reset();
    pass.uncounted.clear();
    pass.cpuMs = pass.wallMs = 0.0;
  }
  for (PassNode& node : s_.passes) {
    if (node.kept) step(node);
  }
}

// --- CpuContext ---

std::span<const float> GraphExecution::read(Texture texture) {
  ReadBack& back = readBack(declaredRead(texture));
  if (back.floats.empty()) readInto(*back.texture, back.floats, s_.byteScratch);
  return back.floats;
}

std::span<const std::uint32_t> GraphExecution::readIntegers(Texture texture) {
  ReadBack& back = readBack(declaredRead(texture));
  if (back.integers.empty()) readIntegersInto(*back.texture, back.integers);
  return back.integers;
}

std::span<const std::byte> GraphExecution::readBytes(Buffer buffer) {
  const BufferResource& resource = *s_.buffers.at(static_cast<std::size_t>(buffer.id)).resource;
  if (!contains(node_->ownBuffers, buffer)) {
    throw Error(fmt::format("it reads buffer '{}', which it did not declare", resource.name));
  }
  s_.bufferScratch.resize(resource.bytes);
  glGetNamedBufferSubData(resource.object.name(), 0, static_cast<GLsizeiptr>(resource.bytes), s_.bufferScratch.data());
  return s_.bufferScratch;
}

void GraphExecution::write(Texture texture, std::span<const float> values) {
  const TextureResource& resource = *s_.textures.at(static_cast<std::size_t>(texture.id)).resource;
  if (std::none_of(node_->writes.begin(), node_->writes.end(), [&](const Target& t) { return t.texture == texture; })) {
    throw Error(fmt::format("it writes texture '{}', which it did not declare", resource.name));
  }
  uploadTexels(resource, values);
}

void GraphExecution::write(Buffer buffer, std::span<const std::byte> bytes) {
  BufferResource& resource = *s_.buffers.at(static_cast<std::size_t>(buffer.id)).resource;
  requireDeclared(buffer);
  writeBuffer(resource, bytes);
}

void GraphExecution::draw(DrawList list, std::span<const std::uint8_t> chosen, const glm::dvec3& origin) {
  DrawListState& state = s_.drawLists.at(static_cast<std::size_t>(list.id));
  requireDeclared(state.records);
  frame_.gpu.select(frame_.scene, chosen, origin, state.storage->records, state.storage->commands);
  upload(state, s_.buffer(state.records));
}

const TextureResource& GraphExecution::declaredRead(Texture texture) const {
  const TextureResource& resource = *s_.textures.at(static_cast<std::size_t>(texture.id)).resource;
  if (contains(node_->textureReads, texture)) return resource;
  throw Error(fmt::format("it reads texture '{}', which it did not declare", resource.name));
}

/// Its values are cleared, but keep their memory, when the texture has changed
/// since they were read.
ReadBack& GraphExecution::readBack(const TextureResource& texture) {
  auto found = std::find_if(s_.readBacks.begin(), s_.readBacks.end(), [&](const ReadBack& b) { return b.texture == &texture; });
  if (found == s_.readBacks.end()) {
    s_.readBacks.emplace_back().texture = &texture;
    found = std::prev(s_.readBacks.end());
  }
  if (found->revision != texture.revision) {
    found->revision = texture.revision;
    found->floats.clear();
    found->integers.clear();
  }
  return *found;
}

void GraphExecution::requireDeclared(Buffer buffer) const {
  if (contains(node_->bufferWrites, buffer)) return;
  throw Error(fmt::format("it writes buffer '{}', which it did not declare", s_.buffer(buffer).name));
}

/// Uploads records and commands; storage grows by doubling and is kept.
void GraphExecution::upload(DrawListState& list, BufferResource& records) {
  DrawStorage& storage = *list.storage;
  const std::span<const std::byte> content = std::as_bytes(std::span(storage.records));
  const bool same = std::equal(content.begin(), content.end(), records.contents.begin(), records.contents.end());
  if (same && records.object) return;
  if (content.size() > records.bytes || !records.object) {
    records.bytes = std::max<std::size_t>(content.size(), records.bytes * 2);
    records.object = gl::makeBuffer(records.bytes, nullptr, records.name);
  }
  records.contents.assign(content.begin(), content.end());
  if (!content.empty()) {
    glNamedBufferSubData(records.object.name(), 0, static_cast<GLsizeiptr>(content.size()), content.data());
  }
  const std::vector<DrawCommand>& commands = storage.commands;
  if (commands.size() > storage.commandCapacity || !storage.commandBuffer) {
    storage.commandCapacity = std::max<std::size_t>(commands.size(), 1);
    storage.commandBuffer = gl::makeBuffer(storage.commandCapacity * sizeof(DrawCommand), nullptr, list.name + " commands");
  }
  if (!commands.empty()) {
    glNamedBufferSubData(storage.commandBuffer.name(), 0, static_cast<GLsizeiptr>(commands.size() * sizeof(DrawCommand)),
                         commands.data());
  }
  records.revision = nextRevision();
}

// --- skipping ---

bool GraphExecution::changed(const PassNode& node) const {
  const PassMemory& memory = *node.memory;
  if (!memory.everRan || !options_.skipUnchanged) return true;
  for (std::size_t i = 0; i < kInputCount; ++i) {
    if (node.inputs.has(static_cast<Input>(i)) && memory.seen.of[i] != revisions_.of[i]) return true;
  }
  const std::vector<std::uint64_t>& seen = memory.seenRevisions;
  if (seen.size() != node.textureReads.size() + node.bufferReads.size()) return true;  // another program
  std::size_t k = 0;
  for (const Texture read : node.textureReads) {
    if (seen[k++] != s_.texture(read).revision) return true;
  }
  for (const Buffer read : node.bufferReads) {
    if (seen[k++] != s_.buffer(read).revision) return true;
  }
  return false;
}

void GraphExecution::remember(PassNode& node) const {
  PassMemory& memory = *node.memory;
  memory.everRan = true;
  memory.seen = revisions_;
  memory.seenRevisions.clear();
  for (const Texture read : node.textureReads) memory.seenRevisions.push_back(s_.texture(read).revision);
  for (const Buffer read : node.bufferReads) memory.seenRevisions.push_back(s_.buffer(read).revision);
}

/// After a failure: what it wrote is of no known revision, and what it read may
/// have come with an error.
void GraphExecution::forget(PassNode& node) const {
  node.memory->everRan = false;
  for (const Target& written : node.writes) s_.texture(written.texture).revision = nextRevision();
  s_.readBacks.clear();
}

void GraphExecution::step(PassNode& node) {
  if (!changed(node)) {
    ++s_.report.counters.passesSkipped;
    return;
  }
  remake(node);
  runTimed(node);
  for (const Target& written : node.writes) s_.texture(written.texture).revision = nextRevision();
  if (!std::holds_alternative<CpuPass>(node.kind)) {
    for (const Buffer written : node.bufferWrites) s_.buffer(written).revision = nextRevision();
  }
  remember(node);
}

/// Makes the transient textures that the pass reads again if others have taken
/// their memory since: all of them and what they are made of, in the order of
/// the frame, in which no two that are needed at once share memory. They come
/// out as they were, so that nobody else has to run.
void GraphExecution::remake(const PassNode& node) {
  const auto isLost = [&](Texture read) {
    const TextureResource& resource = s_.texture(read);
    return resource.info.transient && resource.object.holder() != &resource;
  };
  if (std::none_of(node.textureReads.begin(), node.textureReads.end(), isLost)) return;
  for (const std::size_t index : node.remakes) {
    PassNode& maker = s_.passes[index];
    if (!s_.report.passes[maker.report].ran) --s_.report.counters.passesSkipped;
    runTimed(maker);
  }
}

void GraphExecution::runTimed(PassNode& node) {
  PassReport& report = s_.report.passes[node.report];
  if (!report.ran) ++s_.report.counters.passesRun;
  report.ran = true;
  node_ = &node;
  const double cpu = options_.timePasses ? processCpuMs() : 0.0;
  const double wall = options_.timePasses ? wallMs() : 0.0;
  const FrameCounters before = s_.report.counters;
  const bool draws = std::holds_alternative<RasterPass>(node.kind) || std::holds_alternative<FullscreenPass>(node.kind);
  try {
    const DebugGroup group(node.name);
    if (options_.countReads) counter_ = ReadCounter::of(s_, node, report);
    SampleCount samples(options_.countFragments && draws);
    std::visit([&](const auto& kind) { perform(node, kind); }, node.kind);
    if (counter_) counter_->finish(s_, report, s_.report.pixelReads);
    counter_.reset();
    if (const auto passed = samples.finished()) report.fragments = report.fragments.value_or(0) + *passed;
    for (const Target& written : node.writes) s_.texture(written.texture).object.hold(&s_.texture(written.texture));
    if (options_.messages != nullptr) options_.messages->throwIfError("while it ran");
    if (options_.checkFinite) {
      for (const Target& written : node.writes) requireFinite(s_.texture(written.texture), s_.readScratch, s_.byteScratch);
    }
  } catch (const std::exception& error) {
    forget(node);
    throw Error(fmt::format("pass '{}': {}", node.name, error.what()));
  } catch (...) {
    forget(node);
    throw Error(fmt::format("pass '{}': it threw something that is no std::exception", node.name));
  }
  report.work += s_.report.counters - before;
  if (options_.timePasses) {
    glFinish();
    report.cpuMs += processCpuMs() - cpu;
    report.wallMs += wallMs() - wall;
  }
}

const GraphReport& Graph::run(const FrameInputs& frame, Revisions revisions, const GraphRun& options) {
  if (!state_->compiled) throw Error("graph '" + state_->name + "' runs before it was compiled");
  GraphExecution(*state_, frame, revisions, options).execute();
  return state_->report;
}

}  // namespace gnomon
