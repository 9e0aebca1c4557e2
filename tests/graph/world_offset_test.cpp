// A world moved by a million metres is the same picture: coordinates are relative to the camera or the light before they are
// floats.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/ext/matrix_transform.hpp>

#include "bench.h"

namespace gnomon::test {
namespace {

/// A power of two, so that moved coordinates keep 2^-32 m of what they had in double.
constexpr double kOffset = 1048576.0;

SessionSetup moved(SessionSetup setup, double offset) {
  const glm::dvec3 by(offset, offset, -offset);
  for (Instance& instance : setup.scene.instances) instance.world = glm::translate(glm::dmat4(1.0), by) * instance.world;
  setup.light.position += by;
  setup.light.target += by;
  setup.camera.position += by;
  setup.camera.target += by;
  return setup;
}

struct Picture {
  Image visibility, mask, positions;
};

Picture draw(const SessionSetup& setup, const std::string& technique, const std::string& parameters) {
  Session session(setup);
  const Slot slot = addSlot(session, technique, parameters);
  session.frame(slot);
  return {session.visibility(slot), session.receiverMask(), session.positions()};
}

struct Case {
  const char* scene;
  const char* technique;
  const char* parameters;
  int levels;  ///< V is a multiple of 1 / levels
};

class WorldOffset : public testing::TestWithParam<Case> {
 protected:
  const SessionSetup setup_ = builtinSetup(GetParam().scene, {120, 90});
  const Picture home_ = draw(setup_, GetParam().technique, GetParam().parameters);
  const Picture far_ = draw(moved(setup_, kOffset), GetParam().technique, GetParam().parameters);
};

TEST_P(WorldOffset, LeavesTheSameMask) {
  EXPECT_TRUE(home_.mask.data == far_.mask.data);
}

/// Double coordinates are off by 2^-32 m, far below a float's rounding: a float comes out at most one rounding off, and the
/// rasteriser's interpolation adds a few. 20 m away a float's unit in the last place is 2e-6 m.
TEST_P(WorldOffset, LeavesPositionsWithinAFloatsRounding) {
  for (std::size_t i = 0; i < home_.positions.data.size(); ++i) {
    ASSERT_NEAR(home_.positions.data[i], far_.positions.data[i], 4.0 * 2e-6);
  }
}

/// Positions within 1e-5 m move a boundary of V by that: V may differ only where its neighbours already do, by one comparison
/// or one ray, and on few pixels. A texel is a centimetre, a penumbra decimetres wide: a boundary crosses a given pixel's
/// point with a probability of 1e-3 for each of its comparisons that may flip.
TEST_P(WorldOffset, LeavesTheSameVisibility) {
  const Image& a = home_.visibility;
  const Image& b = far_.visibility;
  std::size_t different = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      if (a.at(x, y) == b.at(x, y)) continue;
      ++different;
      EXPECT_LE(std::abs(a.at(x, y) - b.at(x, y)), 1.001f / static_cast<float>(GetParam().levels)) << x << ", " << y;
    }
  }
  RecordProperty("different", static_cast<int>(different));
  EXPECT_LE(different, a.pixels() / 1000);
}

INSTANTIATE_TEST_SUITE_P(Techniques, WorldOffset,
                         testing::Values(Case{"sphere_grid", "shadow_map", "{}", 1},
                                         Case{"pillars", "pcf", R"({"taps": 5})", 25},
                                         Case{"pillars", "shadow_map", R"({"map_format": "d16"})", 1},
                                         Case{"layers", "shadow_map", "{}", 1},
                                         Case{"layers", "ray_traced", R"({"samples": 16})", 16}),
                         [](const auto& p) { return std::string(p.param.scene) + "_" + p.param.technique; });

// --- a directional light's position means nothing, however far ---

TEST(DirectionalLight, MayBeFarFromTheScene) {
  SessionSetup setup = builtinSetup("layers", {120, 90});
  setup.light = {};
  setup.light.type = LightType::directional;
  setup.light.position = {3.0, 5.0, 1.0};
  const Image near = renderVisibility(setup, "shadow_map");
  setup.light.position += kOffset;
  setup.light.target += kOffset;
  EXPECT_TRUE(near.data == renderVisibility(setup, "shadow_map").data);
}

}  // namespace
}  // namespace gnomon::test
