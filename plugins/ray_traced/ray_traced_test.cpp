// What the closed forms of tests/analytic do not see: the same picture by brute force, how many rays are cast, and seeds.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <map>

#include "gnomon/scene/look_at.h"

#include "agreement.h"
#include "gnomon/base/parallel.h"
#include "render.h"

namespace gnomon::test {
namespace {

/// A frame of one slot: V, rays, and the receivers.
struct Traced {
  Image visibility;
  std::uint64_t rays = 0;
  std::vector<ReceiverPoint> points;
};

Traced trace(Session& session, int samples, int seed = 0) {
  const Slot slot = addSlot(session, "ray_traced", fmt::format(R"({{"samples": {}, "seed": {}}})", samples, seed));
  const FrameReport report = session.frame(slot);
  Traced result{session.visibility(slot), report.technique.counters.rays, receiverPoints(session)};
  session.removeSlots();
  return result;
}

Traced trace(SessionSetup setup, int samples, int seed = 0) {
  ensureContext();
  Session session(std::move(setup));
  return trace(session, samples, seed);
}

// Brute force

/// Whether the segment from `from` to `to` meets the triangle (Moeller and Trumbore 1997, in double).
bool meets(const Triangle& triangle, const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 e1 = triangle.b - triangle.a;
  const glm::dvec3 e2 = triangle.c - triangle.a;
  const glm::dvec3 direction = to - from;
  const glm::dvec3 p = glm::cross(direction, e2);
  const double determinant = glm::dot(e1, p);
  if (determinant == 0.0) return false;  // in the triangle's plane
  const glm::dvec3 s = from - triangle.a;
  const double u = glm::dot(s, p) / determinant;
  const glm::dvec3 q = glm::cross(s, e1);
  const double v = glm::dot(direction, q) / determinant;
  const double t = glm::dot(e2, q) / determinant;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 && t < 1.0;
}

std::vector<Triangle> casters(const Scene& scene) {
  std::vector<Triangle> triangles;
  for (const Instance& instance : scene.instances) {
    for (std::size_t t = 0; t < scene.meshes[instance.mesh].triangles() && instance.casts; ++t) {
      triangles.push_back(worldTriangle(scene, instance, t));
    }
  }
  return triangles;
}

/// A point over spheres that float, and over pillars that touch the floor, seen from near: some 0.05 m a pixel.
SessionSetup pointSetup(const std::string& scene = "sphere_grid", const std::string& parameters = R"({"count": 3})",
                        const glm::dvec3& camera = {0.0, 2.5, 3.5}) {
  SessionSetup setup = builtinSetup(scene, {96, 72}, parameters);
  setup.light.source = {};
  setup.light.type = LightType::point;
  setup.camera.position = camera;
  return setup;
}

class BruteForce : public testing::TestWithParam<std::string> {};

TEST_P(BruteForce, LoopOverAllTrianglesGivesTheSamePicture) {
  Session session(GetParam() == "pillars" ? pointSetup("pillars", R"({"count": 9})", {3.0, 3.5, 3.0}) : pointSetup());
  const Traced traced = trace(session, 1);
  const Image normals = session.normals();
  const std::vector<Triangle> triangles = casters(session.scene());
  const glm::dvec3 light = session.light().position;

  // The tracer's vertices and origins are floats: off by 2^-24 of some 20 m, and lifted off the receiver's plane by 16 times
  // that, 2e-5 m. Where origins moved by up to twice as much disagree, rounding decides, and the pixel is not judged.
  constexpr double lift = 4e-5;
  std::vector<int> verdicts(traced.points.size());  // 0 dark, 1 lit, -1 not judged
  parallelFor(traced.points.size(), [&](std::size_t i) {
    const ReceiverPoint& p = traced.points[i];
    const glm::dvec3 n(normals.at(p.x, p.y, 0), normals.at(p.x, p.y, 1), normals.at(p.x, p.y, 2));
    const Axes around = axesAround(n);
    int lit = 0;
    int tried = 0;
    for (const glm::dvec3& shift : {n * (0.25 * lift), n * lift, n * lift + around.x * lift, n * lift - around.x * lift,
                                    n * lift + around.y * lift, n * lift - around.y * lift}) {
      const glm::dvec3 from = p.position + shift;
      ++tried;
      lit += std::none_of(triangles.begin(), triangles.end(), [&](const Triangle& t) { return meets(t, from, light); }) ? 1 : 0;
    }
    verdicts[i] = lit == tried ? 1 : lit == 0 ? 0 : -1;
  });

  std::map<int, int> counts;
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    ++counts[verdicts[i]];
    const ReceiverPoint& p = traced.points[i];
    if (verdicts[i] < 0) continue;
    EXPECT_EQ(traced.visibility.at(p.x, p.y), static_cast<float>(verdicts[i])) << "pixel " << p.x << ' ' << p.y;
  }
  RecordProperty("verdicts", fmt::format("{} dark, {} lit, {} undecided", counts[0], counts[1], counts[-1]));
  EXPECT_GT(counts[0], 300);
  EXPECT_GT(counts[1], 300);
  // Some 30 m of shadow edges, 1e-4 m wide, over pixels of 0.05 m: one or two of the picture's 6912 pixels.
  EXPECT_LE(counts[-1], 7);
}

INSTANTIATE_TEST_SUITE_P(RayTraced, BruteForce, testing::Values("sphere_grid", "pillars"),
                         [](const auto& test) { return test.param; });

// Rays

TEST(RayTraced, BuildsOverTheCastersTrianglesAndNoOthers) {
  SessionSetup setup = builtinSetup("pillars", {16, 12});
  setup.scene.instances.back().casts = false;
  std::uint64_t triangles = 0;
  for (const Instance& instance : setup.scene.instances) {
    if (instance.casts) triangles += setup.scene.meshes[instance.mesh].indices.size() / 3;
  }
  Session session(std::move(setup));
  const Slot slot = addSlot(session, "ray_traced");
  EXPECT_EQ(session.frame(slot).technique.counters.primitives, triangles);
}

TEST(RayTraced, CastsOneRayAReceiverWithoutExtent) {
  const Traced traced = trace(pointSetup(), 64);
  EXPECT_EQ(traced.rays, traced.points.size());
}

TEST(RayTraced, CastsAllSamplesAtASourceWithExtent) {
  const Traced traced = trace(builtinSetup("half_plane", {80, 60}), 12);  // a floor below its source: no horizon cuts it
  EXPECT_EQ(traced.rays, 12 * traced.points.size());
}

TEST(RayTraced, CastsOneRayWhereThePlanFindsNoPenumbra) {
  SessionSetup setup = builtinSetup("half_plane", {80, 60}, R"({"source_size": 1e-6})");
  const Traced traced = trace(std::move(setup), 12);
  EXPECT_EQ(traced.rays, traced.points.size());
}

TEST(RayTraced, ShowsTheSourcesCentreWhereThePenumbraIsForcedOff) {
  SessionSetup forced = builtinSetup("half_plane", {80, 60});
  forced.overrides[Effect::penumbra] = Toggle::off;
  SessionSetup centre = builtinSetup("half_plane", {80, 60});
  centre.light.source = {};
  const Traced a = trace(std::move(forced), 12);
  const Traced b = trace(std::move(centre), 12);
  EXPECT_EQ(a.rays, a.points.size());
  EXPECT_EQ(a.visibility.data, b.visibility.data);
}

// Seeds

TEST(RayTraced, SameSeedSameBits) {
  EXPECT_EQ(trace(builtinSetup("square", {80, 60}), 8, 5).visibility.data,
            trace(builtinSetup("square", {80, 60}), 8, 5).visibility.data);
}

TEST(RayTraced, OtherSeedsOtherNoise) {
  Session session(builtinSetup("square", {80, 60}));
  const Traced a = trace(session, 8, 5);
  const Traced b = trace(session, 8, 6);
  // Noise at 8 samples is of the order of one sample: pixels of a penumbra mostly differ by some eighths or not at all.
  int penumbra = 0;
  int different = 0;
  for (const ReceiverPoint& p : a.points) {
    const float first = a.visibility.at(p.x, p.y);
    penumbra += first > 0.0f && first < 1.0f ? 1 : 0;
    different += first != b.visibility.at(p.x, p.y) ? 1 : 0;
  }
  EXPECT_GT(penumbra, 100);
  EXPECT_GT(different, penumbra / 4);
}

// The receiver's horizon

/// A wall in z = 0 facing +Z, nothing else, under a square source of edge 1 of which a quarter lies behind the wall's plane.
SessionSetup loneWallSetup() {
  SessionSetup setup = builtinSetup("half_plane", {80, 60});
  setup.scene.instances.resize(1);
  setup.scene.instances[0].world = glm::rotate(glm::dmat4(1.0), glm::radians(90.0), {1.0, 0.0, 0.0});
  setup.light.position = {0.0, 4.0, 0.25};
  setup.light.target = {0.0, 0.0, 0.25};
  setup.camera.position = {0.0, 0.0, 3.0};
  setup.camera.target = {0.0, 0.0, 0.0};
  return setup;
}

TEST(RayTraced, SamplesBelowTheHorizonDoNotDarken) {
  const Traced traced = trace(loneWallSetup(), 32);
  ASSERT_GT(traced.points.size(), 1000u);
  for (const ReceiverPoint& p : traced.points) ASSERT_EQ(traced.visibility.at(p.x, p.y), 1.0f);
}

TEST(RayTraced, SamplesBelowTheHorizonAreNotTraced) {
  // The horizon falls between two of the 32 strata: 24 samples lie above it, but for those within the 5e-5 m by which origins
  // are lifted: 5e-5 of a stratum's 1/32 m, in 0.2 % of the pixels.
  const Traced traced = trace(loneWallSetup(), 32);
  const auto receivers = static_cast<double>(traced.points.size());
  EXPECT_NEAR(static_cast<double>(traced.rays), 24.0 * receivers, 0.005 * receivers);
}

TEST(RayTraced, SourceOfAnySizeAndDistanceGivesFiniteVisibility) {  // Embree's floats end at 1e38, their squares at 1e19
  for (const double size : {1e-300, 1e-30, 1e19, 1e38, 1e60, 1e300}) {
    SessionSetup setup = builtinSetup("layers", {24, 18});
    setup.light.source.size = {size, 1.0};
    const Image visibility = renderVisibility(std::move(setup), "ray_traced", R"({"samples": 4})");
    for (const float v : visibility.data) ASSERT_TRUE(v >= 0.0f && v <= 1.0f) << "source of " << size << " m";
  }
}

}  // namespace
}  // namespace gnomon::test
