// The reference as the runner renders it: two halves that share the samples between them and nothing else.
#include <gtest/gtest.h>

#include <algorithm>

#include "gnomon/base/files.h"
#include "gnomon/run/reference.h"
#include "render.h"

namespace gnomon::test {
namespace {

ResolvedTechnique rayTraced(const std::string& parameters) {
  return {registry().open("ray_traced"), parametersOf("ray_traced", parameters)};
}

std::uint64_t pixelsIn(const Image& mask) {
  return static_cast<std::uint64_t>(std::count(mask.data.begin(), mask.data.end(), 1.0f));
}

TEST(ReferenceHalves, ShareTheSamplesThatWereAskedFor) {
  // The floor faces the whole source, which lies above it: no sample falls below a horizon, so that rays can be counted.
  Session session(builtinSetup("half_plane", {40, 30}));
  const RenderedReference reference = renderReference(session, registry(), {rayTraced(R"({"samples": 8})"), {}});
  session.runShared();
  ASSERT_GT(pixelsIn(session.receiverMask()), 0U);
  EXPECT_EQ(reference.rays, 8 * pixelsIn(session.receiverMask()));
}

TEST(ReferenceHalves, HaveSeedsOfTheirOwn) {
  Session session(builtinSetup("half_plane", {40, 30}));
  const RenderedReference reference = renderReference(session, registry(), {rayTraced(R"({"samples": 8})"), {}});
  EXPECT_NE(reference.halves.a.data, reference.halves.b.data);
}

TEST(ReferenceHalves, OfASourceWithoutExtentAreOneAndTheSame) {
  SessionSetup setup = builtinSetup("half_plane", {40, 30});
  setup.light.source = {};
  Session session(std::move(setup));
  const RenderedReference reference = renderReference(session, registry(), {rayTraced(R"({"samples": 8})"), {}});
  session.runShared();
  EXPECT_EQ(reference.halves.a.data, reference.halves.b.data);
  EXPECT_EQ(reference.rays, pixelsIn(session.receiverMask()));
}

TEST(ReferenceKey, HoldsTheCodeOfTechniqueAndFramework) {  // else a mended sampler would be judged by the old one's halves
  const Session session(builtinSetup("half_plane", {8, 6}));
  const ResolvedTechnique technique = rayTraced("{}");
  const std::string code =
      readFile(technique.technique.registered->library) + readFile(installationDirectory().parent_path() / "libgnomon.so");
  EXPECT_NE(referenceKey(session, technique).find(hashHex(code)), std::string::npos);
}

class Casters : public ::testing::TestWithParam<const char*> {};

TEST_P(Casters, ThatDoNotCastShadowNothing) {
  SessionSetup setup = builtinSetup("layers", {80, 60});
  const Image with = renderVisibility(setup, GetParam());
  ASSERT_LT(*std::min_element(with.data.begin(), with.data.end()), 0.5f);
  for (Instance& instance : setup.scene.instances) instance.casts = false;
  const Image without = renderVisibility(setup, GetParam());
  EXPECT_EQ(*std::min_element(without.data.begin(), without.data.end()), 1.0f);
}

INSTANTIATE_TEST_SUITE_P(Techniques, Casters, ::testing::Values("shadow_map", "pcf", "ray_traced"));

}  // namespace
}  // namespace gnomon::test
