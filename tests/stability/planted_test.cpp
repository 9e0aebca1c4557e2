// Each defect that the suite is there for, planted in a copy of a real plugin, is caught and named.
#include <gtest/gtest.h>

#include <fstream>
#include <regex>

#include "gnomon/base/files.h"
#include "planted.h"
#include "render.h"

namespace gnomon::test {
namespace {

using namespace stability;

constexpr const char* kDepthMap = "gnomon/depth_map.glsl";

/// The cell fails, and one of its reasons begins with `beginning`.
testing::AssertionResult failsWith(const CellReport& cell, const std::string& beginning) {
  if (cell.outcome != Outcome::fail) return testing::AssertionFailure() << cell.hardCase << ": " << outcomeName(cell.outcome);
  std::string all;
  for (const std::string& reason : cell.reasons) {
    if (reason.rfind(beginning, 0) == 0) return testing::AssertionSuccess();
    all += "\n  " + reason;
  }
  return testing::AssertionFailure() << cell.hardCase << ": no reason begins with \"" << beginning << "\" among" << all;
}

TEST(Planted, UnalteredCopiesPass) {  // what is caught below is caught because of what was altered
  for (const char* plugin : {"shadow_map", "pcf"}) {
    PlantedTechnique copy(plugin, {});
    for (const char* name : {"world_moved_1e6", "receiver_outside_map", "grazing_0.05_degrees"}) {
      EXPECT_EQ(copy.check(name).outcome, Outcome::pass) << plugin << " in " << name;
    }
  }
}

TEST(Planted, BiasRemovedIsAcne) {
  PlantedTechnique planted("shadow_map", {{kDepthMap, "depth += r.bias;", ""}});
  EXPECT_TRUE(failsWith(planted.check("world_moved_1e6"), "acne"));
}

TEST(Planted, BiasThatGrowsWithoutReasonIsALeak) {  // half of the depth range
  PlantedTechnique planted("shadow_map", {{kDepthMap, "depth += r.bias;", "depth += r.bias + 0.5;"}});
  EXPECT_TRUE(failsWith(planted.check("world_moved_1e6"), "leak"));
}

TEST(Planted, PlaneNotFollowedIsAcne) {
  PlantedTechnique planted("pcf", {{kDepthMap, "clamp(dot(r.slope,", "0.0 * clamp(dot(r.slope,"}});
  EXPECT_TRUE(failsWith(planted.check("light_above_up_parallel"), "acne"));
}

TEST(Planted, MirroredLookupIsALeak) {
  PlantedTechnique planted("shadow_map", {{kDepthMap, "r.uv = image * 0.5 + 0.5;", "r.uv = image * vec2(-0.5, 0.5) + 0.5;"}});
  EXPECT_TRUE(failsWith(planted.check("light_above_up_parallel"), "leak"));
}

TEST(Planted, LookupThreeTexelsBesideIsALeak) {
  PlantedTechnique planted("shadow_map",
                           {{kDepthMap, "r.uv = image * 0.5 + 0.5;", "r.uv = image * 0.5 + 0.5 + 3.0 * mapTexel.xy;"}});
  EXPECT_TRUE(failsWith(planted.check("world_moved_1e6"), "leak"));
}

TEST(Planted, DarkOutsideTheMapIsAcne) {
  PlantedTechnique planted(
      "pcf", {{kDepthMap, "greaterThanEqual(uv, vec2(1.0)))) return 1.0;", "greaterThanEqual(uv, vec2(1.0)))) return 0.0;"}});
  EXPECT_TRUE(failsWith(planted.check("receiver_outside_map"), "acne"));
}

TEST(Planted, KernelThatWrapsAroundIsAcne) {
  PlantedTechnique planted("pcf", {{kDepthMap, "float isLit(sampler2D map, Receiver r, vec2 uv) {",
                                    "float isLit(sampler2D map, Receiver r, vec2 uv) { uv = fract(uv);"}});
  EXPECT_TRUE(failsWith(planted.check("receiver_outside_map"), "acne"));
}

TEST(Planted, MaskIgnoredIsDarkOutsideIt) {
  PlantedTechnique planted("pcf", {{kDepthMap, "if (texelFetch(gMask, r.pixel, 0).r == 0.0) discard;", ""}});
  EXPECT_TRUE(failsWith(planted.check("world_moved_1e6"), "dark outside the receiver mask"));
}

TEST(Planted, VisibilityOfTwoIsOutOfRange) {
  PlantedTechnique planted("shadow_map", {{"shadow_map.frag", "visibility = isLit(", "visibility = 2.0 * isLit("}});
  EXPECT_TRUE(failsWith(planted.check("scale_1e-4"), "out of [0,1]"));
}

TEST(Planted, DivisionByNothingIsNotFinite) {  // 0 / 0 where a receiver is wholly dark
  PlantedTechnique planted("pcf", {{"pcf.frag", "visibility = lit / float(TAPS * TAPS);", "visibility = lit / lit;"}});
  const CellReport cell = planted.check("world_moved_1e6");
  EXPECT_TRUE(failsWith(cell, "technique 'planted': pass 'filter': target 'filter' holds"));
}

TEST(Planted, ShortKernelIsALeakOfItsLastTap) {  // 1/25 of light is 4 per cent: no tolerance hides it
  PlantedTechnique planted(
      "pcf", {{"pcf.frag", "visibility = lit / float(TAPS * TAPS);", "visibility = (lit + 1.0) / float(TAPS * TAPS + 1);"}});
  EXPECT_TRUE(failsWith(planted.check("world_moved_1e6"), "leak"));
}

TEST(Planted, CoordinatesOfTheWorldLoseTheirDigits) {  // as if casters came to the light's axes through a million metres
  PlantedTechnique planted("shadow_map", {{"gnomon/light_depth.vert", "relativePosition(drawRecords[record], position)",
                                           "((relativePosition(drawRecords[record], position) + 1e6) - 1e6)"}});
  EXPECT_EQ(planted.check("world_moved_1e6").outcome, Outcome::fail);
}

TEST(Planted, LengthBuiltInFailsInASmallWorld) {  // a bias of a millimetre, in a world of 0.8 mm
  const std::vector<Alteration> millimetre{{kDepthMap, "depth += r.bias;", "depth += 1e-3 * mapDepthRate(mapDepth.w);"}};
  PlantedTechnique planted("shadow_map", millimetre);
  EXPECT_TRUE(failsWith(planted.check("scale_1e-4"), "leak"));
}

TEST(Planted, CompileErrorFailsTheCellWithItsLine) {
  PlantedTechnique planted("shadow_map", {{"shadow_map.frag", "visibility = isLit(", "visibility == isLit(("}});
  const CellReport cell = planted.check("world_moved_1e6");
  ASSERT_EQ(cell.outcome, Outcome::fail);
  EXPECT_NE(cell.reasons.at(0).find("shadow_map.frag:"), std::string::npos) << cell.reasons.at(0);
}

TEST(Planted, ReferenceThatIsWrongDoesNotJudgeItself) {  // the floor registered as the reference: truth comes from geometry
  PlantedTechnique planted("unshadowed", {}, "reference");
  EXPECT_TRUE(failsWith(planted.check("world_moved_1e6"), "leak"));
}

TEST(Planted, WhatIsNeverTheSameTwiceIsNotTheSameBits) {
  ensureContext();
  Registry unsteady({std::filesystem::path(GNOMON_BINARY_DIR) / "test_plugins" / "unsteady",
                     installationDirectory() / "plugins" / "unshadowed"});
  const CellReport cell = runStability(unsteady, {"unsteady"}, {findCase("world_moved_1e6")}).cells.at(0);
  EXPECT_TRUE(failsWith(cell, "not the same bits in a second, fresh session"));
  EXPECT_TRUE(failsWith(cell, "not the same bits after another technique ran"));
}

/// A guard of the shaders, and a cell that fails without it.
struct Defence {
  const char* name;
  const char* plugin;
  const char* hardCase;
};
constexpr Defence kDefences[] = {{"behind_light", "shadow_map", "normal_offset_behind_light"},
                                 {"plane_beyond_far", "pcf", "light_in_plane"}};
/// What this renderer does not show: without it slopes are infinite or NaN where a receiver's plane passes through the light,
/// and llvmpipe's min and max drop NaN. What they do is undefined in GLSL.
constexpr const char* kUndefinedWithout = "plane_through_light";

TEST(Defences, EachIsNeededBySomeCase) {
  for (const Defence& defence : kDefences) {
    PlantedTechnique planted(defence.plugin, {{kDepthMap, std::string("GNOMON_DEFENCE(") + defence.name + ")", "false"}});
    EXPECT_EQ(planted.check(defence.hardCase).outcome, Outcome::fail) << defence.name;
  }
}

TEST(Defences, EveryOneInTheShadersIsListedHere) {
  const std::regex pattern(R"(GNOMON_DEFENCE\((\w+)\))");
  for (const auto& entry : std::filesystem::recursive_directory_iterator(installationDirectory())) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".glsl" && extension != ".frag" && extension != ".vert") continue;
    const std::string text = readFile(entry.path());
    for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match) {
      const std::string name = (*match)[1];
      if (name == "name" || name == kUndefinedWithout) continue;  // "name": its definition
      EXPECT_TRUE(std::any_of(std::begin(kDefences), std::end(kDefences), [&](const Defence& d) { return name == d.name; }))
          << entry.path() << ": the defence " << name << " has no case that fails without it";
    }
  }
}

}  // namespace
}  // namespace gnomon::test
