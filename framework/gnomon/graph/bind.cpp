// What a pass's program uses, out of what it is given.
#include <fmt/format.h>

#include <algorithm>

#include "gnomon/base/error.h"
#include "gnomon/graph/state.h"

namespace gnomon {

namespace {

std::string join(const std::vector<std::string>& parts) {
  std::string all;
  for (const std::string& part : parts) all += (all.empty() ? "" : ", ") + part;
  return all;
}

/// The handle of that name among the listed ones, else among the provided ones.
template <class Named, class Handle>
const Handle* find(const std::string& name, const std::vector<Named>& listed, Handle Named::*member,
                   const std::map<std::string, Handle>& provided) {
  const auto at = std::find_if(listed.begin(), listed.end(), [&](const Named& each) { return each.name == name; });
  if (at != listed.end()) return &((*at).*member);
  const auto given = provided.find(name);
  return given == provided.end() ? nullptr : &given->second;
}

/// The binding of a block, or an error.
BoundProgram::Block blockOf(const PassNode& node, const gl::Program::Point& point, GLenum target) {
  if (point.name == gl::kReadsBlock) return {target, point.at, BoundProgram::Source::readCounts, {}};
  if (point.name == "DrawRecords" || point.name == "TriangleNormals") {  // the graph's own: bound when the pass draws
    const auto* raster = std::get_if<RasterPass>(&node.kind);
    if (raster == nullptr || raster->vertices) {
      throw Error(fmt::format("pass '{}': the shader's block '{}' is of passes that draw the scene", node.name, point.name));
    }
    if (point.name == "TriangleNormals") return {target, point.at, BoundProgram::Source::triangleNormals, {}};
    return {target, point.at, BoundProgram::Source::buffer, node.ownBuffers.front()};
  }
  const NamedBuffer* written = nullptr;
  for (const NamedBuffer& each : node.recipe.writes) {
    if (each.name == point.name && target == GL_SHADER_STORAGE_BUFFER) written = &each;
  }
  const Buffer* buffer = written != nullptr
                             ? &written->buffer
                             : find(point.name, node.recipe.buffers, &NamedBuffer::buffer, node.recipe.context->buffers);
  if (buffer == nullptr)
    throw Error(fmt::format("pass '{}': nothing is given for the shader's block '{}'", node.name, point.name));
  return {target, point.at, BoundProgram::Source::buffer, *buffer};
}

}  // namespace

void requireWritten(const Graph::State& s, const PassNode& node, std::size_t index, Texture texture) {
  if (texture.id < 0 || static_cast<std::size_t>(texture.id) >= s.textures.size()) {
    throw Error(fmt::format("pass '{}' uses a texture that was never declared", node.name));
  }
  const TextureSlot& slot = s.at(texture);
  if (slot.imported || slot.isHistory) return;
  for (const int writer : slot.writers) {
    if (writer == static_cast<int>(index)) {
      throw Error(fmt::format("pass '{}' reads its own target '{}'", node.name, slot.resource->name));
    }
    if (writer < 0) {
      throw Error(
          fmt::format("pass '{}' reads texture '{}' before any pass writes "
                      "it{}; declare the writer first",
                      node.name, slot.resource->name, slot.writers.size() > 1 ? " in all its layers" : ""));
    }
    if (writer > static_cast<int>(index)) {
      throw Error(
          fmt::format("pass '{}' reads texture '{}' before '{}' writes "
                      "it; declare the writer first",
                      node.name, slot.resource->name, s.passes[static_cast<std::size_t>(writer)].name));
    }
  }
}

BoundProgram bindProgram(const Graph::State& s, const PassNode& node, std::size_t index,
                         const std::optional<gl::ReadCounting>& counting) {
  const Recipe& recipe = node.recipe;
  gl::ShaderSources sources = recipe.context->sources;
  sources.readCounting = counting;
  std::vector<gl::Constant> constants = recipe.context->constants;
  constants.insert(constants.end(), s.specialised.begin(), s.specialised.end());
  constants.insert(constants.end(), recipe.constants.begin(), recipe.constants.end());
  BoundProgram bound;
  try {
    bound.program = s.shares.programs->get(sources, recipe.stages, constants, s.name + "/" + node.name);
  } catch (const Error& error) {
    throw Error(fmt::format("pass '{}': {}", node.name, error.what()));
  }
  for (const gl::Program::Point& point : bound.program->samplers) {
    const Texture* texture = find(point.name, recipe.reads, &NamedTexture::texture, recipe.context->textures);
    if (texture == nullptr) {
      throw Error(fmt::format("pass '{}': nothing is given for the shader's uniform '{}'", node.name, point.name));
    }
    requireWritten(s, node, index, *texture);
    const auto* raster = std::get_if<RasterPass>(&node.kind);
    const auto* screen = std::get_if<FullscreenPass>(&node.kind);
    if ((raster != nullptr && raster->depthRead == *texture) ||
        (screen != nullptr && screen->stencil && screen->stencil->texture == *texture)) {
      throw Error(fmt::format("pass '{}' both tests against texture '{}' and samples it", node.name, s.texture(*texture).name));
    }
    bound.textures.push_back(*texture);
  }
  for (const gl::Program::Point& point : bound.program->images) {
    const auto image = std::find_if(recipe.images.begin(), recipe.images.end(),
                                    [&](const NamedTexture& each) { return each.name == point.name; });
    if (image == recipe.images.end()) {
      throw Error(fmt::format("pass '{}': nothing is given for the shader's image '{}'", node.name, point.name));
    }
    bound.images.push_back(image->texture);
  }
  if (bound.images.size() != recipe.images.size()) {
    std::vector<std::string> unused;
    for (const NamedTexture& image : recipe.images) {
      const auto& used = bound.program->images;
      if (std::none_of(used.begin(), used.end(), [&](const auto& point) { return point.name == image.name; }))
        unused.push_back("'" + image.name + "'");
    }
    throw Error(fmt::format("pass '{}': its shader does not use the image {}", node.name, join(unused)));
  }
  for (const gl::Program::Point& point : bound.program->uniforms)
    bound.blocks.push_back(blockOf(node, point, GL_UNIFORM_BUFFER));
  for (const gl::Program::Point& point : bound.program->storages)
    bound.blocks.push_back(blockOf(node, point, GL_SHADER_STORAGE_BUFFER));
  for (const BoundProgram::Block& block : bound.blocks) {
    if (block.source != BoundProgram::Source::buffer) continue;
    if (block.buffer.id < 0 || static_cast<std::size_t>(block.buffer.id) >= s.buffers.size()) {
      throw Error(fmt::format("pass '{}' uses a buffer that was never declared", node.name));
    }
    if (const int writer = s.at(block.buffer).writer; writer > static_cast<int>(index)) {
      throw Error(
          fmt::format("pass '{}' reads buffer '{}' before '{}' writes "
                      "it; declare the writer first",
                      node.name, s.buffer(block.buffer).name, s.passes[static_cast<std::size_t>(writer)].name));
    }
  }
  return bound;
}

void useProgram(PassNode& node, BoundProgram bound) {
  node.bound = std::move(bound);
  node.textureReads = node.ownTextures;
  node.textureReads.insert(node.textureReads.end(), node.bound.textures.begin(), node.bound.textures.end());
  node.bufferReads = node.ownBuffers;
  for (const BoundProgram::Block& block : node.bound.blocks) {
    if (block.source != BoundProgram::Source::buffer) continue;
    const auto& written = node.bufferWrites;
    if (std::find(written.begin(), written.end(), block.buffer) == written.end()) node.bufferReads.push_back(block.buffer);
  }
}

}  // namespace gnomon
