// Move-only OpenGL objects: created complete, deleted with their owner. A
// current context is required throughout.
#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <glm/vec2.hpp>
#include <string>
#include <utility>

namespace gnomon::gl {

namespace detail {
void countObject(int change);
}

/// How many objects this process owns now: what leaks shows here.
int liveObjects();

/// Owns one OpenGL name; `Deleter` frees it.
template <auto Deleter>
class Object {
 public:
  Object() = default;
  explicit Object(GLuint name) : name_(name) {
    if (name_ != 0) detail::countObject(1);
  }
  Object(Object&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Object& operator=(Object&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;
  ~Object() {
    if (name_ == 0) return;
    Deleter(name_);
    detail::countObject(-1);
  }
  GLuint name() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

 private:
  GLuint name_ = 0;
};

namespace detail {
void deleteTexture(GLuint name);
void deleteBuffer(GLuint name);
void deleteFramebuffer(GLuint name);
void deleteVertexArray(GLuint name);
void deleteProgram(GLuint name);
void deleteShader(GLuint name);
void deleteQuery(GLuint name);
void deleteSampler(GLuint name);
}  // namespace detail

using TextureObject = Object<&detail::deleteTexture>;
using BufferObject = Object<&detail::deleteBuffer>;
using FramebufferObject = Object<&detail::deleteFramebuffer>;
using VertexArrayObject = Object<&detail::deleteVertexArray>;
using ProgramObject = Object<&detail::deleteProgram>;
using ShaderObject = Object<&detail::deleteShader>;
using QueryObject = Object<&detail::deleteQuery>;
using SamplerObject = Object<&detail::deleteSampler>;

/// Names an object for debuggers; cut to what every driver takes.
void setLabel(GLenum kind, GLuint name, const std::string& label);

/// Immutable storage of one level. Throws Error beyond the driver's limit,
/// naming it.
TextureObject makeTexture2D(GLenum internalFormat, glm::ivec2 size, const std::string& label);
TextureObject makeTexture2DArray(GLenum internalFormat, glm::ivec2 size, int layers, const std::string& label);
/// Immutable storage, writable by glNamedBufferSubData. `bytes` may be 0 (16
/// are taken).
BufferObject makeBuffer(std::size_t bytes, const void* data, const std::string& label);
FramebufferObject makeFramebuffer(const std::string& label);
VertexArrayObject makeVertexArray(const std::string& label);
/// Nearest or linear, clamped to the edge, no mip-maps.
SamplerObject makeSampler(GLenum filter);
QueryObject makeQuery(GLenum target);

}  // namespace gnomon::gl
