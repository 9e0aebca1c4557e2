// What a record says of the reference, against what can be had without it: rays by counting, the standard error by rendering
// again, the cosine floor by integrals in closed form.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <vector>

#include "closed_forms.h"
#include "gnomon/base/statistics.h"
#include "gnomon/run/reference.h"
#include "gnomon/scene/builtin_dimensions.h"
#include "render.h"
#include "temporary_folder.h"

namespace gnomon::test {
namespace {

constexpr double kEdgeHeight = 1.0;

SessionSetup halfPlane() {
  return builtinSetup("half_plane", {64, 48}, R"({"blocker_height": 1.0, "source_size": 2.0})");
}

struct Recorded {
  ReceiverImages receivers;
  RenderedReference reference;
  ReferenceRecord record;
};

Recorded record(Session& session, const std::string& parameters) {
  const ResolvedTechnique technique{registry().open("ray_traced"), parametersOf("ray_traced", parameters)};
  Recorded result{{}, renderReference(session, registry(), {technique, {}}), {}};
  session.runShared();
  result.receivers = receiverImages(session);
  result.record = referenceRecord(session, result.receivers, result.reference);
  return result;
}

std::vector<std::size_t> receiversOf(const Image& mask) {
  std::vector<std::size_t> pixels;
  for (std::size_t i = 0; i < mask.pixels(); ++i) {
    if (mask.data[i] > 0.5f) pixels.push_back(i);
  }
  return pixels;
}

using Quad = std::array<glm::dvec3, 4>;

/// Seen from the origin (van Oosterom and Strackee 1983), steradians.
double solidAngleOf(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 u = glm::normalize(a);
  const glm::dvec3 v = glm::normalize(b);
  const glm::dvec3 w = glm::normalize(c);
  return 2.0 * std::abs(std::atan2(glm::dot(u, glm::cross(v, w)), 1.0 + glm::dot(u, v) + glm::dot(v, w) + glm::dot(w, u)));
}
double solidAngleOf(const Quad& q) {
  return solidAngleOf(q[0], q[1], q[2]) + solidAngleOf(q[0], q[2], q[3]);
}

/// Integral of N.w over the quad's directions from the origin (Lambert 1760); all of it above the horizon.
double cosineIntegral(const Quad& q, const glm::dvec3& normal) {
  double sum = 0.0;
  for (std::size_t k = 0; k < q.size(); ++k) {
    const glm::dvec3& a = q[k];
    const glm::dvec3& b = q[(k + 1) % q.size()];
    const glm::dvec3 across = glm::cross(a, b);
    const double sine = glm::length(across);
    if (sine > 0.0) sum += 0.5 * std::atan2(sine, glm::dot(a, b)) * glm::dot(normal, across) / sine;
  }
  return std::abs(sum);
}

/// The part of half_plane's source that is above `low`, relative to a point of the floor.
Quad sourceAbove(double low, double size, const glm::dvec3& from) {
  const double h = 0.5 * size;
  const double left = std::clamp(low, -h, h);
  const double y = dimensions::kSourceHeight;
  Quad quad{{{left, y, -h}, {h, y, -h}, {h, y, h}, {left, y, h}}};
  for (glm::dvec3& corner : quad) corner -= from;
  return quad;
}

/// The difference between N.L V and the integral over what is visible, in closed form; root mean square.
double exactCosineFloor(const Session& session, const ReceiverImages& receivers, bool hasBlocker) {
  const double size = session.light().source.size.x;
  const glm::dvec3 centre(0.0, dimensions::kSourceHeight, 0.0);
  double sum = 0.0;
  const std::vector<std::size_t> pixels = receiversOf(receivers.mask);
  for (const std::size_t i : pixels) {
    const SurfacePoint at = surfacePoint(session, receivers, i);
    const double edge =
        hasBlocker ? closed_form::projectToSource(at.position.x, dimensions::kHalfPlaneEdge, kEdgeHeight, centre.y) : -size;
    const Quad seen = sourceAbove(edge, size, at.position);
    const double v = (seen[1].x - seen[0].x) / size;
    const double exact = cosineIntegral(seen, at.normal) / solidAngleOf(sourceAbove(-size, size, at.position));
    sum += std::pow(glm::dot(at.normal, glm::normalize(centre - at.position)) * v - exact, 2);
  }
  return std::sqrt(sum / static_cast<double>(pixels.size()));
}

TEST(ReferenceRecord, RaysAreSamplesTimesReceivers) {  // none falls below the floor's horizon
  Session session(halfPlane());
  const Recorded fixed = record(session, R"({"samples": 64})");
  const std::uint64_t all = 64 * receiversOf(fixed.receivers.mask).size();
  EXPECT_EQ(fixed.record.rays, all);
  EXPECT_EQ(fixed.record.raysSaved, 0U);
  const Recorded adaptive = record(session, R"({"samples": 64, "standard_error": 0.05})");
  EXPECT_EQ(adaptive.record.rays.value() + adaptive.record.raysSaved.value(), all);
  EXPECT_LT(adaptive.record.rays.value(), all / 2);
}

TEST(ReferenceRecord, StandardErrorIsThatOfBothHalvesTogether) {
  constexpr int seeds = 16;
  Session session(builtinSetup("pillars", {64, 48}));
  std::vector<std::vector<double>> values;
  double said = 0.0;
  for (int seed = 0; seed < seeds; ++seed) {
    const Recorded recorded = record(session, fmt::format(R"({{"samples": 128, "seed": {}}})", seed));
    const std::vector<std::size_t> pixels = receiversOf(recorded.receivers.mask);
    values.resize(pixels.size());
    const auto& [a, b] = recorded.reference.halves;
    for (std::size_t k = 0; k < pixels.size(); ++k) values[k].push_back(0.5 * (a.data[pixels[k]] + b.data[pixels[k]]));
    said += std::pow(recorded.record.standardError.value(), 2) / seeds;
  }
  double seen = 0.0;
  for (const std::vector<double>& v : values) seen += variance(v) / static_cast<double>(values.size());
  const double ratio = std::sqrt(said / seen);
  RecordProperty("ratio", fmt::format("{:.2f}", ratio));
  EXPECT_GT(ratio, 0.95);            // never too hopeful
  EXPECT_LT(ratio, std::sqrt(8.0));  // the most that runs, eight to a half, are less even than both halves
}

TEST(ReferenceRecord, StandardErrorIsLessThanAHalfsByTheRootOfTwo) {
  Session session(builtinSetup("pillars", {64, 48}));
  const Recorded recorded = record(session, R"({"samples": 128})");
  const Slot slot = addSlot(session, "ray_traced", R"({"samples": 64, "statistics": true})");
  session.frame(slot);
  const Image statistics = session.statistics(slot).value();
  double sum = 0.0;
  const std::vector<std::size_t> pixels = receiversOf(recorded.receivers.mask);
  for (const std::size_t i : pixels) sum += std::pow(statistics.data[2 * i], 2);
  const double half = std::sqrt(sum / static_cast<double>(pixels.size()));
  EXPECT_NEAR(recorded.record.standardError.value() / half, std::sqrt(0.5), 0.02);
}

TEST(ReferenceRecord, AdaptiveStandardErrorIsTheOneThatWasAskedFor) {
  constexpr double target = 0.02;
  Session session(halfPlane());
  const Recorded recorded = record(session, fmt::format(R"({{"samples": 8192, "standard_error": {}}})", target));
  const auto& error = recorded.reference.standardError;
  const float greatest = *std::max_element(error.data.begin(), error.data.end());
  EXPECT_LE(greatest, 2.0 * target);
  EXPECT_GE(greatest, 0.5 * target);  // no more rays than needed
}

/// The reference of a run config, its parameters those.
Json parametersOfReference(const std::string& parameters) {
  const TemporaryFolder folder;
  folder.write("run.json", fmt::format(R"({{"scene": {{"builtin": "square"}}, "techniques": [{{"technique": "pcf"}}],
                                            "reference": {{"technique": "ray_traced", "parameters": {}}}}})",
                                       parameters));
  Problems problems;
  const std::vector<ResolvedRun> runs = resolveRuns(folder / "run.json", registry(), problems);
  problems.throwIfAny();
  return runs.at(0).reference.parametersJson();
}

TEST(ReferenceOfARunConfig, StopsEarlyUnlessANumberOfSamplesWasAskedFor) {
  const Json usual = parametersOfReference("{}");
  EXPECT_EQ(usual.at("samples"), 4096);
  EXPECT_EQ(usual.at("standard_error"), 0.0025);
  const Json fixed = parametersOfReference(R"({"samples": 64})");
  EXPECT_EQ(fixed.at("samples"), 64);
  EXPECT_EQ(fixed.at("standard_error"), 0.0);
  const Json coarse = parametersOfReference(R"({"standard_error": 0.05})");
  EXPECT_EQ(coarse.at("samples"), 4096);
  EXPECT_EQ(coarse.at("standard_error"), 0.05);
}

TEST(ReferenceRecord, CosineFloorOfAnEmptySceneIsThatOfTheSourcesShape) {
  SessionSetup setup = halfPlane();
  setup.scene.instances.at(1).casts = false;
  Session session(std::move(setup));
  const Recorded recorded = record(session, R"({"samples": 16})");
  const double exact = exactCosineFloor(session, recorded.receivers, false);
  RecordProperty("floor", fmt::format("{:.5f}", exact));
  EXPECT_GT(exact, 0.005);
  EXPECT_NEAR(recorded.record.cosineFloor.value(), exact, 0.02 * exact);
}

TEST(ReferenceRecord, CosineFloorBehindAnEdgeIsThatOfTheVisiblePart) {
  Session session(halfPlane());
  const Recorded recorded = record(session, R"({"samples": 4096})");
  const double exact = exactCosineFloor(session, recorded.receivers, true);
  RecordProperty("floor", fmt::format("{:.5f}, closed form {:.5f}", recorded.record.cosineFloor.value(), exact));
  EXPECT_GT(exact, 0.005);
  EXPECT_NEAR(recorded.record.cosineFloor.value(), exact, 0.02 * exact);
}

TEST(ReferenceRecord, CosineFloorOfASmallSourceIsNothing) {
  Session session(builtinSetup("half_plane", {64, 48}, R"({"blocker_height": 1.0, "source_size": 0.01})"));
  EXPECT_LT(record(session, R"({"samples": 64})").record.cosineFloor.value(), 1e-3);
}

}  // namespace
}  // namespace gnomon::test
