#include "bare_frame.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "gnomon/base/error.h"
#include "gnomon/scene/light.h"

namespace gnomon::bench {

namespace {

constexpr GLuint kLargestName = 4096;  // drivers count names from 1

std::string labelOf(GLenum kind, GLuint name) {
  std::array<char, 256> text{};
  glGetObjectLabel(kind, name, static_cast<GLsizei>(text.size()), nullptr, text.data());
  return text.data();
}

/// The one object labelled "session/NAME" or "TECHNIQUE/NAME".
GLuint labelled(GLenum kind, const std::string& technique, const std::string& name) {
  GLuint found = 0;
  for (GLuint i = 1; i < kLargestName; ++i) {
    if ((kind == GL_PROGRAM ? glIsProgram(i) : glIsBuffer(i)) == GL_FALSE) continue;
    const std::string label = labelOf(kind, i);
    if (label != "session/" + name && label != technique + "/" + name) continue;
    if (found != 0) throw Error(fmt::format("two objects are labelled '{}': the bare frame cannot tell them apart", label));
    found = i;
  }
  if (found == 0)
    throw Error(fmt::format("nothing of {} is labelled '{}': the bare frame does not know its passes", technique, name));
  return found;
}

std::string resourceName(GLuint program, GLenum interface, GLuint index) {
  std::array<char, 256> text{};
  glGetProgramResourceName(program, interface, index, static_cast<GLsizei>(text.size()), nullptr, text.data());
  return text.data();
}

GLuint activeResources(GLuint program, GLenum interface) {
  GLint count = 0;
  glGetProgramInterfaceiv(program, interface, GL_ACTIVE_RESOURCES, &count);
  return static_cast<GLuint>(count);
}

/// The session's texture of a name, as the slot sees it.
TextureInfo infoOf(const Session& session, Slot slot, const std::string& name) {
  for (const auto& texture : session.textures(slot)) {
    if (texture->name == name) return texture->info;
  }
  throw Error(fmt::format("the session has no texture '{}': the bare frame does not know its passes", name));
}

/// The only depth texture beside the G-buffer's.
TextureInfo depthMapInfo(const Session& session, Slot slot) {
  for (const auto& texture : session.textures(slot)) {
    if (formatFacts(texture->info.format).depth && texture->name != "depth") return texture->info;
  }
  throw Error("the technique renders no depth map");
}

std::vector<std::uint8_t> castersOf(const Scene& scene) {
  std::vector<std::uint8_t> flags;
  for (const Instance& instance : scene.instances) flags.push_back(instance.casts ? 1 : 0);
  return flags;
}

struct Selection {
  std::vector<DrawRecord> records;
  std::vector<DrawCommand> commands;
};

Selection selected(const GpuScene& gpu, const Scene& scene, const std::vector<std::uint8_t>& flags, const glm::dvec3& origin) {
  Selection result;
  gpu.select(scene, flags, origin, result.records, result.commands);
  return result;
}

}  // namespace

BareFrame::BareFrame(const Session& session, Slot slot, const std::string& technique)
    : technique_(technique),
      gpu_(session.scene()),
      emptyVertexArray_(gl::makeVertexArray("bare")),
      nearest_(gl::makeSampler(GL_NEAREST)) {
  const std::vector<std::string> passes = session.passNames(slot);
  if (passes.size() != 3 || passes[1] != "light depth") {
    throw Error(fmt::format("{} has the passes {}: the bare frame knows a fit, light depth and a filter", technique,
                            fmt::join(passes, ", ")));
  }
  const Scene& scene = session.scene();
  const std::vector<std::uint8_t> everything(scene.instances.size(), 1);
  const Selection visible = selected(gpu_, scene, everything, session.camera().position);
  const Selection casters = selected(gpu_, scene, castersOf(scene), lightFrame(session.light()).origin);
  visible_ = makeDraws(visible.records, visible.commands);
  casters_ = makeDraws(casters.records, casters.commands);

  const glm::ivec2 size = session.outputSize();
  const TextureResource& restriction = add("gRestriction", {size, Format::r8});
  const float one = 1.0f;
  glClearTexImage(restriction.object.name(), 0, GL_RED, GL_FLOAT, &one);
  const TextureResource& position = add("gPosition", infoOf(session, slot, "position"));
  const TextureResource& normal = add("gNormal", infoOf(session, slot, "normal"));
  const TextureResource& ids = add("gIds", {size, Format::rg32ui});
  const TextureResource& shading = add("gShadingNormal", infoOf(session, slot, "shading normal"));
  const TextureResource& albedo = add("gAlbedo", infoOf(session, slot, "albedo"));
  const TextureResource& depth = add("gDepth", infoOf(session, slot, "depth"));
  const TextureResource& mask = add("gMask", infoOf(session, slot, "receiver mask"));
  const TextureResource& map = add("depthMap", depthMapInfo(session, slot));
  visibility_ = &add("visibility", session.visibilityTexture(slot).info);

  gbuffer_ = makePass("g-buffer", {&position, &normal, &ids, &shading, &albedo, &depth}, visible_.records.name());
  mask_ = makePass("receiver mask", {&mask}, 0);
  lightDepth_ = makePass("light depth", {&map}, casters_.records.name());
  filter_ = makePass(passes.back(), {visibility_}, 0);
}

const TextureResource& BareFrame::add(const std::string& sampler, const TextureInfo& info) {
  auto texture = std::make_unique<TextureResource>();
  texture->name = sampler;
  texture->info = info;
  texture->object = gl::makeTexture2D(formatFacts(info.format).internalFormat, info.size, "bare " + sampler);
  textures_.emplace_back(sampler, std::move(texture));
  return *textures_.back().second;
}

BareFrame::Draws BareFrame::makeDraws(const std::vector<DrawRecord>& records, const std::vector<DrawCommand>& commands) const {
  Draws draws;
  draws.records = gl::makeBuffer(records.size() * sizeof(DrawRecord), records.data(), "bare records");
  draws.commands = gl::makeBuffer(commands.size() * sizeof(DrawCommand), commands.data(), "bare commands");
  draws.count = static_cast<GLsizei>(commands.size());
  for (const DrawCommand& command : commands) draws.primitives += std::uint64_t{command.count} / 3 * command.instanceCount;
  return draws;
}

BareFrame::Pass BareFrame::makePass(const std::string& name, const std::vector<const TextureResource*>& targets,
                                    GLuint drawRecords) {
  Pass pass;
  pass.program = labelled(GL_PROGRAM, technique_, name);
  pass.framebuffer = gl::makeFramebuffer("bare " + name);
  pass.size = targets.front()->info.size;
  std::vector<GLenum> colours;
  for (const TextureResource* target : targets) {
    const bool depth = formatFacts(target->info.format).depth;
    const GLenum attachment = target->info.format == Format::d32f_s8 ? GL_DEPTH_STENCIL_ATTACHMENT
                              : depth                                ? GL_DEPTH_ATTACHMENT
                                      : GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(colours.size());
    glNamedFramebufferTexture(pass.framebuffer.name(), attachment, target->object.name(), 0);
    if (!depth) colours.push_back(attachment);
  }
  if (colours.empty()) colours.push_back(GL_NONE);
  glNamedFramebufferDrawBuffers(pass.framebuffer.name(), static_cast<GLsizei>(colours.size()), colours.data());
  bindSamplers(pass);
  bindBlocks(pass, GL_UNIFORM_BLOCK, GL_UNIFORM_BUFFER, drawRecords);
  bindBlocks(pass, GL_SHADER_STORAGE_BLOCK, GL_SHADER_STORAGE_BUFFER, drawRecords);
  return pass;
}

void BareFrame::bindSamplers(Pass& pass) const {
  for (GLuint i = 0; i < activeResources(pass.program, GL_UNIFORM); ++i) {
    const std::array<GLenum, 2> wanted{GL_LOCATION, GL_BLOCK_INDEX};
    std::array<GLint, 2> got{};
    glGetProgramResourceiv(pass.program, GL_UNIFORM, i, 2, wanted.data(), 2, nullptr, got.data());
    if (got[1] != -1 || got[0] < 0) continue;
    const std::string name = resourceName(pass.program, GL_UNIFORM, i);
    const auto found = std::find_if(textures_.begin(), textures_.end(), [&](const auto& t) { return t.first == name; });
    if (found == textures_.end()) throw Error(fmt::format("the bare frame does not know the shader's uniform '{}'", name));
    GLint unit = 0;
    glGetUniformiv(pass.program, got[0], &unit);
    pass.textures.emplace_back(static_cast<GLuint>(unit), found->second->object.name());
  }
}

void BareFrame::bindBlocks(Pass& pass, GLenum interface, GLenum target, GLuint drawRecords) {
  for (GLuint i = 0; i < activeResources(pass.program, interface); ++i) {
    const std::string name = resourceName(pass.program, interface, i);
    const GLenum wanted = GL_BUFFER_BINDING;
    GLint binding = 0;
    glGetProgramResourceiv(pass.program, interface, i, 1, &wanted, 1, nullptr, &binding);
    const GLuint buffer = name == "DrawRecords"       ? drawRecords
                          : name == "TriangleNormals" ? gpu_.triangleNormals()
                                                      : block(name);
    pass.blocks.push_back({target, static_cast<GLuint>(binding), buffer});
  }
}

GLuint BareFrame::block(const std::string& name) {
  for (const NamedBlock& known : blocks_) {
    if (known.name == name) return known.own.name();
  }
  const GLuint source = labelled(GL_BUFFER, technique_, name);
  GLint bytes = 0;
  glGetNamedBufferParameteriv(source, GL_BUFFER_SIZE, &bytes);
  gl::BufferObject own = gl::makeBuffer(static_cast<std::size_t>(bytes), nullptr, "bare " + name);
  glCopyNamedBufferSubData(source, own.name(), 0, 0, bytes);
  blocks_.push_back({name, source, std::move(own)});
  return blocks_.back().own.name();
}

BarePose BareFrame::pose(const Session& session) const {
  BarePose pose;
  for (const NamedBlock& block : blocks_) {
    if (block.name == "Parameters") continue;  // no pose changes it
    GLint bytes = 0;
    glGetNamedBufferParameteriv(block.source, GL_BUFFER_SIZE, &bytes);
    std::vector<std::byte> content(static_cast<std::size_t>(bytes));
    glGetNamedBufferSubData(block.source, 0, bytes, content.data());
    pose.blocks.emplace_back(block.own.name(), std::move(content));
  }
  const Scene& scene = session.scene();
  const std::vector<std::uint8_t> everything(scene.instances.size(), 1);
  pose.visible = selected(gpu_, scene, everything, session.camera().position).records;
  pose.casters = selected(gpu_, scene, castersOf(scene), lightFrame(session.light()).origin).records;
  return pose;
}

void BareFrame::begin(const Pass& pass, GLuint vertexArray) const {
  glBindFramebuffer(GL_FRAMEBUFFER, pass.framebuffer.name());
  glViewport(0, 0, pass.size.x, pass.size.y);
  glUseProgram(pass.program);
  glBindVertexArray(vertexArray);
  for (const auto& [unit, texture] : pass.textures) {
    glBindTextureUnit(unit, texture);
    glBindSampler(unit, nearest_.name());
  }
  for (const Pass::Block& block : pass.blocks) glBindBufferBase(block.target, block.binding, block.buffer);
}

void BareFrame::drawScene(const Draws& draws) const {
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, draws.commands.name());
  glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, nullptr, draws.count, 0);
}

void BareFrame::draw(const BarePose& pose) {
  for (const auto& [buffer, bytes] : pose.blocks) {
    glNamedBufferSubData(buffer, 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
  }
  const auto upload = [](const Draws& draws, const std::vector<DrawRecord>& records) {
    glNamedBufferSubData(draws.records.name(), 0, static_cast<GLsizeiptr>(records.size() * sizeof(DrawRecord)), records.data());
  };
  upload(visible_, pose.visible);
  upload(casters_, pose.casters);

  const std::array<float, 4> zeros{};
  const std::array<float, 4> ones{1.0f, 1.0f, 1.0f, 1.0f};
  const std::array<GLuint, 4> none{~0U, ~0U, 0U, 0U};
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  glDepthFunc(GL_GREATER);

  begin(gbuffer_, gpu_.vertexArray());
  glEnable(GL_DEPTH_TEST);
  glDisable(GL_DEPTH_CLAMP);
  for (const GLint colour : {0, 1, 3, 4})
    glClearNamedFramebufferfv(gbuffer_.framebuffer.name(), GL_COLOR, colour, zeros.data());
  glClearNamedFramebufferuiv(gbuffer_.framebuffer.name(), GL_COLOR, 2, none.data());
  glClearNamedFramebufferfi(gbuffer_.framebuffer.name(), GL_DEPTH_STENCIL, 0, 0.0f, 0);
  drawScene(visible_);

  begin(mask_, emptyVertexArray_.name());
  glDisable(GL_DEPTH_TEST);
  glClearNamedFramebufferfv(mask_.framebuffer.name(), GL_COLOR, 0, zeros.data());
  glDrawArrays(GL_TRIANGLES, 0, 3);

  begin(lightDepth_, gpu_.vertexArray());
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_DEPTH_CLAMP);
  glClearNamedFramebufferfv(lightDepth_.framebuffer.name(), GL_DEPTH, 0, zeros.data());
  drawScene(casters_);

  begin(filter_, emptyVertexArray_.name());
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_DEPTH_CLAMP);
  glClearNamedFramebufferfv(filter_.framebuffer.name(), GL_COLOR, 0, ones.data());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

std::uint64_t BareFrame::primitives() const {
  return visible_.primitives + casters_.primitives;
}

Image BareFrame::visibility() const {
  return readTexture(*visibility_);
}

}  // namespace gnomon::bench
