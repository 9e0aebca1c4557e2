// Techniques that each break one promise fail the checks that look for it, and no other.
#include "gnomon/check/check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "gnomon/base/files.h"
#include "plugin_folder.h"

namespace gnomon::test {
namespace {

using namespace check;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::UnorderedElementsAreArray;

Registry& registry() {
  static Registry registry({installationDirectory() / "plugins", testPlugin("misconduct"), testPlugin("mischief")});
  return registry;
}

std::vector<Line> linesOf(const std::string& technique, const std::vector<std::string>& names) {
  std::vector<const Check*> chosen;
  for (const std::string& name : names) chosen.push_back(findCheck(name));
  return checkTechnique(registry(), technique, chosen);
}

/// What the test plugins can keep: their pictures are nobody's shadows.
const std::vector<std::string> kPromises{"contract", "parameters", "sizes", "bits", "inputs", "state", "leaks"};

struct Misdeed {
  std::string technique;
  /// Which checks fail, and what their line must hold.
  std::map<std::string, std::string> failures;

  friend void PrintTo(const Misdeed& m, std::ostream* out) { *out << m.technique; }
};

class Misdeeds : public ::testing::TestWithParam<Misdeed> {};

TEST_P(Misdeeds, FailTheChecksThatLookForThemAndNoOther) {
  std::vector<std::string> expected;
  for (const auto& failure : GetParam().failures) expected.push_back(failure.first);
  std::vector<std::string> failed;
  for (const Line& line : linesOf(GetParam().technique, kPromises)) {
    EXPECT_THAT(line.finding.text, Not(HasSubstr("\n")));
    if (line.finding.outcome == Outcome::pass) continue;
    failed.push_back(line.check);
    const auto words = GetParam().failures.find(line.check);
    if (words != GetParam().failures.end()) {
      EXPECT_THAT(line.finding.text, HasSubstr(words->second)) << line.check;
    }
  }
  EXPECT_THAT(failed, UnorderedElementsAreArray(expected));
}

INSTANTIATE_TEST_SUITE_P(Check, Misdeeds,
                         ::testing::Values(Misdeed{"well_behaved", {}},
                                           Misdeed{"writes_nan", {{"contract", "pass 'work': target 'visibility' holds nan"}}},
                                           Misdeed{"writes_two", {{"contract", "V is 2 at pixel (63, 47), wrong at 1 pixels"}}},
                                           Misdeed{"dark_outside", {{"contract", "not 1 outside the receiver mask"}}},
                                           Misdeed{"dark_at_the_end", {{"parameters", "level = 1.0: V is -1"}}},
                                           Misdeed{"dark_when_narrow", {{"sizes", "output 1x1: V is -1"}}},
                                           Misdeed{"never_the_same",
                                                   {{"parameters", "pixels differ"},
                                                    {"bits", "in a fresh session: "},
                                                    {"inputs", "pixels differ"},
                                                    {"state", "than alone"}}},
                                           Misdeed{"hides_its_input", {{"inputs", "Input::camera and does not declare it"}}},
                                           Misdeed{"leaves_state",
                                                   {{"state", "leaves GL_TEXTURE_CUBE_MAP_SEAMLESS on (it was off)"}}},
                                           Misdeed{"leaks_textures", {{"leaks", "leaves 50 textures behind"}}},
                                           Misdeed{"leaks_memory", {{"leaks", "free what set-up allocates"}}},
                                           Misdeed{"keeps_its_parameter", {{"parameters", "changed while it runs"}}}),
                         [](const auto& each) { return each.param.technique; });

TEST(Check, StopsAtAContractThatIsBroken) {
  EXPECT_THAT(linesOf("writes_two", kPromises), ::testing::SizeIs(1));
  EXPECT_THAT(linesOf("writes_two", {"bits"}), ::testing::SizeIs(1)) << "but another one can be asked for";
}

TEST(Check, NamesTheParameterValueThatThrows) {
  const std::vector<Line> lines = linesOf("mischief", {"parameters"});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].finding.outcome, Outcome::fail);
  EXPECT_THAT(lines[0].finding.text, HasSubstr(R"(fault = "throw_in_create": technique 'mischief': thrown in create)"));
}

TEST(Check, NobodysShadowsAreNoNearerToTheReference) {
  EXPECT_EQ(linesOf("well_behaved", {"accuracy"})[0].finding.outcome, Outcome::fail);
}

TEST(Check, FailingHardCasesAreNamed) {
  const Finding finding = linesOf("well_behaved", {"stability"})[0].finding;
  EXPECT_EQ(finding.outcome, Outcome::fail);
  EXPECT_THAT(finding.text, AllOf(HasSubstr("hard cases"), HasSubstr("`gnomon stability well_behaved`")));
}

class Promises : public ::testing::TestWithParam<std::string> {};

TEST_P(Promises, AreKeptByEveryTechniqueThatIsShipped) {
  std::vector<std::string> broken;
  Registry shipped({installationDirectory() / "plugins"});
  for (const std::string& name : shipped.names()) {
    for (const Line& line : checkTechnique(shipped, name, {findCheck(GetParam())})) {
      if (line.finding.outcome == Outcome::fail) broken.push_back(name + ": " + line.finding.text);
    }
  }
  EXPECT_THAT(broken, IsEmpty());
}

// The hard cases are the stability suite's.
INSTANTIATE_TEST_SUITE_P(Check, Promises,
                         ::testing::Values("contract", "parameters", "sizes", "bits", "inputs", "state", "leaks", "accuracy"),
                         [](const auto& each) { return each.param; });

TEST(Check, AnUnknownTechniqueIsNotChecked) {
  EXPECT_THROW(linesOf("no_such_technique", {"contract"}), InputError);
}

}  // namespace
}  // namespace gnomon::test
