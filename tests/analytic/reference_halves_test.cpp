// The reference as the runner renders it: two halves that share the samples between them and nothing else.
#include <gtest/gtest.h>

#include <algorithm>

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

}  // namespace
}  // namespace gnomon::test
