#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>

#include "map_edges.h"

namespace gnomon::test {
namespace {

using closed_form::boxFilteredTexels;

/// Positions reach the map through floats: a tap so near the border of a texel may fall on either side.
constexpr double kRoundingTexels = 1e-3;

bool nearTexelBorder(double texel) {
  return std::abs(texel - std::round(texel)) < kRoundingTexels;
}

class PcfKernel : public testing::TestWithParam<int> {
 protected:
  static int taps() { return GetParam(); }
};

TEST_P(PcfKernel, GivesMultiplesOfOneTapAndNothingElse) {
  const Image v = renderVisibility(builtinSetup("sphere_grid", {120, 90}, R"({"count": 3})"), "pcf",
                                   fmt::format(R"({{"taps": {}, "map_size": [256, 256]}})", taps()));
  const std::set<float> values(v.data.begin(), v.data.end());
  EXPECT_LE(values.size(), static_cast<std::size_t>(taps() * taps() + 1));
  EXPECT_GT(values.size(), static_cast<std::size_t>(taps() + 1))
      << "edges that run across the map give more than one axis does";
  for (const float value : values) {
    const float count = value * static_cast<float>(taps() * taps());
    EXPECT_NEAR(count, std::round(count), 1e-3f) << value;  // 961 taps times the rounding of a float
  }
}

/// half_plane across its edge, every pixel against the taps counted by geometry. Texels run with X, and against Z.
void expectBoxFilteredTexels(Across across, int taps, double spread, glm::ivec2 mapSize) {
  const EdgeScene scene{.across = across};
  Session session(scene.setup());
  const Slot slot = addSlot(
      session, "pcf", fmt::format(R"({{"taps": {}, "spread": {}, "map_size": [{}, {}]}})", taps, spread, mapSize.x, mapSize.y));
  session.frame(slot);
  const int size = across == Across::x ? mapSize.x : mapSize.y;
  // Which texels the blocker covers: those whose centre's ray meets it. Rasterisation snaps vertices to 1/256 of a texel.
  const double edge =
      EdgeScene::texelOf(dimensions::kHalfPlaneEdge, dimensions::kSourceHeight - EdgeScene::kBlockerHeight, size);
  ASSERT_FALSE(std::abs(edge - 0.5 - std::round(edge - 0.5)) < 1.0 / 128.0)
      << "the edge passes a texel's centre: choose another size";
  const int firstLit = static_cast<int>(std::ceil(edge - 0.5));
  int judged = 0;
  int between = 0;
  for (const EdgePixel& pixel : acrossEdge(session, slot, across)) {
    const double texel = EdgeScene::texelOf(pixel.at, dimensions::kSourceHeight, size);
    if (nearTexelBorder(texel - 0.5 * spread * (taps - 1))) continue;
    const double expected = across == Across::x ? boxFilteredTexels(texel, firstLit, taps, spread)
                                                : 1.0 - boxFilteredTexels(size - texel, size - firstLit, taps, spread);
    ASSERT_NEAR(pixel.visibility, expected, 1e-6) << "at " << pixel.at << ", texel " << texel << ", first lit " << firstLit;
    ++judged;
    between += expected > 0.0 && expected < 1.0 ? 1 : 0;
  }
  EXPECT_GT(judged, scene.output.x * 9 / 10);
  EXPECT_GT(between, 20);
}

TEST_P(PcfKernel, StraightEdgeIsTheBoxFilteredStepOfTheMapsOwnEdge) {
  expectBoxFilteredTexels(Across::x, taps(), 1.0, {1024, 1024});
}

INSTANTIATE_TEST_SUITE_P(Taps, PcfKernel, testing::Values(2, 3, 4, 5, 9, 19, 31));

TEST(Pcf, EdgeAcrossTheMapsOtherAxis) {
  expectBoxFilteredTexels(Across::z, 3, 1.0, {256, 1024});
  expectBoxFilteredTexels(Across::z, 4, 1.0, {256, 1024});
}

TEST(Pcf, SpreadOfTwoReadsEveryOtherTexel) {
  expectBoxFilteredTexels(Across::x, 5, 2.0, {1024, 1024});
  expectBoxFilteredTexels(Across::x, 4, 2.0, {1024, 1024});
}

// Energy: a filter moves shadow about, and keeps its amount

/// A quad 2 m above a wide floor, its shadow clear of it as seen from straight above: 1.5 <= x <= 2.5, |z| <= 0.5.
SessionSetup squareShadowSetup() {
  SessionSetup setup = builtinSetup("half_plane", {800, 600});
  setup.scene.instances.at(0).world = glm::scale(glm::dmat4(1.0), {8.0, 1.0, 8.0});
  setup.scene.instances.at(1).world = glm::scale(glm::translate(glm::dmat4(1.0), {0.0, 2.0, 0.0}), {0.25, 1.0, 0.25});
  setup.light.source = {};
  setup.light.position = {-2.0, dimensions::kSourceHeight, 0.0};
  setup.light.target = {-2.0, 0.0, 0.0};
  setup.camera.type = CameraType::orthographic;
  setup.camera.position = {2.0, 3.0, 0.0};
  setup.camera.target = {2.0, 0.0, 0.0};
  setup.camera.height = 4.5;
  return setup;
}

double sumOfShadow(const std::string& technique, const std::string& parameters) {
  const Image v = renderVisibility(squareShadowSetup(), technique, parameters);
  double sum = 0.0;
  for (const float value : v.data) sum += 1.0 - value;
  return sum;
}

TEST_P(PcfKernel, KeepsTheHardShadowsAmount) {
  // The hard shadow is a rectangle of whole texels, and the filtered one the mean of N^2 copies of it, shifted by whole or half
  // texels. Of a rectangle w by h pixels wide, pixel centres hit floor(w) or ceil(w) columns and floor(h) or ceil(h) rows.
  const double pixel = 4.5 / 600.0;
  const double texel = 2.0 * dimensions::kSourceHeight * std::tan(glm::radians(60.0)) / 256.0;
  const double hard = sumOfShadow("shadow_map", R"({"map_size": [256, 256]})");
  const double side = std::round(1.0 / texel) * texel / pixel;  // 1 m, snapped: 18 or 19 texels
  ASSERT_NEAR(std::sqrt(hard), side, 1.0 + texel / pixel);
  const double widest = side + texel / pixel;
  const double bound = std::pow(std::ceil(widest), 2) - std::pow(std::ceil(widest) - 1.0, 2);
  const double soft = sumOfShadow("pcf", fmt::format(R"({{"taps": {}, "map_size": [256, 256]}})", taps()));
  RecordProperty("sums", fmt::format("{} {} bound {}", hard, soft, bound));
  EXPECT_NEAR(soft, hard, bound);
}

// Wide kernels on inclined planes

class PcfOnLonePlane : public testing::TestWithParam<Glancing> {};

TEST_P(PcfOnLonePlane, WidestKernelHasNoAcne) {
  for (const double elevation : {5.0, 20.0, 60.0}) {
    EXPECT_EQ(shadowedShare(lonePlane(GetParam(), elevation), "pcf", R"({"taps": 31, "bias.curvature": 0})"), 0.0)
        << elevation << " degrees";
  }
}

TEST_P(PcfOnLonePlane, WidestKernelHasAcneWithoutTheReceiversPlane) {
  EXPECT_GT(shadowedShare(lonePlane(GetParam(), 20.0), "pcf",
                          R"({"taps": 31, "bias.curvature": 0, "bias.receiver_plane": false, "bias.slope": 1})"),
            0.05);
}

INSTANTIATE_TEST_SUITE_P(Lights, PcfOnLonePlane, testing::Values(Glancing::directional, Glancing::spot),
                         [](const auto& test) { return test.param == Glancing::directional ? "directional" : "spot"; });

TEST(Pcf, TapsOutsideTheMapAreLit) {
  // A floor wholly under a roof: V is the share of taps that leave the map of 32 texels, up to half of them.
  constexpr int taps = 31;
  constexpr int mapSize = 32;
  constexpr double coneDegrees = 35.0;
  SessionSetup setup = builtinSetup("half_plane");
  setup.scene.instances.at(1).world = glm::scale(glm::translate(glm::dmat4(1.0), {0.0, 1.0, 0.0}), {9.0, 1.0, 9.0});
  setup.light.source = {};
  setup.light.coneHalfAngleDegrees = coneDegrees;
  setup.camera.position = {0.0, 0.9, 2.0};
  setup.camera.target = {-1.0, 0.0, 0.0};
  Session session(std::move(setup));
  const Slot slot =
      addSlot(session, "pcf", fmt::format(R"({{"taps": {0}, "map_size": [{1}, {1}], "bias.curvature": 0}})", taps, mapSize));
  session.frame(slot);
  const Image v = session.visibility(slot);
  const auto texelOf = [&](double x) {
    return (0.5 * x / (dimensions::kSourceHeight * std::tan(glm::radians(coneDegrees))) + 0.5) * mapSize;
  };
  const auto inside = [&](double texel) {
    int count = 0;
    for (int i = 0; i < taps; ++i) {
      const double tap = texel + i - 0.5 * (taps - 1);
      count += tap >= 0.0 && tap < mapSize ? 1 : 0;
    }
    return count;
  };
  int judged = 0;
  int leaving = 0;
  for (const ReceiverPoint& p : receiverPoints(session)) {
    const glm::dvec2 texel(texelOf(p.position.x), texelOf(-p.position.z));
    if (nearTexelBorder(texel.x) || nearTexelBorder(texel.y)) continue;
    const double expected = 1.0 - static_cast<double>(inside(texel.x) * inside(texel.y)) / (taps * taps);
    ASSERT_NEAR(v.at(p.x, p.y), expected, 1e-6) << "at " << p.position.x << ' ' << p.position.z;
    ++judged;
    leaving += expected > 0.25 ? 1 : 0;
  }
  EXPECT_GT(judged, 1000);
  EXPECT_GT(leaving, 1000);
}

}  // namespace
}  // namespace gnomon::test
