// Counts calls of one OpenGL function while it lives: libepoxy calls through pointers that can be set.
#pragma once

#include <epoxy/gl.h>

namespace gnomon::test {

/// `Pointer` is the address of libepoxy's pointer, such as &epoxy_glLinkProgram. One at a time for each.
template <auto Pointer>
class GlCalls;

template <class... Arguments, void (**Pointer)(Arguments...)>
class GlCalls<Pointer> {
 public:
  GlCalls() : before_(*Pointer) {
    count_ = 0;
    original_ = before_;
    *Pointer = &GlCalls::counted;
  }
  ~GlCalls() { *Pointer = before_; }
  GlCalls(const GlCalls&) = delete;
  GlCalls& operator=(const GlCalls&) = delete;

  int count() const { return count_; }

 private:
  static void counted(Arguments... arguments) {
    ++count_;
    original_(arguments...);
  }

  static inline int count_ = 0;
  static inline void (*original_)(Arguments...) = nullptr;
  void (*before_)(Arguments...);
};

using LinkedPrograms = GlCalls<&epoxy_glLinkProgram>;
using ReadTextures = GlCalls<&epoxy_glGetTextureImage>;

}  // namespace gnomon::test
