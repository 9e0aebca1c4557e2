// The contract through a session: whatever a technique does wrong ends in an Error that names it and its pass, and the session
// goes on as if it had never been.
#include "gnomon/technique/technique.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "gnomon/base/json.h"
#include "plugin_folder.h"
#include "render.h"

namespace gnomon::test {
namespace {

using ::testing::AllOf;
using ::testing::Each;
using ::testing::HasSubstr;

/// Scenes of 64x48: what is tested does not depend on the picture's size.
SessionSetup smallSetup() {
  return builtinSetup("half_plane", {64, 48});
}

Registry& testRegistry() {
  static Registry registry({testPlugin("mischief"), testPlugin("counter")});
  return registry;
}

Slot addTestSlot(Session& session, const std::string& name, const Json& values) {
  const OpenTechnique technique = testRegistry().open(name);
  Problems problems;
  const std::shared_ptr<void> parameters = testRegistry().parameters(technique, values, {"test", ""}, problems);
  problems.throwIfAny();
  return session.addSlot(technique, parameters);
}

Image shadowMap(Session& session) {
  const Slot slot = addSlot(session, "shadow_map", R"({"map_size": 64})");
  session.frame(slot);
  return session.visibility(slot);
}

enum class When { addSlot, frame };

struct Misdeed {
  const char* fault;
  When when;                       ///< by then it is noticed
  std::vector<std::string> words;  ///< what the message must hold besides the technique's name
};

void PrintTo(const Misdeed& misdeed, std::ostream* out) {
  *out << misdeed.fault;
}

class Misdeeds : public ::testing::TestWithParam<Misdeed> {};

TEST_P(Misdeeds, IsAnErrorThatNamesThemAndTheSessionGoesOn) {
  const Misdeed& misdeed = GetParam();
  ensureContext();
  Session session(smallSetup());
  const Image before = shadowMap(session);

  bool added = false;
  std::string message;
  try {
    const Slot slot = addTestSlot(session, "mischief", Json{{"fault", misdeed.fault}});
    added = true;
    session.frame(slot);
  } catch (const Error& error) {
    message = error.what();
  }
  EXPECT_EQ(added, misdeed.when == When::frame) << message;
  EXPECT_THAT(message, HasSubstr("technique 'mischief': "));
  for (const std::string& word : misdeed.words) EXPECT_THAT(message, HasSubstr(word));

  EXPECT_EQ(shadowMap(session).data, before.data);
}

const std::vector<Misdeed> kMisdeeds{
    {"throw_in_create", When::addSlot, {"thrown in create"}},
    {"throw_in_support", When::addSlot, {"thrown in support"}},
    {"throw_in_setup", When::addSlot, {"thrown in setup"}},
    {"throw_number_in_setup", When::addSlot, {"no std::exception"}},
    {"throw_in_update", When::frame, {"thrown in update"}},
    {"throw_in_pass", When::frame, {"pass 'work'", "thrown in the pass"}},
    {"throw_number_in_pass", When::frame, {"pass 'work'", "no std::exception"}},
    {"no_visibility", When::addSlot, {"visibility"}},
    {"unknown_handle", When::addSlot, {"never declared"}},
    {"never_written", When::addSlot, {"'blank'", "nothing writes"}},
    {"wrong_size", When::addSlot, {"3x2", "64x48"}},
    {"wrong_format", When::addSlot, {"r8", "r16f or r32f"}},
    {"syntax_error", When::addSlot, {"pass 'broken'", "syntax_error.frag:5"}},
    {"missing_include", When::addSlot, {"pass 'broken'", "missing_include.frag:1", "not_there.glsl"}},
    {"include_outside", When::addSlot, {"pass 'broken'", "include_outside.frag:1", "leaves the shader folders"}},
    {"missing_shader", When::addSlot, {"pass 'broken'", "nowhere.frag"}},
    {"unknown_sampler", When::addSlot, {"pass 'broken'", "'nobodyGaveThis'"}},
    {"unknown_block", When::addSlot, {"pass 'broken'", "'NobodyGaveThis'"}},
    {"gl_error", When::frame, {"pass 'work'", "OpenGL"}},
    {"undeclared_read", When::frame, {"pass 'work'", "did not declare"}},
    {"undeclared_write", When::frame, {"pass 'work'", "did not declare"}},
    {"wrong_amount", When::frame, {"pass 'work'", "3072", "3071"}},
    {"two_writers", When::addSlot, {"pass 'second'", "'shared'", "writer"}},
    {"too_large", When::addSlot, {"16384x16384"}},
    {"undeclared_defence", When::addSlot, {"GNOMON_DEFENCE(nobody_declared_this)", "notes"}},
    {"read_before_write", When::addSlot, {"pass 'early'", "'later'", "before any pass writes it"}},
};

INSTANTIATE_TEST_SUITE_P(Contract, Misdeeds, ::testing::ValuesIn(kMisdeeds),
                         [](const ::testing::TestParamInfo<Misdeed>& each) { return std::string(each.param.fault); });

TEST(Contract, WithoutFaultTheSameTechniqueRenders) {  // else every misdeed above could be the same one
  ensureContext();
  Session session(smallSetup());
  const Slot slot = addTestSlot(session, "mischief", Json{{"fault", "none"}});
  session.frame(slot);
  EXPECT_THAT(session.visibility(slot).data, Each(1.0f));
}

TEST(Contract, WhatIsNotANumberIsFoundByCheckFinite) {
  ensureContext();
  Session session(smallSetup());
  const Slot slot = addTestSlot(session, "mischief", Json{{"fault", "not_a_number"}});
  try {
    session.frame(slot, {.checkFinite = true});
    FAIL() << "a NaN passed";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("technique 'mischief': pass 'work': target 'visibility' holds"), HasSubstr("63")));
  }
}

TEST(Contract, StateThatATechniqueLeavesChangesNoOther) {
  ensureContext();
  const auto render = [](Session& session, const std::string& technique, const std::string& json) {
    const Slot slot = addSlot(session, technique, json);
    session.frame(slot);
    const Image shaded = session.shaded(slot);
    std::vector<float> all = session.visibility(slot).data;
    all.insert(all.end(), shaded.data.begin(), shaded.data.end());
    return all;
  };
  const auto renderAll = [&](Session& session) {
    std::vector<std::vector<float>> all;
    all.push_back(render(session, "shadow_map", R"({"map_size": 64})"));
    all.push_back(render(session, "pcf", R"({"map_size": 64})"));
    all.push_back(render(session, "ray_traced", R"({"samples": 2})"));
    return all;
  };
  Session clean(smallSetup());
  const auto expected = renderAll(clean);
  Session session(smallSetup());
  session.frame(addTestSlot(session, "mischief", Json{{"fault", "leaves_state"}}));
  EXPECT_EQ(renderAll(session), expected);
  Session later(smallSetup());  // its G-buffer is drawn in that state too
  EXPECT_EQ(renderAll(later), expected);
}

TEST(Contract, ARefusalIsToldAndRendersNothing) {
  ensureContext();
  Session session(smallSetup());
  const Slot slot = addTestSlot(session, "mischief", Json{{"fault", "refuse"}});
  EXPECT_FALSE(session.support(slot).ok());
  EXPECT_EQ(session.support(slot).refusal, "it was asked to refuse");
  EXPECT_TRUE(session.runTechnique(slot).passes.empty());
}

TEST(Contract, AFailedPassRunsAgainInTheNextFrame) {
  ensureContext();
  Session session(smallSetup());
  const Slot slot = addTestSlot(session, "mischief", Json{{"fault", "throw_in_pass"}});
  EXPECT_THROW(session.frame(slot), Error);
  EXPECT_THROW(session.frame(slot), Error) << "a pass that failed must not count as done";
}

TEST(Contract, AMisbehavingSlotLeavesItsNeighbourRunning) {
  ensureContext();
  Session session(smallSetup());
  const Slot good = addSlot(session, "shadow_map", R"({"map_size": 64})");
  session.frame(good);
  const Image before = session.visibility(good);
  const Slot bad = addTestSlot(session, "mischief", Json{{"fault", "gl_error"}});
  EXPECT_THROW(session.frame(bad), Error);
  session.moveLight(session.light());  // all its light passes run again
  session.frame(good);
  EXPECT_EQ(session.visibility(good).data, before.data);
}

// --- update ---

TEST(Contract, UpdateIsCalledOnceAFrameAndItsBlockReachesTheShader) {
  ensureContext();
  Session session(smallSetup());
  const Slot slot = addTestSlot(session, "counter", Json::object());
  for (const float expected : {0.125f, 0.25f, 0.375f}) {  // exact in binary
    session.frame(slot);
    EXPECT_THAT(session.visibility(slot).data, Each(expected));
  }
}

TEST(Contract, UniformParameterReachesTheShader) {
  ensureContext();
  Session session(smallSetup());
  const Slot slot = addTestSlot(session, "counter", Json{{"step", 0.75}});
  session.frame(slot);
  EXPECT_THAT(session.visibility(slot).data, Each(0.75f));
}

TEST(Contract, SpecialisedParameterReachesTheShader) {
  ensureContext();
  Session session(smallSetup());
  const Slot slot = addTestSlot(session, "counter", Json{{"gain", 3}});
  session.frame(slot);
  EXPECT_THAT(session.visibility(slot).data, Each(0.375f));
}

}  // namespace
}  // namespace gnomon::test
