// Declaration: handles, programs and what they use, pruning, storage.
#include <fmt/format.h>

#include <algorithm>

#include "gnomon/base/error.h"
#include "gnomon/graph/state.h"

namespace gnomon {

class GraphDeclaration final : public GraphBuilder {
 public:
  explicit GraphDeclaration(Graph::State& state) : s_(state) {}

  Texture texture(const std::string& name, const TextureInfo& info) override { return addTexture(name, info, kNoWriter); }

  Buffer buffer(const std::string& name, std::size_t bytes) override {
    auto resource = std::make_shared<BufferResource>();
    resource->name = name;
    resource->bytes = bytes;
    resource->contents.assign(bytes, std::byte{0});
    resource->object = gl::makeBuffer(bytes, resource->contents.data(), s_.name + "/" + name);
    s_.buffers.push_back(std::move(resource));
    s_.bufferImported.push_back(false);
    return {static_cast<int>(s_.buffers.size()) - 1};
  }

  DrawList drawList(const std::string& name) override {
    DrawListState& list = s_.drawLists.emplace_back();
    list.name = name;
    list.records = std::make_shared<BufferResource>();
    list.records->name = name;
    return {static_cast<int>(s_.drawLists.size()) - 1};
  }

  void provide(const std::string& name, Texture texture) override { s_.providedTextures[name] = texture; }
  void provide(const std::string& name, Buffer buffer) override { s_.providedBuffers[name] = buffer; }
  void include(const std::string& name, const std::string& text) override { s_.sources.generated[name] = text; }
  void constant(const Constant& constant) override { s_.constants.push_back({constant.name, constant.value}); }

  Texture fullscreen(const std::string& name, const FullscreenPass& pass) override {
    PassNode& node = addPass(name);
    node.size = pass.size.value_or(s_.outputSize);
    const Texture target = addTexture(name, {node.size, pass.format}, passIndex());
    node.writes = {target};
    node.kind = pass;
    bind(node, {{GL_VERTEX_SHADER, "gnomon/fullscreen.vert"}, {GL_FRAGMENT_SHADER, pass.shader}}, pass.reads, pass.buffers,
         pass.constants);
    return target;
  }

  void raster(const std::string& name, const RasterPass& pass) override {
    PassNode& node = addPass(name);
    node.inputs = {Input::geometry};
    for (const Texture colour : pass.colours) addWrite(node, colour);
    if (pass.depth) addWrite(node, *pass.depth);
    if (node.writes.empty()) throw Error(fmt::format("pass '{}' writes nothing", name));
    node.size = infoOf(node.writes[0]).size;
    for (const Texture target : node.writes) {
      const TextureInfo& info = infoOf(target);
      if (info.size == node.size) continue;
      throw Error(fmt::format("pass '{}': its targets differ in size: '{}' is {}x{}, '{}' {}x{}", name, nameOf(node.writes[0]),
                              node.size.x, node.size.y, nameOf(target), info.size.x, info.size.y));
    }
    node.kind = pass;
    node.bufferReads.push_back(recordsOf(pass.draws, name));
    std::vector<gl::ShaderStage> stages{{GL_VERTEX_SHADER, pass.vertex}};
    if (!pass.fragment.empty()) stages.push_back({GL_FRAGMENT_SHADER, pass.fragment});
    bind(node, stages, pass.reads, pass.buffers, pass.constants);
  }

  void cpu(const std::string& name, const CpuPass& pass) override {
    PassNode& node = addPass(name);
    node.inputs = pass.inputs;
    for (const Texture texture : pass.reads) addRead(node, texture);
    for (const Buffer buffer : pass.after) node.bufferReads.push_back(s_.buffers[checked(buffer, name)]);
    for (const Texture texture : pass.writes) addWrite(node, texture);
    for (const Buffer buffer : pass.buffers) {
      const std::size_t i = checked(buffer, name);
      if (s_.bufferImported[i])
        throw Error(fmt::format("pass '{}': buffer '{}' belongs to another graph", name, s_.buffers[i]->name));
      addWrite(node, s_.buffers[i]);
    }
    for (const DrawList list : pass.draws) addWrite(node, recordsOf(list, name));
    node.kind = pass;
  }

  Facts& facts() override { return s_.facts; }

  Texture import(const std::string& /*name*/, const std::shared_ptr<TextureResource>& resource) override {
    s_.textures.push_back(resource);
    s_.writer.push_back(kImported);
    return {static_cast<int>(s_.textures.size()) - 1};
  }
  Buffer import(const std::string& /*name*/, const std::shared_ptr<BufferResource>& resource) override {
    s_.buffers.push_back(resource);
    s_.bufferImported.push_back(true);
    return {static_cast<int>(s_.buffers.size()) - 1};
  }

 private:
  int passIndex() const { return static_cast<int>(s_.passes.size()) - 1; }

  PassNode& addPass(const std::string& name) {
    if (s_.compiled) throw Error(fmt::format("pass '{}' is declared after the graph was compiled", name));
    s_.passes.emplace_back().name = name;
    return s_.passes.back();
  }

  Texture addTexture(const std::string& name, const TextureInfo& info, int writer) {
    auto resource = std::make_shared<TextureResource>();
    resource->name = name;
    resource->info = info;
    s_.textures.push_back(std::move(resource));
    s_.writer.push_back(writer);
    return {static_cast<int>(s_.textures.size()) - 1};
  }

  std::size_t checked(Texture texture, const std::string& pass) const {
    if (texture.id < 0 || static_cast<std::size_t>(texture.id) >= s_.textures.size()) {
      throw Error(fmt::format("pass '{}' uses a texture that was never declared", pass));
    }
    return static_cast<std::size_t>(texture.id);
  }
  std::size_t checked(Buffer buffer, const std::string& pass) const {
    if (buffer.id < 0 || static_cast<std::size_t>(buffer.id) >= s_.buffers.size()) {
      throw Error(fmt::format("pass '{}' uses a buffer that was never declared", pass));
    }
    return static_cast<std::size_t>(buffer.id);
  }
  const std::shared_ptr<BufferResource>& recordsOf(DrawList list, const std::string& pass) const {
    if (list.id < 0 || static_cast<std::size_t>(list.id) >= s_.drawLists.size()) {
      throw Error(fmt::format("pass '{}' uses a draw list that was never declared", pass));
    }
    return s_.drawLists[static_cast<std::size_t>(list.id)].records;
  }
  const std::string& nameOf(Texture texture) const { return s_.textures[static_cast<std::size_t>(texture.id)]->name; }
  const TextureInfo& infoOf(Texture texture) const { return s_.textures[static_cast<std::size_t>(texture.id)]->info; }

  void addWrite(PassNode& node, Texture texture) {
    const std::size_t i = checked(texture, node.name);
    if (s_.writer[i] == kImported) {
      throw Error(fmt::format("pass '{}': texture '{}' belongs to another graph", node.name, s_.textures[i]->name));
    }
    if (s_.writer[i] != kNoWriter)
      throw Error(fmt::format("pass '{}': texture '{}' has a writer already", node.name, s_.textures[i]->name));
    s_.writer[i] = passIndex();
    node.writes.push_back(texture);
  }

  /// Passes run in the order of their declaration: whoever reads the buffer must come later.
  void addWrite(PassNode& node, const std::shared_ptr<BufferResource>& buffer) {
    const auto has = [&](const auto& list) { return std::find(list.begin(), list.end(), buffer) != list.end(); };
    for (const PassNode& other : s_.passes) {
      if (has(other.bufferWrites)) {
        throw Error(fmt::format("pass '{}': buffer '{}' has a writer already, '{}'", node.name, buffer->name, other.name));
      }
      if (has(other.bufferReads)) {
        throw Error(fmt::format("pass '{}' writes buffer '{}' after '{}' has read it", node.name, buffer->name, other.name));
      }
    }
    node.bufferWrites.push_back(buffer);
  }

  void addRead(PassNode& node, Texture texture) {
    const std::size_t i = checked(texture, node.name);
    if (s_.writer[i] == kNoWriter)
      throw Error(fmt::format("pass '{}' reads texture '{}' before any pass writes it", node.name, s_.textures[i]->name));
    if (s_.writer[i] == passIndex())
      throw Error(fmt::format("pass '{}' reads its own target '{}'", node.name, s_.textures[i]->name));
    node.textureReads.push_back(s_.textures[i]);
  }

  /// A uniform block in a standard layout is active even if nothing of it is used: ask who refers to it. (Not so for storage
  /// blocks: Mesa 22.3 says of every one that nobody does.)
  static bool isReferenced(GLuint program, GLuint uniformBlock) {
    const std::array<GLenum, 2> users{GL_REFERENCED_BY_VERTEX_SHADER, GL_REFERENCED_BY_FRAGMENT_SHADER};
    std::array<GLint, 2> used{};
    glGetProgramResourceiv(program, GL_UNIFORM_BLOCK, uniformBlock, 2, users.data(), 2, nullptr, used.data());
    return used[0] != 0 || used[1] != 0;
  }

  /// Compiles, then finds by introspection which samplers and blocks the program really uses: listed ones first, then
  /// provided ones. Only those are reads, so that an unused include makes no dependency.
  void bind(PassNode& node, const std::vector<gl::ShaderStage>& stages, const std::vector<NamedTexture>& reads,
            const std::vector<NamedBuffer>& buffers, const std::vector<Constant>& constants) {
    std::vector<gl::Constant> all = s_.constants;
    for (const Constant& constant : constants) all.push_back({constant.name, constant.value});
    try {
      node.bound.program = gl::makeProgram(s_.sources, stages, all, s_.name + "/" + node.name);
    } catch (const Error& error) {
      throw Error(fmt::format("pass '{}': {}", node.name, error.what()));
    }
    bindSamplers(node, reads);
    bindBlocks(node, buffers, GL_UNIFORM_BLOCK, GL_UNIFORM_BUFFER);
    bindBlocks(node, buffers, GL_SHADER_STORAGE_BLOCK, GL_SHADER_STORAGE_BUFFER);
  }

  void bindSamplers(PassNode& node, const std::vector<NamedTexture>& reads) {
    const GLuint program = node.bound.program.name();
    GLint count = 0;
    glGetProgramInterfaceiv(program, GL_UNIFORM, GL_ACTIVE_RESOURCES, &count);
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
      const std::array<GLenum, 3> wanted{GL_TYPE, GL_LOCATION, GL_BLOCK_INDEX};
      std::array<GLint, 3> got{};
      glGetProgramResourceiv(program, GL_UNIFORM, i, 3, wanted.data(), 3, nullptr, got.data());
      if (got[2] != -1 || got[1] < 0) continue;
      std::array<char, 256> text{};
      glGetProgramResourceName(program, GL_UNIFORM, i, static_cast<GLsizei>(text.size()), nullptr, text.data());
      const std::string name(text.data());
      const auto listed = std::find_if(reads.begin(), reads.end(), [&](const NamedTexture& r) { return r.name == name; });
      Texture texture;
      if (listed != reads.end()) {
        texture = listed->texture;
      } else if (const auto provided = s_.providedTextures.find(name); provided != s_.providedTextures.end()) {
        texture = provided->second;
      } else {
        throw Error(fmt::format("pass '{}': nothing is given for the shader's uniform '{}'", node.name, name));
      }
      addRead(node, texture);
      const auto unit = static_cast<GLuint>(node.bound.textures.size());
      glProgramUniform1i(program, got[1], static_cast<GLint>(unit));
      node.bound.textures.emplace_back(unit, node.textureReads.back());
    }
  }

  void bindBlocks(PassNode& node, const std::vector<NamedBuffer>& buffers, GLenum interface, GLenum target) {
    const GLuint program = node.bound.program.name();
    GLint count = 0;
    glGetProgramInterfaceiv(program, interface, GL_ACTIVE_RESOURCES, &count);
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
      if (target == GL_UNIFORM_BUFFER && !isReferenced(program, i)) continue;
      std::array<char, 256> text{};
      glGetProgramResourceName(program, interface, i, static_cast<GLsizei>(text.size()), nullptr, text.data());
      const std::string name(text.data());
      if (target == GL_UNIFORM_BUFFER) {
        glUniformBlockBinding(program, i, i);
      } else {
        glShaderStorageBlockBinding(program, i, i);
      }
      if (name == "DrawRecords" || name == "TriangleNormals") {  // the graph's own: bound when the pass draws
        if (!std::holds_alternative<RasterPass>(node.kind)) {
          throw Error(fmt::format("pass '{}': the shader's block '{}' is of passes that draw", node.name, name));
        }
        node.bound.blocks.push_back({target, i, name == "DrawRecords" ? node.bufferReads.front() : nullptr});
        continue;
      }
      const auto listed = std::find_if(buffers.begin(), buffers.end(), [&](const NamedBuffer& b) { return b.name == name; });
      Buffer buffer;
      if (listed != buffers.end()) {
        buffer = listed->buffer;
      } else if (const auto provided = s_.providedBuffers.find(name); provided != s_.providedBuffers.end()) {
        buffer = provided->second;
      } else {
        throw Error(fmt::format("pass '{}': nothing is given for the shader's block '{}'", node.name, name));
      }
      const auto& resource = s_.buffers[checked(buffer, node.name)];
      node.bufferReads.push_back(resource);
      node.bound.blocks.push_back({target, i, resource});
    }
  }

  Graph::State& s_;
};

Graph::Graph(std::string name, glm::ivec2 outputSize, gl::ShaderSources sources) : state_(std::make_unique<State>()) {
  state_->name = std::move(name);
  state_->outputSize = outputSize;
  state_->sources = std::move(sources);
  state_->emptyVertexArray = gl::makeVertexArray("full screen");
  state_->nearest = gl::makeSampler(GL_NEAREST);
  state_->builder = std::make_unique<GraphDeclaration>(*state_);
}

Graph::~Graph() = default;

GraphBuilder& Graph::builder() {
  return *state_->builder;
}

void Graph::compile(std::span<const Texture> outputs) {
  State& s = *state_;
  if (s.compiled) throw Error("graph '" + s.name + "' is compiled already");
  // Backwards from the outputs: a pass is kept if something kept reads what it writes.
  std::vector<const void*> wanted;
  for (const Texture texture : outputs) {
    const auto i = static_cast<std::size_t>(texture.id);
    if (texture.id < 0 || i >= s.textures.size()) throw Error("graph '" + s.name + "': an output was never declared");
    if (s.writer[i] == kNoWriter)
      throw Error(fmt::format("graph '{}': nothing writes its output '{}'", s.name, s.textures[i]->name));
    wanted.push_back(s.textures[i].get());
  }
  const auto isWanted = [&](const void* resource) { return std::find(wanted.begin(), wanted.end(), resource) != wanted.end(); };
  for (auto node = s.passes.rbegin(); node != s.passes.rend(); ++node) {
    node->kept =
        std::any_of(node->writes.begin(), node->writes.end(),
                    [&](Texture t) { return isWanted(s.textures[static_cast<std::size_t>(t.id)].get()); }) ||
        std::any_of(node->bufferWrites.begin(), node->bufferWrites.end(), [&](const auto& b) { return isWanted(b.get()); });
    if (!node->kept) continue;
    for (const auto& read : node->textureReads) wanted.push_back(read.get());
    for (const auto& read : node->bufferReads) wanted.push_back(read.get());
  }

  for (PassNode& node : s.passes) {
    if (!node.kept) continue;
    for (const Texture texture : node.writes) {
      TextureResource& resource = *s.textures[static_cast<std::size_t>(texture.id)];
      resource.object =
          gl::makeTexture2D(formatFacts(resource.info.format).internalFormat, resource.info.size, s.name + "/" + resource.name);
    }
    if (std::holds_alternative<CpuPass>(node.kind)) continue;
    node.framebuffer = gl::makeFramebuffer(s.name + "/" + node.name);
    std::vector<GLenum> draws;
    for (const Texture texture : node.writes) {
      const TextureResource& resource = *s.textures[static_cast<std::size_t>(texture.id)];
      const bool depth = formatFacts(resource.info.format).depth;
      const GLenum attachment = resource.info.format == Format::d32f_s8 ? GL_DEPTH_STENCIL_ATTACHMENT
                                : depth                                 ? GL_DEPTH_ATTACHMENT
                                        : GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(draws.size());
      glNamedFramebufferTexture(node.framebuffer.name(), attachment, resource.object.name(), 0);
      if (!depth) draws.push_back(attachment);
    }
    if (draws.empty()) draws.push_back(GL_NONE);
    glNamedFramebufferDrawBuffers(node.framebuffer.name(), static_cast<GLsizei>(draws.size()), draws.data());
    const GLenum status = glCheckNamedFramebufferStatus(node.framebuffer.name(), GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
      throw Error(fmt::format("pass '{}': its targets are not a complete framebuffer here (0x{:04x})", node.name, status));
    }
  }
  s.compiled = true;
}

const Facts& Graph::facts() const {
  return state_->facts;
}

std::shared_ptr<TextureResource> Graph::resource(Texture texture) const {
  if (texture.id < 0 || static_cast<std::size_t>(texture.id) >= state_->textures.size()) {
    throw Error("graph '" + state_->name + "': a texture was never declared");
  }
  return state_->textures[static_cast<std::size_t>(texture.id)];
}
std::shared_ptr<BufferResource> Graph::resource(Buffer buffer) const {
  return state_->buffers.at(static_cast<std::size_t>(buffer.id));
}

std::size_t Graph::memoryBytes() const {
  std::size_t total = 0;
  for (std::size_t i = 0; i < state_->textures.size(); ++i) {
    const TextureResource& t = *state_->textures[i];
    if (state_->writer[i] == kImported || !t.object) continue;
    total += static_cast<std::size_t>(t.info.size.x) * static_cast<std::size_t>(t.info.size.y) *
             static_cast<std::size_t>(formatFacts(t.info.format).bytes);
  }
  for (std::size_t i = 0; i < state_->buffers.size(); ++i) {
    if (!state_->bufferImported[i]) total += state_->buffers[i]->bytes;
  }
  for (const DrawListState& list : state_->drawLists) total += list.records->bytes + list.commandCapacity * sizeof(DrawCommand);
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
  for (std::size_t i = 0; i < state_->textures.size(); ++i) {
    if (state_->writer[i] != kImported && state_->textures[i]->object) owned.push_back(state_->textures[i]);
  }
  return owned;
}

}  // namespace gnomon
