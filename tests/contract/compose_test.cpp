// Techniques composed in JSON of components out of several plugins.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "gnomon/base/files.h"
#include "gnomon/session.h"
#include "plugin_folder.h"
#include "render.h"
#include "temporary_folder.h"

namespace gnomon::test {
namespace {

using ::testing::HasSubstr;

class Composed : public ::testing::Test {
 protected:
  /// A registry of the installation and one technique file with nothing but a composition of these.
  Registry& with(const std::string& projection, const std::string& representation, const std::string& footprint) {
    const Json file{
        {"techniques",
         {{"mine",
           {{"title", "Mine"},
            {"compose", {{"projection", projection}, {"representation", representation}, {"footprint", footprint}}}}}}}};
    folder_.write("techniques/mine.json", file.dump());
    registry_ = std::make_unique<Registry>(
        std::vector<std::filesystem::path>{installationDirectory() / "plugins", folder_ / "techniques"});
    return *registry_;
  }
  std::string whyNot(Registry& registry) {
    try {
      registry.open("mine");
    } catch (const InputError& error) {
      std::string lines;
      for (const Problem& problem : error.problems()) lines += problem.line() + "\n";
      return lines;
    }
    return "opened";
  }
  Image render(Registry& registry, const std::string& name, SessionSetup setup) {
    ensureContext();
    Session session(std::move(setup));
    Problems problems;
    const OpenTechnique technique = registry.open(name);
    const Slot slot = session.addSlot(technique, registry.parameters(technique, Json::object(), {}, problems));
    problems.throwIfAny();
    session.frame(slot, {.checkFinite = true});
    return session.visibility(slot);
  }

  TemporaryFolder folder_;
  std::unique_ptr<Registry> registry_;
};

TEST_F(Composed, JsonAloneMakesATechnique) {
  Registry& registry = with("single", "depth", "nearest");
  ASSERT_TRUE(registry.problems().empty()) << registry.problems().list()[0].line();
  const Image mine = render(registry, "mine", builtinSetup("layers"));
  EXPECT_EQ(mine.data, renderVisibility(builtinSetup("layers"), "shadow_map").data);
}

TEST_F(Composed, ParametersAreThoseOfAllThree) {
  Registry& registry = with("single", "vsm", "fixed");
  const std::vector<std::string> names = registry.open("mine").entry->parameters->names();
  for (const std::string name : {"map_size", "bias.slope", "min_variance", "taps", "spread"})
    EXPECT_TRUE(std::find(names.begin(), names.end(), name) != names.end()) << name;
}

TEST_F(Composed, AnUnknownComponentIsNamedWithThoseThereAre) {
  const std::string why = whyNot(with("single", "depths", "nearest"));
  EXPECT_THAT(why, HasSubstr("/techniques/mine/compose/representation"));
  EXPECT_THAT(why, HasSubstr("no representation is registered as 'depths'"));
  EXPECT_THAT(why, HasSubstr("depth, esm, vsm"));
}

TEST_F(Composed, AComponentOfAnotherAxisIsNotTaken) {
  EXPECT_THAT(whyNot(with("depth", "single", "nearest")),
              HasSubstr("no projection is registered as 'depth' (depth is a representation)"));
}

TEST_F(Composed, AllThatIsWrongIsToldAtOnceWithTheNearestNames) {
  const std::string why = whyNot(with("singel", "vms", "nearest"));
  EXPECT_THAT(why, HasSubstr("did you mean 'single'?"));
  EXPECT_THAT(why, HasSubstr("did you mean 'vsm'?"));
}

TEST_F(Composed, WhatMakesNoSenseIsRefusedWithTheReason) {
  const std::string why = whyNot(with("single", "depth", "prefiltered"));
  EXPECT_THAT(why, HasSubstr("/techniques/mine/compose: "));
  EXPECT_THAT(why, HasSubstr("can only be compared texel by texel"));
}

TEST_F(Composed, AdmissibleComponentsLeaveOutWhatMakesNoSense) {
  Registry& registry = with("single", "vsm", "prefiltered");
  const RegisteredTechnique& mine = *registry.find("mine");
  EXPECT_THAT(registry.admissible(mine, Axis::representation), ::testing::ElementsAre("esm", "vsm"));  // depth is compared
  EXPECT_THAT(registry.admissible(mine, Axis::footprint), ::testing::ElementsAre("fixed", "nearest", "pcss", "prefiltered"));
}

TEST_F(Composed, AFileWithBothOrNeitherMakerIsWrong) {
  folder_.write("techniques/mine.json", R"({"techniques": {"mine": {"title": "Mine"}}})");
  const Registry neither({folder_ / "techniques"});
  ASSERT_EQ(neither.problems().list().size(), 1u);
  EXPECT_THAT(neither.problems().list()[0].line(), HasSubstr("neither \"entry\""));
  folder_.write("techniques/mine.json",
                R"({"library": "x", "techniques": {"mine": {"title": "Mine", "entry": "e",
                    "compose": {"projection": "single", "representation": "depth", "footprint": "nearest"}}}})");
  const Registry both({folder_ / "techniques"});
  EXPECT_THAT(both.problems().list().at(0).line(), HasSubstr("both \"entry\" and \"compose\""));
}

TEST_F(Composed, ARepresentationOfOneSmallFolderWorksUnderEveryFootprint) {
  Registry registry({installationDirectory() / "plugins", testPlugin("made_up")});
  ASSERT_TRUE(registry.problems().empty()) << registry.problems().list()[0].line();
  for (const std::string name : {"made_up_prefiltered", "made_up_pcss"}) {
    const Image v = render(registry, name, builtinSetup("layers"));
    const auto [low, high] = std::minmax_element(v.data.begin(), v.data.end());
    EXPECT_LT(*low, 0.1f) << name;
    EXPECT_EQ(*high, 1.0f) << name;
  }
}

TEST_F(Composed, TheMadeUpRepresentationIsUnder80Lines) {
  std::size_t lines = 0;
  for (const auto& item :
       std::filesystem::directory_iterator(std::string(GNOMON_SOURCE_DIR) + "/tests/contract/plugins/made_up")) {
    const std::string text = readFile(item.path());
    lines += static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }
  EXPECT_LT(lines, 80u);
}

}  // namespace
}  // namespace gnomon::test
