#include "gnomon/passes/present.h"

#include "gnomon/base/files.h"
#include "gnomon/gl/program.h"

namespace gnomon {

Presenter::Presenter()
    : program_(gl::makeProgram({{installationDirectory() / "shaders"}, {}},
                               {{GL_VERTEX_SHADER, "gnomon/fullscreen.vert"}, {GL_FRAGMENT_SHADER, "gnomon/present.frag"}}, {},
                               "present")),
      vertexArray_(gl::makeVertexArray("present")),
      nearest_(gl::makeSampler(GL_NEAREST)) {}

void Presenter::draw(const PresentView& view, glm::ivec2 size) const {
  const GLuint program = program_.name();
  const auto at = [program](const char* name) { return glGetUniformLocation(program, name); };
  const TextureResource* right = view.right != nullptr ? view.right : view.left;
  const glm::ivec2 extent = view.extent.x > 0 && view.extent.y > 0 ? view.extent : size;
  const glm::ivec2 corner(view.at.x, size.y - view.at.y - extent.y);  // windows count from the bottom
  glViewport(corner.x, corner.y, extent.x, extent.y);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_FRAMEBUFFER_SRGB);  // the shader encodes: window framebuffers differ in whether they would
  glUseProgram(program);
  glProgramUniform1i(program, at("left"), 0);
  glProgramUniform1i(program, at("right"), 1);
  glProgramUniform1i(program, at("mode"), static_cast<int>(view.mode));
  glProgramUniform1i(program, at("channel"), view.channel);
  glProgramUniform1f(program, at("divider"), view.right != nullptr ? view.divider : 2.0f);
  glProgramUniform1f(program, at("scale"), view.scale);
  glProgramUniform2f(program, at("range"), view.range.x, view.range.y);
  glProgramUniform2f(program, at("corner"), static_cast<float>(corner.x), static_cast<float>(corner.y));
  glProgramUniform2f(program, at("extent"), static_cast<float>(extent.x), static_cast<float>(extent.y));
  glBindTextureUnit(0, view.left->object.name());
  glBindTextureUnit(1, right->object.name());
  glBindSampler(0, nearest_.name());
  glBindSampler(1, nearest_.name());
  glBindVertexArray(vertexArray_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace gnomon
