// What runs: only what changed; what fails is named and can be run again; every pass sets the state it needs.
#include <epoxy/gl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

#include "bench.h"
#include "gnomon/base/error.h"

namespace gnomon::test {
namespace {

using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr const char* kNumbers = "layout(std140) uniform Numbers { float x; };";

class Execution : public testing::Test {
 protected:
  Bench bench;
  std::unique_ptr<Graph> graph = bench.graph();
  GraphBuilder& builder = graph->builder();

  Texture useNumbers(const std::string& name, Buffer numbers) {
    return builder.fullscreen(name, {.shader = shaderWriting(builder, "x", kNumbers), .buffers = {{"Numbers", numbers}}});
  }
  Texture copy(const std::string& name, Texture from) {
    const std::string shader = shaderWriting(builder, "texelFetch(source, p, 0).r", "uniform sampler2D source;");
    return builder.fullscreen(name, {.shader = shader, .reads = {{"source", from}}});
  }
  void compile(Texture output) { graph->compile(std::span(&output, 1)); }
  std::vector<std::string> runPasses(const GraphRun& options = {}) { return ran(bench.run(*graph, options)); }

  /// numbers <- light; "light" draws them; "camera" copies that, and depends on the camera by itself.
  Texture declareChain() {
    const Buffer numbers = builder.buffer("numbers", 16);
    builder.cpu("fit",
                {.inputs = {Input::light, Input::camera}, .buffers = {numbers}, .run = [this, numbers](CpuContext& context) {
                   context.writeBlock(numbers, std::array<float, 4>{value, 0, 0, 0});
                 }});
    return copy("compare", useNumbers("depth", numbers));
  }
  float value = 1.0f;
};

// --- skipping ---

TEST_F(Execution, AStaticFrameRunsNothing) {
  compile(declareChain());
  EXPECT_THAT(runPasses(), ElementsAre("fit", "depth", "compare"));
  const GraphReport second = bench.run(*graph);
  EXPECT_EQ(second.counters.passesRun, 0U);
  EXPECT_EQ(second.counters.passesSkipped, 3U);
  EXPECT_EQ(second.counters.draws, 0U);
}

TEST_F(Execution, AChangedInputRunsWhatDependsOnItAndWhatReadsThat) {
  compile(declareChain());
  runPasses();
  ++bench.revisions[Input::light];
  value = 2.0f;
  EXPECT_THAT(runPasses(), ElementsAre("fit", "depth", "compare"));
}

TEST_F(Execution, EqualBytesAreNoChange) {  // the camera moved, the fit came out the same: the map is not drawn again
  compile(declareChain());
  runPasses();
  ++bench.revisions[Input::camera];
  EXPECT_THAT(runPasses(), ElementsAre("fit"));
}

TEST_F(Execution, AnInputThatNobodyDependsOnRunsNothing) {
  compile(declareChain());
  runPasses();
  ++bench.revisions[Input::time];
  ++bench.revisions[Input::geometry];
  EXPECT_THAT(runPasses(), IsEmpty());
}

TEST_F(Execution, ForcedOffSkippingRunsAll) {
  compile(declareChain());
  runPasses();
  EXPECT_THAT(runPasses({.skipUnchanged = false}), ElementsAre("fit", "depth", "compare"));
}

TEST_F(Execution, ValuesSetFromOutsideRunWhatReadsThem) {
  const Buffer numbers = builder.buffer("numbers", 16);
  const Texture out = useNumbers("draw", numbers);
  compile(out);
  graph->uniforms().writeBlock(numbers, std::array<float, 4>{3.0f, 0, 0, 0});
  runPasses();
  graph->uniforms().writeBlock(numbers, std::array<float, 4>{3.0f, 0, 0, 0});
  EXPECT_THAT(runPasses(), IsEmpty());
  graph->uniforms().writeBlock(numbers, std::array<float, 4>{4.0f, 0, 0, 0});
  EXPECT_THAT(runPasses(), ElementsAre("draw"));
  EXPECT_EQ(graph->read(out).at(0, 0), 4.0f);
}

TEST_F(Execution, AChangeInAnImportedTextureRunsWhatReadsIt) {
  const Texture out = declareChain();
  compile(out);
  runPasses();
  const std::unique_ptr<Graph> other = bench.graph("other");
  const Texture imported = other->builder().import("compare", graph->resource(out));
  const std::string shader = shaderWriting(other->builder(), "texelFetch(source, p, 0).r", "uniform sampler2D source;");
  const Texture copied = other->builder().fullscreen("copy", {.shader = shader, .reads = {{"source", imported}}});
  other->compile(std::span(&copied, 1));
  EXPECT_THAT(ran(bench.run(*other)), ElementsAre("copy"));
  EXPECT_THAT(ran(bench.run(*other)), IsEmpty());
  ++bench.revisions[Input::light];
  value = 2.0f;
  runPasses();
  EXPECT_THAT(ran(bench.run(*other)), ElementsAre("copy"));
  EXPECT_EQ(other->read(copied).at(0, 0), 2.0f);
}

// --- cpu passes ---

TEST_F(Execution, ACpuPassReadsWhatWasDrawnAndWritesWhatIsRead) {
  const Texture drawn = builder.fullscreen("draw", {.shader = shaderWriting(builder, "float(p.x + 10 * p.y)")});
  const Texture doubled = builder.texture("doubled", {{8, 4}, Format::r32f});
  builder.cpu("double", {.reads = {drawn}, .writes = {doubled}, .run = [=](CpuContext& context) {
                           std::vector<float> values;
                           for (const float v : context.read(drawn)) values.push_back(2.0f * v);
                           context.write(doubled, values);
                         }});
  compile(copy("out", doubled));
  runPasses();
  EXPECT_EQ(graph->read(doubled).at(3, 2), 46.0f);
}

TEST_F(Execution, AnUndeclaredReadIsRefused) {
  const Texture drawn = builder.fullscreen("draw", {.shader = shaderWriting(builder, "1.0")});
  const Texture target = builder.texture("target", {{8, 4}, Format::r32f});
  builder.cpu("sneak", {.writes = {target}, .run = [=](CpuContext& context) { context.read(drawn); }});
  graph->compile(std::array{drawn, target});
  EXPECT_THAT(errorOf([&] { runPasses(); }), AllOf(HasSubstr("'sneak'"), HasSubstr("'draw'"), HasSubstr("did not declare")));
}

TEST_F(Execution, AnUndeclaredWriteOfATextureIsRefused) {
  const Texture other = builder.texture("other", {{8, 4}, Format::r32f});
  const Texture target = builder.texture("target", {{8, 4}, Format::r32f});
  builder.cpu("owner", {.writes = {other}, .run = [](CpuContext&) {}});
  builder.cpu("sneak",
              {.writes = {target}, .run = [=](CpuContext& context) { context.write(other, std::vector<float>(32, 1.0f)); }});
  graph->compile(std::array{other, target});
  EXPECT_THAT(errorOf([&] { runPasses(); }), AllOf(HasSubstr("'sneak'"), HasSubstr("'other'"), HasSubstr("did not declare")));
}

TEST_F(Execution, AnUndeclaredWriteOfABufferIsRefused) {
  const Buffer numbers = builder.buffer("numbers", 16);
  const Texture target = builder.texture("target", {{8, 4}, Format::r32f});
  builder.cpu("sneak", {.writes = {target}, .run = [=](CpuContext& context) { context.writeBlock(numbers, 1.0f); }});
  compile(target);
  EXPECT_THAT(errorOf([&] { runPasses(); }), AllOf(HasSubstr("'sneak'"), HasSubstr("'numbers'"), HasSubstr("did not declare")));
}

TEST_F(Execution, AnUndeclaredDrawListIsRefused) {
  const DrawList list = builder.drawList("casters");
  const Texture target = builder.texture("target", {{8, 4}, Format::r32f});
  builder.cpu("sneak", {.writes = {target}, .run = [=](CpuContext& context) {
                          context.draw(list, std::vector<std::uint8_t>(2, 1), glm::dvec3(0.0));
                        }});
  compile(target);
  EXPECT_THAT(errorOf([&] { runPasses(); }), AllOf(HasSubstr("'sneak'"), HasSubstr("'casters'"), HasSubstr("did not declare")));
}

TEST_F(Execution, TooManyBytesForABufferAreRefused) {
  const Buffer numbers = builder.buffer("numbers", 16);
  builder.cpu("fill",
              {.buffers = {numbers}, .run = [=](CpuContext& context) { context.writeBlock(numbers, std::array<float, 5>{}); }});
  compile(useNumbers("draw", numbers));
  EXPECT_THAT(errorOf([&] { runPasses(); }), AllOf(HasSubstr("'fill'"), HasSubstr("'numbers'"), HasSubstr("20")));
}

TEST_F(Execution, AWrongNumberOfTexelsIsRefused) {
  const Texture target = builder.texture("target", {{8, 4}, Format::r32f});
  builder.cpu("fill", {.writes = {target}, .run = [=](CpuContext& context) { context.write(target, std::vector<float>(31)); }});
  compile(target);
  EXPECT_THAT(errorOf([&] { runPasses(); }),
              AllOf(HasSubstr("'fill'"), HasSubstr("'target'"), HasSubstr("31"), HasSubstr("32")));
}

// --- failures ---

TEST_F(Execution, APassThatFailsIsNamedAndRunsAgain) {
  bool broken = true;
  const Texture target = builder.texture("target", {{8, 4}, Format::r32f});
  builder.cpu("fragile", {.writes = {target}, .run = [&broken, target](CpuContext& context) {
                            if (broken) throw Error("no luck");
                            context.write(target, std::vector<float>(32, 7.0f));
                          }});
  const Texture out = copy("out", target);
  compile(out);
  EXPECT_THAT(errorOf([&] { runPasses(); }), AllOf(HasSubstr("'fragile'"), HasSubstr("no luck")));
  broken = false;
  EXPECT_THAT(runPasses(), ElementsAre("fragile", "out"));
  EXPECT_EQ(graph->read(out).at(0, 0), 7.0f);
}

TEST_F(Execution, AnOpenGlErrorIsThatOfThePassThatMadeIt) {
  bool broken = true;
  const Texture target = builder.texture("target", {{8, 4}, Format::r32f});
  builder.cpu("good", {.writes = {target}, .run = [](CpuContext&) {}});
  const Texture other = builder.texture("other", {{8, 4}, Format::r32f});
  builder.cpu("bad", {.reads = {target}, .writes = {other}, .run = [&broken](CpuContext&) {
                        if (broken) glEnable(0xdead);
                      }});
  compile(copy("after", other));
  EXPECT_THAT(errorOf([&] { runPasses(); }), AllOf(HasSubstr("'bad'"), HasSubstr("OpenGL"), Not(HasSubstr("'good'"))));
  broken = false;
  EXPECT_THAT(runPasses(), ElementsAre("bad", "after"));
}

TEST_F(Execution, NonFiniteTexelsAreNamedByPassTargetAndPixel) {
  const std::string shader = shaderWriting(builder, "p == ivec2(5, 2) ? -log(0.0 * float(p.x)) : 1.0");
  compile(builder.fullscreen("explode", {.shader = shader}));
  EXPECT_EQ(errorOf([&] { runPasses(); }), "");  // not looked for unless asked
  const std::string message = errorOf([&] { runPasses({.skipUnchanged = false, .checkFinite = true}); });
  EXPECT_THAT(message,
              AllOf(HasSubstr("pass 'explode'"), HasSubstr("target 'explode'"), HasSubstr("(5, 2)"), HasSubstr("inf")));
}

TEST_F(Execution, NonFiniteTexelsAreFoundAgainInTheNextFrame) {
  compile(builder.fullscreen("explode", {.shader = shaderWriting(builder, "-log(0.0 * float(p.x))")}));
  EXPECT_THAT(errorOf([&] { runPasses({.checkFinite = true}); }), HasSubstr("'explode'"));
  EXPECT_THAT(errorOf([&] { runPasses({.checkFinite = true}); }), HasSubstr("'explode'"));
}

// --- labels and groups ---

std::string labelOf(GLenum kind, GLuint name) {
  std::array<char, 300> text{};
  glGetObjectLabel(kind, name, static_cast<GLsizei>(text.size()), nullptr, text.data());
  return text.data();
}

TEST_F(Execution, TexturesAndBuffersAreLabelled) {
  const Buffer numbers = builder.buffer("numbers", 16);
  const Texture out = useNumbers("draw", numbers);
  compile(out);
  EXPECT_EQ(labelOf(GL_TEXTURE, graph->resource(out)->object.name()), "bench/draw");
  EXPECT_EQ(labelOf(GL_BUFFER, graph->resource(numbers)->object.name()), "bench/numbers");
}

TEST_F(Execution, ProgramsAndFramebuffersAreLabelled) {
  compile(builder.fullscreen("draw", {.shader = shaderWriting(builder, "1.0")}));
  runPasses();
  GLint program = 0;
  GLint framebuffer = 0;
  glGetIntegerv(GL_CURRENT_PROGRAM, &program);
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
  EXPECT_EQ(labelOf(GL_PROGRAM, static_cast<GLuint>(program)), "bench/draw");
  EXPECT_EQ(labelOf(GL_FRAMEBUFFER, static_cast<GLuint>(framebuffer)), "bench/draw");
}

TEST_F(Execution, NamesLongerThanADriversLabelsAreNoError) {
  compile(builder.fullscreen(std::string(1000, 'x'), {.shader = shaderWriting(builder, "1.0")}));
  EXPECT_EQ(runPasses().size(), 1U);
}

GLint groupDepth() {
  GLint depth = 0;
  glGetIntegerv(GL_DEBUG_GROUP_STACK_DEPTH, &depth);
  return depth;
}

TEST_F(Execution, EveryPassRunsInAGroupThatEnds) {
  const Texture target = builder.texture("target", {{8, 4}, Format::r32f});
  GLint inside = 0;
  builder.cpu("look", {.writes = {target}, .run = [&inside](CpuContext&) { inside = groupDepth(); }});
  compile(copy("out", target));
  const GLint before = groupDepth();
  runPasses();
  EXPECT_EQ(inside, before + 1);
  EXPECT_EQ(groupDepth(), before);
}

TEST_F(Execution, AGroupEndsWhenItsPassFails) {
  const Texture target = builder.texture("target", {{8, 4}, Format::r32f});
  builder.cpu("fail", {.writes = {target}, .run = [](CpuContext&) { throw Error("no luck"); }});
  compile(target);
  const GLint before = groupDepth();
  EXPECT_NE(errorOf([&] { runPasses(); }), "");
  EXPECT_EQ(groupDepth(), before);
}

// --- targets ---

TEST_F(Execution, DiscardedPixelsHoldTheClearValue) {
  builder.include("half.frag", "out float v;\nvoid main() { if (gl_FragCoord.x < 4.0) discard; v = 2.0; }\n");
  const Texture out = builder.fullscreen("half", {.shader = "half.frag", .clear = glm::vec4(1.0f)});
  compile(out);
  runPasses();
  EXPECT_EQ(graph->read(out).at(3, 1), 1.0f);
  EXPECT_EQ(graph->read(out).at(4, 1), 2.0f);
}

TEST_F(Execution, RowZeroOfWhatAPassWritesIsRowZeroOfWhatIsRead) {
  const Texture out = builder.fullscreen("rows", {.shader = shaderWriting(builder, "float(p.x + 10 * p.y)")});
  compile(out);
  runPasses();
  EXPECT_EQ(graph->read(out).at(2, 0), 2.0f);
  EXPECT_EQ(graph->read(out).at(2, 3), 32.0f);
}

TEST_F(Execution, NoStateLeftByOthersChangesAPass) {
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
  const Texture position = builder.texture("position", {{8, 4}, Format::rgba32f});
  const Texture depth = builder.texture("depth", {{8, 4}, Format::d32f_s8});
  builder.include(
      "position.frag",
      "in vec3 relative;\nlayout(location = 0) out vec4 position;\nvoid main() { position = vec4(relative, 1.0); }\n");
  builder.raster(
      "draw",
      {.vertex = "gnomon/gbuffer.vert", .fragment = "position.frag", .draws = list, .colours = {position}, .depth = depth});
  const Texture out = copy("out", position);
  compile(out);
  const std::vector<std::string> all = runPasses();
  const std::vector<float> before = graph->read(position).data;
  ASSERT_GT(std::count_if(before.begin(), before.end(), [](float v) { return v != 0.0f; }), 8);

  const float rubbish = 42.0f;  // so that drawing nothing shows
  glClearTexImage(graph->resource(position)->object.name(), 0, GL_RED, GL_FLOAT, &rubbish);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, 1, 1);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_FRONT_AND_BACK);
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_NEVER, 0, 0xff);
  glEnable(GL_DEPTH_CLAMP);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1e6f, 1e6f);
  glPolygonMode(GL_FRONT_AND_BACK, GL_POINT);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_NEVER);
  glDepthRangef(0.25f, 0.5f);
  glClipControl(GL_UPPER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  glViewport(0, 0, 1, 1);
  glEnable(GL_RASTERIZER_DISCARD);
  glEnable(GL_SAMPLE_MASK);
  glSampleMaski(0, 0);
  glEnable(GL_COLOR_LOGIC_OP);
  glLogicOp(GL_CLEAR);
  EXPECT_EQ(runPasses({.skipUnchanged = false}), all);
  const std::vector<float> after = graph->read(position).data;
  // Put back what other tests of this process would meet.
  glDisable(GL_SAMPLE_MASK);
  glDisable(GL_COLOR_LOGIC_OP);
  glDisable(GL_RASTERIZER_DISCARD);
  glDepthRangef(0.0f, 1.0f);
  EXPECT_EQ(before, after);
}

}  // namespace
}  // namespace gnomon::test
