// Passes that several graphs of a session share.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

#include "bench.h"
#include "gnomon/base/files.h"

namespace gnomon::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

constexpr const char* kNumber = "layout(std140) uniform Number { float x; };";
constexpr const char* kSource = "uniform sampler2D source;";

/// As a technique with a map: "fit" on the CPU, "map", and "show", which adds `offset` to what the map holds.
struct User {
  std::unique_ptr<Graph> graph;
  Texture map, out;
  Buffer number;
  std::shared_ptr<std::string> identity = std::make_shared<std::string>();
};

class Sharing : public testing::Test {
 protected:
  User user(float offset, const std::string& identity, Format format = Format::r32f, glm::vec4 clear = glm::vec4(0.0f),
            Blend blend = Blend::none) {
    User u;
    *u.identity = identity;
    u.graph =
        std::make_unique<Graph>("user", glm::ivec2(8, 4), gl::ShaderSources{{installationDirectory() / "shaders"}, {}}, shares);
    GraphBuilder& builder = u.graph->builder();
    u.number = builder.buffer("number", 16);
    builder.cpu("fit", {.inputs = {Input::light},
                        .buffers = {u.number},
                        .run =
                            [this, number = u.number](CpuContext& context) {
                              context.facts().farDepth = static_cast<double>(value);
                              context.writeBlock(number, std::array<float, 4>{value, 0, 0, 0});
                            },
                        .identity = [text = u.identity] { return *text; }});
    u.map = builder.fullscreen("map", {.shader = shaderWriting(builder, "x", kNumber),
                                       .buffers = {{"Number", u.number}},
                                       .format = format,
                                       .clear = clear,
                                       .blend = blend});
    u.out = builder.fullscreen("show", {.shader = shaderWriting(builder, "OFFSET + texelFetch(source, p, 0).r", kSource),
                                        .reads = {{"source", u.map}},
                                        .constants = {{"OFFSET", offset}}});
    u.graph->compile(std::span(&u.out, 1));
    return u;
  }
  std::vector<std::string> frame(const User& u) { return ran(bench.run(*u.graph)); }
  float shown(const User& u) const { return u.graph->read(u.out).at(2, 1); }
  void moveLight(float to) {
    value = to;
    ++bench.revisions[Input::light];
  }

  float value = 3.0f;
  Bench bench;
  GraphShares shares{std::make_shared<gl::ProgramCache>(), makeSharedPasses()};
};

TEST_F(Sharing, TheSecondFindsTheMapOfTheFirst) {
  const User a = user(10.0f, "fit");
  const User b = user(20.0f, "fit");
  EXPECT_THAT(frame(a), ElementsAre("fit", "map", "show"));
  EXPECT_THAT(frame(b), ElementsAre("fit", "show"));
  EXPECT_EQ(shown(a), 13.0f);
  EXPECT_EQ(shown(b), 23.0f);
}

TEST_F(Sharing, FlippingRendersTheMapOnceForEachChange) {
  const User a = user(10.0f, "fit");
  const User b = user(20.0f, "fit");
  int maps = 0;
  for (int change = 0; change < 3; ++change) {
    moveLight(static_cast<float>(change) + 5.0f);
    for (const User* u : {&a, &b, &a, &b}) {
      const std::vector<std::string> passes = frame(*u);
      maps += static_cast<int>(std::count(passes.begin(), passes.end(), "map"));
    }
    EXPECT_EQ(shown(a), value + 10.0f);
    EXPECT_EQ(shown(b), value + 20.0f);
  }
  EXPECT_EQ(maps, 3);
}

TEST_F(Sharing, EachGraphKnowsItsFacts) {
  const User a = user(10.0f, "fit");
  const User b = user(20.0f, "fit");
  frame(a);
  frame(b);
  EXPECT_EQ(b.graph->facts().farDepth, 3.0);
}

TEST_F(Sharing, WithoutTheFirstTheSecondIsWhole) {
  auto a = std::make_unique<User>(user(10.0f, "fit"));
  const User b = user(20.0f, "fit");
  frame(*a);
  frame(b);
  a.reset();
  EXPECT_THAT(frame(b), IsEmpty());
  moveLight(7.0f);
  EXPECT_THAT(frame(b), ElementsAre("fit", "map", "show"));
  EXPECT_EQ(shown(b), 27.0f);
}

TEST_F(Sharing, WithoutAnIdentityNothingThatDependsOnTheCpuPassIsShared) {
  const User a = user(10.0f, "");
  const User b = user(20.0f, "");
  frame(a);
  EXPECT_THAT(frame(b), ElementsAre("fit", "map", "show"));
}

TEST_F(Sharing, AnotherIdentityIsAnotherMap) {
  const User a = user(10.0f, "fit");
  const User b = user(20.0f, "other fit");
  frame(a);
  EXPECT_THAT(frame(b), Contains("map"));
}

TEST_F(Sharing, AnotherFormatIsAnotherMap) {
  const User a = user(10.0f, "fit");
  const User b = user(20.0f, "fit", Format::r16f);
  frame(a);
  EXPECT_THAT(frame(b), Contains("map"));
}

TEST_F(Sharing, AnotherStateIsAnotherMap) {
  const User a = user(10.0f, "fit");
  const User b = user(20.0f, "fit", Format::r32f, glm::vec4(1.0f));
  frame(a);
  EXPECT_THAT(frame(b), Contains("map"));
}

TEST_F(Sharing, AnotherBlendingIsAnotherMap) {
  const User a = user(10.0f, "fit");
  const User b = user(20.0f, "fit", Format::r32f, glm::vec4(0.0f), Blend::additive);
  frame(a);
  EXPECT_THAT(frame(b), Contains("map"));
}

TEST_F(Sharing, OutputsAreEachGraphsOwn) {
  const User a = user(10.0f, "fit");
  const User b = user(10.0f, "fit");
  EXPECT_NE(a.graph->resource(a.out), b.graph->resource(b.out));
  EXPECT_EQ(a.graph->resource(a.map), b.graph->resource(b.map));
}

TEST_F(Sharing, GraphsThatAreNotToldToShareNothing) {
  shares.passes = nullptr;
  const User a = user(10.0f, "fit");
  const User b = user(10.0f, "fit");
  frame(a);
  EXPECT_THAT(frame(b), ElementsAre("fit", "map", "show"));
}

TEST_F(Sharing, AnIdentityThatChangesPartsThem) {
  const User a = user(10.0f, "fit");
  const User b = user(20.0f, "fit");
  frame(a);
  frame(b);
  *b.identity = "fit of other parameters";
  b.graph->refreshSharing();
  EXPECT_THAT(frame(b), ElementsAre("fit", "map", "show"));
  EXPECT_THAT(frame(a), IsEmpty());
  EXPECT_NE(a.graph->resource(a.map), b.graph->resource(b.map));
  EXPECT_EQ(shown(b), 23.0f);
}

TEST_F(Sharing, AnIdentityThatComesBackJoinsThemAgain) {
  const User a = user(10.0f, "fit");
  const User b = user(20.0f, "other");
  frame(a);
  frame(b);
  *b.identity = "fit";
  b.graph->refreshSharing();
  EXPECT_THAT(frame(b), Not(Contains("map")));
  EXPECT_EQ(a.graph->resource(a.map), b.graph->resource(b.map));
  EXPECT_EQ(shown(b), 23.0f);
}

TEST_F(Sharing, AnIdentityThatChangesWhileNobodySharesKeepsTheTextures) {
  const User a = user(10.0f, "fit");
  frame(a);
  const auto before = a.graph->resource(a.map);
  *a.identity = "fit of other parameters";
  a.graph->refreshSharing();
  EXPECT_EQ(a.graph->resource(a.map), before);
  const User of = user(20.0f, "fit");
  const User to = user(30.0f, "fit of other parameters");
  EXPECT_NE(of.graph->resource(of.map), before);
  EXPECT_EQ(to.graph->resource(to.map), before);
}

TEST_F(Sharing, AFailureOfOneIsNoPictureOfTheOther) {
  const User a = user(10.0f, "fit");
  const User b = user(20.0f, "fit");
  value = std::numeric_limits<float>::infinity();
  EXPECT_THAT(errorOf([&] { bench.run(*a.graph, {.checkFinite = true}); }), testing::HasSubstr("'map'"));
  moveLight(4.0f);
  EXPECT_THAT(frame(b), Contains("map"));
  EXPECT_EQ(shown(b), 24.0f);
}

}  // namespace
}  // namespace gnomon::test
