// Declaration: handles, passes, and what makes no sense.
#include <fmt/format.h>

#include <algorithm>

#include "gnomon/base/error.h"
#include "gnomon/graph/state.h"

namespace gnomon {

namespace {

/// What a geometry shader may be invoked for, at least (OpenGL 4.5,
/// MAX_GEOMETRY_SHADER_INVOCATIONS).
constexpr int kMostScreenLayers = 32;

std::vector<gl::Constant> constantsOf(const std::vector<Constant>& constants) {
  std::vector<gl::Constant> all;
  for (const Constant& constant : constants) all.push_back({constant.name, constant.value});
  return all;
}

std::string describe(const TextureInfo& info) {
  const std::string layers = info.layers > 0 ? fmt::format(" x {} layers", info.layers) : "";
  return fmt::format("{}x{}{} {}", info.size.x, info.size.y, layers, formatFacts(info.format).name);
}

bool sameStorage(const TextureInfo& a, const TextureInfo& b) {
  return a.size == b.size && a.format == b.format && a.layers == b.layers;
}

}  // namespace

class GraphDeclaration final : public GraphBuilder {
 public:
  explicit GraphDeclaration(Graph::State& state) : s_(state) {}

  Texture texture(const std::string& name, const TextureInfo& info) override { return addTexture(name, info); }

  Texture history(const std::string& name, const TextureInfo& info, const glm::vec4& reset) override {
    if (info.transient) throw Error(fmt::format("history '{}' is transient, so that nothing of it would be left", name));
    const Texture texture = addTexture(name, info);
    s_.at(texture).isHistory = true;
    s_.at(texture).reset = reset;
    return texture;
  }

  void remember(Texture history, Texture current) override {
    const std::string name = s_.texture(checked(history, "remember")).name;
    PassNode& node = addPass(name);
    if (!s_.at(history).isHistory) throw Error(fmt::format("'{}' is remembered, and was not declared by history", name));
    if (s_.at(history).writers[0] >= 0) throw Error(fmt::format("history '{}' is of two textures", name));
    read(node, current);
    const TextureInfo& from = s_.texture(current).info;
    const TextureInfo& to = s_.texture(history).info;
    if (!sameStorage(from, to) || from.transient) {
      throw Error(fmt::format("history '{}' is {}, and cannot hold '{}', {}{}", name, describe(to), s_.texture(current).name,
                              describe(from), from.transient ? ", transient" : ""));
    }
    std::fill(s_.at(history).writers.begin(), s_.at(history).writers.end(), static_cast<int>(passIndex()));
    node.writes = {{history, -1}};
    node.kind = HistoryPass{history, current};
    useProgram(node, {});
  }

  Buffer buffer(const std::string& name, std::size_t bytes) override {
    auto resource = std::make_shared<BufferResource>();
    resource->name = name;
    resource->bytes = bytes;
    resource->object = gl::makeBuffer(bytes, nullptr, s_.name + "/" + name);
    glClearNamedBufferData(resource->object.name(), GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE, nullptr);
    return addBuffer({std::move(resource), false, -1});
  }

  DrawList drawList(const std::string& name) override {
    auto records = std::make_shared<BufferResource>();
    records->name = name;
    const Buffer buffer = addBuffer({std::move(records), false, -1});
    s_.drawLists.push_back({name, buffer, std::make_shared<DrawStorage>()});
    return {static_cast<int>(s_.drawLists.size()) - 1};
  }

  void provide(const std::string& name, Texture texture) override { context().textures[name] = texture; }
  void provide(const std::string& name, Buffer buffer) override { context().buffers[name] = buffer; }
  void include(const std::string& name, const std::string& text) override { context().sources.generated[name] = text; }
  void constant(const Constant& constant) override { context().constants.push_back({constant.name, constant.value}); }

  Texture fullscreen(const std::string& name, const FullscreenPass& pass) override {
    PassNode& node = addPass(name);
    node.size = pass.size.value_or(s_.outputSize);
    requireColour(node, name, pass.format);
    const Texture target = addTexture(name, {node.size, pass.format, pass.layers, pass.transient});
    if (pass.from) readAs(node, *pass.from, s_.texture(target).info);
    if (pass.stencil) requireStencil(node, pass.stencil->texture);
    write(node, {target, -1});
    node.kind = pass;
    std::vector<gl::ShaderStage> stages{{GL_VERTEX_SHADER, "gnomon/fullscreen.vert"}};
    std::vector<Constant> constants = pass.constants;
    if (pass.layers > kMostScreenLayers) {
      throw Error(
          fmt::format("pass '{}' has {} layers; a full-screen pass has at most {}", name, pass.layers, kMostScreenLayers));
    }
    if (pass.layers > 0) {
      stages.push_back({GL_GEOMETRY_SHADER, "gnomon/fullscreen_layers.geom"});
      constants.push_back({"SCREEN_LAYERS", pass.layers});
    }
    stages.push_back({GL_FRAGMENT_SHADER, pass.shader});
    give(node, {s_.context, std::move(stages), constantsOf(constants), pass.reads, {}, pass.buffers, {}});
    return target;
  }

  void raster(const std::string& name, const RasterPass& pass) override {
    PassNode& node = addPass(name);
    const int layer = pass.layer.value_or(-1);
    if (pass.vertices) {
      if (pass.draws || pass.indirect) throw Error(fmt::format("pass '{}' draws both the scene and vertices of its own", name));
      if (pass.vertices->indirect) readIndirect(node, *pass.vertices->indirect, 16);
    } else {
      node.inputs = {Input::geometry};
      node.ownBuffers.push_back(recordsOf(pass.draws, name));  // the first: DrawRecords
      if (pass.indirect) readIndirect(node, *pass.indirect, sizeof(DrawCommand));
    }
    for (const Texture colour : pass.colours) {
      requireColour(node, s_.texture(checked(colour, name)).name, s_.texture(colour).info.format);
      write(node, {colour, layer});
    }
    if (pass.depth) {
      requireDepth(node, *pass.depth);
      write(node, {*pass.depth, layer});
    }
    std::vector<Texture> together;
    for (const Target& target : node.writes) together.push_back(target.texture);
    if (pass.depthRead) {
      if (pass.depth) throw Error(fmt::format("pass '{}' has both `depth` and `depthRead`; give one", name));
      requireDepth(node, *pass.depthRead);
      read(node, *pass.depthRead);
      together.push_back(*pass.depthRead);
    }
    if (node.writes.empty()) throw Error(fmt::format("pass '{}' writes nothing", name));
    requireOneSize(node, together, pass);
    if (pass.depthFrom) {
      if (!pass.depth || pass.layer) {
        throw Error(fmt::format("pass '{}': `depthFrom` needs a `depth` whose layers are all drawn", name));
      }
      readAs(node, *pass.depthFrom, s_.texture(*pass.depth).info);
    }
    if (pass.stencil && !pass.depth) throw Error(fmt::format("pass '{}' has a stencil state and no `depth`", name));
    if (pass.stencil) requireStencilFormat(node, *pass.depth);
    writeStorage(node, pass.writes);
    node.kind = pass;
    std::vector<gl::ShaderStage> stages{{GL_VERTEX_SHADER, pass.vertex}};
    if (!pass.geometry.empty()) stages.push_back({GL_GEOMETRY_SHADER, pass.geometry});
    if (!pass.fragment.empty()) stages.push_back({GL_FRAGMENT_SHADER, pass.fragment});
    give(node, {s_.context, std::move(stages), constantsOf(pass.constants), pass.reads, {}, pass.buffers, pass.writes});
  }

  void compute(const std::string& name, const ComputePass& pass) override {
    PassNode& node = addPass(name);
    for (const NamedTexture& image : pass.images) {
      requireColour(node, s_.texture(checked(image.texture, name)).name, s_.texture(image.texture).info.format);
      write(node, {image.texture, -1});
    }
    writeStorage(node, pass.writes);
    if (node.writes.empty() && node.bufferWrites.empty()) throw Error(fmt::format("pass '{}' writes nothing", name));
    if (pass.indirect) readIndirect(node, *pass.indirect, 12);
    node.kind = pass;
    give(node, {s_.context,
                {{GL_COMPUTE_SHADER, pass.shader}},
                constantsOf(pass.constants),
                pass.reads,
                pass.images,
                pass.buffers,
                pass.writes});
  }

  void cpu(const std::string& name, const CpuPass& pass) override {
    PassNode& node = addPass(name);
    node.inputs = pass.inputs;
    for (const Texture texture : pass.reads) read(node, texture);
    for (const Buffer buffer : pass.after) node.ownBuffers.push_back(checked(buffer, name));
    for (const Texture texture : pass.writes) write(node, {texture, -1});
    for (const Buffer buffer : pass.buffers) write(node, checked(buffer, name));
    for (const DrawList list : pass.draws) write(node, recordsOf(list, name));
    node.kind = pass;
    useProgram(node, {});
  }

  Facts& facts() override { return s_.facts; }

  Texture import(const std::string& /*name*/, const std::shared_ptr<TextureResource>& resource) override {
    s_.textures.push_back({.resource = resource, .imported = true});
    return {static_cast<int>(s_.textures.size()) - 1};
  }
  Buffer import(const std::string& /*name*/, const std::shared_ptr<BufferResource>& resource) override {
    return addBuffer({resource, true, -1});
  }

 private:
  std::size_t passIndex() const { return s_.passes.size() - 1; }

  /// What later shaders are declared in; earlier ones keep theirs.
  ShaderContext& context() {
    if (s_.context.use_count() > 1) s_.context = std::make_shared<ShaderContext>(*s_.context);
    return *s_.context;
  }

  PassNode& addPass(const std::string& name) {
    if (s_.compiled) throw Error(fmt::format("pass '{}' is declared after the graph was compiled", name));
    s_.passes.emplace_back().name = name;
    return s_.passes.back();
  }

  Texture addTexture(const std::string& name, const TextureInfo& info) {
    auto resource = std::make_shared<TextureResource>();
    resource->name = name;
    resource->info = info;
    s_.textures.push_back(
        {.resource = std::move(resource), .writers = std::vector<int>(static_cast<std::size_t>(std::max(info.layers, 1)), -1)});
    return {static_cast<int>(s_.textures.size()) - 1};
  }

  Buffer addBuffer(BufferSlot slot) {
    s_.buffers.push_back(std::move(slot));
    return {static_cast<int>(s_.buffers.size()) - 1};
  }

  Texture checked(Texture texture, const std::string& pass) const {
    if (texture.id < 0 || static_cast<std::size_t>(texture.id) >= s_.textures.size()) {
      throw Error(fmt::format("pass '{}' uses a texture that was never declared", pass));
    }
    return texture;
  }
  Buffer checked(Buffer buffer, const std::string& pass) const {
    if (buffer.id < 0 || static_cast<std::size_t>(buffer.id) >= s_.buffers.size()) {
      throw Error(fmt::format("pass '{}' uses a buffer that was never declared", pass));
    }
    return buffer;
  }
  Buffer recordsOf(DrawList list, const std::string& pass) const {
    if (list.id < 0 || static_cast<std::size_t>(list.id) >= s_.drawLists.size()) {
      throw Error(fmt::format("pass '{}' uses a draw list that was never declared", pass));
    }
    return s_.drawLists[static_cast<std::size_t>(list.id)].records;
  }

  static void requireColour(const PassNode& node, const std::string& target, Format format) {
    if (!formatFacts(format).depth) return;
    throw Error(
        fmt::format("pass '{}': '{}' is given as colour or image and "
                    "has the depth format {}",
                    node.name, target, formatFacts(format).name));
  }
  void requireDepth(const PassNode& node, Texture texture) const {
    const TextureResource& resource = s_.texture(checked(texture, node.name));
    if (formatFacts(resource.info.format).depth) return;
    throw Error(
        fmt::format("pass '{}': '{}' is given as depth and has format "
                    "{}; depth formats are d16, d24, d32f, d32f_s8",
                    node.name, resource.name, formatFacts(resource.info.format).name));
  }
  void requireStencilFormat(const PassNode& node, Texture texture) const {
    const TextureResource& resource = s_.texture(checked(texture, node.name));
    if (resource.info.format == Format::d32f_s8) return;
    throw Error(
        fmt::format("pass '{}': '{}' is given as stencil and has "
                    "format {}; it must be d32f_s8",
                    node.name, resource.name, formatFacts(resource.info.format).name));
  }
  void requireStencil(PassNode& node, Texture texture) {
    requireStencilFormat(node, texture);
    read(node, texture);
    if (s_.texture(texture).info.size == node.size) return;
    throw Error(fmt::format("pass '{}' is {}x{}, the stencil that it tests, '{}', is {}", node.name, node.size.x, node.size.y,
                            s_.texture(texture).name, describe(s_.texture(texture).info)));
  }

  /// Targets of one pass have one size; layers where all are drawn, and then
  /// somebody chooses among them.
  void requireOneSize(PassNode& node, const std::vector<Texture>& targets, const RasterPass& pass) const {
    const TextureResource& first = s_.texture(targets[0]);
    node.size = first.info.size;
    for (const Texture target : targets) {
      const TextureResource& other = s_.texture(target);
      if (other.info.size == node.size && (pass.layer || other.info.layers == first.info.layers)) continue;
      throw Error(fmt::format("pass '{}': its targets differ in size: '{}' is {}, '{}' {}", node.name, first.name,
                              describe(first.info), other.name, describe(other.info)));
    }
    if (first.info.layers > 0 && !pass.layer && pass.geometry.empty()) {
      throw Error(
          fmt::format("pass '{}': its target '{}' has layers; give `layer`, or "
                      "a geometry shader that sets gl_Layer",
                      node.name, first.name));
    }
  }

  void write(PassNode& node, const Target& target) {
    TextureSlot& slot = s_.at(checked(target.texture, node.name));
    const std::string& name = slot.resource->name;
    if (slot.imported) throw Error(fmt::format("pass '{}': texture '{}' belongs to another graph", node.name, name));
    if (slot.isHistory) throw Error(fmt::format("pass '{}': '{}' is a history; only `remember` fills it", node.name, name));
    const int layers = slot.resource->info.layers;
    if (target.layer >= 0 && target.layer >= layers) {
      throw Error(fmt::format("pass '{}' draws layer {} of '{}', which has {}", node.name, target.layer, name, layers));
    }
    for (std::size_t i = 0; i < slot.writers.size(); ++i) {
      if (target.layer >= 0 && static_cast<std::size_t>(target.layer) != i) continue;
      if (slot.writers[i] >= 0) {
        throw Error(fmt::format("pass '{}': texture '{}' has a writer already, '{}'", node.name, name,
                                s_.passes[static_cast<std::size_t>(slot.writers[i])].name));
      }
      slot.writers[i] = static_cast<int>(passIndex());
    }
    node.writes.push_back(target);
  }

  /// Passes run in the order of their declaration: whoever reads the buffer
  /// must come later.
  void write(PassNode& node, Buffer buffer) {
    BufferSlot& slot = s_.at(buffer);
    if (slot.imported) {
      throw Error(fmt::format("pass '{}': buffer '{}' belongs to another graph", node.name, slot.resource->name));
    }
    if (slot.writer >= 0) {
      throw Error(fmt::format("pass '{}': buffer '{}' has a writer already, '{}'", node.name, slot.resource->name,
                              s_.passes[static_cast<std::size_t>(slot.writer)].name));
    }
    for (const PassNode& other : s_.passes) {
      const auto& reads = &other == &node ? other.ownBuffers : other.bufferReads;
      if (std::find(reads.begin(), reads.end(), buffer) == reads.end()) continue;
      throw Error(
          fmt::format("pass '{}' writes buffer '{}' after '{}' has read it", node.name, slot.resource->name, other.name));
    }
    slot.writer = static_cast<int>(passIndex());
    node.bufferWrites.push_back(buffer);
  }

  void writeStorage(PassNode& node, const std::vector<NamedBuffer>& writes) {
    for (const NamedBuffer& each : writes) write(node, checked(each.buffer, node.name));
  }

  void read(PassNode& node, Texture texture) {
    requireWritten(s_, node, passIndex(), texture);
    node.ownTextures.push_back(texture);
  }

  /// Reads what something of the pass begins as a copy of.
  void readAs(PassNode& node, Texture from, const TextureInfo& to) {
    read(node, from);
    if (sameStorage(s_.texture(from).info, to)) return;
    throw Error(
        fmt::format("pass '{}' begins with a copy of '{}', {}, into "
                    "{}; they must be the same",
                    node.name, s_.texture(from).name, describe(s_.texture(from).info), describe(to)));
  }

  void readIndirect(PassNode& node, const Indirect& indirect, std::size_t commandBytes) {
    const BufferResource& buffer = s_.buffer(checked(indirect.buffer, node.name));
    const std::size_t end = indirect.offset + static_cast<std::size_t>(std::max(indirect.commands, 0)) * commandBytes;
    if (indirect.commands < 1 || indirect.offset % 4 != 0 || end > buffer.bytes) {
      throw Error(
          fmt::format("pass '{}': {} commands at byte {} do not lie in "
                      "buffer '{}' of {} bytes",
                      node.name, indirect.commands, indirect.offset, buffer.name, buffer.bytes));
    }
    node.ownBuffers.push_back(indirect.buffer);
  }

  void give(PassNode& node, Recipe recipe) {
    node.recipe = std::move(recipe);
    useProgram(node, bindProgram(s_, node, passIndex()));
  }

  Graph::State& s_;
};

Graph::Graph(std::string name, glm::ivec2 outputSize, gl::ShaderSources sources, GraphShares shares)
    : state_(std::make_unique<State>()) {
  state_->name = std::move(name);
  state_->outputSize = outputSize;
  state_->shares = std::move(shares);
  if (!state_->shares.programs) state_->shares.programs = std::make_shared<gl::ProgramCache>();
  state_->context = std::make_shared<ShaderContext>();
  state_->context->sources = std::move(sources);
  state_->emptyVertexArray = gl::makeVertexArray("full screen");
  state_->nearest = gl::makeSampler(GL_NEAREST);
  state_->builder = std::make_unique<GraphDeclaration>(*state_);
}

Graph::~Graph() = default;

}  // namespace gnomon
