// Texels between CPU and GPU, and the size of what holds them.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>

#include "gnomon/base/error.h"
#include "gnomon/gl/state.h"
#include "gnomon/graph/state.h"

namespace gnomon {

namespace {

/// Above what those who own a resource outside of any graph count.
std::atomic<std::uint64_t> revisions{std::uint64_t{1} << 32U};

GLenum channelLayout(const FormatFacts& facts) {
  if (facts.depth) return GL_DEPTH_COMPONENT;
  return facts.channels == 1 ? GL_RED : facts.channels == 2 ? GL_RG : GL_RGBA;
}

int heightOf(const TextureInfo& info) {
  return info.size.y * std::max(info.layers, 1);
}

}  // namespace

std::uint64_t nextRevision() {
  return ++revisions;
}

std::size_t texelCount(const TextureInfo& info) {
  return static_cast<std::size_t>(info.size.x) * static_cast<std::size_t>(heightOf(info));
}

std::size_t bytesOf(const TextureInfo& info) {
  return texelCount(info) * static_cast<std::size_t>(formatFacts(info.format).bytes);
}

void readInto(const TextureResource& texture, std::vector<float>& out, std::vector<std::uint8_t>& bytes) {
  gl::restoreTransfers();  // code of a plugin may read in the middle of a pass of its own
  glFinish();              // reading waits for what was drawn, but software renderers were seen not to under load
  const FormatFacts& facts = formatFacts(texture.info.format);
  out.resize(texelCount(texture.info) * static_cast<std::size_t>(facts.channels));
  if (texture.info.format == Format::r8) {  // several times as fast as the driver's conversion
    bytes.resize(out.size());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureImage(texture.object.name(), 0, GL_RED, GL_UNSIGNED_BYTE, static_cast<GLsizei>(bytes.size()), bytes.data());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    std::transform(bytes.begin(), bytes.end(), out.begin(), [](std::uint8_t b) { return static_cast<float>(b) / 255.0f; });
    return;
  }
  glGetTextureImage(texture.object.name(), 0, channelLayout(facts), GL_FLOAT, static_cast<GLsizei>(out.size() * sizeof(float)),
                    out.data());
}

void readIntegersInto(const TextureResource& texture, std::vector<std::uint32_t>& out) {
  out.resize(texelCount(texture.info) * 2);
  gl::restoreTransfers();
  glFinish();  // as above
  glGetTextureImage(texture.object.name(), 0, GL_RG_INTEGER, GL_UNSIGNED_INT, static_cast<GLsizei>(out.size() * 4), out.data());
}

void uploadTexels(const TextureResource& texture, std::span<const float> values) {
  const FormatFacts& facts = formatFacts(texture.info.format);
  const std::size_t wanted = texelCount(texture.info) * static_cast<std::size_t>(facts.channels);
  if (values.size() != wanted) {
    throw Error(fmt::format("texture '{}' has {} values, {} were written", texture.name, wanted, values.size()));
  }
  gl::restoreTransfers();
  const auto [width, height] = std::pair(texture.info.size.x, texture.info.size.y);
  const GLuint name = texture.object.name();
  const GLenum layout = channelLayout(facts);
  if (texture.info.layers > 0) {
    glTextureSubImage3D(name, 0, 0, 0, 0, width, height, texture.info.layers, layout, GL_FLOAT, values.data());
  } else {
    glTextureSubImage2D(name, 0, 0, 0, width, height, layout, GL_FLOAT, values.data());
  }
}

void clearTexture(const TextureResource& texture, const glm::vec4& value) {
  const GLuint name = texture.object.name();
  if (texture.info.format == Format::rg32ui) {
    const std::array<GLuint, 2> integers{static_cast<GLuint>(value.x), static_cast<GLuint>(value.y)};
    glClearTexImage(name, 0, GL_RG_INTEGER, GL_UNSIGNED_INT, integers.data());
  } else if (texture.info.format == Format::d32f_s8) {
    struct {
      float depth;
      GLuint stencil;
    } const both{value.x, static_cast<GLuint>(value.y)};
    glClearTexImage(name, 0, GL_DEPTH_STENCIL, GL_FLOAT_32_UNSIGNED_INT_24_8_REV, &both);
  } else {
    glClearTexImage(name, 0, formatFacts(texture.info.format).depth ? GL_DEPTH_COMPONENT : GL_RGBA, GL_FLOAT, &value.x);
  }
}

void copyTexture(const TextureResource& from, const TextureResource& to) {
  const TextureInfo& info = from.info;
  const GLenum target = info.layers > 0 ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D;
  glCopyImageSubData(from.object.name(), target, 0, 0, 0, 0, to.object.name(), target, 0, 0, 0, 0, info.size.x, info.size.y,
                     std::max(info.layers, 1));
}

void requireFinite(const TextureResource& texture, std::vector<float>& scratch, std::vector<std::uint8_t>& bytes) {
  if (texture.info.format == Format::rg32ui) return;
  readInto(texture, scratch, bytes);
  const auto bad = std::find_if_not(scratch.begin(), scratch.end(), [](float v) { return std::isfinite(v); });
  if (bad == scratch.end()) return;
  const auto i = static_cast<std::size_t>(bad - scratch.begin());
  const auto channels = static_cast<std::size_t>(formatFacts(texture.info.format).channels);
  const auto width = static_cast<std::size_t>(texture.info.size.x);
  const auto height = static_cast<std::size_t>(texture.info.size.y);
  const std::size_t pixel = i / channels;
  const std::string layer = texture.info.layers > 0 ? fmt::format(", layer {}", pixel / (width * height)) : "";
  throw Error(fmt::format("target '{}' holds {} at pixel ({}, {}){}, channel {}", texture.name, *bad, pixel % width,
                          pixel / width % height, layer, i % channels));
}

void writeBuffer(BufferResource& buffer, std::span<const std::byte> bytes) {
  if (bytes.size() > buffer.bytes) {
    throw Error(fmt::format("buffer '{}' holds {} bytes, {} were written", buffer.name, buffer.bytes, bytes.size()));
  }
  if (buffer.contents.empty()) buffer.contents.assign(buffer.bytes, std::byte{0});
  if (std::memcmp(buffer.contents.data(), bytes.data(), bytes.size()) == 0) return;
  std::memcpy(buffer.contents.data(), bytes.data(), bytes.size());
  glNamedBufferSubData(buffer.object.name(), 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
  buffer.revision = nextRevision();
}

Image readTexture(const TextureResource& texture) {
  const FormatFacts& facts = formatFacts(texture.info.format);
  if (texture.info.format == Format::rg32ui) throw Error(fmt::format("texture '{}' holds integers", texture.name));
  Image image(texture.info.size.x, heightOf(texture.info), facts.channels);
  std::vector<std::uint8_t> bytes;
  readInto(texture, image.data, bytes);
  return image;
}

}  // namespace gnomon
