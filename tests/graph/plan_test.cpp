// What the effect plan's rules change in what runs, each on both sides of its threshold, and that nothing else changes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include "bench.h"
#include "gnomon/run/resolve.h"
#include "gnomon/scene/builtin.h"

namespace gnomon::test {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;

std::uint64_t maskPixels(const Session& session) {
  const Image mask = session.receiverMask();
  return static_cast<std::uint64_t>(std::count(mask.data.begin(), mask.data.end(), 1.0f));
}

const PlanDecision& decision(const Session& session, Effect effect) {
  return session.plan().decisions[planIndex(effect)];
}
const PlanDecision& decision(const Session& session, Rule rule) {
  return session.plan().decisions[planIndex(rule)];
}

// --- penumbra: how many rays the reference casts ---

constexpr std::uint64_t kSamples = 8;

/// half_plane: the source is overhead, so that all of it lies above every receiver's horizon and every sample is a ray.
std::uint64_t raysPerMaskPixel(const SessionSetup& setup) {
  Session session(setup);
  const Slot slot = addSlot(session, "ray_traced", R"({"samples": 8})");
  const std::uint64_t rays = session.frame(slot).technique.counters.rays;
  EXPECT_EQ(rays % maskPixels(session), 0U);
  return rays / maskPixels(session);
}

SessionSetup halfPlane(double sourceSize) {
  SessionSetup setup = builtinSetup("half_plane", {60, 45});
  setup.light.source.size = glm::dvec2(sourceSize);
  return setup;
}

double widestPenumbra(const SessionSetup& setup) {
  return survey(setup.scene, setup.light, setup.camera, setup.outputSize).widestPenumbraPixels;
}

/// The source's edge at which the widest penumbra is `pixels`: it grows with the source.
double sourceSizeFor(double pixels) {
  double low = 0.0;
  double high = 1.0;
  while (high - low > 1e-12) {
    const double middle = 0.5 * (low + high);
    (widestPenumbra(halfPlane(middle)) < pixels ? low : high) = middle;
  }
  return low;
}

TEST(PlanPenumbra, WithoutExtentTheReferenceCastsOneRayAPixel) {
  SessionSetup setup = halfPlane(1.0);
  setup.light.source = {};
  EXPECT_EQ(raysPerMaskPixel(setup), 1U);
}

TEST(PlanPenumbra, WithExtentItCastsAsManyAsAsked) {
  EXPECT_EQ(raysPerMaskPixel(halfPlane(1.0)), kSamples);
}

TEST(PlanPenumbra, JustUnderHalfAPixelItCastsOneRay) {
  const SessionSetup setup = halfPlane(sourceSizeFor(0.4999));
  ASSERT_NEAR(widestPenumbra(setup), 0.4999, 1e-6);
  EXPECT_EQ(raysPerMaskPixel(setup), 1U);
}

TEST(PlanPenumbra, JustOverHalfAPixelItCastsAsManyAsAsked) {
  const SessionSetup setup = halfPlane(sourceSizeFor(0.5001));
  ASSERT_NEAR(widestPenumbra(setup), 0.5001, 1e-6);
  EXPECT_EQ(raysPerMaskPixel(setup), kSamples);
}

TEST(PlanPenumbra, ForcedOnItSearchesANarrowOneToo) {
  SessionSetup setup = halfPlane(sourceSizeFor(0.4999));
  setup.overrides[Effect::penumbra] = Toggle::on;
  EXPECT_EQ(raysPerMaskPixel(setup), kSamples);
}

TEST(PlanPenumbra, TheDecisionTellsTheNumber) {
  Session session(halfPlane(sourceSizeFor(0.4999)));
  EXPECT_FALSE(decision(session, Effect::penumbra).on);
  EXPECT_NEAR(decision(session, Effect::penumbra).value, 0.4999, 1e-6);
  EXPECT_THAT(decision(session, Effect::penumbra).reason, HasSubstr("0.4999"));
}

// --- receivers: whether anything runs ---

/// One triangle that faces up, and a light `height` above its plane.
SessionSetup oneTriangle(double height) {
  SessionSetup setup = builtinSetup("layers", {40, 30});
  setup.scene = {};
  Mesh mesh;
  mesh.positions = {{-1, 0, 1}, {1, 0, 1}, {0, 0, -1}};
  mesh.normals = std::vector<glm::vec3>(3, {0, 1, 0});
  mesh.indices = {0, 1, 2};
  setup.scene.meshes = {mesh};
  setup.scene.materials = {{}};
  setup.scene.instances = {{"triangle", 0, 0, glm::dmat4(1.0), true, true}};
  setup.camera.target = glm::dvec3(0.0);
  setup.light.position = {0.0, height, 0.0};
  setup.light.target = {0.0, height > 0.0 ? -10.0 : 10.0, 0.0};
  return setup;
}

class PlanReceivers : public testing::TestWithParam<const char*> {};

TEST_P(PlanReceivers, WithoutAFacingTriangleNothingRunsAndAllIsLit) {
  Session session(oneTriangle(-1e-3));
  const Slot slot = addSlot(session, GetParam());
  const FrameReport report = session.frame(slot);
  EXPECT_EQ(decision(session, Rule::receivers).value, 0.0);
  EXPECT_EQ(report.technique.counters.passesRun, 0U);
  EXPECT_EQ(report.technique.counters.passesSkipped, 0U);
  EXPECT_THAT(session.passNames(slot), IsEmpty());
  EXPECT_THAT(session.visibility(slot).data, Each(1.0f));
}

TEST_P(PlanReceivers, OneFacingTriangleMakesItRun) {
  Session session(oneTriangle(1e-3));
  const Slot slot = addSlot(session, GetParam());
  EXPECT_EQ(decision(session, Rule::receivers).value, 1.0);
  EXPECT_GT(session.frame(slot).technique.counters.passesRun, 0U);
}

TEST_P(PlanReceivers, ForcedOnTheyRunToTheSamePicture) {
  SessionSetup setup = oneTriangle(-1e-3);
  setup.overrides[Rule::receivers] = Toggle::on;
  Session session(setup);
  const Slot slot = addSlot(session, GetParam());
  EXPECT_GT(session.frame(slot).technique.counters.passesRun, 0U);
  EXPECT_THAT(session.visibility(slot).data, Each(1.0f));
}

INSTANTIATE_TEST_SUITE_P(Techniques, PlanReceivers, testing::Values("unshadowed", "shadow_map", "pcf", "ray_traced"),
                         [](const auto& p) { return std::string(p.param); });

// --- the plan of a whole motion ---

TEST(PlanUnion, ALightThatWillFaceReceiversMakesItRunFromTheStart) {
  SessionSetup setup = oneTriangle(-1.0);
  setup.lightPoses = {setup.light, oneTriangle(1.0).light};
  Session session(setup);
  const Slot slot = addSlot(session, "shadow_map");
  session.frame(slot);
  EXPECT_TRUE(session.plan().has(Rule::receivers));
  EXPECT_THAT(session.visibility(slot).data, Each(1.0f));  // the mask is empty at this pose
  EXPECT_EQ(maskPixels(session), 0U);
}

TEST(PlanUnion, AtThatPoseThePictureIsThatOfASessionMadeThere) {
  SessionSetup there = builtinSetup("layers", {80, 60});
  SessionSetup moving = there;
  moving.light.position = {-1.0, -7.0, 0.6};
  moving.lightPoses = {moving.light, there.light};
  std::vector<float> moved;
  {
    Session session(moving);
    const Slot slot = addSlot(session, "shadow_map");
    session.frame(slot);
    session.moveLight(there.light);
    session.frame(slot);
    moved = session.visibility(slot).data;
  }
  EXPECT_EQ(moved, renderVisibility(there, "shadow_map").data);
  EXPECT_THAT(moved, testing::Contains(0.0f));
}

// --- culling: on a named view, configs/culling.json ---

SessionSetup cornerView() {
  ensureContext();
  Problems problems;
  const std::vector<ResolvedRun> runs =
      resolveRuns(std::filesystem::path(GNOMON_SOURCE_DIR) / "configs/culling.json", registry(), problems);
  problems.throwIfAny();
  SessionSetup setup;
  setup.scene = runs.at(0).scene;
  setup.light = runs.at(0).lights.at(0);
  setup.camera = runs.at(0).camera;
  setup.outputSize = runs.at(0).config.output.size;
  return setup;
}

/// sphere_grid from close to one corner: most of its 81 spheres shadow only what is not in the picture.
SessionSetup cornerView(Toggle culling) {
  SessionSetup setup = cornerView();
  setup.overrides[Rule::culling] = culling;
  return setup;
}

struct Drawn {
  FrameCounters counters;
  std::vector<float> visibility;
};

Drawn draw(const SessionSetup& setup, const std::string& technique, const std::string& parameters = "{}") {
  Session session(setup);
  const Slot slot = addSlot(session, technique, parameters);
  const FrameCounters counters = session.frame(slot).technique.counters;
  return {counters, session.visibility(slot).data};
}

TEST(PlanCulling, AtLeastHalvesTheDepthPassOfTheCornerView) {
  const Drawn culled = draw(cornerView(Toggle::automatic), "shadow_map");
  const Drawn all = draw(cornerView(Toggle::off), "shadow_map");
  RecordProperty("culled", static_cast<int>(culled.counters.primitives));
  RecordProperty("all", static_cast<int>(all.counters.primitives));
  EXPECT_EQ(all.counters.primitives, 81U * 760U + 2U);
  EXPECT_LE(2 * culled.counters.primitives, all.counters.primitives);
}

TEST(PlanCulling, TheCornerViewHasShadowsToGetWrong) {
  EXPECT_THAT(draw(cornerView(Toggle::automatic), "shadow_map").visibility, testing::Contains(0.0f).Times(testing::Gt(1000)));
}

class PlanCullingBits : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(PlanCullingBits, AreTheSameWithoutIt) {
  const auto& [technique, parameters] = GetParam();
  EXPECT_TRUE(draw(cornerView(Toggle::automatic), technique, parameters).visibility ==
              draw(cornerView(Toggle::off), technique, parameters).visibility);
}

INSTANTIATE_TEST_SUITE_P(Techniques, PlanCullingBits,
                         testing::Values(std::pair("shadow_map", R"({"map_format": "d32f"})"),
                                         std::pair("shadow_map", R"({"map_format": "d16", "map_size": 64})"),
                                         std::pair("shadow_map", R"({"bias.normal": 3, "map_size": 128})"),
                                         std::pair("pcf", R"({"taps": 5})"),
                                         std::pair("pcf", R"({"taps": 31, "spread": 4, "map_size": 256})")),
                         [](const auto& p) { return std::string(p.param.first) + "_" + std::to_string(p.index); });

/// A camera close over the floor and a quad high up that its frustum does not reach, whose shadow lies in the picture.
SessionSetup casterOutsideTheView() {
  SessionSetup setup = builtinSetup("layers", {120, 90});
  Scene& scene = setup.scene;
  scene.instances.resize(1);  // the floor
  Instance quad;
  quad.name = "high";
  quad.world = glm::scale(glm::translate(glm::dmat4(1.0), {-2.0, 4.0, 0.0}), {0.4, 1.0, 0.4});
  scene.instances.push_back(quad);
  setup.light = {};
  setup.light.position = {-4.0, 8.0, 0.0};  // the quad is half way to the origin
  setup.light.coneHalfAngleDegrees = 45.0;
  setup.camera = {};
  setup.camera.position = {0.0, 2.0, 2.5};
  return setup;
}

TEST(PlanCulling, KeepsACasterOutsideTheViewThatShadowsInside) {
  const SessionSetup setup = casterOutsideTheView();
  Session session(setup);
  const Slot slot = addSlot(session, "shadow_map");
  const FrameReport report = session.frame(slot);
  // The frustum does not meet the quad: one of its planes has all corners outside.
  const auto planes = frustumPlanes(setup.camera, 120.0 / 90.0);
  const Bounds& quad = session.survey().instanceBounds.at(1);
  const bool outside = std::any_of(planes.begin(), planes.end(), [&](const glm::dvec4& plane) {
    for (int i = 0; i < 8; ++i) {
      if (glm::dot(glm::dvec3(plane), quad.corner(i) - setup.camera.position) + plane.w >= 0.0) return false;
    }
    return true;
  });
  ASSERT_TRUE(outside);
  EXPECT_EQ(report.technique.counters.primitives, 4U);  // floor and quad
  EXPECT_THAT(session.visibility(slot).data, testing::Contains(0.0f).Times(testing::Gt(500)));
}

TEST(PlanCulling, ThatShadowIsWhereTheReferenceHasIt) {
  const Image reference = renderVisibility(casterOutsideTheView(), "ray_traced");
  const Image mapped = renderVisibility(casterOutsideTheView(), "shadow_map", R"({"map_size": 4096})");
  // A texel is 2 tan(45) 9 m / 4096 = 4 mm here, a third of a pixel: only pixels beside an edge of the reference may differ.
  for (int y = 1; y + 1 < reference.height; ++y) {
    for (int x = 1; x + 1 < reference.width; ++x) {
      if (besideAnEdge(reference, x, y)) continue;
      ASSERT_EQ(mapped.at(x, y), reference.at(x, y)) << "pixel (" << x << ", " << y << ")";
    }
  }
}

// --- skipping ---

TEST(PlanSkipping, ForcedOffLeavesTheSameBits) {
  SessionSetup setup = cornerView();
  setup.overrides[Rule::skipping] = Toggle::off;
  std::vector<float> second;
  {
    Session session(setup);
    const Slot slot = addSlot(session, "pcf");
    session.frame(slot);
    const FrameReport report = session.frame(slot);
    EXPECT_EQ(report.technique.counters.passesRun, 3U);
    EXPECT_EQ(report.technique.counters.passesSkipped, 0U);
    second = session.visibility(slot).data;
  }
  EXPECT_TRUE(second == draw(cornerView(), "pcf").visibility);
}

}  // namespace
}  // namespace gnomon::test
