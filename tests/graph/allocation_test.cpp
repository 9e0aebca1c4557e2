// Frames take their memory once.
#include <gtest/gtest.h>

#include <memory>

#include "allocations.h"
#include "bench.h"

namespace gnomon::test {
namespace {

/// Calls of operator new in one frame after a few that grew what grows. `move` changes the session before each frame.
template <class Move>
std::size_t perFrame(const std::string& scene, const std::string& sceneParameters, const Move& move) {
  Session session(builtinSetup(scene, {60, 45}, sceneParameters));
  const Slot slot = addSlot(session, "shadow_map");
  std::size_t count = 0;
  for (int i = 0; i < 4; ++i) {
    move(session, 0.01 * i);
    const std::size_t before = allocations();
    session.frame(slot);
    count = allocations() - before;
  }
  return count;
}

void nothing(Session& /*session*/, double /*offset*/) {}

void moveLight(Session& session, double offset) {
  Light light = session.light();
  light.position.x += offset;
  session.moveLight(light);
}

void moveCamera(Session& session, double offset) {
  Camera camera = session.camera();
  camera.position.x += offset;
  session.moveCamera(camera);
}

TEST(Allocation, TheCounterCounts) {
  const std::size_t before = allocations();
  const auto one = std::make_unique<int>(1);
  EXPECT_EQ(allocations() - before, 1U);
}

TEST(Allocation, AStaticFrameTakesNothing) {
  EXPECT_EQ(perFrame("sphere_grid", "{}", nothing), 0U);
}

TEST(Allocation, AMovingLightTakesNothing) {
  EXPECT_EQ(perFrame("sphere_grid", R"({"count": 20})", moveLight), 0U);
}

TEST(Allocation, AMovingLightOverBoxesThatItsReachCutsTakesNothing) {
  EXPECT_EQ(perFrame("pillars", "{}", moveLight), 0U);
}

TEST(Allocation, AMovingCameraTakesNothing) {
  EXPECT_EQ(perFrame("sphere_grid", R"({"count": 20})", moveCamera), 0U);
}

}  // namespace
}  // namespace gnomon::test
