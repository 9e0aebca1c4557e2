#include "gnomon/gl/instrument.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "gnomon/base/error.h"

namespace gnomon::gl {
namespace {

const std::string kHead = "#version 450 core\nuniform sampler2D map;\nuniform sampler2D other;\n";

/// The part of a fragment shader's counting text that was made of `body`.
std::string rewritten(const std::string& body) {
  const std::string text = kHead + body;
  const std::string all = instrumented(text, GL_FRAGMENT_SHADER, readableNames({text}), {});
  const std::string marker = "uniform sampler2D other;\n";
  const std::size_t begin = all.find(marker) + marker.size();
  return all.substr(begin, all.rfind("\nvoid main()") - begin);
}

TEST(ReadableNames, AreThoseOfSamplersAndImages) {
  EXPECT_EQ(readableNames({"layout(binding = 0) uniform highp sampler2D a, b;\n// uniform sampler2D c;\n",
                           "uniform usampler2DArray d; uniform float e; layout(r32f) uniform image2D f;"}),
            (std::vector<std::string>{"a", "b", "d", "f"}));
}

TEST(Instrumented, ReadsCountBeforeTheyHappen) {
  EXPECT_EQ(rewritten("vec4 v = texelFetch(map, p, 0);"), "vec4 v = (gnomonRead(0, 1u), texelFetch(map, p, 0));");
  EXPECT_EQ(rewritten("vec4 v = textureGather(other, p);"), "vec4 v = (gnomonRead(1, 4u), textureGather(other, p));");
}

TEST(Instrumented, NestedReadsCountEach) {
  EXPECT_EQ(rewritten("v = textureLod(map, texture(other, f(p)).xy, 0.0);"),
            "v = (gnomonRead(0, 1u), textureLod(map, (gnomonRead(1, 1u), texture(other, f(p))).xy, 0.0));");
}

TEST(Instrumented, SamplersTakeTheirNumbersThroughFunctions) {
  EXPECT_EQ(rewritten("vec4 g(sampler2D m, vec2 p) { return texture(m, p) + h(p, m); }\nvec4 v = g(other, p);"),
            "vec4 g(sampler2D m, int gnomonOf_m, vec2 p) { return (gnomonRead(gnomonOf_m, 1u), texture(m, p)) + "
            "h(p, m, gnomonOf_m); }\nvec4 v = g(other, 1, p);");
}

TEST(Instrumented, AParametersNameIsItsFunctionsAlone) {
  EXPECT_EQ(rewritten("vec4 g(sampler2D map) { return texture(map, p); }\nvoid k() { texture(map, p); }"),
            "vec4 g(sampler2D map, int gnomonOf_map) { return (gnomonRead(gnomonOf_map, 1u), texture(map, p)); }\n"
            "void k() { (gnomonRead(0, 1u), texture(map, p)); }");
}

TEST(Instrumented, WhatOnlyAsksCountsNothing) {
  const std::string body = "ivec2 s = textureSize(map, 0); int l = textureQueryLevels(map);";
  EXPECT_EQ(instrumented(kHead + body, GL_FRAGMENT_SHADER, {"map", "other"}, {}), kHead + body);
}

TEST(Instrumented, CommentsAndMembersAreNoReads) {
  const std::string body = "/* texture(map, p) */ // texelFetch(map, p, 0)\nfloat f = s.texture;";
  EXPECT_EQ(instrumented(kHead + body, GL_FRAGMENT_SHADER, {"map", "other"}, {}), kHead + body);
}

TEST(Instrumented, MainEndsAndDiscardsWithItsCounts) {
  EXPECT_EQ(
      rewritten("void main() { if (texture(map, p).r == 0.0) discard; else return; }"),
      "void gnomonMain() { if ((gnomonRead(0, 1u), texture(map, p)).r == 0.0) { gnomonFlush(); discard; } else return; }");
}

TEST(Instrumented, TestsComeFirstWhereThatChangesNothing) {
  const auto early = [](const std::string& body, bool writesDepth) {
    const std::string all = instrumented(kHead + "vec4 v = texture(map, p);" + body, GL_FRAGMENT_SHADER, {"map", "other"},
                                         {.writesDepth = writesDepth});
    return all.find("early_fragment_tests") != std::string::npos;
  };
  EXPECT_TRUE(early("", true));
  EXPECT_TRUE(early("discard;", false));
  EXPECT_FALSE(early("discard;", true));
  EXPECT_FALSE(early("gl_FragDepth = 0.0;", false));
}

TEST(Instrumented, LinesStayWhereTheyWere) {
  const std::string text = kHead + "#line 1 3\nvec4 v = texture(map,\n  p);\nvoid main() {}\n";
  const std::string all = instrumented(text, GL_FRAGMENT_SHADER, {"map", "other"}, {});
  const auto linesAfter = [](const std::string& t) {
    const std::size_t begin = t.find("#line 1 3");
    return std::count(
        t.begin() + static_cast<std::ptrdiff_t>(begin),
        t.begin() + static_cast<std::ptrdiff_t>(t.find("Main() {", begin) == std::string::npos ? t.find("main() {", begin)
                                                                                               : t.find("Main() {", begin)),
        '\n');
  };
  EXPECT_EQ(linesAfter(all), linesAfter(text));
}

TEST(Instrumented, WhatCannotBeCountedIsRefused) {
  const auto refused = [](const std::string& body) {
    const std::string text = kHead + body;
    EXPECT_THROW(instrumented(text, GL_FRAGMENT_SHADER, readableNames({text}), {}), Error) << body;
  };
  refused("#define READ(p) texture(map, p)\n");
  refused("uniform sampler2D maps[4];\n");
  refused("vec4 v = texture(unknown, p);");
}

}  // namespace
}  // namespace gnomon::gl
