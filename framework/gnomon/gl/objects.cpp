#include "gnomon/gl/objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "gnomon/base/error.h"

namespace gnomon::gl {

namespace {
std::atomic<int> objects{0};  // contexts of several threads share it
}

int liveObjects() {
  return objects;
}

namespace detail {
void countObject(int change) {
  objects += change;
}
void deleteTexture(GLuint name) {
  glDeleteTextures(1, &name);
}
void deleteBuffer(GLuint name) {
  glDeleteBuffers(1, &name);
}
void deleteFramebuffer(GLuint name) {
  glDeleteFramebuffers(1, &name);
}
void deleteVertexArray(GLuint name) {
  glDeleteVertexArrays(1, &name);
}
void deleteProgram(GLuint name) {
  glDeleteProgram(name);
}
void deleteShader(GLuint name) {
  glDeleteShader(name);
}
void deleteQuery(GLuint name) {
  glDeleteQueries(1, &name);
}
void deleteSampler(GLuint name) {
  glDeleteSamplers(1, &name);
}
}  // namespace detail

void setLabel(GLenum kind, GLuint name, const std::string& label) {
  // GL_MAX_LABEL_LENGTH is 256 at least, with the terminating zero.
  glObjectLabel(kind, name, static_cast<GLsizei>(std::min<std::size_t>(label.size(), 255)), label.c_str());
}

namespace {

void requireSize(glm::ivec2 size, const std::string& label) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  if (size.x < 1 || size.y < 1 || size.x > limit || size.y > limit) {
    throw Error(fmt::format("texture '{}': {}x{} is outside this driver's 1..{}", label, size.x, size.y, limit));
  }
}

TextureObject newTexture(GLenum target) {
  GLuint name = 0;
  glCreateTextures(target, 1, &name);
  return TextureObject(name);
}

}  // namespace

TextureObject makeTexture2D(GLenum internalFormat, glm::ivec2 size, const std::string& label) {
  requireSize(size, label);
  TextureObject texture = newTexture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), 1, internalFormat, size.x, size.y);
  setLabel(GL_TEXTURE, texture.name(), label);
  return texture;
}

TextureObject makeTexture2DArray(GLenum internalFormat, glm::ivec2 size, int layers, const std::string& label) {
  requireSize(size, label);
  GLint limit = 0;
  glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &limit);
  if (layers < 1 || layers > limit) {
    throw Error(fmt::format("texture '{}': {} layers are outside this driver's 1..{}", label, layers, limit));
  }
  TextureObject texture = newTexture(GL_TEXTURE_2D_ARRAY);
  glTextureStorage3D(texture.name(), 1, internalFormat, size.x, size.y, layers);
  setLabel(GL_TEXTURE, texture.name(), label);
  return texture;
}

BufferObject makeBuffer(std::size_t bytes, const void* data, const std::string& label) {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  BufferObject buffer(name);
  // OpenGL has no empty buffers; nothing is read from `data` beyond `bytes`.
  glNamedBufferStorage(name, bytes == 0 ? 16 : static_cast<GLsizeiptr>(bytes), bytes == 0 ? nullptr : data,
                       GL_DYNAMIC_STORAGE_BIT);
  setLabel(GL_BUFFER, name, label);
  return buffer;
}

FramebufferObject makeFramebuffer(const std::string& label) {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  setLabel(GL_FRAMEBUFFER, name, label);
  return FramebufferObject(name);
}

VertexArrayObject makeVertexArray(const std::string& label) {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  setLabel(GL_VERTEX_ARRAY, name, label);
  return VertexArrayObject(name);
}

SamplerObject makeSampler(GLenum filter) {
  GLuint name = 0;
  glCreateSamplers(1, &name);
  const auto mode = static_cast<GLint>(filter);
  glSamplerParameteri(name, GL_TEXTURE_MIN_FILTER, mode);
  glSamplerParameteri(name, GL_TEXTURE_MAG_FILTER, mode);
  glSamplerParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glSamplerParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return SamplerObject(name);
}

QueryObject makeQuery(GLenum target) {
  GLuint name = 0;
  glCreateQueries(target, 1, &name);
  return QueryObject(name);
}

}  // namespace gnomon::gl
