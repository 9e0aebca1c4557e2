// Slots of a session that shows techniques in turn: what they have in common is done once.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "bench.h"

namespace gnomon::test {
namespace {

using testing::Contains;

constexpr const char* kOne = R"({"map_size": 64})";
constexpr const char* kOther = R"({"map_size": 64, "bias.slope": 3})";

SessionSetup smallSetup(bool sharePasses) {
  SessionSetup setup = builtinSetup("pillars", {60, 45});
  setup.sharePasses = sharePasses;
  return setup;
}

class SharedSlots : public testing::Test {
 protected:
  std::vector<std::string> frame(Slot slot, const GraphRun& options = {}) {
    return ran(session_.frame(slot, options).technique);
  }
  void moveLight() {
    Light light = session_.light();
    light.position.x += 0.1;
    session_.moveLight(light);
  }

  Session session_{smallSetup(true)};
  Slot first_ = addSlot(session_, "shadow_map", kOne);
  Slot second_ = addSlot(session_, "shadow_map", kOther);
};

TEST_F(SharedSlots, TheSecondFindsTheMapOfTheFirst) {
  EXPECT_THAT(frame(first_), Contains("light depth"));
  EXPECT_THAT(frame(second_), testing::Not(Contains("light depth")));
}

TEST_F(SharedSlots, TechniquesThatAskForOneMapGetOne) {  // whatever they make of it
  int maps = 0;
  for (const char* technique : {"pcss", "pcss_vsm", "pcss_esm"}) {
    const std::vector<std::string> passes = frame(addSlot(session_, technique, kOne));
    maps += static_cast<int>(std::count(passes.begin(), passes.end(), "light depth"));
  }
  EXPECT_EQ(maps, 1);
}

TEST_F(SharedSlots, FlippingUnderAMovingLightDrawsTheMapOnceForEachPose) {
  int maps = 0;
  for (int pose = 0; pose < 5; ++pose) {
    moveLight();
    for (const Slot slot : {first_, second_, first_, second_}) {
      const std::vector<std::string> passes = frame(slot);
      maps += static_cast<int>(std::count(passes.begin(), passes.end(), "light depth"));
    }
  }
  EXPECT_EQ(maps, 5);
}

TEST_F(SharedSlots, GiveTheBitsOfSlotsThatShareNothing) {
  frame(first_);
  moveLight();
  frame(second_);
  frame(first_);
  SessionSetup alone = smallSetup(false);
  alone.light = session_.light();
  EXPECT_EQ(session_.visibility(first_).data, renderVisibility(alone, "shadow_map", kOne).data);
  EXPECT_EQ(session_.visibility(second_).data, renderVisibility(alone, "shadow_map", kOther).data);
}

TEST_F(SharedSlots, ReplacingOneLeavesTheOtherWhole) {
  frame(first_);
  frame(second_);
  const std::vector<float> before = session_.visibility(second_).data;
  session_.replaceSlot(first_, registry().open("pcf"), parametersOf("pcf", kOne));
  frame(first_);
  frame(second_, {.skipUnchanged = false});
  EXPECT_EQ(session_.visibility(second_).data, before);
}

TEST_F(SharedSlots, AParameterThatMovesTheMapPartsThem) {
  frame(first_);
  frame(second_);
  const std::vector<float> before = session_.visibility(first_).data;
  const std::string moved = R"({"map_size": 64, "bias.normal": 8})";
  session_.setParameters(second_, registry().open("shadow_map"), parametersOf("shadow_map", moved));
  EXPECT_THAT(frame(second_), Contains("light depth"));
  EXPECT_EQ(session_.visibility(second_).data, renderVisibility(smallSetup(false), "shadow_map", moved).data);
  frame(first_, {.skipUnchanged = false});
  EXPECT_EQ(session_.visibility(first_).data, before);
}

TEST(Slots, ShareNothingUnlessAsked) {
  Session session(smallSetup(false));
  session.frame(addSlot(session, "shadow_map", kOne));
  EXPECT_THAT(ran(session.frame(addSlot(session, "shadow_map", kOne)).technique), Contains("light depth"));
}

}  // namespace
}  // namespace gnomon::test
