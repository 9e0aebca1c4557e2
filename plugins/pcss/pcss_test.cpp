#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "map_edges.h"

namespace gnomon::test {
namespace {

constexpr double kSource = 0.4;  ///< edge of the square source, metres
constexpr double kWide = dimensions::kSourceHeight;

/// The row across half_plane's edge, its blocker at `height`, the shadow's edge in the middle. The light is `behind` metres
/// behind the edge, so that the shadow's edge is clear of the blocker as seen from above.
std::vector<EdgePixel> rowAt(double height, const std::string& technique, const std::string& parameters,
                             double source = kSource, double behind = 0.3, double coneDegrees = 30.0) {
  SessionSetup setup = builtinSetup("half_plane", {1024, 4}, fmt::format(R"({{"blocker_height": {}}})", height));
  setup.scene.instances.at(0).world = glm::scale(glm::dmat4(1.0), {4.0, 1.0, 4.0});
  setup.light.source.size = glm::dvec2(source);
  if (source == 0.0) setup.light.source = {};
  setup.light.coneHalfAngleDegrees = coneDegrees;
  setup.light.target = {-behind, 0.0, 0.0};
  setup.light.position = {-behind, kWide, 0.0};
  const double edge = -behind + behind * kWide / (kWide - height);
  setup.camera.type = CameraType::orthographic;
  setup.camera.target = {edge, 0.0, 0.0};
  setup.camera.position = {edge, 3.5, 0.0};
  setup.camera.up = {0.0, 0.0, -1.0};
  const double penumbra = kSource * height / (kWide - height);
  setup.camera.height = 1.4 * std::max(penumbra, 0.02) * 4.0 / 1024.0;
  ensureContext();
  Session session(std::move(setup));
  const Slot slot = addSlot(session, technique, parameters);
  session.frame(slot);
  return acrossEdge(session, slot, Across::x);
}

/// Twice the way from V = 1/4 to V = 3/4: the width of a linear ramp.
double widthOf(const std::vector<EdgePixel>& row) {
  const auto where = [&](double v) {
    for (std::size_t i = 1; i < row.size(); ++i) {
      if (row[i - 1].visibility <= v && row[i].visibility > v) return row[i].at;
    }
    throw Error("the row does not cross the penumbra");
  };
  return 2.0 * (where(0.75) - where(0.25));
}

const char* const kFine = R"({"map_size": 2048, "taps": 41, "search_taps": 33, "widest": 1024})";

class PcssHeight : public testing::TestWithParam<int> {};

TEST_P(PcssHeight, PenumbraIsAsWideAsSimilarTrianglesSay) {
  const double height = 0.3 * std::pow(10.0, GetParam() / 9.0);  // 0.3 to 3 m
  const double expected = kSource * height / (kWide - height);
  EXPECT_NEAR(widthOf(rowAt(height, "pcss", kFine)), expected, 0.1 * expected) << "blocker at " << height << " m";
}

INSTANTIATE_TEST_SUITE_P(TenHeights, PcssHeight, testing::Range(0, 10));

TEST(Pcss, HardensToNothingAtContact) {
  const double texel = 2.0 * kWide * std::tan(glm::radians(45.0)) / 2048.0;
  EXPECT_LT(widthOf(rowAt(0.05, "pcss", kFine, kSource, 2.0, 45.0)), 2.5 * texel);
}

TEST(Pcss, WithoutExtentItIsTheHardShadowOfItsBiases) {
  const std::string biases = R"("bias.slope": 0, "bias.curvature": 1, "bias.receiver_plane": true)";
  const auto soft = rowAt(1.0, "pcss", R"({"map_size": 512})", 0.0);
  const auto hard = rowAt(1.0, "shadow_map", "{\"map_size\": 512, " + biases + "}", 0.0);
  for (std::size_t i = 0; i < soft.size(); ++i) ASSERT_EQ(soft[i].visibility, hard[i].visibility) << soft[i].at;
}

TEST(Pcss, ForEveryRepresentationItIsTheSameHardShadowWithoutExtent) {
  const auto over = [](const std::string& technique) { return rowAt(1.0, technique, R"({"map_size": 512})", 0.0); };
  const auto hard = rowAt(1.0, "shadow_map", R"({"map_size": 512, "bias.slope": 0, "bias.receiver_plane": true})", 0.0);
  for (const char* technique : {"pcss_vsm", "pcss_esm"}) {
    const auto row = over(technique);
    for (std::size_t i = 0; i < row.size(); ++i) ASSERT_EQ(row[i].visibility, hard[i].visibility) << technique << " " << i;
  }
}

TEST(Pcss, ASourceRolledByAQuarterIsThatOfTheOtherProportions) {
  const auto under = [](glm::dvec2 size, double roll) {
    SessionSetup setup = builtinSetup("pillars");
    setup.light.source = {.shape = SourceShape::rectangle, .size = size, .rollDegrees = roll};
    return renderVisibility(setup, "pcss");
  };
  const Image upright = under({0.2, 2.0}, 0.0);
  EXPECT_LT(meanDifference(under({2.0, 0.2}, 90.0), upright), 0.1 * meanDifference(under({2.0, 0.2}, 0.0), upright));
}

TEST(Pcss, UnderADirectionalLightThePenumbraIsThatOfItsDisc) {
  // Of a disc the middle half of V lies within 0.404 radii of its centre (A.2), each radius h tan(delta/2) on the floor (A.7).
  constexpr double kDegrees = 8.0;
  const double radius = 1.0 * std::tan(glm::radians(kDegrees / 2.0));
  SessionSetup setup = builtinSetup("half_plane", {1024, 4}, R"({"blocker_height": 1})");
  setup.scene.instances.at(0).world = glm::scale(glm::dmat4(1.0), {4.0, 1.0, 4.0});
  setup.light = {};
  setup.light.type = LightType::directional;
  setup.light.position = {0.0, kWide, 0.0};
  setup.light.angularDiameterDegrees = kDegrees;
  setup.camera.type = CameraType::orthographic;
  setup.camera.target = {0.1, 0.0, 0.0};
  setup.camera.position = {0.1, 0.9, 0.0};
  setup.camera.up = {0.0, 0.0, -1.0};
  setup.camera.height = 0.5 * 4.0 / 1024.0;
  ensureContext();
  Session session(std::move(setup));
  const Slot slot = addSlot(session, "pcss", kFine);
  session.frame(slot);
  // Straight above, the blocker hides its own half of the shadow from this camera: what is seen is the lit half.
  const auto row = acrossEdge(session, slot, Across::x);
  const auto three = std::find_if(row.begin(), row.end(), [](const EdgePixel& p) { return p.visibility > 0.75; });
  ASSERT_NE(three, row.end());
  EXPECT_NEAR(three->at, 0.404 * radius, 0.08 * radius);
}

TEST(Pcss, TapsWeighAlikeInEveryRepresentation) {  // of four taps a wrong mean would favour one
  const SessionSetup setup = builtinSetup("pillars");
  EXPECT_LT(meanDifference(renderVisibility(setup, "pcss_esm", R"({"exponent": 5000, "taps": 2})"),
                           renderVisibility(setup, "pcss", R"({"taps": 2})")),
            2e-3);
}

TEST(Pcss, ItsBiasGrowsWithItsKernel) {
  // The kernel's radius on the receiver is (d - b) w / 2 b: times the curvature it passes the blocker from 2 b / w = 24 on.
  const auto with = [](const char* curvature) {
    return renderVisibility(builtinSetup("pillars"), "pcss", fmt::format(R"({{"bias.curvature": {}}})", curvature));
  };
  const Image without = with("0");
  EXPECT_LT(meanDifference(with("4"), without), 2e-3);
  EXPECT_GT(meanDifference(with("64"), without), 1e-2);
}

TEST(Pcss, SeveralBlockersAreTakenForOne) {
  ensureContext();
  Session session(builtinSetup("pillars"));
  EXPECT_EQ(session.support(addSlot(session, "pcss")).ignored, std::vector<Effect>{Effect::overlappingPenumbrae});
}

TEST(Pcss, AMapThatIsNotSquareGivesTheSamePenumbrae) {
  const auto with = [](const char* size) {
    return renderVisibility(builtinSetup("layers"), "pcss", fmt::format(R"({{"map_size": {}}})", size));
  };
  EXPECT_LT(meanDifference(with("[4096, 256]"), with("[256, 256]")), 5e-3);
}

TEST(Pcss, SteepExponentialsAreNoDarkerThanComparisons) {  // each tap is compared with the receiver's plane
  const SessionSetup setup = builtinSetup("pillars");
  EXPECT_LT(meanDifference(renderVisibility(setup, "pcss_esm", R"({"exponent": 1000})"), renderVisibility(setup, "pcss")),
            5e-3);
}

TEST(Pcss, EveryRepresentationFindsThePenumbra) {
  // Variance is exact for one blocker over one receiver; exponentials fall short of a linear ramp by their steepness.
  const double expected = kSource * 1.0 / (kWide - 1.0);
  const std::string fine = R"({"map_size": 1024, "taps": 33, "search_taps": 33, "widest": 512, "bleeding_reduction": 0})";
  EXPECT_NEAR(widthOf(rowAt(1.0, "pcss_vsm", fine)), expected, 0.1 * expected);
  const std::string steep = R"({"map_size": 1024, "taps": 33, "search_taps": 33, "widest": 512, "exponent": 1000})";
  EXPECT_NEAR(widthOf(rowAt(1.0, "pcss_esm", steep)), expected, 0.1 * expected);
}

}  // namespace
}  // namespace gnomon::test
