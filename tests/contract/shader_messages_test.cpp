// A shader that does not compile is told once, by who asked for it.
#include <gtest/gtest.h>

#include "gnomon/gl/context.h"
#include "gnomon/gl/program.h"
#include "plugin_folder.h"
#include "render.h"

namespace gnomon::test {
namespace {

TEST(ShaderMessages, AFaultIsNotTheNextOnesToo) {
  ensureContext();
  gl::DebugMessages messages;  // of somebody who works beside
  EXPECT_THROW(gl::makeProgram({{testPlugin("mischief")}, {}}, {{GL_FRAGMENT_SHADER, "syntax_error.frag"}}, {}, "broken"),
               Error);
  EXPECT_NO_THROW(messages.throwIfError("something else"));
}

TEST(ShaderMessages, WhatOpenGLCallsAnErrorIsToldToWhoeverAsksNext) {
  ensureContext();
  gl::DebugMessages first;
  const gl::DebugMessages second;  // a later one takes nothing from an earlier one
  glEnable(GL_TEXTURE_2D_ARRAY);   // no capability
  EXPECT_THROW(first.throwIfError("here"), Error);
  EXPECT_NO_THROW(first.throwIfError("here"));
}

}  // namespace
}  // namespace gnomon::test
