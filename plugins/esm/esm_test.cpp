#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "map_edges.h"

namespace gnomon::test {
namespace {

std::vector<EdgePixel> edge(const std::string& parameters) {
  const EdgeScene scene;
  ensureContext();
  Session session(scene.setup());
  const Slot slot = addSlot(session, "esm", parameters);
  session.frame(slot, {.checkFinite = true});
  return acrossEdge(session, slot, Across::x);
}

class EsmExponent : public testing::TestWithParam<int> {};

TEST_P(EsmExponent, StaysFiniteAndBetween0And1) {  // e^(c z) itself leaves a float's range above 88
  ensureContext();
  Session session(builtinSetup("layers"));
  const Slot slot = addSlot(session, "esm", fmt::format(R"({{"exponent": {}, "width": 31}})", GetParam()));
  session.frame(slot, {.checkFinite = true});
  const Image v = session.visibility(slot);
  const auto [low, high] = std::minmax_element(v.data.begin(), v.data.end());
  EXPECT_GE(*low, 0.0f);
  EXPECT_LE(*high, 1.0f);
  EXPECT_LT(*low, 0.5f);
}

INSTANTIATE_TEST_SUITE_P(UpTo, EsmExponent, testing::Values(1, 30, 88, 200, 1000, 5000));

TEST(Esm, TheLogDomainIsTheMeanOfExponentials) {
  // One blocker at b, a receiver at t (of the depth range), a share p of lit texels under the filter: V = p + (1-p) e^(c(b-t)).
  // Along the ramp of a straight edge p runs from 0 to 1, so that V's least value is e^(c(b-t)) itself.
  const auto row = edge(R"({"map_size": 512, "width": 9, "exponent": 30, "bias.constant": 0, "bias.slope": 0})");
  const EdgeScene scene;
  Session session(scene.setup());
  const Slot slot = addSlot(session, "esm", R"({"map_size": 512, "width": 9})");
  session.frame(slot);
  const Facts facts = session.facts(slot);
  const double range = facts.farDepth - facts.nearDepth;
  const double expected = std::exp(-30.0 * EdgeScene::kBlockerHeight / range);
  const auto least =
      std::min_element(row.begin(), row.end(), [](const auto& a, const auto& b) { return a.visibility < b.visibility; });
  EXPECT_NEAR(least->visibility, expected, 1e-4);
}

TEST(Esm, AKernelThatReachesBeyondTheReceiverIsCompared) {
  // pillars' floor slopes as the light sees it: without the defence a wide kernel's farther half drowns every blocker.
  SessionSetup setup = builtinSetup("pillars");
  const std::string wide = R"({"width": 21})";
  const Image filtered = renderVisibility(setup, "pcf", R"({"taps": 21})");
  const double compared = meanDifference(renderVisibility(setup, "esm", wide), filtered);
  setup.overrides.without = {"straddling_kernel"};
  EXPECT_LT(compared, 0.2 * meanDifference(renderVisibility(setup, "esm", wide), filtered));
}

TEST(Esm, ASteepExponentialIsTheFilteredStep) {  // to what drivers make of exp and log, 18 of them one after another
  const auto row = edge(R"({"map_size": 512, "width": 9, "exponent": 500})");
  const double texel = 2.0 * std::tan(glm::radians(EdgeScene::kConeDegrees)) * dimensions::kSourceHeight / 512.0;
  const double centre = EdgeScene::texelOf(EdgeScene::shadowEdge(), dimensions::kSourceHeight, 512);
  for (const EdgePixel& pixel : row) {
    const double at = (pixel.at - EdgeScene::shadowEdge()) / texel + centre - EdgeScene::snappedEdge(512);
    if (std::abs(at) < 3.5) {
      EXPECT_NEAR(pixel.visibility, 0.5 + at / 9.0, 1e-2) << at;
    }
  }
}

TEST(Esm, OverDarkeningIsAPower) {
  const auto plain = edge(R"({"map_size": 256, "width": 9})");
  const auto squared = edge(R"({"map_size": 256, "width": 9, "over_darkening": 2})");
  for (std::size_t i = 0; i < plain.size(); ++i)
    ASSERT_NEAR(squared[i].visibility, plain[i].visibility * plain[i].visibility, 1e-3) << plain[i].at;
}

TEST(Esm, LeaksInUmbraMoreTheSmallerItsExponent) {
  const auto leak = [](int exponent) {
    return leakInUmbra(builtinSetup("layers", {240, 180}), "esm", fmt::format(R"({{"exponent": {}}})", exponent));
  };
  EXPECT_GT(leak(5), 0.01);
  EXPECT_GT(leak(5), 2.0 * leak(50));
}

}  // namespace
}  // namespace gnomon::test
