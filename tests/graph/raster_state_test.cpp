// Fixed-function state of passes: blending, stencil, depth, culling, layers, geometry shaders, draws from buffers.
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench.h"

namespace gnomon::test {
namespace {

using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;

/// Draws rectangles of its own: vertex `i` of two triangles each; instance n covers columns n to 7, at depth (4 - n) / 8:
/// nearer first.
constexpr const char* kRectangles = R"(
flat out int number;
void main() {
  number = gl_InstanceID;
  const vec2 corner = vec2(gl_VertexID == 1 || gl_VertexID == 4 || gl_VertexID == 3, gl_VertexID == 2 || gl_VertexID == 5 || gl_VertexID == 4);
  gl_Position = vec4(mix(vec2(float(gl_InstanceID) / 4.0 - 1.0, -1.0), vec2(1.0), corner), float(4 - gl_InstanceID) / 8.0, 1.0);
}
)";

class RasterState : public testing::Test {
 protected:
  RasterState() { builder.include("rectangles.vert", kRectangles); }

  std::string fragment(const std::string& value) {
    const std::string text =
        fmt::format("flat in int number;\nlayout(location = 0) out float v;\nvoid main() {{ v = {}; }}\n", value);
    const std::string name = fmt::format("test {:x}", std::hash<std::string>{}(text));
    builder.include(name, text);
    return name;
  }
  Texture target(const std::string& name = "target", int layers = 0) {
    return builder.texture(name, {{8, 4}, Format::r32f, layers});
  }
  /// Four rectangles that write their number + 2.
  RasterPass rectangles(Texture colour, const std::string& value = "float(number) + 2.0") {
    return {.vertex = "rectangles.vert",
            .fragment = fragment(value),
            .vertices = VertexDraw{.vertices = 6, .instances = 4},
            .colours = {colour},
            .clears = {glm::vec4(1.0f)}};
  }
  std::vector<float> row(Texture texture, int y = 0) {
    const Image image = graph->read(texture);
    std::vector<float> values;
    for (int x = 0; x < image.width; ++x) values.push_back(image.at(x, y));
    return values;
  }
  std::vector<float> rowOf(RasterPass pass) {
    builder.raster("draw", pass);
    graph->compile(pass.colours);
    report = bench.run(*graph);
    return row(pass.colours[0]);
  }

  Bench bench;
  std::unique_ptr<Graph> graph = bench.graph();
  GraphBuilder& builder = graph->builder();
  GraphReport report;
};

TEST_F(RasterState, WithoutBlendingTheLastDrawnIsSeen) {
  EXPECT_THAT(rowOf(rectangles(target())), ElementsAre(2, 3, 4, 5, 5, 5, 5, 5));
}

TEST_F(RasterState, AdditiveBlendingSums) {
  RasterPass pass = rectangles(target());
  pass.blend = Blend::additive;
  EXPECT_THAT(rowOf(pass), ElementsAre(3, 6, 10, 15, 15, 15, 15, 15));
}

TEST_F(RasterState, MinBlendingKeepsTheSmallest) {
  RasterPass pass = rectangles(target());
  pass.clears = {glm::vec4(10.0f)};
  pass.blend = Blend::min;
  EXPECT_THAT(rowOf(pass), ElementsAre(2, 2, 2, 2, 2, 2, 2, 2));
}

TEST_F(RasterState, MaxBlendingKeepsTheGreatest) {
  RasterPass pass = rectangles(target(), "4.0 - float(number)");
  pass.blend = Blend::max;
  EXPECT_THAT(rowOf(pass), ElementsAre(4, 4, 4, 4, 4, 4, 4, 4));
}

TEST_F(RasterState, MultiplyBlendingMultiplies) {
  RasterPass pass = rectangles(target());
  pass.blend = Blend::multiply;
  EXPECT_THAT(rowOf(pass), ElementsAre(2, 6, 24, 120, 120, 120, 120, 120));
}

TEST_F(RasterState, VerticesAreCountedAsPrimitives) {
  rowOf(rectangles(target()));
  EXPECT_EQ(report.counters.primitives, 8U);
  EXPECT_EQ(report.counters.draws, 1U);
}

// --- culling: in the target, rows from the bottom, these rectangles run counter-clockwise ---

TEST_F(RasterState, CounterClockwiseTrianglesAreCulledWhereAsked) {
  RasterPass pass = rectangles(target());
  pass.cull = Cull::counterClockwise;
  EXPECT_THAT(rowOf(pass), Each(1.0f));
}

TEST_F(RasterState, ClockwiseCullingLeavesThem) {
  RasterPass pass = rectangles(target());
  pass.cull = Cull::clockwise;
  EXPECT_THAT(rowOf(pass), ElementsAre(2, 3, 4, 5, 5, 5, 5, 5));
}

// --- depth: greater is nearer ---

TEST_F(RasterState, ADepthTestThatNothingPassesDrawsNothing) {
  RasterPass pass = rectangles(target());
  pass.depth = builder.texture("deep", {{8, 4}, Format::d32f});
  pass.depthTest = Compare::less;  // against 0: nothing is farther than far
  EXPECT_THAT(rowOf(pass), Each(1.0f));
}

TEST_F(RasterState, DepthThatIsNotWrittenHidesNothing) {
  RasterPass pass = rectangles(target(), "1.0");
  pass.depth = builder.texture("deep", {{8, 4}, Format::d32f});
  pass.depthWrite = false;
  pass.blend = Blend::additive;
  EXPECT_THAT(rowOf(pass), ElementsAre(2, 3, 4, 5, 5, 5, 5, 5));
}

/// A depth texture in which columns 0 to 3 are at 0.5, stencil 7, and the rest at 0.
class OnDepth : public RasterState {
 protected:
  OnDepth() {
    builder.include("depth.vert",
                    "void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }\n");
    builder.include("depth.frag", "void main() { if (int(gl_FragCoord.x) > 3) discard; gl_FragDepth = 0.5; }\n");
    depth = builder.texture("deep", {{8, 4}, Format::d32f_s8});
    builder.raster("deepen", {.vertex = "depth.vert",
                              .fragment = "depth.frag",
                              .vertices = VertexDraw{.vertices = 3},
                              .depth = depth,
                              .stencil = Stencil{.counterClockwise = {.pass = StencilOp::replace}, .reference = 7}});
  }
  Texture depth;
};

TEST_F(OnDepth, IsTestedAgainstWithoutBeingWritten) {
  RasterPass pass = rectangles(target(), "1.0");
  pass.depthRead = depth;
  pass.blend = Blend::additive;
  EXPECT_THAT(rowOf(pass), ElementsAre(1, 1, 1, 1, 5, 5, 5, 5));  // depths 1/8 to 4/8 are not nearer than 0.5
}

TEST_F(OnDepth, IsBegunWithAndLeftAsItWas) {
  RasterPass pass = rectangles(target(), "1.0");
  const Texture own = builder.texture("own", {{8, 4}, Format::d32f_s8});
  pass.depth = own;
  pass.depthFrom = depth;
  pass.blend = Blend::additive;
  builder.raster("draw", pass);
  graph->compile(std::array{pass.colours[0], own, depth});
  bench.run(*graph);
  EXPECT_THAT(row(pass.colours[0]), ElementsAre(1, 1, 1, 1, 2, 2, 2, 2));
  EXPECT_THAT(row(own), ElementsAre(0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f));
  EXPECT_THAT(row(depth), ElementsAre(0.5f, 0.5f, 0.5f, 0.5f, 0, 0, 0, 0));
}

TEST_F(OnDepth, AFullscreenPassDrawsWhereTheStencilIs) {
  const Texture out = builder.fullscreen("marked", {.shader = shaderWriting(builder, "5.0"),
                                                    .clear = glm::vec4(1.0f),
                                                    .stencil = StencilTest{.texture = depth, .reference = 7}});
  graph->compile(std::span(&out, 1));
  bench.run(*graph);
  EXPECT_THAT(row(out), ElementsAre(5, 5, 5, 5, 1, 1, 1, 1));
}

TEST_F(OnDepth, StencilCountsWhatFailsInDepth) {  // as a shadow volume does
  RasterPass pass = rectangles(target(), "1.0");
  const Texture own = builder.texture("own", {{8, 4}, Format::d32f_s8});
  pass.depth = own;
  pass.depthFrom = depth;
  pass.depthWrite = false;
  pass.stencil = Stencil{.counterClockwise = {.depthFail = StencilOp::incrementWrap}};
  builder.raster("count", pass);
  const Texture out = builder.fullscreen("marked", {.shader = shaderWriting(builder, "5.0"),
                                                    .clear = glm::vec4(1.0f),
                                                    .stencil = StencilTest{.texture = own, .reference = 9}});
  graph->compile(std::span(&out, 1));
  bench.run(*graph);
  EXPECT_THAT(row(out), ElementsAre(1, 5, 1, 1, 1, 1, 1, 1));  // 7 and two rectangles in column 1
}

TEST_F(OnDepth, StencilIsComparedUnderItsReadMask) {
  RasterPass pass = rectangles(target(), "9.0");
  pass.depth = builder.texture("own", {{8, 4}, Format::d32f_s8});
  pass.depthFrom = depth;
  pass.depthTest = Compare::always;
  pass.stencil = Stencil{.counterClockwise = {.compare = Compare::equal}, .reference = 4, .readMask = 4};
  EXPECT_THAT(rowOf(pass), ElementsAre(9, 9, 9, 9, 1, 1, 1, 1));  // 7 and 4 agree in that bit
}

TEST_F(OnDepth, StencilIsWrittenUnderItsWriteMask) {
  RasterPass pass = rectangles(target(), "1.0");
  const Texture own = builder.texture("own", {{8, 4}, Format::d32f_s8});
  pass.depth = own;
  pass.depthFrom = depth;
  pass.depthTest = Compare::always;
  pass.stencil = Stencil{.counterClockwise = {.pass = StencilOp::zero}, .writeMask = 2};
  builder.raster("draw", pass);
  const Texture out = builder.fullscreen("marked", {.shader = shaderWriting(builder, "5.0"),
                                                    .clear = glm::vec4(1.0f),
                                                    .stencil = StencilTest{.texture = own, .reference = 5}});
  graph->compile(std::span(&out, 1));
  bench.run(*graph);
  EXPECT_THAT(row(out), ElementsAre(5, 5, 5, 5, 1, 1, 1, 1));  // 7 without its second bit
}

TEST_F(RasterState, AFullscreenPassBlendsIntoACopy) {
  const Texture first = builder.fullscreen("first", {.shader = shaderWriting(builder, "float(p.x)")});
  const Texture out =
      builder.fullscreen("add", {.shader = shaderWriting(builder, "10.0"), .from = first, .blend = Blend::additive});
  graph->compile(std::span(&out, 1));
  bench.run(*graph);
  EXPECT_THAT(row(out), ElementsAre(10, 11, 12, 13, 14, 15, 16, 17));
}

TEST_F(RasterState, APassLeavesNoStateThatOthersDoNotExpect) {
  RasterPass pass = rectangles(target());
  pass.depth = builder.texture("deep", {{8, 4}, Format::d32f_s8});
  pass.depthWrite = false;
  pass.depthClamp = true;
  pass.cull = Cull::clockwise;
  pass.blend = Blend::min;
  pass.stencil = Stencil{.writeMask = 0};
  rowOf(pass);
  for (const GLenum off : {GL_STENCIL_TEST, GL_CULL_FACE, GL_BLEND, GL_DEPTH_CLAMP}) EXPECT_FALSE(glIsEnabled(off)) << off;
  GLboolean depthMask = GL_FALSE;
  glGetBooleanv(GL_DEPTH_WRITEMASK, &depthMask);
  EXPECT_TRUE(depthMask);
}

// --- layers ---

TEST_F(RasterState, ALayerIsDrawnAlone) {
  const Texture array = target("array", 2);
  RasterPass pass = rectangles(array);
  pass.layer = 1;
  builder.raster("second", pass);
  pass.layer = 0;
  pass.fragment = fragment("9.0");
  builder.raster("first", pass);
  graph->compile(std::span(&array, 1));
  bench.run(*graph);
  EXPECT_THAT(row(array, 0), Each(9.0f));
  EXPECT_THAT(row(array, 4), ElementsAre(2, 3, 4, 5, 5, 5, 5, 5));
}

TEST_F(RasterState, AGeometryShaderDrawsAllLayers) {
  builder.include("layers.geom", R"(
layout(triangles, invocations = 2) in;
layout(triangle_strip, max_vertices = 3) out;
flat in int number[];
flat out int numberOut;
void main() {
  for (int i = 0; i < 3; ++i) {
    numberOut = number[i] + 10 * gl_InvocationID;
    gl_Layer = gl_InvocationID;
    gl_Position = gl_in[i].gl_Position;
    EmitVertex();
  }
}
)");
  builder.include("out.frag", "flat in int numberOut;\nout float v;\nvoid main() { v = float(numberOut); }\n");
  const Texture array = target("array", 2);
  RasterPass pass = rectangles(array);
  pass.geometry = "layers.geom";
  pass.fragment = "out.frag";
  EXPECT_THAT(rowOf(pass), ElementsAre(0, 1, 2, 3, 3, 3, 3, 3));
  EXPECT_THAT(row(array, 7), ElementsAre(10, 11, 12, 13, 13, 13, 13, 13));
}

TEST_F(RasterState, AFullscreenPassDrawsEveryLayer) {
  const Texture array =
      builder.fullscreen("layers", {.shader = shaderWriting(builder, "float(p.x + 10 * gl_Layer)"), .layers = 3});
  graph->compile(std::span(&array, 1));
  bench.run(*graph);
  EXPECT_THAT(row(array, 11), ElementsAre(20, 21, 22, 23, 24, 25, 26, 27));
}

TEST_F(RasterState, MemoryCountsEveryLayer) {
  const Texture array = builder.fullscreen("layers", {.shader = shaderWriting(builder, "1.0"), .layers = 3});
  graph->compile(std::span(&array, 1));
  EXPECT_EQ(graph->memoryBytes(), 3U * 8U * 4U * 4U);
}

// --- draws from a buffer ---

TEST_F(RasterState, VerticesComeFromABuffer) {
  builder.include("commands.comp",
                  "layout(local_size_x = 1) in;\nlayout(std430) buffer Commands { uint n[]; };\n"
                  "void main() { n[0] = 6u; n[1] = 2u; }\n");
  const Buffer commands = builder.buffer("commands", 16);
  builder.compute("command", {.shader = "commands.comp", .writes = {{"Commands", commands}}});
  RasterPass pass = rectangles(target());
  pass.vertices = VertexDraw{.indirect = Indirect{commands}};
  EXPECT_THAT(rowOf(pass), ElementsAre(2, 3, 3, 3, 3, 3, 3, 3));
}

TEST_F(RasterState, SceneGeometryComesFromABuffer) {
  const DrawList list = builder.drawList("all");
  const Buffer view = builder.buffer("View", 96);
  builder.provide("View", view);
  builder.cpu("view",
              {.inputs = {Input::camera}, .buffers = {view}, .draws = {list}, .run = [=](CpuContext& context) {
                 const glm::mat4 clip(cameraProjection(context.frame().camera, 2.0) * cameraRotation(context.frame().camera));
                 std::array<float, 24> block{};
                 std::copy_n(&clip[0][0], 16, block.begin());
                 context.writeBlock(view, block);
                 context.draw(list, std::vector<std::uint8_t>(2, 1), context.frame().camera.position);
               }});
  // The floor's two triangles and then none: as a culling compute pass would say.
  builder.include("commands.comp",
                  "layout(local_size_x = 1) in;\nlayout(std430) buffer Commands { uint n[]; };\n"
                  "void main() { n[0] = 6u; n[1] = 1u; }\n");
  const Buffer commands = builder.buffer("commands", 2 * sizeof(DrawCommand));
  builder.compute("command", {.shader = "commands.comp", .writes = {{"Commands", commands}}});
  builder.include("one.frag", "layout(location = 0) out float v;\nvoid main() { v = 1.0; }\n");
  const auto draw = [&](const std::string& name, std::optional<Indirect> indirect) {
    const Texture colour = builder.texture(name, {{64, 32}, Format::r32f});  // enough pixels for the box
    builder.raster(name, {.vertex = "gnomon/gbuffer.vert",
                          .fragment = "one.frag",
                          .draws = list,
                          .indirect = indirect,
                          .colours = {colour},
                          .blend = Blend::additive});
    return colour;
  };
  const Texture all = draw("all of it", std::nullopt);
  const Texture floor = draw("floor", Indirect{commands, 0, 2});
  graph->compile(std::array{all, floor});
  bench.run(*graph);
  const Image both = graph->read(all);
  const Image one = graph->read(floor);
  EXPECT_GT(*std::max_element(both.data.begin(), both.data.end()), 1.0f);
  EXPECT_EQ(*std::max_element(one.data.begin(), one.data.end()), 1.0f);
}

// --- refusals ---

TEST_F(RasterState, AColourFormatGivenAsDepthIsRefused) {
  RasterPass pass = rectangles(target());
  pass.depth = target("flat");
  EXPECT_THAT(errorOf([&] { builder.raster("draw", pass); }),
              AllOf(HasSubstr("'draw'"), HasSubstr("'flat'"), HasSubstr("r32f"), HasSubstr("d32f_s8")));
}

TEST_F(RasterState, ADepthFormatGivenAsColourIsRefused) {
  const RasterPass pass = rectangles(builder.texture("deep", {{8, 4}, Format::d32f}));
  EXPECT_THAT(errorOf([&] { builder.raster("draw", pass); }),
              AllOf(HasSubstr("'draw'"), HasSubstr("'deep'"), HasSubstr("d32f")));
}

TEST_F(RasterState, LayersThatNobodyChoosesAreRefused) {
  EXPECT_THAT(errorOf([&] { builder.raster("draw", rectangles(target("array", 2))); }),
              AllOf(HasSubstr("'draw'"), HasSubstr("'array'"), HasSubstr("gl_Layer")));
}

TEST_F(RasterState, ALayerOutsideTheArrayIsRefused) {
  RasterPass pass = rectangles(target("array", 2));
  pass.layer = 2;
  EXPECT_THAT(errorOf([&] { builder.raster("draw", pass); }),
              AllOf(HasSubstr("'draw'"), HasSubstr("layer 2"), HasSubstr("'array'")));
}

TEST_F(RasterState, MoreLayersThanTheDriverHasAreRefused) {
  const Texture array = target("array", 1 << 20);
  builder.cpu("fill", {.writes = {array}, .run = [](CpuContext&) {}});
  EXPECT_THAT(errorOf([&] { graph->compile(std::span(&array, 1)); }),
              AllOf(HasSubstr("'bench/array'"), HasSubstr("1048576 layers")));
}

TEST_F(RasterState, AFullscreenPassOfTooManyLayersIsRefused) {
  EXPECT_THAT(errorOf([&] { builder.fullscreen("screens", {.shader = shaderWriting(builder, "1.0"), .layers = 33}); }),
              AllOf(HasSubstr("'screens'"), HasSubstr("33"), HasSubstr("32")));
}

TEST_F(RasterState, AnArrayOfWhichALayerIsMissingIsNotRead) {
  const Texture array = target("array", 2);
  RasterPass pass = rectangles(array);
  pass.layer = 1;
  builder.raster("second", pass);
  const std::string shader = shaderWriting(builder, "texelFetch(source, ivec3(p, 0), 0).r", "uniform sampler2DArray source;");
  EXPECT_THAT(errorOf([&] {
                builder.fullscreen("reader", {.shader = shader, .reads = {{"source", array}}});
              }),
              AllOf(HasSubstr("'reader'"), HasSubstr("'array'"), HasSubstr("all its layers")));
}

TEST_F(RasterState, TwoWritersOfALayerAreRefusedByName) {
  RasterPass pass = rectangles(target("array", 2));
  pass.layer = 1;
  builder.raster("first", pass);
  EXPECT_THAT(errorOf([&] { builder.raster("again", pass); }),
              AllOf(HasSubstr("'again'"), HasSubstr("'array'"), HasSubstr("'first'")));
}

TEST_F(OnDepth, TestingAndSamplingOneTextureIsRefused) {
  const std::string shader = shaderWriting(builder, "texelFetch(source, p, 0).r", "uniform sampler2D source;");
  EXPECT_THAT(
      errorOf([&] {
        builder.fullscreen("pass", {.shader = shader, .reads = {{"source", depth}}, .stencil = StencilTest{.texture = depth}});
      }),
      AllOf(HasSubstr("'pass'"), HasSubstr("'deep'")));
}

TEST_F(OnDepth, ACopyOfAnotherSizeIsRefused) {
  const Texture first = builder.fullscreen("first", {.shader = shaderWriting(builder, "1.0")});
  EXPECT_THAT(errorOf([&] {
                builder.fullscreen("small", {.shader = shaderWriting(builder, "1.0"), .size = glm::ivec2(4, 4), .from = first});
              }),
              AllOf(HasSubstr("'small'"), HasSubstr("'first'"), HasSubstr("8x4"), HasSubstr("4x4")));
}

}  // namespace
}  // namespace gnomon::test
