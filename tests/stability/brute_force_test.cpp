// The suite's own truth against closed forms: what clipping decides, and what GroundTruth makes of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "closed_forms.h"
#include "gnomon/scene/builtin_dimensions.h"
#include "gnomon/stability/brute_force.h"
#include "gnomon/stability/cases.h"
#include "gnomon/stability/oracle.h"
#include "render.h"

namespace gnomon::test {
namespace {

using namespace stability;

Polygon rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0, 0.0}, {x1, y0, 0.0}, {x1, y1, 0.0}, {x0, y1, 0.0}};
}

TEST(Covers, TwoTrianglesCoverTheirSquare) {
  EXPECT_TRUE(covers(std::vector<Polygon>{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}}},
                     rectangle(0, 0, 1, 1)));
}

TEST(Covers, WindingDoesNotMatter) {
  EXPECT_TRUE(covers(std::vector<Polygon>{{{-1, -1, 0}, {-1, 3, 0}, {3, -1, 0}}}, rectangle(0, 0, 1, 1)));
}

TEST(Covers, AGapOfAThousandthIsFound) {
  EXPECT_FALSE(covers(std::vector<Polygon>{rectangle(0, 0, 0.5, 1), rectangle(0.501, 0, 1, 1)}, rectangle(0, 0, 1, 1)));
}

TEST(Covers, AHoleInTheMiddleIsFound) {
  const std::vector<Polygon> frame{rectangle(0, 0, 1, 0.4), rectangle(0, 0.6, 1, 1), rectangle(0, 0, 0.4, 1),
                                   rectangle(0.6, 0, 1, 1)};
  EXPECT_FALSE(covers(frame, rectangle(0, 0, 1, 1)));
}

TEST(Covers, NothingCoversNothing) {
  EXPECT_FALSE(covers({}, rectangle(0, 0, 1, 1)));
}

TEST(ClippedTriangle, KeepsWhatAHalfSpaceHolds) {  // of a right triangle of area 2, x >= 1 keeps a quarter
  const HalfSpace half{{1.0, 0.0, 0.0}, -1.0};
  const Polygon kept = clippedTriangle({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, std::span(&half, 1));
  ASSERT_EQ(kept.size(), 3U);
  double area = 0.0;
  for (std::size_t i = 0; i < 3; ++i) area += 0.5 * (kept[i].x * kept[(i + 1) % 3].y - kept[(i + 1) % 3].x * kept[i].y);
  EXPECT_NEAR(area, 0.5, 1e-15);
}

TEST(NearestFace, IsAsNearAsTheNearestOfManyPointsOnIt) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto point = [&] { return glm::dvec3(unit(random), unit(random), unit(random)); };
  for (int i = 0; i < 50; ++i) {
    Face face{point(), point(), point(), {}};
    face.normal = glm::normalize(glm::cross(face.b - face.a, face.c - face.a));
    const glm::dvec3 p = 2.0 * point();
    double sampled = 1e9;
    constexpr int kSteps = 200;
    for (int u = 0; u <= kSteps; ++u) {
      for (int v = 0; u + v <= kSteps; ++v) {
        sampled =
            std::min(sampled, glm::length(face.a + (face.b - face.a) * (u / 200.0) + (face.c - face.a) * (v / 200.0) - p));
      }
    }
    const NearestFace found = nearestFace(std::span(&face, 1), p, face.normal);
    EXPECT_LE(found.distance, sampled + 1e-12);
    EXPECT_NEAR(glm::length(found.point - p), found.distance, 1e-12);
    EXPECT_GE(found.distance, sampled - 3.0 / kSteps);  // points of the grid lie at most half of its diagonal apart
  }
}

/// A built-in scene's receivers on the floor, as the suite judges them.
std::vector<ReceiverPoint> floorOf(const std::string& scene) {
  const SessionSetup setup = builtinSetup(scene, {96, 96});
  Session session(setup);
  session.runShared();
  const GroundTruth truth(setup, session.positions(), session.normals(), session.receiverMask());
  EXPECT_TRUE(truth.faults().empty()) << truth.faults().front();
  std::vector<ReceiverPoint> floor;
  for (const ReceiverPoint& r : truth.receivers()) {
    if (std::abs(r.position.y) < 1e-6) floor.push_back(r);
  }
  return floor;
}

/// One G-buffer of a hard case, to be damaged.
struct Picture {
  SessionSetup setup = findCase("light_above_up_parallel")->make();
  Image positions, normals, mask;

  Picture() {
    ensureContext();
    Session session(setup);
    session.runShared();
    positions = session.positions();
    normals = session.normals();
    mask = session.receiverMask();
  }
  std::vector<std::string> faults() const { return GroundTruth(setup, positions, normals, mask).faults(); }
};

TEST(GroundTruth, FindsNoFaultInAGoodPicture) {
  EXPECT_TRUE(Picture().faults().empty());
}

TEST(GroundTruth, NoticesAMaskThatLacksAReceiver) {
  Picture picture;
  *std::find(picture.mask.data.begin(), picture.mask.data.end(), 1.0f) = 0.0f;
  ASSERT_EQ(picture.faults().size(), 1U);
  EXPECT_EQ(picture.faults()[0].rfind("the receiver mask is 0", 0), 0U) << picture.faults()[0];
}

TEST(GroundTruth, NoticesAMaskThatHoldsTheBackground) {
  Picture picture;
  std::size_t background = 0;
  while (picture.positions.data[4 * background + 3] != 0.0f) ++background;
  picture.mask.data[background] = 1.0f;
  ASSERT_EQ(picture.faults().size(), 1U);
  EXPECT_NE(picture.faults()[0].find("where there is no geometry"), std::string::npos) << picture.faults()[0];
}

TEST(GroundTruth, NoticesAPositionATenthOfAMillimetreOff) {
  Picture picture;
  const auto pixel =
      static_cast<std::size_t>(std::find(picture.mask.data.begin(), picture.mask.data.end(), 1.0f) - picture.mask.data.begin());
  for (std::size_t c = 0; c < 3; ++c) picture.positions.data[4 * pixel + c] += 1e-4f * picture.normals.data[4 * pixel + c];
  ASSERT_EQ(picture.faults().size(), 1U);
  EXPECT_NE(picture.faults()[0].find("off every surface"), std::string::npos) << picture.faults()[0];
}

/// Lit where V is 1, dark where V is 0, and nowhere else.
void expectAgreement(const std::vector<ReceiverPoint>& floor, const std::function<double(const glm::dvec3&)>& closedForm) {
  std::size_t lit = 0;
  std::size_t dark = 0;
  for (const ReceiverPoint& r : floor) {
    const double v = closedForm(r.position);
    if (r.truth != Certainty::open) {
      ASSERT_EQ(v, r.truth == Certainty::lit ? 1.0 : 0.0) << r.position.x << ' ' << r.position.z;
    }
    lit += r.truth == Certainty::lit ? 1U : 0U;
    dark += r.truth == Certainty::dark ? 1U : 0U;
  }
  const auto is = [&](double value) {
    return static_cast<std::size_t>(
        std::count_if(floor.begin(), floor.end(), [&](const auto& r) { return closedForm(r.position) == value; }));
  };
  EXPECT_GT(lit, 100U);
  EXPECT_GT(dark, 100U);
  // Pixels are centimetres apart and positions right to micrometres: hardly one falls between.
  EXPECT_GE(lit + 2, is(1.0));
  EXPECT_GE(dark + 2, is(0.0));
}

TEST(GroundTruth, AgreesWithTheHalfPlane) {
  const closed_form::SourceAxis source{dimensions::kSourceHeight, 0.0, 1.0};
  expectAgreement(floorOf("half_plane"), [&](const glm::dvec3& p) {
    return closed_form::halfPlaneRectangle(p.x, dimensions::kHalfPlaneEdge, 1.0, source);
  });
}

TEST(GroundTruth, AgreesWithOverlappingStrips) {  // two blockers that only together hide the source
  const closed_form::SourceAxis source{dimensions::kSourceHeight, 0.0, 1.0};
  const auto strip = [](const dimensions::Strip& s) { return closed_form::Strip{s.height, {s.left, s.right}}; };
  const std::array<closed_form::Strip, 2> both{strip(dimensions::kLowerStrip), strip(dimensions::kUpperStrip)};
  std::vector<ReceiverPoint> floor = floorOf("strips");
  std::size_t wrong = 0;
  for (const ReceiverPoint& r : floor) {
    const double v = closed_form::strips(r.position.x, both, source);
    if (r.truth == Certainty::lit && v != 1.0) ++wrong;
    if (r.truth == Certainty::dark && v > 1e-12) ++wrong;
  }
  EXPECT_EQ(wrong, 0U);
}

}  // namespace
}  // namespace gnomon::test
