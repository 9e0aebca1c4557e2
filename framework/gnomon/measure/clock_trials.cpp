#include "gnomon/measure/clock_trials.h"

#include "gnomon/base/clock.h"
#include "gnomon/base/files.h"
#include "gnomon/gl/program.h"

namespace gnomon {

namespace {

constexpr int kDrawsPerUnit = 2;
constexpr double kSmallestTrialMs = 4.0;  // twice what counts as heavy

class TrialDrawing {
 public:
  TrialDrawing()
      : program_(
            gl::makeProgram({{installationDirectory() / "shaders"}, {}},
                            {{GL_VERTEX_SHADER, "gnomon/fullscreen.vert"}, {GL_FRAGMENT_SHADER, "gnomon/clock_trial.frag"}}, {},
                            "clock trial")),
        target_(gl::makeTexture2D(GL_R32F, {kSize, kSize}, "clock trial")),
        framebuffer_(gl::makeFramebuffer("clock trial")),
        vertexArray_(gl::makeVertexArray("clock trial")) {
    glNamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT0, target_.name(), 0);
  }

  /// `work` units of drawing with `iterations` steps a pixel, each draw under a timer query of its own.
  ClockTrial run(int work, int iterations) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, kSize, kSize);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glUseProgram(program_.name());
    glProgramUniform1i(program_.name(), glGetUniformLocation(program_.name(), "iterations"), iterations);
    glBindVertexArray(vertexArray_.name());
    std::vector<gl::QueryObject> queries;
    glFinish();
    const double cpu = processCpuMs();
    const double wall = wallMs();
    for (int i = 0; i < work * kDrawsPerUnit; ++i) {
      queries.push_back(gl::makeQuery(GL_TIME_ELAPSED));
      glBeginQuery(GL_TIME_ELAPSED, queries.back().name());
      glDrawArrays(GL_TRIANGLES, 0, 3);
      glEndQuery(GL_TIME_ELAPSED);
    }
    glFinish();
    ClockTrial trial{static_cast<double>(work), wallMs() - wall, processCpuMs() - cpu, 0.0};
    for (const gl::QueryObject& query : queries) {
      GLuint64 nanoseconds = 0;
      glGetQueryObjectui64v(query.name(), GL_QUERY_RESULT, &nanoseconds);
      *trial.gpuMs += static_cast<double>(nanoseconds) * 1e-6;
    }
    return trial;
  }

 private:
  static constexpr int kSize = 256;
  gl::ProgramObject program_;
  gl::TextureObject target_;
  gl::FramebufferObject framebuffer_;
  gl::VertexArrayObject vertexArray_;
};

}  // namespace

std::vector<ClockTrial> runClockTrials() {
  TrialDrawing drawing;
  int iterations = 64;
  drawing.run(1, iterations);  // compiles
  // A shader invocation may be cut off after 65535 iterations on some renderers: stay well below.
  while (drawing.run(1, iterations).wallMs < kSmallestTrialMs && iterations < 32768) iterations *= 2;
  std::vector<ClockTrial> trials;
  for (const int work : {1, 2, 4, 1, 2, 4}) trials.push_back(drawing.run(work, iterations));
  return trials;
}

}  // namespace gnomon
