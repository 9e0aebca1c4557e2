#include "gnomon/gl/objects.h"

#include <fmt/format.h>

#include <algorithm>

#include "gnomon/base/error.h"

namespace gnomon::gl {

namespace detail {
void deleteTexture(GLuint name) { glDeleteTextures(1, &name); }
void deleteBuffer(GLuint name) { glDeleteBuffers(1, &name); }
void deleteFramebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }
void deleteVertexArray(GLuint name) { glDeleteVertexArrays(1, &name); }
void deleteProgram(GLuint name) { glDeleteProgram(name); }
void deleteShader(GLuint name) { glDeleteShader(name); }
void deleteQuery(GLuint name) { glDeleteQueries(1, &name); }
void deleteSampler(GLuint name) { glDeleteSamplers(1, &name); }
}  // namespace detail

namespace {
void label(GLenum kind, GLuint name, const std::string& text) {
  glObjectLabel(kind, name, static_cast<GLsizei>(std::min<std::size_t>(text.size(), 200)), text.c_str());
}
}  // namespace

TextureObject makeTexture2D(GLenum internalFormat, glm::ivec2 size, const std::string& text) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  if (size.x < 1 || size.y < 1 || size.x > limit || size.y > limit) {
    throw Error(fmt::format("texture '{}': {}x{} is outside this driver's 1..{}", text, size.x, size.y, limit));
  }
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  TextureObject texture(name);
  glTextureStorage2D(name, 1, internalFormat, size.x, size.y);
  label(GL_TEXTURE, name, text);
  return texture;
}

BufferObject makeBuffer(std::size_t bytes, const void* data, const std::string& text) {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  BufferObject buffer(name);
  glNamedBufferStorage(name, static_cast<GLsizeiptr>(std::max<std::size_t>(bytes, 16)), bytes == 0 ? nullptr : data,
                       GL_DYNAMIC_STORAGE_BIT);
  label(GL_BUFFER, name, text);
  return buffer;
}

FramebufferObject makeFramebuffer(const std::string& text) {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  label(GL_FRAMEBUFFER, name, text);
  return FramebufferObject(name);
}

VertexArrayObject makeVertexArray(const std::string& text) {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  label(GL_VERTEX_ARRAY, name, text);
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
