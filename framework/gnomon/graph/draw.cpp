// What passes do on the GPU: every pass sets all the state it needs, and orders
// its memory accesses with those of others.
#include <fmt/format.h>

#include <algorithm>

#include "gnomon/graph/execution.h"

namespace gnomon {

namespace {

/// Before shaders write memory: not until what earlier commands read there was
/// read (OpenGL 4.5 core, 7.12.2).
constexpr GLbitfield kBeforeShaderWrites = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT;
/// After: whatever may read it next, in this graph or another.
constexpr GLbitfield kAfterShaderWrites = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                                          GL_UNIFORM_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_COMMAND_BARRIER_BIT |
                                          GL_TEXTURE_UPDATE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT |
                                          GL_FRAMEBUFFER_BARRIER_BIT | GL_PIXEL_BUFFER_BARRIER_BIT;

/// OpenGL's comparisons follow one another in our order.
GLenum enumOf(Compare compare) {
  return GL_NEVER + static_cast<GLenum>(compare);
}

GLenum enumOf(StencilOp op) {
  constexpr std::array<GLenum, 8> kOps{GL_KEEP, GL_ZERO, GL_REPLACE, GL_INCR, GL_INCR_WRAP, GL_DECR, GL_DECR_WRAP, GL_INVERT};
  return kOps[static_cast<std::size_t>(op)];
}

GLenum enumOf(Topology topology) {
  constexpr std::array<GLenum, 4> kTopologies{GL_TRIANGLES, GL_TRIANGLE_STRIP, GL_LINES, GL_POINTS};
  return kTopologies[static_cast<std::size_t>(topology)];
}

std::uint64_t primitivesOf(const VertexDraw& draw) {
  const auto n = static_cast<std::uint64_t>(std::max(draw.vertices, 0));
  const std::array<std::uint64_t, 4> each{n / 3, n < 3 ? 0 : n - 2, n / 2, n};
  return each[static_cast<std::size_t>(draw.topology)] * static_cast<std::uint64_t>(std::max(draw.instances, 0));
}

void setEnabled(GLenum capability, bool on) {
  if (on) {
    glEnable(capability);
  } else {
    glDisable(capability);
  }
}

void setBlend(Blend blend) {
  setEnabled(GL_BLEND, blend != Blend::none);
  constexpr std::array<GLenum, 5> kEquations{GL_FUNC_ADD, GL_FUNC_ADD, GL_MIN, GL_MAX, GL_FUNC_ADD};
  glBlendEquation(kEquations[static_cast<std::size_t>(blend)]);
  if (blend == Blend::multiply) {
    glBlendFunc(GL_DST_COLOR, GL_ZERO);
  } else {
    glBlendFunc(GL_ONE, GL_ONE);
  }
}

void setStencilFace(GLenum face, const StencilFace& state, const Stencil& stencil) {
  glStencilFuncSeparate(face, enumOf(state.compare), stencil.reference, stencil.readMask);
  glStencilOpSeparate(face, enumOf(state.fail), enumOf(state.depthFail), enumOf(state.pass));
}

void setStencil(const Stencil& stencil) {
  glEnable(GL_STENCIL_TEST);
  setStencilFace(GL_FRONT, stencil.counterClockwise, stencil);
  setStencilFace(GL_BACK, stencil.clockwise, stencil);
  glStencilMask(stencil.writeMask);
}

/// What follows outside of the graph expects none of these.
void leaveState() {
  for (const GLenum off : {GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_CULL_FACE, GL_DEPTH_CLAMP}) glDisable(off);
  glStencilMask(0xff);
  glDepthMask(GL_TRUE);
  setBlend(Blend::none);
}

const void* atOffset(std::size_t offset) {
  return reinterpret_cast<const void*>(offset);  // NOLINT: OpenGL's way to say where in the bound buffer
}

}  // namespace

void GraphExecution::countWritten(const PassNode& node, const std::optional<glm::ivec4>& region) {
  for (const Target& target : node.writes) {
    const TextureInfo& info = s_.texture(target.texture).info;
    std::uint64_t texels = texelCount(info) / (target.layer >= 0 ? static_cast<std::size_t>(std::max(info.layers, 1)) : 1);
    if (region) texels = static_cast<std::uint64_t>(region->z) * static_cast<std::uint64_t>(region->w);
    s_.report.counters.texelsWritten += texels;
    s_.report.counters.bytesWritten += texels * static_cast<std::uint64_t>(formatFacts(info.format).bytes);
  }
}

void GraphExecution::bind(const PassNode& node) {
  const BoundProgram& bound = counter_ ? counter_->bound() : node.bound;
  glUseProgram(bound.program->object.name());
  for (GLuint unit = 0; unit < bound.textures.size(); ++unit) {
    glBindTextureUnit(unit, s_.texture(bound.textures[unit]).object.name());
    glBindSampler(unit, s_.nearest.name());
  }
  for (GLuint unit = 0; unit < bound.images.size(); ++unit) {
    const TextureResource& image = s_.texture(bound.images[unit]);
    glBindImageTexture(unit, image.object.name(), 0, GL_TRUE, 0, GL_READ_WRITE, formatFacts(image.info.format).internalFormat);
  }
  for (const BoundProgram::Block& block : bound.blocks) glBindBufferBase(block.target, block.binding, bufferOf(block));
}

GLuint GraphExecution::bufferOf(const BoundProgram::Block& block) const {
  switch (block.source) {
    case BoundProgram::Source::triangleNormals:
      return frame_.gpu.triangleNormals();
    case BoundProgram::Source::readCounts:
      return counter_->buffer();
    case BoundProgram::Source::buffer:
      break;
  }
  return s_.buffer(block.buffer).object.name();
}

void GraphExecution::prepare(const PassNode& node, GLuint vertexArray, Blend blend) {
  glBindFramebuffer(GL_FRAMEBUFFER, node.framebuffer.name());
  glViewport(0, 0, node.size.x, node.size.y);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glDepthRangef(0.0f, 1.0f);
  for (const GLenum off :
       {GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_CULL_FACE, GL_COLOR_LOGIC_OP, GL_POLYGON_OFFSET_FILL, GL_FRAMEBUFFER_SRGB,
        GL_RASTERIZER_DISCARD, GL_SAMPLE_MASK, GL_SAMPLE_ALPHA_TO_COVERAGE, GL_PRIMITIVE_RESTART}) {
    glDisable(off);
  }
  setBlend(blend);
  glFrontFace(GL_CCW);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glBindVertexArray(vertexArray);
  bind(node);
}

void GraphExecution::clearStorage(const PassNode& node) {
  for (const Buffer buffer : node.bufferWrites) {
    glClearNamedBufferData(s_.buffer(buffer).object.name(), GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE, nullptr);
  }
  if (!node.bufferWrites.empty()) glMemoryBarrier(kBeforeShaderWrites);
}

void GraphExecution::perform(const PassNode& node, const FullscreenPass& pass) {
  if (pass.from) copyTexture(s_.texture(*pass.from), s_.texture(node.writes[0].texture));
  prepare(node, s_.emptyVertexArray.name(), pass.blend);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_DEPTH_CLAMP);
  if (pass.clear && !pass.from) glClearNamedFramebufferfv(node.framebuffer.name(), GL_COLOR, 0, &pass.clear->x);
  if (pass.stencil) {
    const StencilFace face{.compare = pass.stencil->compare};
    setStencil({face, face, pass.stencil->reference, pass.stencil->mask, 0});
  }
  std::optional<glm::ivec4> region;
  if (pass.region) {  // after the clear, which a scissor would hold back too
    region = pass.region();
    glEnable(GL_SCISSOR_TEST);
    glScissor(region->x, region->y, region->z, region->w);
  }
  glDrawArrays(GL_TRIANGLES, 0, 3);
  leaveState();
  ++s_.report.counters.draws;
  countWritten(node, region);
}

void GraphExecution::perform(const PassNode& node, const RasterPass& pass) {
  if (pass.depthFrom) copyTexture(s_.texture(*pass.depthFrom), s_.texture(*pass.depth));
  clearStorage(node);
  prepare(node, pass.vertices ? s_.emptyVertexArray.name() : frame_.gpu.vertexArray(), pass.blend);
  clearTargets(node, pass);
  setEnabled(GL_DEPTH_TEST, pass.depth || pass.depthRead);
  glDepthMask(pass.depth && pass.depthWrite ? GL_TRUE : GL_FALSE);
  glDepthFunc(enumOf(pass.depthTest));
  setEnabled(GL_DEPTH_CLAMP, pass.depthClamp);
  if (pass.cull != Cull::none) {
    glEnable(GL_CULL_FACE);
    glCullFace(pass.cull == Cull::clockwise ? GL_BACK : GL_FRONT);
  }
  if (pass.stencil) setStencil(*pass.stencil);
  if (pass.vertices) {
    drawVertices(*pass.vertices);
  } else {
    drawScene(pass);
  }
  leaveState();
  if (!node.bufferWrites.empty()) glMemoryBarrier(kAfterShaderWrites);
  countWritten(node);
}

void GraphExecution::drawScene(const RasterPass& pass) {
  const DrawStorage& list = *s_.drawLists[static_cast<std::size_t>(pass.draws.id)].storage;
  if (pass.indirect) {
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, s_.buffer(pass.indirect->buffer).object.name());
    glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, atOffset(pass.indirect->offset), pass.indirect->commands, 0);
    s_.report.counters.draws += static_cast<std::uint64_t>(pass.indirect->commands);
    return;  // how many triangles only the GPU knows
  }
  if (list.commands.empty()) return;
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, list.commandBuffer.name());
  glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, nullptr, static_cast<GLsizei>(list.commands.size()), 0);
  for (const DrawCommand& command : list.commands) {
    ++s_.report.counters.draws;
    s_.report.counters.primitives += std::uint64_t{command.count} / 3 * command.instanceCount;
  }
}

void GraphExecution::drawVertices(const VertexDraw& draw) {
  const GLenum topology = enumOf(draw.topology);
  if (draw.indirect) {
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, s_.buffer(draw.indirect->buffer).object.name());
    glMultiDrawArraysIndirect(topology, atOffset(draw.indirect->offset), draw.indirect->commands, 0);
    s_.report.counters.draws += static_cast<std::uint64_t>(draw.indirect->commands);
    return;
  }
  glDrawArraysInstanced(topology, 0, draw.vertices, draw.instances);
  ++s_.report.counters.draws;
  s_.report.counters.primitives += primitivesOf(draw);
}

void GraphExecution::clearTargets(const PassNode& node, const RasterPass& pass) {
  const GLuint framebuffer = node.framebuffer.name();
  for (std::size_t i = 0; i < pass.colours.size(); ++i) {
    const glm::vec4 value = i < pass.clears.size() ? pass.clears[i] : glm::vec4(0.0f);
    if (s_.texture(pass.colours[i]).info.format == Format::rg32ui) {
      const std::array<GLuint, 4> none{~0U, ~0U, 0U, 0U};
      glClearNamedFramebufferuiv(framebuffer, GL_COLOR, static_cast<GLint>(i), none.data());
    } else {
      glClearNamedFramebufferfv(framebuffer, GL_COLOR, static_cast<GLint>(i), &value.x);
    }
  }
  if (!pass.depth || pass.depthFrom) return;
  glDepthMask(GL_TRUE);
  glStencilMask(0xff);
  const float farthest = 0.0f;
  if (s_.texture(*pass.depth).info.format == Format::d32f_s8) {
    glClearNamedFramebufferfi(framebuffer, GL_DEPTH_STENCIL, 0, farthest, 0);
  } else {
    glClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, &farthest);
  }
}

void GraphExecution::perform(const PassNode& node, const ComputePass& pass) {
  if (pass.clear) {
    for (const Target& target : node.writes) clearTexture(s_.texture(target.texture), *pass.clear);
  }
  clearStorage(node);
  glMemoryBarrier(kBeforeShaderWrites);
  bind(node);
  if (pass.indirect) {
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, s_.buffer(pass.indirect->buffer).object.name());
    glDispatchComputeIndirect(static_cast<GLintptr>(pass.indirect->offset));
  } else {
    glDispatchCompute(static_cast<GLuint>(pass.groups.x), static_cast<GLuint>(pass.groups.y),
                      static_cast<GLuint>(pass.groups.z));
  }
  glMemoryBarrier(kAfterShaderWrites);
  countWritten(node);
}

void GraphExecution::perform(const PassNode& node, const CpuPass& pass) {
  pass.run(*this);
  countWritten(node);
}

void GraphExecution::perform(const PassNode& /*node*/, const HistoryPass& pass) {
  copyTexture(s_.texture(pass.current), s_.texture(pass.history));
}

}  // namespace gnomon
