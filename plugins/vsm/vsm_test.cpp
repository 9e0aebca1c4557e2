#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "map_edges.h"

namespace gnomon::test {
namespace {

double leakInLayers(const std::string& technique, const std::string& parameters) {
  return leakInUmbra(builtinSetup("layers", {240, 180}), technique, parameters);
}

std::vector<EdgePixel> edge(const std::string& technique, const std::string& parameters) {
  const EdgeScene scene;
  ensureContext();
  Session session(scene.setup());
  const Slot slot = addSlot(session, technique, parameters);
  session.frame(slot, {.checkFinite = true});
  return acrossEdge(session, slot, Across::x);
}

TEST(Vsm, OfTwoDepthsTheBoundIsTheLitShare) {
  // Chebyshev's bound is tight for one planar blocker over one planar receiver: V is what the filter covers of lit texels, here
  // a box of 9 and the two texels of the bilinear lookup: a ramp of 10 texels that is linear but for its ends.
  const auto row = edge("vsm", R"({"map_size": 512, "width": 9, "bleeding_reduction": 0, "min_variance": 1e-9})");
  const double texel = 2.0 * std::tan(glm::radians(EdgeScene::kConeDegrees)) * dimensions::kSourceHeight / 512.0;
  const double centre = EdgeScene::texelOf(EdgeScene::shadowEdge(), dimensions::kSourceHeight, 512);
  const double snapped = EdgeScene::snappedEdge(512);
  int judged = 0;
  for (const EdgePixel& pixel : row) {
    const double at = (pixel.at - EdgeScene::shadowEdge()) / texel + centre - snapped;  // texels beyond the map's own edge
    if (std::abs(at) > 3.5) continue;
    EXPECT_NEAR(pixel.visibility, 0.5 + at / 9.0, 2e-3) << at;
    ++judged;
  }
  EXPECT_GT(judged, 50);
}

TEST(Vsm, LeaksThroughTheNearerOfTwoBlockersWherePcfDoesNot) {
  const double leak = leakInLayers("vsm", R"({"width": 9, "bleeding_reduction": 0})");
  EXPECT_GT(leak, 0.005);
  EXPECT_GT(leak, 4.0 * leakInLayers("pcf", R"({"taps": 9})"));  // what a wide filter brings in over the umbra's border
}

TEST(Vsm, BleedingReductionDarkensTheLeak) {
  EXPECT_LT(leakInLayers("vsm", R"({"width": 25, "bleeding_reduction": 0.3})"),
            0.7 * leakInLayers("vsm", R"({"width": 25, "bleeding_reduction": 0})"));
}

TEST(Vsm, APlaneShadesItselfNowhere) {
  for (const double elevation : {5.0, 20.0, 60.0}) {
    const SessionSetup plane = lonePlane(Glancing::spot, elevation);
    const Image v = renderVisibility(plane, "vsm", R"({"bleeding_reduction": 0})");
    EXPECT_GT(*std::min_element(v.data.begin(), v.data.end()), 0.9f) << elevation << " degrees";
  }
}

TEST(Vsm, TheSlopeOfATexelIsVarianceToo) {  // without bias and least variance nothing else keeps a sloped plane lit
  const SessionSetup plane = lonePlane(Glancing::spot, 20.0);
  const Image v = renderVisibility(
      plane, "vsm",
      R"({"width": 1, "min_variance": 1e-12, "bleeding_reduction": 0, "bias.constant": 0, "bias.slope": 0, "map_size": 256})");
  EXPECT_GT(*std::min_element(v.data.begin(), v.data.end()), 0.3f);
}

TEST(Vsm, TheLookupsTexelsBelongToTheReach) {
  ensureContext();
  Session session(builtinSetup("pillars"));
  const Slot slot = addSlot(session, "vsm", R"({"width": 9})");
  session.frame(slot);
  EXPECT_EQ(session.facts(slot).filterRadiusTexels, 5.0);  // four beside the middle, and the bilinear lookup's one
}

TEST(Vsm, HalfFloatsLoseDigitsThatMomentsNeed) {
  const auto exact = edge("vsm", R"({"map_size": 512, "min_variance": 1e-9})");
  const auto half = edge("vsm", R"({"map_size": 512, "min_variance": 1e-9, "moments": "rg16f"})");
  double largest = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i)
    largest = std::max(largest, std::abs(exact[i].visibility - half[i].visibility));
  EXPECT_GT(largest, 1e-4);
  EXPECT_LT(largest, 0.2);
}

/// sphere_grid's visibility; its floor receives. Near and far, and with them the least variance, are those of the whole scene.
Image overFloor(bool casts, Toggle idleReceivers) {
  SessionSetup setup = builtinSetup("sphere_grid");
  setup.scene.instances.at(0).casts = casts;
  setup.overrides[Rule::idleReceivers] = idleReceivers;
  setup.overrides[Rule::fitting] = Toggle::off;
  return renderVisibility(setup, "vsm");
}

TEST(Vsm, AFloorThatCastsNothingIsInTheMapAllTheSame) {
  const Image casting = overFloor(true, Toggle::automatic);
  EXPECT_GT(meanDifference(overFloor(false, Toggle::off), casting), 1e-3);
  EXPECT_LT(meanDifference(overFloor(false, Toggle::automatic), casting), 1e-5);
}

TEST(Vsm, AnIdleReceiverShadesNoOther) {  // bars over a floor that reaches beyond them, none of which casts
  SessionSetup setup = builtinSetup("pillars");
  setup.scene.instances.at(0).world = glm::scale(setup.scene.instances.at(0).world, glm::dvec3(3.0, 1.0, 3.0));
  for (Instance& instance : setup.scene.instances) instance.casts = false;
  const Image v = renderVisibility(setup, "vsm");
  EXPECT_GT(*std::min_element(v.data.begin(), v.data.end()), 0.99f);
}

TEST(Vsm, WithoutALeastVarianceAPlaneShadesItself) {  // in half floats M2 - M1^2 cancels to less than 0
  SessionSetup plane = lonePlane(Glancing::spot, 60.0);
  const std::string half =
      R"({"moments": "rg16f", "min_variance": 1e-3, "bleeding_reduction": 0, "bias.constant": 0, "bias.slope": 0})";
  const auto darkest = [&] {
    const Image v = renderVisibility(plane, "vsm", half);
    return *std::min_element(v.data.begin(), v.data.end());
  };
  EXPECT_GT(darkest(), 0.9f);
  plane.overrides.without = {"min_variance"};
  EXPECT_LT(darkest(), 0.86f);
}

TEST(Vsm, TheGaussianIsNarrowerThanTheBoxOfItsWidth) {
  const auto widthOf = [](const std::vector<EdgePixel>& row) {
    const auto penumbra = [](const EdgePixel& p) { return p.visibility > 0.1 && p.visibility < 0.9; };
    return std::count_if(row.begin(), row.end(), penumbra);
  };
  EXPECT_LT(widthOf(edge("vsm_gaussian", R"({"map_size": 512, "width": 15})")),
            0.7 * static_cast<double>(widthOf(edge("vsm", R"({"map_size": 512, "width": 15})"))));
}

}  // namespace
}  // namespace gnomon::test
