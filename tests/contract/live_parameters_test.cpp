// Parameters of a slot that change, with techniques that count and that fail.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "plugin_folder.h"
#include "render.h"

namespace gnomon::test {
namespace {

using ::testing::Each;

class LiveParameters : public ::testing::Test {
 protected:
  OpenTechnique open(const std::string& name) { return registry_.open(name); }
  std::shared_ptr<void> values(const std::string& name, const Json& json) {
    Problems problems;
    std::shared_ptr<void> made = registry_.parameters(open(name), json, {"test", ""}, problems);
    problems.throwIfAny();
    return made;
  }
  Slot add(const std::string& name, const Json& json) { return session_.addSlot(open(name), values(name, json)); }
  bool set(Slot slot, const std::string& name, const Json& json) {
    return session_.setParameters(slot, open(name), values(name, json));
  }
  std::vector<float> frame(Slot slot) {
    session_.frame(slot);
    return session_.visibility(slot).data;
  }

  Registry registry_{{testPlugin("mischief"), testPlugin("counter")}};
  Session session_{builtinSetup("half_plane", {64, 48})};
};

TEST_F(LiveParameters, AUniformChangeKeepsTheTechniquesOwnState) {  // which counts its frames
  const Slot slot = add("counter", Json{{"step", 0.125}});
  frame(slot);
  EXPECT_FALSE(set(slot, "counter", Json{{"step", 0.25}}));
  EXPECT_THAT(frame(slot), Each(0.5f));
}

TEST_F(LiveParameters, ASpecialisedChangeKeepsTheTechniquesOwnState) {
  const Slot slot = add("counter", Json{{"step", 0.125}});
  frame(slot);
  EXPECT_FALSE(set(slot, "counter", Json{{"step", 0.125}, {"gain", 3}}));
  EXPECT_THAT(frame(slot), Each(0.75f));
}

class FailedChange : public LiveParameters, public ::testing::WithParamInterface<const char*> {};

TEST_P(FailedChange, LeavesTheSlotAsItWas) {
  const Slot slot = add("mischief", Json{{"fault", "none"}});
  EXPECT_THROW(set(slot, "mischief", Json{{"fault", GetParam()}}), Error);
  EXPECT_THAT(frame(slot), Each(1.0f));
  EXPECT_FALSE(set(slot, "mischief", Json{{"fault", "none"}})) << "the slot took over the values that failed";
}

INSTANTIATE_TEST_SUITE_P(Contract, FailedChange,
                         ::testing::Values("throw_in_create", "throw_in_support", "throw_in_setup", "syntax_error"),
                         [](const auto& each) { return std::string(each.param); });

TEST_F(LiveParameters, ARefusedSlotServesAgainWithOtherValues) {
  const Slot slot = add("mischief", Json{{"fault", "refuse"}});
  ASSERT_FALSE(session_.support(slot).ok());
  EXPECT_TRUE(set(slot, "mischief", Json{{"fault", "none"}}));
  EXPECT_TRUE(session_.support(slot).ok());
}

}  // namespace
}  // namespace gnomon::test
