// Constants that change while the graph stays: what mentions them is compiled again, once.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "bench.h"
#include "gl_calls.h"

namespace gnomon::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// "first" writes A, "second" reads it and adds B where USE is true, else C of "other".
class Specialise : public testing::Test {
 protected:
  Specialise() {
    GraphBuilder& builder = graph->builder();
    graph->specialise({{"A", 1}, {"B", 10}, {"USE", true}});
    first = builder.fullscreen("first", {.shader = shaderWriting(builder, "float(A)")});
    const Texture other = builder.fullscreen("other", {.shader = shaderWriting(builder, "500.0")});
    const std::string shader =
        shaderWriting(builder, "texelFetch(source, p, 0).r + (USE ? float(B) : texelFetch(otherwise, p, 0).r)",
                      "uniform sampler2D source; uniform sampler2D otherwise;");
    out = builder.fullscreen("second", {.shader = shader, .reads = {{"source", first}, {"otherwise", other}}});
    graph->compile(std::span(&out, 1));
    bench.run(*graph);
  }

  int compiled(const std::vector<Constant>& constants) {
    const LinkedPrograms linked;
    graph->specialise(constants);
    return linked.count();
  }
  float value() { return graph->read(out).at(0, 0); }

  Bench bench;
  std::unique_ptr<Graph> graph = bench.graph();
  Texture first, out;
};

TEST_F(Specialise, OnlyProgramsThatMentionTheConstantAreCompiled) {
  EXPECT_EQ(compiled({{"A", 1}, {"B", 20}, {"USE", true}}), 1);
  EXPECT_THAT(ran(bench.run(*graph)), ElementsAre("second"));
  EXPECT_EQ(value(), 21.0f);
}

TEST_F(Specialise, WhatReadsTheOtherResultRunsToo) {
  EXPECT_EQ(compiled({{"A", 2}, {"B", 10}, {"USE", true}}), 1);
  EXPECT_THAT(ran(bench.run(*graph)), ElementsAre("first", "second"));
  EXPECT_EQ(value(), 12.0f);
}

TEST_F(Specialise, TheSameValuesCompileAndRunNothing) {
  EXPECT_EQ(compiled({{"A", 1}, {"B", 10}, {"USE", true}}), 0);
  EXPECT_THAT(ran(bench.run(*graph)), IsEmpty());
}

TEST_F(Specialise, GoingBackCompilesNothing) {
  compiled({{"A", 2}, {"B", 20}, {"USE", true}});
  bench.run(*graph);
  EXPECT_EQ(compiled({{"A", 1}, {"B", 10}, {"USE", true}}), 0);
  bench.run(*graph);
  EXPECT_EQ(value(), 11.0f);
}

TEST_F(Specialise, APassThatIsNeededOnlyNowRuns) {
  EXPECT_THAT(graph->passNames(), ElementsAre("first", "second"));
  compiled({{"A", 1}, {"B", 10}, {"USE", false}});
  EXPECT_THAT(ran(bench.run(*graph)), ElementsAre("other", "second"));
  EXPECT_EQ(value(), 501.0f);
}

TEST_F(Specialise, APassThatIsNoLongerNeededGivesItsMemoryBack) {
  const std::size_t before = graph->memoryBytes();
  compiled({{"A", 1}, {"B", 10}, {"USE", false}});
  EXPECT_EQ(graph->memoryBytes(), before + 8U * 4U * 4U);
  compiled({{"A", 1}, {"B", 10}, {"USE", true}});
  EXPECT_EQ(graph->memoryBytes(), before);
}

TEST_F(Specialise, TexturesOfOthersStay) {
  const GLuint before = graph->resource(first)->object.name();
  compiled({{"A", 1}, {"B", 10}, {"USE", false}});
  EXPECT_EQ(graph->resource(first)->object.name(), before);
}

TEST_F(Specialise, AConstantThatDoesNotCompileLeavesAllAsItWas) {
  const std::string message = errorOf([&] { graph->specialise({{"A", 1}, {"USE", true}}); });
  EXPECT_THAT(message, HasSubstr("'second'"));
  EXPECT_THAT(ran(bench.run(*graph)), IsEmpty());
  EXPECT_EQ(compiled({{"A", 1}, {"B", 10}, {"USE", true}}), 0);
}

// --- the cache ---

TEST(ProgramCache, IsBounded) {
  const Bench bench;
  gl::ProgramCache cache(3);
  gl::ShaderSources sources;
  sources.generated["a.frag"] = "out float v;\nvoid main() { v = float(N); }\n";
  sources.generated["a.vert"] = "void main() { gl_Position = vec4(0.0); }\n";
  const std::vector<gl::ShaderStage> stages{{GL_VERTEX_SHADER, "a.vert"}, {GL_FRAGMENT_SHADER, "a.frag"}};
  const int before = gl::liveObjects();
  for (int i = 0; i < 7; ++i) cache.get(sources, stages, {{"N", i}}, "a");
  EXPECT_EQ(cache.size(), 3U);
  EXPECT_EQ(gl::liveObjects(), before + 3);
}

TEST(ProgramCache, KnowsProgramsInUseThatItNoLongerKeeps) {
  const Bench bench;
  gl::ProgramCache cache(1);
  gl::ShaderSources sources;
  sources.generated["a.comp"] = "layout(local_size_x = 1) in;\nvoid main() { for (int i = 0; i < N; ++i) barrier(); }\n";
  const std::vector<gl::ShaderStage> stages{{GL_COMPUTE_SHADER, "a.comp"}};
  const auto one = cache.get(sources, stages, {{"N", 1}}, "a");
  cache.get(sources, stages, {{"N", 2}}, "a");
  const LinkedPrograms linked;
  EXPECT_EQ(cache.get(sources, stages, {{"N", 1}}, "a"), one);
  EXPECT_EQ(linked.count(), 0);
}

TEST(ProgramCache, AConstantOfALongerNameIsAnother) {
  const Bench bench;
  gl::ProgramCache cache;
  gl::ShaderSources sources;
  sources.generated["a.comp"] = "layout(local_size_x = 1) in;\nconst int TAPS_2 = 3;\nvoid main() {}\n";
  const std::vector<gl::ShaderStage> stages{{GL_COMPUTE_SHADER, "a.comp"}};
  EXPECT_EQ(cache.get(sources, stages, {{"TAPS", 1}}, "a"), cache.get(sources, stages, {{"TAPS", 2}}, "a"));
}

}  // namespace
}  // namespace gnomon::test
