// Each defect that the suite is there for, planted in a copy of a real plugin, is caught and named.
#include <gtest/gtest.h>

#include <set>

#include "planted.h"
#include "render.h"

namespace gnomon::test {
namespace {

using namespace stability;

constexpr const char* kDepthMap = "gnomon/depth_map.glsl";

/// The cell fails, and one of its reasons holds `part`.
testing::AssertionResult failsWith(const CellReport& cell, const std::string& part) {
  if (cell.outcome != Outcome::fail) return testing::AssertionFailure() << cell.hardCase << ": " << outcomeName(cell.outcome);
  std::string all;
  for (const std::string& reason : cell.reasons) {
    if (reason.find(part) != std::string::npos) return testing::AssertionSuccess();
    all += "\n  " + reason;
  }
  return testing::AssertionFailure() << cell.hardCase << ": no reason holds \"" << part << "\" among" << all;
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
  PlantedTechnique planted("shadow_map", {{kDepthMap, "centre) + r.bias;", "centre);"}});
  EXPECT_TRUE(failsWith(planted.check("world_moved_1e6"), "acne"));
}

TEST(Planted, BiasThatGrowsWithoutReasonIsALeak) {  // half of the depth range
  PlantedTechnique planted("shadow_map", {{kDepthMap, "centre) + r.bias;", "centre) + r.bias + 0.5;"}});
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
  PlantedTechnique planted(
      "pcf", {{kDepthMap, "float isLit(MapPoint r, vec2 uv) {", "float isLit(MapPoint r, vec2 uv) { uv = fract(uv);"}});
  EXPECT_TRUE(failsWith(planted.check("receiver_outside_map"), "acne"));
}

TEST(Planted, MaskIgnoredIsDarkOutsideIt) {
  PlantedTechnique planted("pcf", {{kDepthMap, "if (texelFetch(gMask, r.pixel, 0).r == 0.0) discard;", ""}});
  EXPECT_TRUE(failsWith(planted.check("world_moved_1e6"), "not 1 outside the receiver mask"));
}

TEST(Planted, VisibilityOfTwoIsOutOfRange) {
  PlantedTechnique planted("shadow_map", {{"nearest.frag", "visibility = visibilityAt(", "visibility = 2.0 * visibilityAt("}});
  EXPECT_TRUE(failsWith(planted.check("scale_1e-4"), "out of [0,1]"));
}

TEST(Planted, DivisionByNothingIsNotFinite) {  // 0 / 0 where a receiver is wholly dark
  PlantedTechnique planted("pcf", {{"fixed.frag", "= filteredVisibility(f, p, TAPS * TAPS);", "= f.lit / f.lit;"}});
  const CellReport cell = planted.check("world_moved_1e6");
  EXPECT_TRUE(failsWith(cell, "technique 'planted': pass 'filter': target 'filter' holds"));
}

TEST(Planted, ShortKernelIsALeakOfItsLastTap) {  // 1/25 of light is 4 per cent: no tolerance hides it
  PlantedTechnique planted(
      "pcf", {{"fixed.frag", "= filteredVisibility(f, p, TAPS * TAPS);", "= (f.lit + 1.0) / float(TAPS * TAPS + 1);"}});
  EXPECT_TRUE(failsWith(planted.check("world_moved_1e6"), "leak"));
}

TEST(Planted, CoordinatesOfTheWorldLoseTheirDigits) {  // as if casters came to the light's axes through a million metres
  PlantedTechnique planted("shadow_map", {{"gnomon/light_depth.vert", "relativePosition(drawRecords[record], position)",
                                           "((relativePosition(drawRecords[record], position) + 1e6) - 1e6)"}});
  EXPECT_EQ(planted.check("world_moved_1e6").outcome, Outcome::fail);
}

TEST(Planted, LengthBuiltInFailsInASmallWorld) {  // a bias of a millimetre, in a world of 0.8 mm
  const std::vector<Alteration> millimetre{{kDepthMap, "centre) + r.bias;", "centre) + 1e-3 * mapDepthRate(mapDepth.w);"}};
  PlantedTechnique planted("shadow_map", millimetre);
  EXPECT_TRUE(failsWith(planted.check("scale_1e-4"), "leak"));
}

TEST(Planted, CompileErrorFailsTheCellWithItsLine) {
  PlantedTechnique planted("shadow_map", {{"nearest.frag", "visibility = visibilityAt(", "visibility == visibilityAt(("}});
  const CellReport cell = planted.check("world_moved_1e6");
  ASSERT_EQ(cell.outcome, Outcome::fail);
  EXPECT_NE(cell.reasons.at(0).find("nearest.frag:"), std::string::npos) << cell.reasons.at(0);
}

TEST(Planted, ReferenceThatIsWrongDoesNotJudgeItself) {  // the floor registered as the reference: truth comes from geometry
  PlantedTechnique planted("unshadowed", {}, "reference");
  EXPECT_TRUE(failsWith(planted.check("world_moved_1e6"), "leak"));
}

TEST(Planted, WhatIsNeverTheSameTwiceIsNotTheSameBits) {
  ensureContext();
  Registry unsteady({std::filesystem::path(GNOMON_BINARY_DIR) / "test_plugins" / "unsteady",
                     installationDirectory() / "plugins" / "unshadowed"});
  const CellReport cell = runStability(unsteady, {{"unsteady"}, {findCase("world_moved_1e6")}}).cells.at(0);
  EXPECT_TRUE(failsWith(cell, "not the same bits in a second, fresh session"));
  EXPECT_TRUE(failsWith(cell, "not the same bits after another technique ran"));
}

/// A defence, and a cell that passes with it and fails without.
struct Need {
  const char* defence;
  const char* technique;
  const char* hardCase;
};
constexpr Need kNeeds[] = {{"behind_light", "shadow_map", "normal_offset_behind_light"},
                           {"plane_beyond_far", "pcf", "light_in_plane"},
                           {"log_domain", "esm", "light_in_plane"}};
/// What this renderer does not show: without it slopes are infinite or NaN where a receiver's plane passes through the light,
/// and llvmpipe's min and max drop NaN. What they do is undefined in GLSL.
constexpr const char* kUndefinedWithout = "plane_through_light";

/// What makes a picture wrong that stays finite and within [0,1]: tests beside the representations show it.
constexpr const char* kShownByPictures[] = {"min_variance", "straddling_kernel"};

TEST(Defences, EachIsNeededBySomeCase) {
  ensureContext();
  for (const Need& need : kNeeds) {
    const Case* hardCase = findCase(need.hardCase);
    EXPECT_EQ(runStability(registry(), {{need.technique}, {hardCase}}).cells.at(0).outcome, Outcome::pass) << need.defence;
    EXPECT_EQ(runStability(registry(), {{need.technique}, {hardCase}, {need.defence}}).cells.at(0).outcome, Outcome::fail)
        << need.defence;
  }
}

TEST(Defences, EveryDeclaredOneIsListedHere) {
  ensureContext();
  std::set<std::string> names;
  for (const Defence& defence : frameworkDefences()) names.insert(defence.name);
  for (const std::string& technique : registry().names()) {
    for (const Defence& defence : registry().open(technique).entry->notes.defences) names.insert(defence.name);
  }
  for (const std::string& name : names) {
    if (name == kUndefinedWithout || std::count(std::begin(kShownByPictures), std::end(kShownByPictures), name) > 0) continue;
    EXPECT_TRUE(std::any_of(std::begin(kNeeds), std::end(kNeeds), [&](const Need& need) { return name == need.defence; }))
        << "the defence " << name << " has no case that fails without it";
  }
}

TEST(Defences, AnUnknownNameIsToldBeforeAnythingRuns) {
  ensureContext();
  bool ran = false;
  try {
    runStability(registry(), {{"shadow_map"}, {&cases().front()}, {"behind_lihgt"}}, [&](const CellReport&) { ran = true; });
    FAIL() << "an unknown defence was switched off";
  } catch (const InputError& error) {
    EXPECT_NE(error.problems().at(0).message.find("did you mean \"behind_light\""), std::string::npos)
        << error.problems().at(0).message;
  }
  EXPECT_FALSE(ran);
}

}  // namespace
}  // namespace gnomon::test
