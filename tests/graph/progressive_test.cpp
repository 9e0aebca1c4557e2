// The reference refined a slice at a time: however it is sliced, it is the reference.
#include "gnomon/run/progressive.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>

#include "bench.h"
#include "gl_calls.h"

namespace gnomon::test {
namespace {

using testing::Each;

constexpr double kWhole = 1e9;  ///< milliseconds: a round is one slice

ResolvedTechnique rayTraced(int samples) {
  return {registry().open("ray_traced"), parametersOf("ray_traced", fmt::format(R"({{"samples": {}}})", samples))};
}

SessionSetup smallSetup(const std::string& scene = "layers") {
  return builtinSetup(scene, {61, 45});
}

void finish(ProgressiveReference& reference, double budget = kWhole) {
  while (!reference.done()) reference.refine(budget);
}

/// The halves at the end.
ReferencePair refined(const SessionSetup& setup, int samples, double budget = kWhole) {
  ProgressiveReference reference(setup, rayTraced(samples), registry());
  finish(reference, budget);
  return reference.halves();
}

void expectSame(const ReferencePair& a, const ReferencePair& b) {
  EXPECT_TRUE(a.a.data == b.a.data);
  EXPECT_TRUE(a.b.data == b.b.data);
}

// --- it is the reference ---

class Unbiased : public testing::TestWithParam<const char*> {};

TEST_P(Unbiased, MeanIsThatOfTheReferenceWithinFourStandardErrors) {  // by chance once in 16000 seeds
  const SessionSetup setup = smallSetup(GetParam());
  const ReferencePair p = refined(setup, 256);
  Session session(setup);
  const ReferencePair r = renderReference(session, registry(), {rayTraced(256), {}}).halves;
  double difference = 0.0;
  double variance = 0.0;  // the mean of two halves has a quarter of the variance of their difference
  for (std::size_t i = 0; i < p.a.data.size(); ++i) {
    const auto sum = [&](const ReferencePair& pair) { return static_cast<double>(pair.a.data[i] + pair.b.data[i]); };
    const auto gap = [&](const ReferencePair& pair) { return static_cast<double>(pair.a.data[i] - pair.b.data[i]); };
    difference += 0.5 * (sum(p) - sum(r));
    variance += 0.25 * (gap(p) * gap(p) + gap(r) * gap(r));
  }
  ASSERT_GT(variance, 0.0);
  RecordProperty("z", fmt::format("{:.2f}", difference / std::sqrt(variance)));
  EXPECT_LT(std::abs(difference), 4.0 * std::sqrt(variance));
}

INSTANTIATE_TEST_SUITE_P(ProgressiveReference, Unbiased, testing::Values("layers", "half_plane", "pillars"));

TEST(ProgressiveReference, HalvesShareNoNoise) {  // nor do they with the reference's own
  const SessionSetup setup = smallSetup();
  const ReferencePair p = refined(setup, 64);
  Session session(setup);
  const ReferencePair r = renderReference(session, registry(), {rayTraced(4096), {}}).halves;
  double together = 0.0;
  double alone = 0.0;
  for (std::size_t i = 0; i < p.a.data.size(); ++i) {
    const double truth = 0.5 * static_cast<double>(r.a.data[i] + r.b.data[i]);
    const double a = static_cast<double>(p.a.data[i]) - truth;
    const double b = static_cast<double>(p.b.data[i]) - truth;
    together += a * b;
    alone += 0.5 * (a * a + b * b);
  }
  ASSERT_GT(alone, 0.0);
  EXPECT_LT(std::abs(together / alone), 0.15);  // 0 but for the truth's noise; 1 if seeds were shared
}

TEST(ProgressiveReference, TracesTheRaysItWasAskedFor) {
  const SessionSetup setup = smallSetup("half_plane");  // a floor below its source: no horizon cuts it
  ProgressiveReference reference(setup, rayTraced(75), registry());
  finish(reference);
  Session session(setup);
  session.runShared();
  const std::vector<float> mask = session.receiverMask().data;
  EXPECT_EQ(reference.wanted(), 74);  // two equal halves
  EXPECT_EQ(reference.samples(), reference.wanted());
  EXPECT_EQ(reference.rays(), 74U * static_cast<std::uint64_t>(std::count(mask.begin(), mask.end(), 1.0f)));
}

TEST(ProgressiveReference, LitAndUmbraAreExact) {
  const ReferencePair p = refined(smallSetup(), 150);
  EXPECT_THAT(p.a.data, testing::AllOf(testing::Contains(0.0f), testing::Contains(1.0f)));
}

// --- slices and rounds ---

TEST(ProgressiveReference, AnySlicingGivesTheSameBits) {
  expectSame(refined(smallSetup(), 64, 0.0), refined(smallSetup(), 64, kWhole));
}

TEST(ProgressiveReference, ASmallBudgetIsManyCalls) {
  ProgressiveReference reference(smallSetup(), rayTraced(32), registry());
  int calls = 0;
  int changes = 0;
  for (; !reference.done(); ++calls) changes += reference.refine(0.0) ? 1 : 0;
  EXPECT_GT(calls, 20);
  EXPECT_EQ(changes, 1);  // 16 rays for A, then 16 for B
}

TEST(ProgressiveReference, SamplesRiseByRounds) {
  ProgressiveReference reference(smallSetup(), rayTraced(96), registry());
  std::vector<int> seen;
  while (!reference.done()) {
    if (reference.refine(0.0)) seen.push_back(reference.samples());
  }
  EXPECT_THAT(seen, testing::ElementsAre(32, 48, 64, 80, 96));
}

TEST(ProgressiveReference, ADoneOneDoesNothing) {
  ProgressiveReference reference(smallSetup(), rayTraced(32), registry());
  finish(reference);
  const std::uint64_t rays = reference.rays();
  EXPECT_FALSE(reference.refine(kWhole));
  EXPECT_EQ(reference.rays(), rays);
}

TEST(ProgressiveReference, RefiningSetsNothingUp) {
  ProgressiveReference reference(smallSetup(), rayTraced(96), registry());
  const LinkedPrograms linked;
  finish(reference, 0.0);
  EXPECT_EQ(linked.count(), 0);
}

// --- moving ---

struct Move {
  const char* name;
  void (*apply)(SessionSetup&);
};

void PrintTo(const Move& move, std::ostream* out) {
  *out << move.name;
}

class MovedReference : public testing::TestWithParam<Move> {};

TEST_P(MovedReference, StartsOverAndGivesTheBitsOfAFreshOne) {
  SessionSetup setup = smallSetup("pillars");
  ProgressiveReference reference(setup, rayTraced(64), registry());
  while (reference.samples() == 0) reference.refine(0.0);
  GetParam().apply(setup);
  reference.moveCamera(setup.camera);
  reference.moveLight(setup.light);
  std::vector<glm::dmat4> worlds;
  for (const Instance& instance : setup.scene.instances) worlds.push_back(instance.world);
  reference.moveInstances(worlds);
  EXPECT_EQ(reference.samples(), 0);
  EXPECT_FALSE(reference.done());
  EXPECT_THAT(readTexture(*reference.visibility()).data, Each(1.0f));
  finish(reference, 0.0);  // small slices: some hold no receiver
  expectSame(reference.halves(), refined(setup, 64));
}

INSTANTIATE_TEST_SUITE_P(ProgressiveReference, MovedReference,
                         testing::Values(Move{"Nothing", [](SessionSetup&) {}},
                                         Move{"Light", [](SessionSetup& s) { s.light.position.x += 0.5; }},
                                         Move{"Camera", [](SessionSetup& s) { s.camera.position.y += 1.0; }},
                                         Move{"SkyBelow",
                                              [](SessionSetup& s) {
                                                s.camera.target.y = s.camera.position.y;
                                                s.camera.up = -s.camera.up;
                                              }},
                                         Move{"Instance",
                                              [](SessionSetup& s) {
                                                glm::dmat4& world = s.scene.instances.back().world;
                                                world = glm::translate(glm::dmat4(1.0), {0.2, 0.1, 0.0}) * world;
                                              }}),
                         [](const auto& each) { return std::string(each.param.name); });

// --- where little is to be done ---

TEST(ProgressiveReference, OfASourceWithoutExtentIsOneRay) {
  SessionSetup setup = smallSetup();
  setup.light.source = {};
  ProgressiveReference reference(setup, rayTraced(64), registry());
  EXPECT_EQ(reference.wanted(), 1);
  EXPECT_TRUE(reference.refine(kWhole));
  EXPECT_TRUE(reference.done());
  EXPECT_EQ(reference.samples(), 1);
  EXPECT_EQ(reference.halves().a.data, renderVisibility(setup, "ray_traced").data);
  EXPECT_EQ(reference.halves().b.data, reference.halves().a.data);
}

TEST(ProgressiveReference, WithoutReceiversInViewIsDoneAtOnce) {
  SessionSetup setup = smallSetup("half_plane");
  ProgressiveReference reference(setup, rayTraced(64), registry());
  Camera camera = setup.camera;
  camera.target = camera.position + glm::dvec3(0.0, 1.0, 1e-3);  // the sky
  reference.moveCamera(camera);
  EXPECT_TRUE(reference.refine(0.0));
  EXPECT_TRUE(reference.done());
  EXPECT_EQ(reference.samples(), reference.wanted());
  EXPECT_THAT(reference.halves().a.data, Each(1.0f));
  EXPECT_EQ(reference.rays(), 0U);
}

TEST(ProgressiveReference, WithoutReceiversInTheSceneIsDoneAtOnce) {
  SessionSetup setup = smallSetup("half_plane");
  for (Instance& instance : setup.scene.instances) instance.receives = false;
  ProgressiveReference reference(setup, rayTraced(64), registry());
  EXPECT_TRUE(reference.refine(0.0));
  EXPECT_TRUE(reference.done());
  EXPECT_THAT(reference.halves().b.data, Each(1.0f));
}

TEST(ProgressiveReference, ThatRefusesIsAnError) {
  SessionSetup setup = smallSetup();
  setup.light.type = LightType::point;
  setup.light.source = {};
  const ResolvedTechnique refusing{registry().open("shadow_map"), parametersOf("shadow_map", "{}")};
  EXPECT_THAT(errorOf([&] { ProgressiveReference(setup, refusing, registry()); }),
              testing::HasSubstr("the reference 'shadow_map' refuses"));
}

// --- what is read of it ---

TEST(ProgressiveReference, ShowsTheMeanOfItsHalves) {
  ProgressiveReference reference(smallSetup(), rayTraced(64), registry());
  const std::uint64_t before = reference.visibility()->revision;
  finish(reference);
  EXPECT_GT(reference.visibility()->revision, before);
  std::vector<float> mean = reference.halves().a.data;
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = 0.5f * (mean[i] + reference.halves().b.data[i]);
  EXPECT_EQ(readTexture(*reference.visibility()).data, mean);
}

TEST(ProgressiveReference, ClassesAreThoseOfItsHalvesOverAllReceivers) {
  const SessionSetup setup = smallSetup("pillars");
  ProgressiveReference reference(setup, rayTraced(64), registry());
  while (reference.samples() < 48) reference.refine(0.0);
  reference.refine(0.0);  // in the midst of a round: the session looks at some rows only
  Session session(setup);
  session.runShared();
  EXPECT_EQ(reference.classes().data, classesOf(session, receiverImages(session), reference.halves()).data);
}

TEST(ProgressiveReference, ClassesFollowItsHalves) {
  ProgressiveReference reference(smallSetup(), rayTraced(512), registry());
  while (reference.samples() == 0) reference.refine(0.0);
  const std::vector<float> early = reference.classes().data;
  finish(reference);
  EXPECT_NE(reference.classes().data, early);  // more rays find more penumbra
}

TEST(ProgressiveReference, ErrorIsThatOfItsHalvesAndClasses) {
  const SessionSetup setup = smallSetup();
  ProgressiveReference reference(setup, rayTraced(64), registry());
  finish(reference);
  const Image visibility = renderVisibility(setup, "pcf");
  EXPECT_EQ(reference.error(visibility),
            measureError(visibility, reference.halves().a, reference.halves().b, reference.classes()));
}

}  // namespace
}  // namespace gnomon::test
