// Compute passes: images, storage buffers, dispatches from a buffer, and the order of their memory accesses.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "bench.h"

namespace gnomon::test {
namespace {

using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class Compute : public testing::Test {
 protected:
  /// A compute shader, and its name.
  std::string shader(const std::string& body, const std::string& declarations, const std::string& local = "local_size_x = 1") {
    const std::string text = fmt::format("layout({}) in;\n{}\nvoid main() {{ {} }}\n", local, declarations, body);
    const std::string name = fmt::format("test {:x}", std::hash<std::string>{}(text));
    builder.include(name, text);
    return name;
  }
  /// Writes 1 + column + 10 * row into an image.
  Texture image(const std::string& name, const std::string& value = "1 + p.x + 10 * p.y") {
    const Texture target = builder.texture(name, {{8, 4}, Format::r32f});
    builder.compute(name,
                    {.shader = shader("ivec2 p = ivec2(gl_GlobalInvocationID.xy); imageStore(target, p, vec4(" + value + "));",
                                      "layout(r32f) uniform writeonly image2D target;", "local_size_x = 8, local_size_y = 4"),
                     .images = {{"target", target}}});
    return target;
  }
  Texture copy(const std::string& name, Texture from) {
    return builder.fullscreen(name,
                              {.shader = shaderWriting(builder, "texelFetch(source, p, 0).r", "uniform sampler2D source;"),
                               .reads = {{"source", from}}});
  }
  void compile(std::initializer_list<Texture> outputs) { graph->compile(std::vector<Texture>(outputs)); }
  std::vector<std::string> frame(const GraphRun& options = {}) { return ran(bench.run(*graph, options)); }

  /// A cpu pass whose one texture is made of a buffer's first 32 floats.
  Texture show(Buffer buffer) {
    const Texture shown = builder.texture("shown", {{8, 4}, Format::r32f});
    builder.cpu("show", {.writes = {shown}, .after = {buffer}, .run = [=](CpuContext& context) {
                           std::vector<float> values(32);
                           const auto bytes = context.readBytes(buffer);
                           std::memcpy(values.data(), bytes.data(), std::min(bytes.size(), values.size() * sizeof(float)));
                           context.write(shown, values);
                         }});
    return shown;
  }

  Bench bench;
  std::unique_ptr<Graph> graph = bench.graph();
  GraphBuilder& builder = graph->builder();
};

TEST_F(Compute, WritesAnImageThatAFullscreenPassSamples) {
  const Texture out = copy("out", image("made"));
  compile({out});
  EXPECT_THAT(frame(), ElementsAre("made", "out"));
  EXPECT_EQ(graph->read(out).at(3, 2), 24.0f);
  EXPECT_THAT(frame(), IsEmpty());
}

TEST_F(Compute, ReadsWhatAFullscreenPassDrew) {
  const Texture drawn = builder.fullscreen("draw", {.shader = shaderWriting(builder, "float(p.x)")});
  const Texture target = builder.texture("target", {{8, 4}, Format::r32f});
  builder.compute("double", {.shader = shader("ivec2 p = ivec2(gl_GlobalInvocationID.xy);"
                                              "imageStore(target, p, 2.0 * texelFetch(source, p, 0));",
                                              "layout(r32f) uniform writeonly image2D target; uniform sampler2D source;"),
                             .reads = {{"source", drawn}},
                             .images = {{"target", target}},
                             .groups = {8, 4, 1}});
  compile({target});
  frame();
  EXPECT_EQ(graph->read(target).at(5, 3), 10.0f);
}

TEST_F(Compute, TexelsItDoesNotWriteHoldTheClearValue) {
  const Texture target = builder.texture("target", {{8, 4}, Format::r32f});
  builder.compute(
      "one", {.shader = shader("imageStore(target, ivec2(2, 1), vec4(5.0));", "layout(r32f) uniform writeonly image2D target;"),
              .images = {{"target", target}},
              .clear = glm::vec4(9.0f)});
  compile({target});
  frame();
  EXPECT_EQ(graph->read(target).at(2, 1), 5.0f);
  EXPECT_EQ(graph->read(target).at(3, 1), 9.0f);
}

constexpr const char* kSums = "layout(std430) buffer Sums { float sums[]; };";

TEST_F(Compute, StorageIsZeroWhenThePassStarts) {
  const Buffer sums = builder.buffer("sums", 128);
  builder.compute(
      "add",
      {.shader = shader("sums[gl_GlobalInvocationID.x] += 2.0;", kSums), .writes = {{"Sums", sums}}, .groups = {32, 1, 1}});
  const Texture shown = show(sums);
  compile({shown});
  for (int i = 0; i < 3; ++i) {
    frame({.skipUnchanged = false});
    EXPECT_THAT(graph->read(shown).data, Each(2.0f));
  }
}

TEST_F(Compute, AFullscreenPassReadsItsStorage) {
  const Buffer sums = builder.buffer("sums", 128);
  builder.compute("fill", {.shader = shader("sums[gl_GlobalInvocationID.x] = float(gl_GlobalInvocationID.x);", kSums),
                           .writes = {{"Sums", sums}},
                           .groups = {32, 1, 1}});
  const Texture out = builder.fullscreen(
      "out", {.shader = shaderWriting(builder, "sums[p.x + 8 * p.y]", "layout(std430) readonly buffer Sums { float sums[]; };"),
              .buffers = {{"Sums", sums}}});
  compile({out});
  EXPECT_THAT(frame(), ElementsAre("fill", "out"));
  EXPECT_EQ(graph->read(out).at(7, 3), 31.0f);
}

TEST_F(Compute, TheDispatchComesFromABuffer) {
  const Buffer counts = builder.buffer("counts", 32);
  builder.compute("count", {.shader = shader("n[4] = 5u; n[5] = 1u; n[6] = 1u;", "layout(std430) buffer Counts { uint n[]; };"),
                            .writes = {{"Counts", counts}}});
  const Buffer sums = builder.buffer("sums", 128);
  builder.compute(
      "fill",
      {.shader = shader("sums[gl_WorkGroupID.x] = 1.0;", kSums), .writes = {{"Sums", sums}}, .indirect = Indirect{counts, 16}});
  const Texture shown = show(sums);
  compile({shown});
  frame();
  EXPECT_EQ(graph->read(shown).at(4, 0), 1.0f);
  EXPECT_EQ(graph->read(shown).at(5, 0), 0.0f);
}

TEST_F(Compute, WritesAllLayersOfAnArray) {
  const Texture target = builder.texture("target", {{8, 4}, Format::r32f, 3});
  builder.compute("fill", {.shader = shader("ivec3 p = ivec3(gl_GlobalInvocationID); imageStore(target, p, vec4(p.z + 1));",
                                            "layout(r32f) uniform writeonly image2DArray target;"),
                           .images = {{"target", target}},
                           .groups = {8, 4, 3}});
  compile({target});
  frame();
  const Image image = graph->read(target);
  EXPECT_EQ(image.height, 12);
  EXPECT_EQ(image.at(7, 3), 1.0f);
  EXPECT_EQ(image.at(0, 11), 3.0f);
}

TEST_F(Compute, NonFiniteTexelsAreNamedWithTheirLayer) {
  const Texture target = builder.texture("target", {{8, 4}, Format::r32f, 3});
  builder.compute("fill", {.shader = shader("imageStore(target, ivec3(6, 3, 1), vec4(uintBitsToFloat(0x7f800000u)));",
                                            "layout(r32f) uniform writeonly image2DArray target;"),
                           .images = {{"target", target}},
                           .clear = glm::vec4(0.0f)});
  compile({target});
  EXPECT_THAT(errorOf([&] { frame({.checkFinite = true}); }),
              AllOf(HasSubstr("pass 'fill'"), HasSubstr("'target'"), HasSubstr("(6, 3), layer 1")));
}

TEST_F(Compute, IsTimed) {
  const Texture target = image("made");
  compile({target});
  EXPECT_GT(bench.run(*graph, {.timePasses = true}).passes.at(0).wallMs, 0.0);
}

// --- refusals ---

TEST_F(Compute, ADepthImageIsRefused) {
  const Texture depth = builder.texture("deep", {{8, 4}, Format::d32f});
  const ComputePass pass{.shader = shader("", ""), .images = {{"target", depth}}};
  EXPECT_THAT(errorOf([&] { builder.compute("pass", pass); }),
              AllOf(HasSubstr("'pass'"), HasSubstr("'deep'"), HasSubstr("d32f")));
}

TEST_F(Compute, AnImageThatTheShaderDoesNotUseIsRefused) {
  const Texture target = builder.texture("target", {{8, 4}, Format::r32f});
  const ComputePass pass{.shader = shader("", ""), .images = {{"unused", target}}};
  EXPECT_THAT(errorOf([&] { builder.compute("pass", pass); }), AllOf(HasSubstr("'pass'"), HasSubstr("'unused'")));
}

TEST_F(Compute, APassThatWritesNothingIsRefused) {
  const ComputePass pass{.shader = shader("", "")};
  EXPECT_THAT(errorOf([&] { builder.compute("pass", pass); }), AllOf(HasSubstr("'pass'"), HasSubstr("writes nothing")));
}

TEST_F(Compute, CommandsOutsideTheirBufferAreRefused) {
  const Buffer counts = builder.buffer("counts", 16);
  const Buffer sums = builder.buffer("sums", 16);
  const ComputePass pass{
      .shader = shader("sums[0] = 1.0;", kSums), .writes = {{"Sums", sums}}, .indirect = Indirect{counts, 8}};
  EXPECT_THAT(errorOf([&] { builder.compute("pass", pass); }),
              AllOf(HasSubstr("'pass'"), HasSubstr("'counts'"), HasSubstr("16")));
}

TEST_F(Compute, ASamplerOfItsOwnImageIsRefused) {
  const Texture target = builder.texture("target", {{8, 4}, Format::r32f});
  const ComputePass pass{.shader = shader("imageStore(target, ivec2(0), texelFetch(source, ivec2(0), 0));",
                                          "layout(r32f) uniform writeonly image2D target; uniform sampler2D source;"),
                         .reads = {{"source", target}},
                         .images = {{"target", target}}};
  EXPECT_THAT(errorOf([&] { builder.compute("pass", pass); }),
              AllOf(HasSubstr("'pass'"), HasSubstr("its own target 'target'")));
}

}  // namespace
}  // namespace gnomon::test
