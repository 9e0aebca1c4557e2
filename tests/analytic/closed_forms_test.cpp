// The closed forms against counting: rays from the receiver to the midpoints of a grid over the source, and a test of where
// each crosses the blockers' planes. The counting shares no formula with what it checks.
#include "closed_forms.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

namespace gnomon::closed_form {
namespace {

constexpr double kHeight = 5.0;
constexpr SourceAxis kSourceX{kHeight, 0.3, 1.4};
constexpr SourceAxis kSourceY{kHeight, -0.2, 0.8};
constexpr int kGrid = 800;
/// An edge along an axis misplaces at most one row of the grid, two edges two; a curved one far less, on average.
constexpr double kTolerance = 2.0 / kGrid;

/// Whether a blocker holds the point where a ray crosses the plane at `height`.
using Solid = std::function<bool(const std::function<glm::dvec2(double height)>& crossing)>;
using Shines = std::function<bool(glm::dvec2 onSource)>;

double counted(
    glm::dvec2 receiver, const Solid& solid, const Shines& shines = [](glm::dvec2) { return true; }) {
  int all = 0;
  int visible = 0;
  for (int j = 0; j < kGrid; ++j) {
    for (int i = 0; i < kGrid; ++i) {
      const glm::dvec2 onSource = {kSourceX.centre + kSourceX.width * ((i + 0.5) / kGrid - 0.5),
                                   kSourceY.centre + kSourceY.width * ((j + 0.5) / kGrid - 0.5)};
      if (!shines(onSource)) continue;
      ++all;
      visible += solid([&](double height) { return receiver + (onSource - receiver) * (height / kHeight); }) ? 0 : 1;
    }
  }
  return static_cast<double>(visible) / all;
}

constexpr std::array kReceivers = {-1.2, -0.45, -0.1, 0.2, 0.33, 0.9};

TEST(ClosedForms, ProjectionKeepsReceiverBlockerAndImageOnOneLine) {
  const double image = projectToSource(0.5, 0.8, 2.0, 5.0);
  EXPECT_DOUBLE_EQ((image - 0.5) / 5.0, (0.8 - 0.5) / 2.0);
}

TEST(ClosedForms, HalfPlaneRectangle) {
  for (const double x : kReceivers) {
    EXPECT_NEAR(halfPlaneRectangle(x, 0.1, 2.0, kSourceX), counted({x, 0.0}, [](const auto& at) { return at(2.0).x < 0.1; }),
                kTolerance)
        << x;
  }
}

TEST(ClosedForms, PenumbraIsLinearBetweenItsEnds) {
  // V is 0 where the ray to the source's far end just misses the edge, 1 where that to its near end does.
  const double width = penumbraWidth(2.0, kSourceX);
  const double dark = 0.1 - (kSourceX.range().high - 0.1) * 2.0 / (kHeight - 2.0);
  EXPECT_NEAR(halfPlaneRectangle(dark, 0.1, 2.0, kSourceX), 0.0, 1e-12);
  EXPECT_NEAR(halfPlaneRectangle(dark + 0.25 * width, 0.1, 2.0, kSourceX), 0.25, 1e-12);
  EXPECT_NEAR(halfPlaneRectangle(dark + width, 0.1, 2.0, kSourceX), 1.0, 1e-12);
}

TEST(ClosedForms, HalfPlaneDisc) {
  constexpr SourceAxis disc{kHeight, kSourceX.centre, kSourceY.width};  // the largest that fits the grid
  const auto inDisc = [&](glm::dvec2 p) {
    return glm::length(p - glm::dvec2(kSourceX.centre, kSourceY.centre)) < 0.5 * disc.width;
  };
  for (const double x : kReceivers) {
    EXPECT_NEAR(halfPlaneDisc(x, 0.1, 2.0, disc),
                counted(
                    {x, 0.0}, [](const auto& at) { return at(2.0).x < 0.1; }, inDisc),
                2.0 * kTolerance)  // the disc is four sevenths of the grid wide
        << x;
  }
}

TEST(ClosedForms, QuarterPlane) {
  for (const double x : kReceivers) {
    const glm::dvec2 receiver = {x, 0.1 - 0.3 * x};
    EXPECT_NEAR(quarterPlane(receiver, {0.1, 0.05}, 2.0, kSourceX, kSourceY),
                counted(receiver, [](const auto& at) { return at(2.0).x < 0.1 && at(2.0).y < 0.05; }), kTolerance)
        << x;
  }
}

TEST(ClosedForms, OuterCorner) {
  for (const double x : kReceivers) {
    const glm::dvec2 receiver = {x, 0.1 - 0.3 * x};
    EXPECT_NEAR(outerCorner(receiver, {0.1, 0.05}, 2.0, kSourceX, kSourceY),
                counted(receiver, [](const auto& at) { return at(2.0).x < 0.1 || at(2.0).y < 0.05; }), kTolerance)
        << x;
  }
}

constexpr std::array<Strip, 2> kStrips = {Strip{2.0, {-0.1, 0.2}}, Strip{3.5, {0.07, 0.42}}};

TEST(ClosedForms, StripsBlockOnceWhereTheyOverlap) {
  const auto solid = [](const auto& at) {
    const double low = at(kStrips[0].height).x;
    const double high = at(kStrips[1].height).x;
    return (low > kStrips[0].range.low && low < kStrips[0].range.high) ||
           (high > kStrips[1].range.low && high < kStrips[1].range.high);
  };
  for (const double x : kReceivers) {
    EXPECT_NEAR(strips(x, kStrips, kSourceX), counted({x, 0.0}, solid), 2.0 * kTolerance) << x;
  }
}

TEST(ClosedForms, StripsDoNotDependOnTheirOrder) {
  const std::array<Strip, 2> reversed = {kStrips[1], kStrips[0]};
  for (const double x : kReceivers) EXPECT_EQ(strips(x, kStrips, kSourceX), strips(x, reversed, kSourceX)) << x;
}

TEST(ClosedForms, AdditiveAndProbabilisticErrByTheOverlap) {
  // Seen from 0 the strips cover [-0.25, 0.5] and [0, 5/7] of a source over [-0.4, 1]: f1 = 0.75/1.4, f2 = (5/7)/1.4, o =
  // 0.5/1.4.
  const double f1 = 0.75 / 1.4;
  const double f2 = 0.5 / 1.4;
  EXPECT_NEAR(strips(0.0, kStrips, kSourceX), 1.0 - (f1 + f2 - 0.4 / 1.4), 1e-12);
  EXPECT_NEAR(stripsAdditive(0.0, kStrips, kSourceX), 1.0 - (f1 + f2), 1e-12);
  EXPECT_NEAR(stripsProbabilistic(0.0, kStrips, kSourceX), (1.0 - f1) * (1.0 - f2), 1e-12);
}

TEST(ClosedForms, Square) {
  for (const double x : kReceivers) {
    const glm::dvec2 receiver = {x, 0.1 - 0.3 * x};
    const auto solid = [](const auto& at) { return std::abs(at(2.0).x - 0.1) < 0.2 && std::abs(at(2.0).y + 0.05) < 0.2; };
    EXPECT_NEAR(square(receiver, 0.4, {0.1, -0.05}, 2.0, kSourceX, kSourceY), counted(receiver, solid), 2.0 * kTolerance) << x;
  }
}

TEST(ClosedForms, SquareHasAnUmbraWhenItsImageCoversTheSource) {  // s H/h >= a
  constexpr SourceAxis source{kHeight, 0.0, 1.0};
  EXPECT_EQ(square({0.0, 0.0}, 0.41, {0.0, 0.0}, 2.0, source, source), 0.0);
  EXPECT_GT(square({0.0, 0.0}, 0.39, {0.0, 0.0}, 2.0, source, source), 0.0);
}

TEST(ClosedForms, SphereOnTheAxis) {  // by the tangent from the receiver: sin(angle) = r / h
  const double rim = 5.0 * std::tan(std::asin(0.3 / 2.0));
  EXPECT_NEAR(sphereOnAxis(0.3, 2.0, 5.0, 1.1), 1.0 - rim * rim / (1.1 * 1.1), 1e-12);
  EXPECT_EQ(sphereOnAxis(0.3, 2.0, 5.0, 0.7), 0.0);
}

TEST(ClosedForms, HalfPlaneBeforeACone) {
  // Directions at equal steps of height and of turn are uniform in solid angle.
  constexpr double half = 0.6;
  const glm::dvec3 axis = glm::normalize(glm::dvec3(0.2, 1.0, 0.1));
  const glm::dvec3 u = glm::normalize(glm::cross(axis, glm::dvec3(0.0, 0.0, 1.0)));
  const glm::dvec3 v = glm::cross(axis, u);
  for (const double x : kReceivers) {
    int visible = 0;
    for (int j = 0; j < kGrid; ++j) {
      const double z = 1.0 - (1.0 - std::cos(half)) * (j + 0.5) / kGrid;
      for (int i = 0; i < kGrid; ++i) {
        const double turn = 2.0 * 3.141592653589793 * (i + 0.5) / kGrid;
        const glm::dvec3 direction = axis * z + std::sqrt(1.0 - z * z) * (u * std::cos(turn) + v * std::sin(turn));
        visible += x + direction.x * (2.0 / direction.y) >= 0.1 ? 1 : 0;
      }
    }
    EXPECT_NEAR(halfPlaneCone(axisBehindEdge(x, 0.1, 2.0, axis), half), static_cast<double>(visible) / (kGrid * kGrid),
                kTolerance)
        << x;
  }
}

TEST(ClosedForms, ConeOfASmallAngleIsADisc) {
  constexpr double half = 1e-3;
  const double radius = kHeight * std::tan(half);
  for (const double t : {-0.9, -0.3, 0.0, 0.5, 0.99}) {
    const double x = -t * radius * 2.0 / (kHeight - 2.0);  // the edge at 0 falls at t on the source
    EXPECT_NEAR(halfPlaneCone(axisBehindEdge(x, 0.0, 2.0, glm::normalize(glm::dvec3(-x, kHeight, 0.0))), half),
                halfPlaneDisc(x, 0.0, 2.0, {kHeight, 0.0, 2.0 * radius}), 1e-5)
        << t;
  }
}

TEST(ClosedForms, DirectionalPenumbraEndsWhereTheConeDoes) {
  constexpr double diameter = 0.2;
  const double width = directionalPenumbraWidth(2.0, diameter);
  const auto at = [&](double x) { return halfPlaneCone(axisBehindEdge(x, 0.1, 2.0, {0.0, 1.0, 0.0}), 0.5 * diameter); };
  EXPECT_EQ(at(0.1 - 0.501 * width), 0.0);
  EXPECT_GT(at(0.1 - 0.499 * width), 0.0);
  EXPECT_LT(at(0.1 + 0.499 * width), 1.0);
  EXPECT_EQ(at(0.1 + 0.501 * width), 1.0);
  EXPECT_NEAR(at(0.1), 0.5, 1e-12);
}

TEST(ClosedForms, BoxFilteredStepIsTheMeanOfTheStep) {
  for (const double x : {-2.0, -0.9, 0.0, 0.3, 1.4, 3.0}) {
    int lit = 0;
    for (int i = 0; i < 1000; ++i) lit += x + 2.5 * ((i + 0.5) / 1000.0 - 0.5) > 0.25 ? 1 : 0;
    EXPECT_NEAR(boxFilteredStep(x, 0.25, 2.5), lit / 1000.0, 1e-3) << x;
  }
}

TEST(ClosedForms, BoxFilteredTexelsOfOddAndEvenKernels) {
  EXPECT_EQ(boxFilteredTexels(7.5, 8, 1), 0.0);
  EXPECT_EQ(boxFilteredTexels(8.5, 8, 1), 1.0);
  EXPECT_DOUBLE_EQ(boxFilteredTexels(7.5, 8, 3), 1.0 / 3.0);       // texels 6, 7, 8
  EXPECT_DOUBLE_EQ(boxFilteredTexels(7.7, 8, 2), 0.5);             // at 7.2 and 8.2: half a texel's shift
  EXPECT_DOUBLE_EQ(boxFilteredTexels(7.3, 8, 2), 0.0);             // at 6.8 and 7.8
  EXPECT_DOUBLE_EQ(boxFilteredTexels(7.5, 8, 3, 2.0), 1.0 / 3.0);  // texels 5, 7, 9
}

}  // namespace
}  // namespace gnomon::closed_form
