// Fitting near and far moves depth quanta. What that may change of the picture follows from the facts a technique states.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "bench.h"
#include "gnomon/base/files.h"
#include "gnomon/passes/gbuffer.h"
#include "gnomon/passes/light_depth.h"
#include "gnomon/passes/light_map.h"
#include "gnomon/scene/builtin.h"

namespace gnomon::test {
namespace {

using testing::Each;

/// A picture with what decided it.
struct Picture {
  Image visibility, positions, normals;
  Facts facts;
};

Picture draw(SessionSetup setup, Toggle fitting, const std::string& technique, const std::string& parameters) {
  setup.overrides[Rule::fitting] = fitting;
  Session session(std::move(setup));
  const Slot slot = addSlot(session, technique, parameters);
  session.frame(slot);
  return {session.visibility(slot), session.positions(), session.normals(), session.facts(slot)};
}

/// half_plane (blocker 1 m over the floor) with a post far below and a plate close under the light, both out of the picture
/// and its shadows: without fitting near and far have to hold them.
SessionSetup deepScene() {
  SessionSetup setup = builtinSetup("half_plane", {100, 75});
  const auto add = [&](const glm::dvec3& position, bool casts) {
    Instance instance = setup.scene.instances.at(0);
    instance.world = glm::scale(glm::translate(glm::dmat4(1.0), position), glm::dvec3(0.01));
    instance.casts = casts;
    instance.receives = !casts;
    setup.scene.instances.push_back(instance);
  };
  add({1.0, -60.0, 1.0}, false);
  add({0.15, 3.9, 0.0}, true);  // shadows x = 6 m and beyond, where no floor is
  return setup;
}

class FittingOff : public testing::TestWithParam<const char*> {
 protected:
  std::string parameters() const { return std::string(R"({"map_format": ")") + GetParam() + R"("})"; }
};

/// Depths of receiver and blocker are `gap` apart. Fitted or not, the comparison goes by their order if no bias and no quantum
/// spans the gap: |error of the stored depth| <= quantum, and the compared one is moved by at most largestBias + quantum.
TEST_P(FittingOff, LeavesTheSameBitsWhereGapsExceedBiasAndQuantum) {
  const Picture on = draw(deepScene(), Toggle::automatic, "shadow_map", parameters());
  const Picture off = draw(deepScene(), Toggle::off, "shadow_map", parameters());
  ASSERT_GT(off.facts.farDepth, 10.0 * on.facts.farDepth);  // else nothing was forced off
  ASSERT_LT(off.facts.nearDepth, 0.5 * on.facts.nearDepth);
  // The floor is at depth 4 under the light; its farthest visible point makes an angle to it with cosine > 0.6, and lies
  // within 4 m of the camera.
  for (const Facts& facts : {on.facts, off.facts}) {
    ASSERT_LT(largestBias(facts, 4.0, 0.6, 4.0) + 2.0 * depthQuantum(facts, 4.0), 1.0);
  }
  EXPECT_TRUE(on.visibility.data == off.visibility.data);
  EXPECT_THAT(on.visibility.data, testing::AllOf(testing::Contains(0.0f), testing::Contains(1.0f)));
}

INSTANTIATE_TEST_SUITE_P(Formats, FittingOff, testing::Values("d16", "d24", "d32f"),
                         [](const auto& p) { return std::string(p.param); });

// --- a scene with contacts: where V differs, a surface lies within bias and quantum of the receiver ---

/// The depth map that a technique would read, as metres along the light's axis; infinity where nothing is.
struct MapDepths {
  Image metres;
  Facts facts;
};

MapDepths mapDepths(const SessionSetup& setup, const DepthMapParameters& parameters) {
  Graph graph("map", setup.outputSize, {{installationDirectory() / "shaders"}, {}});
  GBuffer gbuffer = sessionPasses(graph.builder(), setup.outputSize).gbuffer;
  gbuffer.mask = lightPasses(graph.builder(), everywhere(setup.outputSize)).mask;
  const std::vector<Bounds> bounds = survey(setup.scene, setup.light, setup.camera, setup.outputSize).instanceBounds;
  const EffectPlan plan =
      planEffects(survey(setup.scene, setup.light, setup.camera, setup.outputSize), setup.light, setup.camera);
  const Buffer values = graph.builder().buffer("Parameters", 16);
  const Texture map =
      lightDepth(graph.builder(), {setup.outputSize, setup.light, gbuffer, 16384, values}, parameters, plan, 0.0).map;
  graph.compile(std::span(&map, 1));
  const GpuScene gpu(setup.scene);
  graph.run({setup.scene, bounds, gpu, setup.light, setup.camera, setup.outputSize, 0.0}, {}, {});
  MapDepths result{graph.read(map), graph.facts()};
  const double n = result.facts.nearDepth;
  const double f = result.facts.farDepth;
  for (float& z : result.metres.data) {  // z = n (f - d) / (d (f - n))
    z = z == 0.0f ? std::numeric_limits<float>::infinity() : static_cast<float>(n * f / (static_cast<double>(z) * (f - n) + n));
  }
  return result;
}

TEST_P(FittingOff, DiffersOnlyWhereASurfaceLiesWithinBiasAndQuantum) {
  const SessionSetup setup = [] {
    SessionSetup s = builtinSetup("pillars", {200, 150});
    // A speck close under the light, beside the picture: the unfitted range has to resolve it, and is coarse on the floor.
    Instance speck = s.scene.instances.at(0);
    speck.world =
        glm::scale(glm::translate(glm::dmat4(1.0), glm::mix(s.light.position, s.light.target, 0.002)), glm::dvec3(1e-4));
    speck.casts = false;
    s.scene.instances.push_back(speck);
    // A plate so low over the floor that a coarse quantum's bias spans the gap.
    Instance plate = s.scene.instances.at(0);
    plate.world = glm::scale(glm::translate(glm::dmat4(1.0), {0.0, 0.1, 3.5}), {0.3, 1.0, 0.1});
    s.scene.instances.push_back(plate);
    return s;
  }();
  const Picture on = draw(setup, Toggle::automatic, "shadow_map", parameters());
  const Picture off = draw(setup, Toggle::off, "shadow_map", parameters());
  ASSERT_LT(off.facts.nearDepth, 0.1 * on.facts.nearDepth);
  const MapDepths map = mapDepths(setup, {.size = on.facts.mapSize, .format = MapFormat::d32f, .bias = {}});
  const MapSubject subject{setup.scene, {}, setup.light, setup.camera, 200.0 / 150.0};
  const MapPlane plane = mapPlane(subject);
  std::size_t different = 0;
  for (int y = 0; y < 150; ++y) {
    for (int x = 0; x < 200; ++x) {
      if (on.visibility.at(x, y) == off.visibility.at(x, y)) continue;
      ++different;
      const glm::dvec3 relative(on.positions.at(x, y, 0), on.positions.at(x, y, 1), on.positions.at(x, y, 2));
      const glm::dvec3 normal(on.normals.at(x, y, 0), on.normals.at(x, y, 1), on.normals.at(x, y, 2));
      const glm::dvec3 p = setup.camera.position + relative - plane.axes.origin;
      const double depth = -glm::dot(plane.axes.z, p);
      const double cosine = glm::dot(normal, -glm::normalize(p));
      double bias = 0.0;
      double quantum = 0.0;
      for (const Facts& facts : {on.facts, off.facts, map.facts}) {
        bias = std::max(bias, largestBias(facts, depth, cosine, glm::length(relative)));
        quantum = std::max(quantum, depthQuantum(facts, depth));
      }
      // A comparison in each picture and the stored depth in each: two quanta; the map looked into here has finer ones.
      const glm::dvec2 texel =
          (glm::dvec2(glm::dot(plane.axes.x, p), glm::dot(plane.axes.y, p)) / depth / plane.halfExtent * 0.5 + 0.5) *
          glm::dvec2(on.facts.mapSize);
      // Rounding of the place in the map may choose a neighbour.
      bool found = false;
      for (int ty = static_cast<int>(texel.y - 0.01); ty <= static_cast<int>(texel.y + 0.01); ++ty) {
        for (int tx = static_cast<int>(texel.x - 0.01); tx <= static_cast<int>(texel.x + 0.01); ++tx) {
          const auto stored = static_cast<double>(map.metres.at(tx, ty));
          found = found || (depth - stored <= bias + 2.0 * quantum && stored - depth <= 2.0 * quantum);
        }
      }
      EXPECT_TRUE(found) << "pixel (" << x << ", " << y << ")";
    }
  }
  RecordProperty("different", static_cast<int>(different));
  if (GetParam() == std::string("d16")) {
    EXPECT_GT(different, 0U);  // else the test says nothing
  }
}

// --- the ends of the fitted range ---

/// A floor that casts and receives, nothing else, under an oblique light: whatever is read, it is lit.
SessionSetup bareFloor() {
  SessionSetup setup = builtinSetup("layers", {64, 48});
  setup.scene.instances.resize(1);
  setup.scene.instances[0].casts = true;
  setup.light = {};
  setup.light.position = {-6.0, 6.0, 0.0};
  setup.light.coneHalfAngleDegrees = 40.0;
  setup.camera.type = CameraType::orthographic;
  setup.camera.position = {0.0, 5.0, 0.0};
  setup.camera.target = glm::dvec3(0.0);
  setup.camera.height = 2.0;
  return setup;
}

TEST(FittedRange, AFloorAloneIsLitToTheBorderOfTheView) {  // where a wide kernel reaches planes beyond far
  for (const char* format : {"d16", "d32f"}) {
    const Picture picture = draw(bareFloor(), Toggle::automatic, "pcf",
                                 std::string(R"({"taps": 31, "spread": 4, "map_size": 512, "map_format": ")") + format + "\"}");
    EXPECT_THAT(picture.visibility.data, Each(1.0f)) << format;
  }
}

}  // namespace
}  // namespace gnomon::test
