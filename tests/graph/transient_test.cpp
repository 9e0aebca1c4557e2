// Transient textures share memory and are made again when a reader runs.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "bench.h"
#include "gnomon/base/error.h"

namespace gnomon::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int kBlurs = 10;

/// A picture that follows the light, ten blurs, and the last of them plus a number that follows the camera.
class Chain : public testing::Test {
 protected:
  Chain() : Chain(true) {}
  explicit Chain(bool transient) {
    GraphBuilder& builder = graph->builder();
    const Buffer light = number("light", Input::light, lightValue);
    const Buffer camera = number("camera", Input::camera, cameraValue);
    const std::string block = "layout(std140) uniform Number { float x; };";
    Texture end =
        builder.fullscreen("picture", {.shader = shaderWriting(builder, "x * fract(float(p.x * 7 + p.y * 3) * 0.37)", block),
                                       .buffers = {{"Number", light}},
                                       .transient = transient});
    const std::string blur = shaderWriting(
        builder, "0.5 * (texelFetch(source, p, 0).r + texelFetch(source, ivec2((p.x + 1) % 8, (p.y + 1) % 4), 0).r)",
        "uniform sampler2D source;");
    for (int i = 0; i < kBlurs; ++i) {
      end = builder.fullscreen(fmt::format("blur {}", i), {.shader = blur, .reads = {{"source", end}}, .transient = transient});
    }
    out = builder.fullscreen(
        "out", {.shader = shaderWriting(builder, "texelFetch(source, p, 0).r + x", "uniform sampler2D source;" + block),
                .reads = {{"source", end}},
                .buffers = {{"Number", camera}}});
    graph->compile(std::span(&out, 1));
  }

  Buffer number(const std::string& name, Input input, const float& value) {
    const Buffer buffer = graph->builder().buffer(name, 16);
    graph->builder().cpu(name, {.inputs = {input}, .buffers = {buffer}, .run = [&value, buffer](CpuContext& context) {
                                  context.writeBlock(buffer, std::array<float, 4>{value, 0, 0, 0});
                                }});
    return buffer;
  }
  std::vector<float> frame(const GraphRun& options = {}) {
    last = ran(bench.run(*graph, options));
    return graph->read(out).data;
  }

  float lightValue = 1.0f;
  float cameraValue = 0.0f;
  Bench bench;
  std::unique_ptr<Graph> graph = bench.graph();
  Texture out;
  std::vector<std::string> last;
};

class LastingChain : public Chain {
 protected:
  LastingChain() : Chain(false) {}
};

TEST_F(Chain, TakesTwoTexturesAndItsOutput) {
  EXPECT_EQ(graph->memoryBytes(), 3U * 8U * 4U * 4U + 2U * 16U);
}

TEST_F(LastingChain, TakesATextureForEachPass) {
  EXPECT_EQ(graph->memoryBytes(), (kBlurs + 2U) * 8U * 4U * 4U + 2U * 16U);
}

class Lasting : public Chain {
 public:
  Lasting() : Chain(false) {}
  using Chain::frame;
  void TestBody() override {}
};

TEST_F(Chain, GivesTheBitsOfALastingOne) {
  EXPECT_EQ(frame(), Lasting().frame());
}

TEST_F(Chain, AStaticFrameRunsNothing) {
  frame();
  frame();
  EXPECT_THAT(last, IsEmpty());
}

TEST_F(Chain, AReaderFindsWhatNobodyOverwroteWithoutMakingItAgain) {
  const std::vector<float> before = frame();
  cameraValue = 2.0f;
  ++bench.revisions[Input::camera];
  const std::vector<float> after = frame();
  EXPECT_THAT(last, ElementsAre("camera", "out"));
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(after[i], before[i] + 2.0f);
}

TEST_F(Chain, IsNotLookedAtByName) {
  frame();
  ASSERT_EQ(graph->textures().size(), 1U);
  EXPECT_EQ(graph->textures()[0]->name, "out");
}

TEST_F(Chain, FramesTakeTheSameTexels) {
  const std::vector<float> before = frame();
  EXPECT_EQ(frame({.skipUnchanged = false}), before);
}

// --- what was overwritten ---

/// "early" and "late" share memory; "reader" of "early" follows the camera, and runs after "late" took the memory.
class Overwritten : public testing::Test {
 protected:
  Overwritten() {
    GraphBuilder& builder = graph->builder();
    const Buffer number = builder.buffer("Number", 16);
    builder.cpu("number", {.inputs = {Input::camera}, .buffers = {number}, .run = [this, number](CpuContext& context) {
                             context.writeBlock(number, std::array<float, 4>{value, 0, 0, 0});
                           }});
    const std::string block = "layout(std140) uniform Number { float x; };";
    const std::string copy = "uniform sampler2D source;";
    const Texture root = builder.fullscreen("root", {.shader = shaderWriting(builder, "3.0"), .transient = true});
    const Texture early =
        builder.fullscreen("early", {.shader = shaderWriting(builder, "1.0 + texelFetch(source, p, 0).r", copy),
                                     .reads = {{"source", root}},
                                     .transient = true});
    read = builder.fullscreen("reader", {.shader = shaderWriting(builder, "x * texelFetch(source, p, 0).r", block + copy),
                                         .reads = {{"source", early}},
                                         .buffers = {{"Number", number}}});
    const Texture late = builder.fullscreen("late", {.shader = shaderWriting(builder, "100.0"), .transient = true});
    const Texture later = builder.fullscreen("later", {.shader = shaderWriting(builder, "200.0"), .transient = true});
    sum = builder.fullscreen("sum", {.shader = shaderWriting(builder, "texelFetch(a, p, 0).r + texelFetch(b, p, 0).r",
                                                             "uniform sampler2D a; uniform sampler2D b;"),
                                     .reads = {{"a", late}, {"b", later}}});
    graph->compile(std::array{read, sum});
    bench.run(*graph);
  }

  float value = 1.0f;
  Bench bench;
  std::unique_ptr<Graph> graph = bench.graph();
  Texture read, sum;
};

TEST_F(Overwritten, SharesAllMemoryThatItMay) {
  EXPECT_EQ(graph->memoryBytes(), 4U * 8U * 4U * 4U + 16U);
}

TEST_F(Overwritten, IsMadeAgainWithAllThatItIsMadeOf) {
  value = 5.0f;
  ++bench.revisions[Input::camera];
  const GraphReport report = bench.run(*graph);
  EXPECT_THAT(ran(report), ElementsAre("number", "root", "early", "reader"));
  EXPECT_EQ(report.counters.passesRun, 4U);
  EXPECT_EQ(report.counters.passesSkipped, 3U);
  EXPECT_EQ(graph->read(read).at(3, 2), 20.0f);
  EXPECT_EQ(graph->read(sum).at(3, 2), 300.0f);
}

TEST_F(Overwritten, WhatTheMakingTookIsMadeAgainInItsTurn) {
  value = 5.0f;
  ++bench.revisions[Input::camera];
  bench.run(*graph);
  bench.run(*graph, {.skipUnchanged = false});
  EXPECT_EQ(graph->read(read).at(0, 0), 20.0f);
  EXPECT_EQ(graph->read(sum).at(0, 0), 300.0f);
}

// --- refusals ---

TEST(Transient, CannotBeAnOutput) {
  const Bench bench;
  const auto graph = bench.graph();
  const Texture out = graph->builder().fullscreen("out", {.shader = shaderWriting(graph->builder(), "1.0"), .transient = true});
  EXPECT_THAT(errorOf([&] { graph->compile(std::span(&out, 1)); }), HasSubstr("'out' is transient"));
}

TEST(Transient, OthersOfAnotherFormatDoNotShare) {
  const Bench bench;
  const auto graph = bench.graph();
  GraphBuilder& builder = graph->builder();
  const Texture a = builder.fullscreen("a", {.shader = shaderWriting(builder, "1.0"), .transient = true});
  const std::string copy = shaderWriting(builder, "texelFetch(source, p, 0).r", "uniform sampler2D source;");
  const Texture b =
      builder.fullscreen("b", {.shader = copy, .reads = {{"source", a}}, .format = Format::r16f, .transient = true});
  const Texture c = builder.fullscreen("c", {.shader = copy, .reads = {{"source", b}}, .transient = true});
  const Texture out = builder.fullscreen("out", {.shader = copy, .reads = {{"source", c}}});
  graph->compile(std::span(&out, 1));
  EXPECT_EQ(graph->memoryBytes(), 8U * 4U * (4U + 2U + 4U));
}

}  // namespace
}  // namespace gnomon::test
