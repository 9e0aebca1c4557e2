// What is declared: refused where it makes no sense, pruned where nobody reads it, and depending on what shaders really use.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "bench.h"

namespace gnomon::test {
namespace {

std::vector<std::string> namesOf(const std::vector<std::shared_ptr<TextureResource>>& textures) {
  std::vector<std::string> names;
  for (const auto& texture : textures) names.push_back(texture->name);
  return names;
}

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class Declaration : public testing::Test {
 protected:
  Bench bench;
  std::unique_ptr<Graph> graph = bench.graph();
  GraphBuilder& builder = graph->builder();

  /// A cpu pass that writes `texture`, and does nothing.
  void cpuWriter(const std::string& name, Texture texture) {
    builder.cpu(name, {.writes = {texture}, .run = [](CpuContext&) {}});
  }
  Texture constant(const std::string& name, const std::string& value = "1.0") {
    return builder.fullscreen(name, {.shader = shaderWriting(builder, value)});
  }
  Texture reader(const std::string& name, Texture texture) {
    const std::string shader = shaderWriting(builder, "texelFetch(source, p, 0).r", "uniform sampler2D source;");
    return builder.fullscreen(name, {.shader = shader, .reads = {{"source", texture}}});
  }
  void compile(std::initializer_list<Texture> outputs) {
    const std::vector<Texture> list(outputs);
    graph->compile(list);
  }
  std::vector<std::string> runPasses() { return ran(bench.run(*graph)); }
  static std::size_t lines(const std::string& text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1;
  }
};

// --- refusals: one line, with the names of the pass and of the texture ---

TEST_F(Declaration, ReadingBeforeWritingIsRefused) {
  const Texture later = builder.texture("later", {{8, 4}, Format::r32f});
  const std::string message = errorOf([&] { reader("early", later); });
  EXPECT_THAT(message, AllOf(HasSubstr("'early'"), HasSubstr("'later'"), HasSubstr("before any pass writes it")));
  EXPECT_EQ(lines(message), 1U);
}

TEST_F(Declaration, ACpuPassReadingBeforeWritingIsRefused) {
  const Texture later = builder.texture("later", {{8, 4}, Format::r32f});
  EXPECT_THAT(errorOf([&] { builder.cpu("early", {.reads = {later}, .run = [](CpuContext&) {}}); }),
              AllOf(HasSubstr("'early'"), HasSubstr("'later'")));
}

TEST_F(Declaration, TwoWritersAreRefused) {
  const Texture texture = builder.texture("shared", {{8, 4}, Format::r32f});
  cpuWriter("first", texture);
  EXPECT_THAT(errorOf([&] { cpuWriter("second", texture); }),
              AllOf(HasSubstr("'second'"), HasSubstr("'shared'"), HasSubstr("has a writer already, 'first'")));
}

TEST_F(Declaration, ASecondWriterOfAFullscreenPassesTargetIsRefused) {
  const Texture texture = constant("first");
  EXPECT_THAT(errorOf([&] { cpuWriter("second", texture); }), AllOf(HasSubstr("'second'"), HasSubstr("'first'")));
}

TEST_F(Declaration, WritingAnImportedTextureIsRefused) {
  const Texture own = constant("own");
  compile({own});
  const std::unique_ptr<Graph> other = bench.graph("other");
  const Texture imported = other->builder().import("own", graph->resource(own));
  EXPECT_THAT(errorOf([&] { other->builder().cpu("writer", {.writes = {imported}, .run = [](CpuContext&) {}}); }),
              AllOf(HasSubstr("'writer'"), HasSubstr("'own'")));
}

TEST_F(Declaration, TwoWritersOfABufferAreRefused) {
  const Buffer buffer = builder.buffer("numbers", 16);
  builder.cpu("first", {.buffers = {buffer}, .run = [](CpuContext&) {}});
  EXPECT_THAT(errorOf([&] { builder.cpu("second", {.buffers = {buffer}, .run = [](CpuContext&) {}}); }),
              AllOf(HasSubstr("'second'"), HasSubstr("'numbers'")));
}

TEST_F(Declaration, ABufferReadBeforeItIsFilledIsRefused) {
  const Buffer buffer = builder.buffer("numbers", 16);
  builder.cpu("early", {.after = {buffer}, .run = [](CpuContext&) {}});
  EXPECT_THAT(errorOf([&] { builder.cpu("late", {.buffers = {buffer}, .run = [](CpuContext&) {}}); }),
              AllOf(HasSubstr("'late'"), HasSubstr("'numbers'"), HasSubstr("'early'")));
}

TEST_F(Declaration, TargetsThatDifferInSizeAreRefused) {
  const Texture colour = builder.texture("colour", {{8, 4}, Format::r32f});
  const Texture depth = builder.texture("deep", {{4, 4}, Format::d32f});
  const RasterPass pass{.vertex = "gnomon/gbuffer.vert", .draws = builder.drawList("all"), .colours = {colour}, .depth = depth};
  EXPECT_THAT(errorOf([&] { builder.raster("draw", pass); }),
              AllOf(HasSubstr("'draw'"), HasSubstr("'deep'"), HasSubstr("differ in size")));
}

TEST_F(Declaration, ATextureOfAnotherSizeMayBeRead) {
  const Texture large = builder.fullscreen("large", {.shader = shaderWriting(builder, "3.0"), .size = glm::ivec2(16, 16)});
  const Texture out = reader("small", large);
  compile({out});
  bench.run(*graph);
  EXPECT_EQ(graph->read(out).at(7, 3), 3.0f);
}

TEST_F(Declaration, APassThatReadsWhatItWritesIsRefused) {
  const Texture texture = builder.texture("both", {{8, 4}, Format::r32f});
  cpuWriter("first", texture);
  EXPECT_THAT(errorOf([&] { builder.cpu("again", {.reads = {texture}, .writes = {texture}, .run = [](CpuContext&) {}}); }),
              AllOf(HasSubstr("'again'"), HasSubstr("'both'")));
}

TEST_F(Declaration, ARasterPassWithoutTargetsIsRefused) {
  const RasterPass pass{.vertex = "gnomon/gbuffer.vert", .draws = builder.drawList("all")};
  EXPECT_THAT(errorOf([&] { builder.raster("draw", pass); }), AllOf(HasSubstr("'draw'"), HasSubstr("writes nothing")));
}

TEST_F(Declaration, AnOutputThatNothingWritesIsRefused) {
  const Texture texture = builder.texture("orphan", {{8, 4}, Format::r32f});
  EXPECT_THAT(errorOf([&] { compile({texture}); }),
              AllOf(HasSubstr("'bench'"), HasSubstr("'orphan'"), HasSubstr("nothing writes")));
}

TEST_F(Declaration, AForeignHandleIsRefused) {
  EXPECT_THAT(errorOf([&] { cpuWriter("pass", Texture{99}); }), AllOf(HasSubstr("'pass'"), HasSubstr("never declared")));
  EXPECT_THAT(errorOf([&] { builder.cpu("pass", {.buffers = {Buffer{99}}, .run = [](CpuContext&) {}}); }),
              AllOf(HasSubstr("'pass'"), HasSubstr("never declared")));
}

TEST_F(Declaration, ASamplerThatNobodyGivesIsRefused) {
  const std::string shader = shaderWriting(builder, "texelFetch(missing, p, 0).r", "uniform sampler2D missing;");
  EXPECT_THAT(errorOf([&] { builder.fullscreen("pass", {.shader = shader}); }),
              AllOf(HasSubstr("'pass'"), HasSubstr("'missing'")));
}

TEST_F(Declaration, ABlockThatNobodyGivesIsRefused) {
  const std::string shader = shaderWriting(builder, "x", "layout(std140) uniform Missing { float x; };");
  EXPECT_THAT(errorOf([&] { builder.fullscreen("pass", {.shader = shader}); }),
              AllOf(HasSubstr("'pass'"), HasSubstr("'Missing'")));
}

TEST_F(Declaration, APassAfterCompileIsRefused) {
  compile({constant("one")});
  EXPECT_THAT(errorOf([&] { constant("late", "2.0"); }), AllOf(HasSubstr("'late'"), HasSubstr("after")));
}

TEST_F(Declaration, RunningBeforeCompileIsRefused) {
  constant("one");
  EXPECT_THAT(errorOf([&] { bench.run(*graph); }), HasSubstr("'bench'"));
}

TEST_F(Declaration, AShaderErrorNamesThePassAndTheLine) {
  builder.include("broken.frag", "out float result;\nvoid main() {\n  result = nowhere;\n}\n");
  const std::string message = errorOf([&] { builder.fullscreen("pass", {.shader = "broken.frag"}); });
  EXPECT_THAT(message, AllOf(HasSubstr("'pass'"), HasSubstr("broken.frag:3")));
}

// --- pruning ---

TEST_F(Declaration, OnlyWhatAnOutputNeedsIsKept) {
  const Texture needed = constant("needed");
  constant("unneeded", "2.0");
  compile({reader("last", needed)});
  EXPECT_THAT(graph->passNames(), ElementsAre("needed", "last"));
  EXPECT_THAT(runPasses(), ElementsAre("needed", "last"));
}

TEST_F(Declaration, APassWhoseLastReaderGoesIsGone) {
  const Texture first = constant("first");
  reader("middle", first);
  compile({constant("other", "2.0")});
  EXPECT_THAT(graph->passNames(), ElementsAre("other"));
  EXPECT_THAT(namesOf(graph->textures()), ElementsAre("other"));
}

TEST_F(Declaration, APassIsKeptForTheBufferItWrites) {
  const Buffer buffer = builder.buffer("Numbers", 16);
  builder.cpu("fill", {.buffers = {buffer}, .run = [](CpuContext&) {}});
  const Texture out =
      builder.fullscreen("use", {.shader = shaderWriting(builder, "x", "layout(std140) uniform Numbers { float x; };"),
                                 .buffers = {{"Numbers", buffer}}});
  compile({out});
  EXPECT_THAT(graph->passNames(), ElementsAre("fill", "use"));
}

// --- what a shader depends on ---

TEST_F(Declaration, AProvidedTextureIsADependencyIfTheShaderUsesIt) {
  builder.provide("given", constant("giver"));
  compile({builder.fullscreen("user",
                              {.shader = shaderWriting(builder, "texelFetch(given, p, 0).r", "uniform sampler2D given;")})});
  EXPECT_THAT(graph->passNames(), ElementsAre("giver", "user"));
}

TEST_F(Declaration, AProvidedTextureIsNoDependencyIfTheShaderOnlyDeclaresIt) {
  builder.provide("given", constant("giver"));
  compile({builder.fullscreen("user", {.shader = shaderWriting(builder, "2.0", "uniform sampler2D given;")})});
  EXPECT_THAT(graph->passNames(), ElementsAre("user"));
}

TEST_F(Declaration, AProvidedTextureBehindAFalseConstantIsNoDependency) {
  builder.provide("given", constant("giver"));
  const std::string shader = shaderWriting(builder, "(USE ? texelFetch(given, p, 0).r : 2.0)", "uniform sampler2D given;");
  compile({builder.fullscreen("user", {.shader = shader, .constants = {{"USE", false}}})});
  EXPECT_THAT(graph->passNames(), ElementsAre("user"));
}

TEST_F(Declaration, AProvidedBlockIsADependencyOnlyIfTheShaderUsesIt) {
  const Buffer buffer = builder.buffer("Numbers", 16);
  builder.cpu("fill", {.buffers = {buffer}, .run = [](CpuContext&) {}});
  builder.provide("Numbers", buffer);
  const std::string block = "layout(std140) uniform Numbers { float x; };";
  const Texture user = builder.fullscreen("user", {.shader = shaderWriting(builder, "x", block)});
  const Texture other = builder.fullscreen("other", {.shader = shaderWriting(builder, "2.0", block)});
  compile({other});
  EXPECT_THAT(graph->passNames(), ElementsAre("other"));
  EXPECT_TRUE(user);
}

TEST_F(Declaration, AListedReadHidesAProvidedOne) {
  builder.provide("source", constant("giver", "3.0"));
  const Texture out = reader("user", constant("listed", "5.0"));
  compile({out});
  bench.run(*graph);
  EXPECT_EQ(graph->read(out).at(0, 0, 0), 5.0f);
}

// --- constants and includes ---

TEST_F(Declaration, ConstantsOfEveryTypeReachTheShader) {
  const Texture out = builder.fullscreen("out", {.shader = shaderWriting(builder, "(B ? 100.0 : 0.0) + float(I) + F"),
                                                 .constants = {{"B", true}, {"I", -7}, {"F", 0.1f}}});
  compile({out});
  bench.run(*graph);
  EXPECT_EQ(graph->read(out).at(0, 0, 0), 100.0f + -7.0f + 0.1f);
}

TEST_F(Declaration, AConstantOfTheGraphReachesEveryLaterShader) {
  builder.constant({"TAPS", 9});
  const Texture out = builder.fullscreen("out", {.shader = shaderWriting(builder, "float(TAPS)")});
  compile({out});
  bench.run(*graph);
  EXPECT_EQ(graph->read(out).at(7, 3, 0), 9.0f);
}

TEST_F(Declaration, AGeneratedTextCanBeIncluded) {
  builder.include("numbers", "const float five = 5.0;\n");
  const Texture out = builder.fullscreen("out", {.shader = shaderWriting(builder, "five", "#include \"numbers\"")});
  compile({out});
  bench.run(*graph);
  EXPECT_EQ(graph->read(out).at(0, 0, 0), 5.0f);
}

// --- memory ---

TEST_F(Declaration, MemoryIsThatOfKeptTexturesAndBuffers) {
  const Texture depth = builder.texture("depth", {{16, 8}, Format::d16});
  const Texture colour = builder.texture("colour", {{16, 8}, Format::rgba16f});
  const Texture unused = builder.texture("unused", {{100, 100}, Format::rgba32f});
  builder.buffer("numbers", 48);
  cpuWriter("a", colour);
  cpuWriter("b", unused);
  builder.cpu("c", {.writes = {depth}, .run = [](CpuContext&) {}});
  compile({depth, colour, constant("small")});
  EXPECT_EQ(graph->memoryBytes(), 16U * 8U * 2U + 16U * 8U * 8U + 8U * 4U * 4U + 48U);
}

TEST_F(Declaration, MemoryDoesNotCountWhatIsImported) {
  const Texture own = constant("own");
  compile({own});
  const std::unique_ptr<Graph> other = bench.graph("other");
  const Texture imported = other->builder().import("own", graph->resource(own));
  const std::string shader = shaderWriting(other->builder(), "texelFetch(source, p, 0).r", "uniform sampler2D source;");
  const Texture out =
      other->builder().fullscreen("copy", {.shader = shader, .reads = {{"source", imported}}, .format = Format::r8});
  other->compile(std::span(&out, 1));
  EXPECT_EQ(other->memoryBytes(), 8U * 4U);
  EXPECT_THAT(namesOf(other->textures()), ElementsAre("copy"));
}

}  // namespace
}  // namespace gnomon::test
