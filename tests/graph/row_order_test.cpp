// Row 0 is the picture's top and column 0 its left, in every texture, on a scene without symmetry.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/ext/matrix_transform.hpp>

#include "bench.h"
#include "gnomon/scene/builtin.h"

namespace gnomon::test {
namespace {

/// A wall at z = 0 seen from the front, 8 m wide and 6 m high, lit from the right above. A plate in front of its upper left
/// quarter shadows a place farther left and down.
class RowOrder : public testing::Test {
 protected:
  RowOrder() : session_(setup()) { session_.frame(slot_); }

  static SessionSetup setup() {
    ensureContext();
    SessionSetup s;
    s.scene.meshes = {boxMesh(glm::dvec3(0.5))};
    s.scene.materials = {{}};
    const auto add = [&](const std::string& name, const glm::dvec3& centre, const glm::dvec3& size) {
      s.scene.instances.push_back({name, 0, 0, glm::scale(glm::translate(glm::dmat4(1.0), centre), size), true, true});
    };
    add("wall", {0.0, 0.0, -0.5}, {8.0, 6.0, 1.0});
    add("plate", {-1.0, 2.0, 1.0}, {1.0, 1.0, 0.1});
    s.light.type = LightType::directional;
    s.light.position = {1.0, 2.0, 1.0};  // the plate's shadow is 1 m to the left and 2 m down
    s.light.target = glm::dvec3(0.0);
    s.camera.type = CameraType::orthographic;
    s.camera.position = {0.0, 0.0, 10.0};
    s.camera.target = glm::dvec3(0.0);
    s.camera.height = 6.0;
    s.outputSize = {80, 60};  // 0.1 m a pixel
    return s;
  }
  /// The pixel at this place on the wall.
  static glm::ivec2 pixel(double x, double y) {
    return {static_cast<int>((x + 4.0) * 10.0), static_cast<int>((3.0 - y) * 10.0)};
  }

  Session session_;
  Slot slot_ = addSlot(session_, "shadow_map");
};

TEST_F(RowOrder, PositionsFallFromTopToBottomAndGrowFromLeftToRight) {
  const Image positions = session_.positions();
  EXPECT_NEAR(positions.at(0, 0, 0), -3.95, 1e-5);
  EXPECT_NEAR(positions.at(0, 0, 1), 2.95, 1e-5);
  EXPECT_NEAR(positions.at(79, 59, 0), 3.95, 1e-5);
  EXPECT_NEAR(positions.at(79, 59, 1), -2.95, 1e-5);
}

TEST_F(RowOrder, ThePlateIsAtTheUpperLeft) {
  const glm::ivec2 plate = pixel(-1.0, 2.0);
  const glm::ivec2 mirrored = pixel(-1.0, -2.0);
  EXPECT_NEAR(session_.positions().at(plate.x, plate.y, 2), 1.05 - 10.0, 1e-5);
  EXPECT_NEAR(session_.positions().at(mirrored.x, mirrored.y, 2), 0.0 - 10.0, 1e-5);
}

TEST_F(RowOrder, ItsShadowIsLeftBelowIt) {
  const Image v = session_.visibility(slot_);
  const auto at = [&](double x, double y) { return v.at(pixel(x, y).x, pixel(x, y).y); };
  EXPECT_EQ(at(-2.0, 0.0), 0.0f);
  EXPECT_EQ(at(2.0, 0.0), 1.0f);  // were columns mirrored
  EXPECT_EQ(at(-2.0, 2.7), 1.0f);
  EXPECT_EQ(at(-2.0, -2.0), 1.0f);
  EXPECT_EQ(at(0.0, 0.0), 1.0f);  // were the light mirrored
}

TEST_F(RowOrder, TheMapsOwnRowsAgreeWithTheReference) {  // a map mirrored in itself would be wrong on both sides alike
  const Image reference = renderVisibility(setup(), "ray_traced");
  const Image v = session_.visibility(slot_);
  // A texel is under 1 cm of 10 cm pixels.
  for (int y = 1; y + 1 < v.height; ++y) {
    for (int x = 1; x + 1 < v.width; ++x) {
      if (besideAnEdge(reference, x, y)) continue;
      ASSERT_EQ(v.at(x, y), reference.at(x, y)) << "pixel (" << x << ", " << y << ")";
    }
  }
}

TEST_F(RowOrder, TheShadedPictureIsDarkWhereTheShadowIs) {
  const Image shaded = session_.shaded(slot_);
  const glm::ivec2 dark = pixel(-2.0, 0.0);
  const glm::ivec2 bright = pixel(2.0, 0.0);
  EXPECT_LT(shaded.at(dark.x, dark.y, 0), 0.5f * shaded.at(bright.x, bright.y, 0));
}

}  // namespace
}  // namespace gnomon::test
