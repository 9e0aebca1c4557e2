#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "map_edges.h"

namespace gnomon::test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

// The edge of half_plane

struct EdgeCase {
  std::string name;
  std::string parameters;
  Across across;

  friend void PrintTo(const EdgeCase& c, std::ostream* out) { *out << c.parameters; }
};

class ShadowMapEdge : public testing::TestWithParam<EdgeCase> {};

TEST_P(ShadowMapEdge, LiesWithinATexelOfGeometry) {
  const EdgeScene scene{.across = GetParam().across};
  Session session(scene.setup());
  const Slot slot = addSlot(session, "shadow_map", GetParam().parameters);
  session.frame(slot);
  const glm::dvec2 footprint = texelFootprint(session.facts(slot), dimensions::kSourceHeight);
  const double texel = GetParam().across == Across::x ? footprint.x : footprint.y;  // the light's Y lies along world Z
  EXPECT_NEAR(hardEdge(acrossEdge(session, slot, GetParam().across)), EdgeScene::shadowEdge(), texel);
}

INSTANTIATE_TEST_SUITE_P(Maps, ShadowMapEdge,
                         testing::Values(EdgeCase{"Square", "{}", Across::x}, EdgeCase{"SquareInZ", "{}", Across::z},
                                         EdgeCase{"Depth16", R"({"map_format": "d16"})", Across::x},
                                         EdgeCase{"Depth24", R"({"map_format": "d24"})", Across::x},
                                         EdgeCase{"Wide", R"({"map_size": [512, 128]})", Across::x},
                                         EdgeCase{"WideInZ", R"({"map_size": [512, 128]})", Across::z}),
                         [](const auto& test) { return test.param.name; });

TEST(ShadowMap, TexelFootprintIsTheConesWidthOverTheMapsSize) {  // what the bound above is made of
  Session session(EdgeScene{}.setup());
  const Slot slot = addSlot(session, "shadow_map", R"({"map_size": [512, 128]})");
  session.frame(slot);
  const double width = 2.0 * dimensions::kSourceHeight * std::tan(glm::radians(EdgeScene::kConeDegrees));
  const glm::dvec2 footprint = texelFootprint(session.facts(slot), dimensions::kSourceHeight);
  EXPECT_NEAR(footprint.x, width / 512.0, 1e-9);
  EXPECT_NEAR(footprint.y, width / 128.0, 1e-9);
}

TEST(ShadowMap, EdgeErrorFallsWithMapSize) {
  // The map moves the edge to the nearest boundary of texels: over sub-texel shifts the error is uniform within half a texel,
  // and its mean a quarter. The view's pixels, 0.25 mm, are 1/27 of the finest map's texel.
  constexpr int shifts = 32;
  const EdgeScene scene;
  Session session(scene.setup());
  const glm::dmat4 floor = session.scene().instances.at(0).world;
  const glm::dmat4 blocker = session.scene().instances.at(1).world;
  std::vector<double> logSize;
  std::vector<double> logError;
  for (const int size : {128, 256, 512, 1024, 2048}) {
    const Slot slot = addSlot(session, "shadow_map", fmt::format(R"({{"map_size": [{0}, {0}]}})", size));
    session.frame(slot);
    const double texel =
        texelFootprint(session.facts(slot), dimensions::kSourceHeight - EdgeScene::kBlockerHeight).x;  // at the blocker
    std::vector<double> errors;
    for (int i = 0; i < shifts; ++i) {
      const double shift = texel * i / shifts;
      session.moveInstances({floor, glm::translate(glm::dmat4(1.0), {shift, 0.0, 0.0}) * blocker});
      session.frame(slot);
      const double measured = hardEdge(acrossEdge(session, slot, Across::x));
      errors.push_back(std::abs(measured - EdgeScene::shadowEdge(dimensions::kHalfPlaneEdge + shift)));
    }
    logSize.push_back(std::log(size));
    logError.push_back(std::log(mean(errors)));
  }
  const double meanSize = mean(logSize);
  const double meanError = mean(logError);
  double sxy = 0.0;
  double sxx = 0.0;
  for (std::size_t i = 0; i < logSize.size(); ++i) {
    sxy += (logSize[i] - meanSize) * (logError[i] - meanError);
    sxx += (logSize[i] - meanSize) * (logSize[i] - meanSize);
  }
  RecordProperty("slope", std::to_string(sxy / sxx));
  EXPECT_NEAR(sxy / sxx, -1.0, 0.1);
}

// A lone plane, five degrees to the light: it has no shadow, and its depth changes by 11 texels across one texel

constexpr double kFiveDegrees = 5.0;

class LonePlane : public testing::TestWithParam<Glancing> {};

TEST_P(LonePlane, HasNoAcneByDefault) {
  for (const char* format : {"d16", "d24", "d32f"}) {
    EXPECT_EQ(
        shadowedShare(lonePlane(GetParam(), kFiveDegrees), "shadow_map", fmt::format(R"({{"map_format": "{}"}})", format)), 0.0)
        << format;
  }
}

TEST_P(LonePlane, HasAcneWithoutBias) {
  const double share =
      shadowedShare(lonePlane(GetParam(), kFiveDegrees), "shadow_map", R"({"bias.slope": 0, "bias.constant": 0})");
  RecordProperty("share", std::to_string(share));
  EXPECT_GT(share, 0.05);
}

TEST_P(LonePlane, HasAcneWithConstantBiasAlone) {  // so that it is the slope's bias that removes it
  EXPECT_GT(shadowedShare(lonePlane(GetParam(), kFiveDegrees), "shadow_map", R"({"bias.slope": 0})"), 0.05);
}

TEST_P(LonePlane, HasNoAcneWithNormalOffset) {
  // k texels along the normal are k sin / cos texels of depth, with the angle from the normal; the plane rises by at most half
  // that, sin / cos times half a texel, over each of the two directions to the corner of a texel.
  EXPECT_EQ(shadowedShare(lonePlane(GetParam(), kFiveDegrees), "shadow_map", R"({"bias.slope": 0, "bias.normal": 2})"), 0.0);
}

TEST_P(LonePlane, HasNoAcneWithReceiverPlane) {
  EXPECT_EQ(
      shadowedShare(lonePlane(GetParam(), kFiveDegrees), "shadow_map", R"({"bias.slope": 0, "bias.receiver_plane": true})"),
      0.0);
}

TEST_P(LonePlane, HasNoAcneInAMapWhoseTexelsAreNotSquare) {
  for (const char* size : {"[1024, 128]", "[128, 1024]"}) {
    for (const char* bias : {R"("bias.slope": 1)", R"("bias.slope": 0, "bias.receiver_plane": true)"}) {
      const std::string parameters = fmt::format(R"({{"map_size": {}, {}}})", size, bias);
      EXPECT_EQ(shadowedShare(lonePlane(GetParam(), kFiveDegrees), "shadow_map", parameters), 0.0) << parameters;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Lights, LonePlane, testing::Values(Glancing::directional, Glancing::spot),
                         [](const auto& test) { return test.param == Glancing::directional ? "directional" : "spot"; });

// Detachment: a wedge that touches the floor along a line, under a light at 45 degrees

constexpr double kWedge = 0.3;  // metres that the wedge rises for a metre away from the light

/// The floor is seen from below the wedge: an orthographic column along X over 0.4 m.
SessionSetup wedgeSetup() {
  SessionSetup setup = builtinSetup("half_plane", {4, 2048});
  glm::dmat4 shape(1.0);  // the unit quad to -1 <= x <= 0, y = -kWedge x, |z| <= 3
  shape[0] = {0.5, -0.5 * kWedge, 0.0, 0.0};
  shape[2] = {0.0, 0.0, 3.0, 0.0};
  shape[3] = {-0.5, 0.5 * kWedge, 0.0, 1.0};
  setup.scene.instances.at(1).world = shape;
  setup.light = {};
  setup.light.type = LightType::directional;
  setup.light.position = {5.0, 5.0, 0.0};
  setup.camera.type = CameraType::orthographic;
  setup.camera.position = {-3.15, 0.45, 0.0};
  setup.camera.target = {-0.15, 0.0, 0.0};
  setup.camera.height = 0.06;
  return setup;
}

struct Detachment {
  double gap = 0.0;    ///< largest distance along the light, from receiver to blocker, whose receiver is lit, metres
  double texel = 0.0;  ///< along the map's Y, metres
  double bound = 0.0;  ///< by facts
};

Detachment detachment(const std::string& parameters) {
  Session session(wedgeSetup());
  const Slot slot = addSlot(session, "shadow_map", parameters);
  session.frame(slot);
  const Image v = session.visibility(slot);
  const Facts facts = session.facts(slot);
  Detachment result;
  result.texel = facts.texel.y;
  double toCamera = 0.0;
  for (const ReceiverPoint& p : receiverPoints(session)) {
    if (p.position.x >= 0.0) continue;
    toCamera = std::max(toCamera, glm::length(p.position - session.camera().position));
    // The ray (x + t, t) meets y = -kWedge x at t = kWedge |x| / (1 + kWedge); its length is sqrt(2) t.
    const double gap = std::sqrt(2.0) * kWedge * -p.position.x / (1.0 + kWedge);
    if (v.at(p.x, p.y) > 0.0f) result.gap = std::max(result.gap, gap);
  }
  const double depth = 5.0 * std::sqrt(2.0);
  // The texel holds the wedge's depth at its centre, up to half a texel off; along the map the wedge's depth changes by
  // (1 - kWedge) / (1 + kWedge).
  result.bound = largestBias(facts, depth, std::sqrt(0.5), toCamera) + depthQuantum(facts, depth) +
                 0.5 * result.texel * (1.0 - kWedge) / (1.0 + kWedge);
  return result;
}

class ShadowMapDetachment : public testing::TestWithParam<const char*> {};

TEST_P(ShadowMapDetachment, IsAtMostTheStatedBias) {
  const Detachment d = detachment(GetParam());
  RecordProperty("detachment", fmt::format("{} m, bound {} m, texel {} m", d.gap, d.bound, d.texel));
  EXPECT_LE(d.gap, d.bound);
}

INSTANTIATE_TEST_SUITE_P(Biases, ShadowMapDetachment,
                         testing::Values(R"({})", R"({"bias.slope": 8})", R"({"bias.slope": 0, "bias.normal": 4})",
                                         R"({"bias.constant": 300, "map_format": "d16"})",
                                         R"({"bias.slope": 0, "bias.receiver_plane": true})"));

TEST(ShadowMap, SlopeBiasDetachesByTheReceiversSlope) {
  // The floor's depth changes by a texel across a texel here: a bias of 8 detaches by 8 texels, but for half a texel's change
  // of the wedge's depth.
  const Detachment d = detachment(R"({"bias.slope": 8, "bias.constant": 0})");
  EXPECT_NEAR(d.gap, 8.0 * d.texel, 0.5 * d.texel);
}

// What one planar map cannot do

TEST(ShadowMap, RefusesAPointLight) {
  SessionSetup setup = builtinSetup("square");
  setup.light.source = {};
  setup.light.type = LightType::point;
  Session session(std::move(setup));
  const Slot slot = addSlot(session, "shadow_map");
  EXPECT_THAT(session.support(slot).refusal, HasSubstr("point light"));
}

TEST(ShadowMap, RefusesAMapBeyondTheDriversLimitAndNamesIt) {
  Session session(builtinSetup("square"));
  const Slot slot = addSlot(session, "shadow_map", R"({"map_size": [65536, 64]})");
  EXPECT_THAT(session.support(slot).refusal, ContainsRegex("65536x64 .*limit of [0-9]+"));
}

TEST(ShadowMap, IsLitOutsideTheMap) {
  // A floor wholly under a roof, lit at 45 degrees from +X, its receivers moved along their normal by 64 texels times the sine
  // of the angle: across the map by half of 64 texels. Those nearest the border, which is 1 % beyond the floor, leave the map.
  SessionSetup setup = builtinSetup("half_plane");
  setup.scene.instances.at(1).world = glm::scale(glm::translate(glm::dmat4(1.0), {0.0, 1.0, 0.0}), {9.0, 1.0, 9.0});
  setup.light = {};
  setup.light.type = LightType::directional;
  setup.light.position = {5.0, 5.0, 0.0};
  setup.camera.position = {-1.0, 0.9, 0.0};
  setup.camera.target = {-3.0, 0.0, 0.0};
  Session session(std::move(setup));
  const Slot slot = addSlot(session, "shadow_map", R"({"bias.normal": 64})");
  session.frame(slot);
  const Image v = session.visibility(slot);
  const Facts facts = session.facts(slot);
  const double shift = 64.0 * std::max(facts.texel.x, facts.texel.y) * 0.5;
  const double border = 0.5 * facts.texel.y * facts.mapSize.y;
  int inside = 0;
  int outside = 0;
  for (const ReceiverPoint& p : receiverPoints(session)) {
    const double across = -p.position.x * std::sqrt(0.5) + shift;
    if (std::abs(across - border) < 1e-5) continue;  // rounding of positions
    const bool leaves = across > border;
    ++(leaves ? outside : inside);
    ASSERT_EQ(v.at(p.x, p.y), leaves ? 1.0f : 0.0f) << "at x = " << p.position.x;
  }
  EXPECT_GT(inside, 100);
  EXPECT_GT(outside, 100);
}

}  // namespace
}  // namespace gnomon::test
