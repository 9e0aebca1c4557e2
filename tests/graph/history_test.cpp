// What a texture held in the last frame.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "bench.h"

namespace gnomon::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// "now" shows `value`, which follows the light; "show" gives 100 times the last one plus this one.
class History : public testing::Test {
 protected:
  History() {
    GraphBuilder& builder = graph->builder();
    const Buffer number = builder.buffer("number", 16);
    builder.cpu("number", {.inputs = {Input::light}, .buffers = {number}, .run = [this, number](CpuContext& context) {
                             context.writeBlock(number, std::array<float, 4>{value, 0, 0, 0});
                           }});
    const Texture before = builder.history("before", {{8, 4}, Format::r32f}, glm::vec4(7.0f));
    const Texture now =
        builder.fullscreen("now", {.shader = shaderWriting(builder, "x", "layout(std140) uniform Number { float x; };"),
                                   .buffers = {{"Number", number}}});
    out = builder.fullscreen("show", {.shader = shaderWriting(builder, "100.0 * texelFetch(a, p, 0).r + texelFetch(b, p, 0).r",
                                                              "uniform sampler2D a; uniform sampler2D b;"),
                                      .reads = {{"a", before}, {"b", now}}});
    builder.remember(before, now);
    graph->compile(std::span(&out, 1));
  }

  float frame(float light) {
    if (light != value) {
      value = light;
      ++bench.revisions[Input::light];
    }
    last = ran(bench.run(*graph));
    return graph->read(out).at(5, 2);
  }

  float value = 1.0f;
  Bench bench;
  std::unique_ptr<Graph> graph = bench.graph();
  Texture out;
  std::vector<std::string> last;
};

TEST_F(History, TheFirstFrameSeesTheResetValue) {
  EXPECT_EQ(frame(1.0f), 701.0f);
}

TEST_F(History, EveryFrameSeesTheOneBefore) {
  frame(1.0f);
  EXPECT_EQ(frame(2.0f), 102.0f);
  EXPECT_EQ(frame(3.0f), 203.0f);
}

TEST_F(History, AStaticFrameAfterAChangeRunsWhoReadsIt) {
  frame(1.0f);
  frame(2.0f);
  EXPECT_EQ(frame(2.0f), 202.0f);
  EXPECT_THAT(last, ElementsAre("show"));
}

TEST_F(History, TheNextOneRunsNothing) {
  frame(1.0f);
  frame(1.0f);
  frame(1.0f);
  EXPECT_THAT(last, IsEmpty());
}

TEST_F(History, ACutStartsAgain) {
  frame(1.0f);
  frame(2.0f);
  graph->cut();
  EXPECT_EQ(frame(2.0f), 702.0f);
  EXPECT_EQ(frame(2.0f), 202.0f);
}

TEST_F(History, IsCountedAsMemory) {
  EXPECT_EQ(graph->memoryBytes(), 3U * 8U * 4U * 4U + 16U);
}

// --- refusals ---

class HistoryRefusal : public testing::Test {
 protected:
  Texture reader(Texture from) {
    return builder.fullscreen("reader",
                              {.shader = shaderWriting(builder, "texelFetch(source, p, 0).r", "uniform sampler2D source;"),
                               .reads = {{"source", from}}});
  }
  Bench bench;
  std::unique_ptr<Graph> graph = bench.graph();
  GraphBuilder& builder = graph->builder();
};

TEST_F(HistoryRefusal, OneInWhichNothingIsRemembered) {
  const Texture out = reader(builder.history("before", {{8, 4}, Format::r32f}, glm::vec4(0.0f)));
  EXPECT_THAT(errorOf([&] { graph->compile(std::span(&out, 1)); }), AllOf(HasSubstr("'bench'"), HasSubstr("'before'")));
}

TEST_F(HistoryRefusal, OneOfAnotherFormat) {
  const Texture before = builder.history("before", {{8, 4}, Format::r16f}, glm::vec4(0.0f));
  const Texture now = reader(before);
  EXPECT_THAT(errorOf([&] { builder.remember(before, now); }),
              AllOf(HasSubstr("'before'"), HasSubstr("r16f"), HasSubstr("'reader'"), HasSubstr("r32f")));
}

TEST_F(HistoryRefusal, OneOfTwoTextures) {
  const Texture before = builder.history("before", {{8, 4}, Format::r32f}, glm::vec4(0.0f));
  const Texture now = reader(before);
  builder.remember(before, now);
  EXPECT_THAT(errorOf([&] { builder.remember(before, now); }), AllOf(HasSubstr("'before'"), HasSubstr("two")));
}

TEST_F(HistoryRefusal, APassThatWritesIt) {
  const Texture before = builder.history("before", {{8, 4}, Format::r32f}, glm::vec4(0.0f));
  EXPECT_THAT(errorOf([&] { builder.cpu("writer", {.writes = {before}, .run = [](CpuContext&) {}}); }),
              AllOf(HasSubstr("'writer'"), HasSubstr("'before'")));
}

}  // namespace
}  // namespace gnomon::test
