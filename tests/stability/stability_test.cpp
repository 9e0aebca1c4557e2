// The matrix itself: every technique of the installation through every hard case. And that a cell cannot pass for nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "gnomon/stability/check.h"
#include "planted.h"
#include "render.h"

namespace gnomon::test {
namespace {

using namespace stability;

std::string reasonsOf(const CellReport& cell) {
  std::string text = cell.technique + " in " + cell.hardCase + ":";
  for (const std::string& reason : cell.reasons) text += "\n  " + reason;
  return text;
}

const StabilityReport& matrix() {
  static const StabilityReport report = [] {
    ensureContext();
    std::vector<const Case*> all;
    for (const Case& c : cases()) all.push_back(&c);
    return runStability(registry(), {registry().names(), all});
  }();
  return report;
}

CellReport cellOf(const std::string& technique, const Case& hardCase) {
  ensureContext();
  return runStability(registry(), {{technique}, {&hardCase}}).cells.at(0);
}

TEST(StabilityMatrix, NoCellFails) {
  for (const CellReport& cell : matrix().cells) EXPECT_NE(cell.outcome, Outcome::fail) << reasonsOf(cell);
}

TEST(StabilityMatrix, NoneOfTheCasesIsRefused) {  // each lists the refusals that it allows: none does
  EXPECT_EQ(matrix().count(Outcome::refused), 0U);
}

TEST(StabilityMatrix, HasACellForEachTechniqueAndCase) {
  std::set<std::pair<std::string, std::string>> seen;
  for (const CellReport& cell : matrix().cells) seen.emplace(cell.technique, cell.hardCase);
  EXPECT_EQ(seen.size(), registry().names().size() * cases().size());
  EXPECT_EQ(matrix().cells.size(), seen.size());
}

TEST(StabilityMatrix, HoldsTheCasesOfTheDesign) {
  for (const char* name : {"world_moved_1e6", "scale_1e-4", "light_in_plane", "light_above_up_parallel", "grazing_0.05_degrees",
                           "near_far_1e9", "spot_89_degrees", "source_larger_than_scene", "receiver_outside_map",
                           "map_of_1_texel", "map_of_3_texels", "empty_scene", "output_1x1"}) {
    EXPECT_NE(findCase(name), nullptr) << name;
  }
}

TEST(StabilityMatrix, CountsUmbraForEveryTechniqueThatShadows) {  // one that is only ever asked for light proves nothing
  for (const std::string& technique : registry().names()) {
    if (registry().find(technique)->declaration.role == TechniqueRole::floor) continue;
    const auto reconstructs = [&](const CellReport& cell) {  // from averages: no bound of its leaks has been derived
      return cell.technique == technique && !cell.notes.empty() &&
             cell.notes[0].find("no mean of depth comparisons") != std::string::npos;
    };
    if (std::any_of(matrix().cells.begin(), matrix().cells.end(), reconstructs)) continue;
    const auto counts = [&](const CellReport& cell) { return cell.technique == technique && cell.dark.counted > 100; };
    EXPECT_GE(std::count_if(matrix().cells.begin(), matrix().cells.end(), counts), 8) << technique;
  }
}

TEST(StabilityMatrix, MovedWorldHasTheSameFiguresAsTheSmallOne) {  // V does not depend on where the world is, or how large
  for (const std::string& technique : registry().names()) {
    const auto cell = [&](const char* name) {
      return *std::find_if(matrix().cells.begin(), matrix().cells.end(),
                           [&](const CellReport& c) { return c.technique == technique && c.hardCase == name; });
    };
    EXPECT_EQ(cell("world_moved_1e6").receivers, cell("scale_1e-4").receivers);
    EXPECT_EQ(cell("world_moved_1e6").dark.truth, cell("scale_1e-4").dark.truth);
  }
}

TEST(StabilityCell, FailsWhereNothingIsInView) {
  Case away = *findCase("world_moved_1e6");
  away.make = [make = away.make] {
    SessionSetup setup = make();
    setup.camera.target = setup.camera.position + glm::dvec3(0.0, 1.0, 0.1);
    return setup;
  };
  const CellReport cell = cellOf("unshadowed", away);
  EXPECT_EQ(cell.outcome, Outcome::fail);
  EXPECT_EQ(cell.reasons.at(0), "nothing was checked: no pixel is in the receiver mask");
}

TEST(StabilityCell, FailsWhereNoPixelIsCertain) {
  Case wide = *findCase("map_of_1_texel");
  wide.noneDark.clear();
  const CellReport cell = cellOf("pcf", wide);
  EXPECT_EQ(cell.outcome, Outcome::fail);
  EXPECT_EQ(cell.reasons.at(0).substr(0, 19), "nothing was checked") << reasonsOf(cell);
}

Case beyondTheDriver() {
  Case large = *findCase("world_moved_1e6");
  large.overrides = {{"map_size", "65536"}};
  return large;
}

TEST(StabilityCell, FailsOnARefusalThatIsNotAllowed) {
  const CellReport cell = cellOf("shadow_map", beyondTheDriver());
  EXPECT_EQ(cell.outcome, Outcome::fail);
  EXPECT_NE(cell.reasons.at(0).find("refused, which this case does not allow: map_size"), std::string::npos) << reasonsOf(cell);
}

TEST(StabilityCell, ReportsARefusalThatIsAllowed) {
  Case large = beyondTheDriver();
  large.allowedRefusals = {"driver's limit"};
  EXPECT_EQ(cellOf("shadow_map", large).outcome, Outcome::refused);
}

TEST(StabilityCell, SetsMapParametersOnlyWhereThereAreAny) {  // ray_traced has no map: the override is not its concern
  Case large = beyondTheDriver();
  EXPECT_EQ(cellOf("ray_traced", large).outcome, Outcome::pass);
}

TEST(StabilityRun, RefusesAnUnknownTechniqueBeforeAnythingRuns) {
  ensureContext();
  bool ran = false;
  EXPECT_THROW(
      runStability(registry(), {{"unshadowed", "no_such"}, {&cases().front()}}, [&](const CellReport&) { ran = true; }),
      InputError);
  EXPECT_FALSE(ran);
}

}  // namespace
}  // namespace gnomon::test
