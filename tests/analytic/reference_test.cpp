// The reference against the closed forms A.1 to A.7 of tests/analytic/closed_forms.h, and against a source that the receiver's
// horizon cuts: 32 scrambles of 32 samples at every pixel of a penumbra. The test function is tested as well: it must see a
// source whose size is 1 % wrong, and blockers combined by a wrong rule.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <glm/ext/matrix_transform.hpp>
#include <glm/trigonometric.hpp>
#include <map>

#include "agreement.h"
#include "closed_forms.h"
#include "gnomon/scene/builtin.h"
#include "gnomon/scene/builtin_dimensions.h"
#include "render.h"

namespace gnomon::test {
namespace {

using closed_form::SourceAxis;

constexpr int kScrambles = 32;
constexpr int kSamples = 32;
constexpr std::size_t kFewestPoints = 200;
constexpr glm::ivec2 kOutput{120, 90};

constexpr glm::dvec2 kRectangle{0.8, 1.3};  // not square, so that exchanged axes are seen
constexpr double kDiscRadius = 0.45;
constexpr double kSphereRadius = 0.6;
constexpr glm::dvec3 kTowardsSky{0.5, 2.0, 0.3};
constexpr double kSkyDegrees = 25.0;
constexpr glm::dvec2 kCorner{0.05, 0.12};
constexpr double kCornerHeight = 1.1;

/// A set-up with a closed form of V: at a receiver, for a source whose size is `scale` times the light's.
struct Case {
  std::string name;
  std::function<SessionSetup()> setup;
  std::function<double(const glm::dvec3& receiver, double scale)> visibility;
  double standardError = 0.0;  ///< at which ray_traced stops; 0: it takes all samples

  friend void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }
};

/// The built-in scenes' source plane and one of its axes, as seen from a receiver at height `y`.
SourceAxis sourceAbove(double y, double width) {
  return {dimensions::kSourceHeight - y, 0.0, width};
}

/// A lamp before the half-plane's edge, so near to the floor that its disc of directions is wide and differs from pixel to
/// pixel.
SessionSetup sphereSetup() {
  SessionSetup setup = builtinSetup("half_plane", kOutput);
  setup.light = {};
  setup.light.type = LightType::point;
  setup.light.position = {0.3, 2.5, 0.4};
  setup.light.radius = kSphereRadius;
  return setup;
}

/// The sky's brightest part, aslant.
SessionSetup skySetup() {
  SessionSetup setup = builtinSetup("half_plane", kOutput);
  setup.light = {};
  setup.light.type = LightType::directional;
  setup.light.position = kTowardsSky;
  setup.light.target = {0.0, 0.0, 0.0};
  setup.light.angularDiameterDegrees = kSkyDegrees;
  return setup;
}

SessionSetup halfPlaneSetup(const Source& source) {
  SessionSetup setup = builtinSetup("half_plane", kOutput);
  setup.light.source = source;
  return setup;
}

void addHorizontalQuad(Scene& scene, double height, glm::dvec2 low, glm::dvec2 high) {
  Instance quad = scene.instances.at(0);
  const glm::dvec2 middle = 0.5 * (low + high);
  quad.world = glm::scale(glm::translate(glm::dmat4(1.0), {middle.x, height, middle.y}),
                          {0.5 * (high.x - low.x), 1.0, 0.5 * (high.y - low.y)});
  quad.receives = false;
  scene.instances.push_back(quad);
}

/// half_plane's floor, camera and light, with the blocker solid where x < kCorner.x and z < kCorner.y.
SessionSetup quarterPlaneSetup() {
  SessionSetup setup = halfPlaneSetup({SourceShape::rectangle, kRectangle});
  setup.scene.instances.resize(1);
  const double end = dimensions::kFloorHalfSize + 1.0;  // beyond it no line from floor to source passes: builtin.cpp
  addHorizontalQuad(setup.scene, kCornerHeight, glm::dvec2(-end), kCorner);
  return setup;
}

double stripsVisibility(double (*combine)(double, std::span<const closed_form::Strip>, const SourceAxis&), const glm::dvec3& p,
                        double scale) {
  const auto strip = [&](const dimensions::Strip& s) { return closed_form::Strip{s.height - p.y, {s.left, s.right}}; };
  const std::array blockers{strip(dimensions::kLowerStrip), strip(dimensions::kUpperStrip)};
  return combine(p.x, blockers, sourceAbove(p.y, scale));
}

/// A wall in z = 0 that faces +Z, under a source that reaches from 0.25 behind it to 0.75 before it: a quarter of it lies below
/// every receiver's horizon and counts neither as seen nor as blocked. A blocker through the wall is solid for z < kOverWall.
/// V is then a ratio of two counts, whose expectation is the ratio of the areas only if the lower count is always the same: it
/// is, since the horizon falls between two of the 32 strata across the source. (Elsewhere the ratio is off by O(1/samples).)
constexpr double kOverWall = 0.12;
constexpr double kOverWallHeight = 2.0;
constexpr double kBeforeWall = 0.25;
SessionSetup wallSetup() {
  SessionSetup setup = builtinSetup("half_plane", kOutput);
  setup.scene.instances.resize(1);
  addHorizontalQuad(setup.scene, kOverWallHeight, {-6.0, -1.0}, {6.0, kOverWall});
  const glm::dmat4 upright = glm::rotate(glm::dmat4(1.0), glm::radians(90.0), {1.0, 0.0, 0.0});
  setup.scene.instances[0].world = glm::scale(upright, {3.0, 1.0, 3.0});  // |x|, |y| <= 3
  setup.light.position = {0.0, dimensions::kSourceHeight, kBeforeWall};
  setup.light.target = {0.0, 0.0, kBeforeWall};
  setup.camera.position = {0.0, 0.5, 6.0};
  setup.camera.target = {0.0, 0.5, 0.0};
  return setup;
}

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {"HalfPlaneRectangle",
       [] {
         return halfPlaneSetup({SourceShape::rectangle, kRectangle});
       },
       [](const glm::dvec3& p, double scale) {
         return closed_form::halfPlaneRectangle(p.x, dimensions::kHalfPlaneEdge, 1.0 - p.y,
                                                sourceAbove(p.y, scale * kRectangle.x));
       }},
      {"HalfPlaneDisc",
       [] {
         return halfPlaneSetup({SourceShape::disc, {}, kDiscRadius});
       },
       [](const glm::dvec3& p, double scale) {
         return closed_form::halfPlaneDisc(p.x, dimensions::kHalfPlaneEdge, 1.0 - p.y,
                                           sourceAbove(p.y, scale * 2.0 * kDiscRadius));
       }},
      {"HalfPlaneSphere", sphereSetup,
       [](const glm::dvec3& p, double scale) {
         const glm::dvec3 towards = sphereSetup().light.position - p;
         const double distance = glm::length(towards);
         return closed_form::halfPlaneCone(
             closed_form::axisBehindEdge(p.x, dimensions::kHalfPlaneEdge, 1.0 - p.y, towards / distance),
             std::asin(scale * kSphereRadius / distance));
       }},
      {"HalfPlaneAngularDiameter", skySetup,
       [](const glm::dvec3& p, double scale) {
         return closed_form::halfPlaneCone(
             closed_form::axisBehindEdge(p.x, dimensions::kHalfPlaneEdge, 1.0 - p.y, glm::normalize(kTowardsSky)),
             0.5 * glm::radians(scale * kSkyDegrees));
       }},
      // Pixels stop after their first samples, or the second, as chance will have it: where the choice favoured a sample, the
      // mean would show it.
      {"StoppedEarly",
       [] {
         return halfPlaneSetup({SourceShape::rectangle, kRectangle});
       },
       [](const glm::dvec3& p, double scale) {
         return closed_form::halfPlaneRectangle(p.x, dimensions::kHalfPlaneEdge, 1.0 - p.y,
                                                sourceAbove(p.y, scale * kRectangle.x));
       },
       0.02},
      {"QuarterPlane", quarterPlaneSetup,
       [](const glm::dvec3& p, double scale) {
         return closed_form::quarterPlane({p.x, p.z}, kCorner, kCornerHeight - p.y, sourceAbove(p.y, scale * kRectangle.x),
                                          sourceAbove(p.y, scale * kRectangle.y));
       }},
      {"Strips", [] { return builtinSetup("strips", kOutput); },
       [](const glm::dvec3& p, double scale) { return stripsVisibility(closed_form::strips, p, scale); }},
      {"Square", [] { return builtinSetup("square", kOutput); },
       [](const glm::dvec3& p, double scale) {
         const SourceAxis source = sourceAbove(p.y, scale);
         return closed_form::square({p.x, p.z}, dimensions::kSquareEdge, {0.0, 0.0}, 1.0 - p.y, source, source);
       }},
      {"CutByTheHorizon", wallSetup,
       [](const glm::dvec3& p, double scale) {
         if (p.y > kOverWallHeight) return 1.0;
         const double front = kBeforeWall + 0.5 * scale - p.z;
         return closed_form::halfPlaneRectangle(0.0, kOverWall - p.z, kOverWallHeight - p.y,
                                                {dimensions::kSourceHeight - p.y, 0.5 * front, front});
       }},
  };
  return all;
}

/// The same for every pixel of the mask: its position, and an estimate from each scramble.
struct Rendered {
  std::vector<ReceiverPoint> points;
  std::vector<Estimates> runs;
};

/// With the source's size multiplied by `sourceScale` behind the closed form's back.
Rendered render(const Case& which, double sourceScale = 1.0, bool withCasters = true) {
  SessionSetup setup = which.setup();
  for (Instance& instance : setup.scene.instances) instance.casts = instance.casts && withCasters;
  setup.light.source.size *= sourceScale;
  setup.light.source.radius *= sourceScale;
  setup.light.radius *= sourceScale;
  setup.light.angularDiameterDegrees *= sourceScale;
  Session session(std::move(setup));
  Rendered result;
  for (int seed = 0; seed < kScrambles; ++seed) {
    const Slot slot = addSlot(session, "ray_traced",
                              fmt::format(R"({{"samples": {}, "seed": {}, "standard_error": {}}})",
                                          which.standardError > 0.0 ? 8 * kSamples : kSamples, seed, which.standardError));
    session.frame(slot);
    const Image v = session.visibility(slot);
    if (result.points.empty()) result.points = receiverPoints(session);
    Estimates& run = result.runs.emplace_back();
    for (const ReceiverPoint& point : result.points) run.push_back(v.at(point.x, point.y));
    session.removeSlots();
  }
  return result;
}

/// Over the points whose closed form is neither 0 nor 1, unless another one is given.
Agreement penumbraAgreement(const Case& which, const Rendered& rendered,
                            const std::function<double(const glm::dvec3&, double)>& claim) {
  std::vector<double> truth;
  std::vector<Estimates> runs(rendered.runs.size());
  for (std::size_t i = 0; i < rendered.points.size(); ++i) {
    const double v = which.visibility(rendered.points[i].position, 1.0);
    if (v <= 0.0 || v >= 1.0) continue;
    truth.push_back(claim(rendered.points[i].position, 1.0));
    for (std::size_t r = 0; r < runs.size(); ++r) runs[r].push_back(rendered.runs[r][i]);
  }
  return agreement(runs, truth, kSamples);
}

std::string describe(const Agreement& a) {
  return fmt::format("{} points, {} rejected; error = {:.2e} (p {:.2g}) + {:.2e} (p {:.2g}) (V - 1/2)", a.points, a.rejected,
                     a.offset, a.offsetPValue, a.slope, a.slopePValue);
}

class Reference : public testing::TestWithParam<Case> {
 protected:
  /// Rendered once a case: the tests of a case share it.
  static const Rendered& rendered() {
    static std::map<std::string, Rendered> all;
    const auto [entry, isNew] = all.try_emplace(GetParam().name);
    if (isNew) entry->second = render(GetParam());
    return entry->second;
  }
};

TEST_P(Reference, AgreesWithTheClosedForm) {
  const Agreement result = penumbraAgreement(GetParam(), rendered(), GetParam().visibility);
  RecordProperty("agreement", describe(result));
  ASSERT_GE(result.points, kFewestPoints);
  EXPECT_TRUE(agrees(result)) << describe(result);
}

TEST_P(Reference, IsExactInLightAndUmbra) {
  // A thousandth of the source's size away from the penumbra, which is far beyond the rounding of positions.
  std::size_t judged = 0;
  for (std::size_t i = 0; i < rendered().points.size(); ++i) {
    const glm::dvec3& position = rendered().points[i].position;
    const double v = GetParam().visibility(position, 1.001);
    if (v != 0.0 && v != 1.0) continue;
    ++judged;
    for (const Estimates& run : rendered().runs) {
      ASSERT_EQ(run[i], v) << "at " << position.x << ' ' << position.y << ' ' << position.z;
    }
  }
  EXPECT_GE(judged, kFewestPoints);
}

TEST_P(Reference, OnePercentOfTheSourcesSizeIsSeen) {
  const Agreement result = penumbraAgreement(GetParam(), render(GetParam(), 1.01), GetParam().visibility);
  RecordProperty("agreement", describe(result));
  EXPECT_FALSE(agrees(result)) << describe(result);
}

TEST_P(Reference, AnEmptyAccelerationStructureIsSeen) {
  const Agreement result = penumbraAgreement(GetParam(), render(GetParam(), 1.0, false), GetParam().visibility);
  ASSERT_GE(result.points, kFewestPoints);
  // A point whose V is within some eight of its standard errors of 1 (1/(32 sqrt 32) at least) may pass for lit.
  EXPECT_GT(result.rejected, result.points * 8 / 10) << describe(result);
}

INSTANTIATE_TEST_SUITE_P(ClosedForms, Reference, testing::ValuesIn(cases()), [](const auto& test) { return test.param.name; });

/// A sphere over the middle of the floor, that disc sources of several radii see from straight above; a picture of the floor
/// around the axis, so small that V is the same all over it (it is stationary there: the rim's image moves within the source).
struct SphereOnAxis {
  static constexpr double kSphere = 0.4;
  static constexpr double kHeight = 1.5;
  static constexpr std::array kSources{0.9, 1.2, 1.4, 1.7, 2.2, 3.5};  // metres of radius; the rim's image has 1.11
  static constexpr int kSegments = 512;  // their chords cut (2/3) (pi/512)^2 = 3e-5 off the rim's area

  static SessionSetup setup() {
    SessionSetup setup = builtinSetup("half_plane", {24, 18});
    Scene& scene = setup.scene;
    scene.instances[1].mesh = static_cast<std::uint32_t>(scene.meshes.size());
    scene.instances[1].world = glm::translate(glm::dmat4(1.0), {0.0, kHeight, 0.0});
    scene.meshes.push_back(sphereMesh(kSphere, kSegments, kSegments));
    setup.light.source = {SourceShape::disc, {}, kSources[0]};
    setup.camera.type = CameraType::orthographic;
    setup.camera.height = 1e-3;
    setup.camera.position = {0.0, 0.5, 3.0};
    setup.camera.target = {0.0, 0.0, 0.0};
    return setup;
  }
};

TEST(SphereOverADisc, AgreesWithTheClosedForm) {
  Session session(SphereOnAxis::setup());
  Light light = session.light();
  std::vector<double> truth;
  std::vector<Estimates> runs(kScrambles);
  for (const double radius : SphereOnAxis::kSources) {
    light.source.radius = radius;
    session.moveLight(light);
    const double v = closed_form::sphereOnAxis(SphereOnAxis::kSphere, SphereOnAxis::kHeight, dimensions::kSourceHeight, radius);
    for (int seed = 0; seed < kScrambles; ++seed) {
      const Slot slot = addSlot(session, "ray_traced", fmt::format(R"({{"samples": {}, "seed": {}}})", kSamples, seed));
      session.frame(slot);
      const Image visibility = session.visibility(slot);
      for (const ReceiverPoint& p : receiverPoints(session)) {
        runs[static_cast<std::size_t>(seed)].push_back(visibility.at(p.x, p.y));
        if (seed == 0) truth.push_back(v);
      }
      session.removeSlots();
    }
  }
  const Agreement result = agreement(runs, truth, kSamples);
  RecordProperty("agreement", describe(result));
  EXPECT_EQ(result.points, SphereOnAxis::kSources.size() * 24 * 18);
  EXPECT_TRUE(agrees(result)) << describe(result);
}

/// Of the right picture against a wrong rule for strips that overlap.
Agreement agreementWithWrongStrips(double (*combine)(double, std::span<const closed_form::Strip>, const SourceAxis&)) {
  const auto strips = std::find_if(cases().begin(), cases().end(), [](const Case& c) { return c.name == "Strips"; });
  return penumbraAgreement(*strips, render(*strips),
                           [=](const glm::dvec3& p, double scale) { return stripsVisibility(combine, p, scale); });
}

TEST(WrongStrips, AddingBlockedFractionsIsSeen) {
  EXPECT_GT(agreementWithWrongStrips(closed_form::stripsAdditive).rejected, 0u);
}

TEST(WrongStrips, MultiplyingVisibleFractionsIsSeen) {
  EXPECT_GT(agreementWithWrongStrips(closed_form::stripsProbabilistic).rejected, 0u);
}

}  // namespace
}  // namespace gnomon::test
