// Run configs with mistakes: all of them are said in one run, one clear line each with file and JSON pointer; the exit code is
// 2 and nothing is written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "program.h"

namespace gnomon::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;
using ::testing::UnorderedElementsAre;

struct Mistake {
  const char* kind;
  std::string config;  ///< the file's text
  std::string place;   ///< JSON pointer, as the line shows it
  std::vector<std::string> words;
};

void PrintTo(const Mistake& mistake, std::ostream* out) {
  *out << mistake.kind;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw Error("the config does not hold " + from);
  return text.replace(at, from.size(), to);
}

const std::vector<Mistake> kMistakes{
    {"UnknownKey", smallConfig(R"({"camrea": {}})"), "/camrea", {"unknown", "did you mean \"camera\""}},
    {"WrongType", smallConfig(R"({"output": {"size": "big"}})"), "/output/size", {"found \"big\"", "pixels"}},
    {"OutOfRange", smallConfig(R"({"measure": {"frames": 0}})"), "/measure/frames", {"found 0", "from 1 to 100000"}},
    {"UnknownTechnique",
     smallConfig(R"({"techniques": [{"technique": "shadow_mpa"}]})"),
     "/techniques/0/technique",
     {"'shadow_mpa'", "did you mean 'shadow_map'"}},
    {"UnknownParameter",
     smallConfig(R"({"techniques": [{"technique": "pcf", "parameters": {"tapz": 3}}]})"),
     "/techniques/0/parameters/tapz",
     {"unknown", "did you mean \"taps\""}},
    {"ParameterOutOfRange",
     smallConfig(R"({"techniques": [{"technique": "pcf", "sweep": {"taps": [3, 99]}}]})"),
     "/techniques/0/sweep/taps/1",
     {"found 99", "from 2 to 31"}},
    {"RepeatedKey", replaced(smallConfig(), "\"output\"", "\"measure\""), "/measure", {"given twice"}},
    {"SweepOfASetParameter",
     smallConfig(R"({"techniques": [{"technique": "pcf", "parameters": {"taps": 3}, "sweep": {"taps": [3, 5]}}]})"),
     "/techniques/0/sweep/taps",
     {"also set in parameters"}},
    {"SweepThatIsNoList",
     smallConfig(R"({"techniques": [{"technique": "pcf", "sweep": {"taps": 5}}]})"),
     "/techniques/0/sweep/taps",
     {"found 5", "a list"}},
    {"SweepOfNothing",
     smallConfig(R"({"techniques": [{"technique": "pcf", "sweep": {"taps": []}}]})"),
     "/techniques/0/sweep/taps",
     {"a list"}},
    {"MissingSceneFile",
     smallConfig(R"({"scene": {"builtin": null, "file": "none.glb"}})"),
     "/scene/file",
     {"none.glb", "No such file"}},
    {"UnknownBuiltinScene",
     smallConfig(R"({"scene": {"builtin": "half_plain"}})"),
     "/scene/builtin",
     {"did you mean \"half_plane\""}},
    {"KeyOfAnotherScene", smallConfig(R"({"scene": {"count": 3}})"), "/scene/count", {"unknown"}},
    {"BadLight",
     smallConfig(
         R"({"lights": [{"type": "spot", "position": [0, 5, 0], "target": [0, 0, 0], "cone_half_angle_degrees": 120}]})"),
     "/lights/0/cone_half_angle_degrees",
     {"found 120", "90"}},
    {"UnknownReference",
     smallConfig(R"({"reference": {"technique": "path_traced"}})"),
     "/reference/technique",
     {"path_traced"}},
    {"NotAnObject", "[]", "", {"found []", "an object with keys among"}},
    {"TextBehindTheDocument", smallConfig() + " {}", "", {"line", "column"}},
    {"MissingKey", smallConfig(R"({"scene": null})"), "", {"\"scene\" is missing", "built-in scene"}},
    {"FractionForAnInteger",
     smallConfig(R"({"techniques": [{"technique": "pcf", "parameters": {"taps": 3.5}}]})"),
     "/techniques/0/parameters/taps",
     {"found 3.5", "an integer from 2 to 31"}},
    {"UnknownChoice",
     smallConfig(R"({"techniques": [{"technique": "shadow_map", "parameters": {"map_format": "d23"}}]})"),
     "/techniques/0/parameters/map_format",
     {"\"d23\"", "did you mean \"d24\"", "d16, d24, d32f"}},
    {"UnknownPicture",
     smallConfig(R"({"output": {"images": ["shadde"]}})"),
     "/output/images/0",
     {"did you mean \"shaded\"", "visibility"}},
    {"PictureListedTwice", smallConfig(R"({"output": {"images": ["error", "error"]}})"), "/output/images/1", {"twice"}},
    {"UnknownRegime",
     smallConfig(R"({"measure": {"regimes": ["dynamc"]}})"),
     "/measure/regimes/0",
     {"did you mean \"dynamic\""}},
    {"UnknownToggle",
     smallConfig(R"({"plan": {"penumbra": "offf"}})"),
     "/plan/penumbra",
     {"did you mean \"off\"", "auto, on, off"}},
    {"UnknownEffect", smallConfig(R"({"plan": {"penumbrae": "off"}})"), "/plan/penumbrae", {"did you mean \"penumbra\""}},
    {"UnknownDefence",
     smallConfig(R"({"plan": {"without": ["behind_lights"]}})"),
     "/plan/without/0",
     {"unknown defence", "did you mean \"behind_light\"", "plane_beyond_far"}},
    {"ReservedParameter",
     smallConfig(R"({"reference": {"parameters": {"seed": 7}}})"),
     "/reference/parameters/seed",
     {"reserved"}},
    {"ReferenceOfOneSample",
     smallConfig(R"({"reference": {"parameters": {"samples": 1}}})"),
     "/reference/parameters/samples",
     {"found 1", "2 or more"}},
    {"NoLight", smallConfig(R"({"lights": []})"), "/lights", {"found []", "at least one light"}},
    {"KeyOfAnotherLight",
     smallConfig(R"({"lights": [{"type": "point", "position": [0, 5, 0], "cone_half_angle_degrees": 20}]})"),
     "/lights/0/cone_half_angle_degrees",
     {"spot"}},
    {"TooShortVector",
     smallConfig(R"({"camera": {"position": [0, 9]}})"),
     "/camera/position",
     {"found [0,9]", "three numbers"}},
    {"UnknownNode",
     smallConfig(R"({"scene": {"builtin": "animated", "move": {"no_such_node": [0, 0, 0]}}})"),
     "/scene/move/no_such_node",
     {"no node", "'no_such_node'"}},
    {"SweepValueListedTwice",
     smallConfig(R"({"techniques": [{"technique": "pcf", "sweep": {"taps": [3, 3.0]}}]})"),
     "/techniques/0/sweep/taps/1",
     {"listed twice"}},
    {"SyntaxError",
     "{\"scene\": {\"builtin\": \"half_plane\"},\n \"techniques\": [}",
     "",
     {"line 2, column 17", "syntax error"}},
};

class BadConfig : public ::testing::TestWithParam<Mistake> {};

TEST_P(BadConfig, IsOneLineWithItsPlaceAndNothingIsWritten) {
  const TemporaryFolder folder;
  const std::string file = folder.write("run.json", GetParam().config).string();
  const Outcome outcome = gnomonProgram({"batch", file, "--out", (folder / "out").string()});
  EXPECT_EQ(outcome.exitCode, 2) << outcome.all();
  const std::vector<std::string> errors = outcome.lines("error");
  ASSERT_EQ(errors.size(), 1U) << outcome.all();
  EXPECT_THAT(errors[0], StartsWith(file + ": " + (GetParam().place.empty() ? "" : GetParam().place + ": ")));
  for (const std::string& word : GetParam().words) EXPECT_THAT(errors[0], HasSubstr(word));
  EXPECT_EQ(outcome.err, "error: " + errors[0] + "\n") << "nothing but the line";
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

INSTANTIATE_TEST_SUITE_P(Kinds, BadConfig, ::testing::ValuesIn(kMistakes),
                         [](const ::testing::TestParamInfo<Mistake>& each) { return std::string(each.param.kind); });

/// Nine kinds in one file.
const char* const kManyMistakes = R"({
  "scene": {"file": "none.glb"},
  "camrea": {"position": [0, 1, 2]},
  "lights": [{"type": "spot", "position": [0, 5, 0], "target": [0, 0, 0], "cone_half_angle_degrees": 120}],
  "output": {"size": "big"},
  "techniques": [{"technique": "shadow_mpa"},
                 {"technique": "pcf", "parameters": {"tapz": 3}},
                 {"technique": "pcf", "parameters": {"taps": 3}, "sweep": {"taps": [3, 5]}}],
  "measure": {"frames": 0, "frames": 2}})";

TEST(BadConfigs, AllMistakesAreSaidInOneRun) {
  const TemporaryFolder folder;
  const std::string file = folder.write("run.json", kManyMistakes).string();
  const Outcome outcome = gnomonProgram({"batch", file, "--out", (folder / "out").string()});
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.lines("error"),
              UnorderedElementsAre(StartsWith(file + ": /measure/frames: "), StartsWith(file + ": /camrea: "),
                                   StartsWith(file + ": /lights/0/cone_half_angle_degrees: "),
                                   StartsWith(file + ": /output/size: "), StartsWith(file + ": /techniques/2/sweep/taps: "),
                                   StartsWith(file + ": /scene/file: "), StartsWith(file + ": /techniques/0/technique: "),
                                   StartsWith(file + ": /techniques/1/parameters/tapz: ")))
      << outcome.all();
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

/// Nothing that one fault hides: without lights of its own a config has no jobs until its scene is known.
TEST(BadConfigs, TechniquesAreCheckedWhateverTheSceneIs) {
  for (const char* scene : {R"({"builtin": null, "file": "none.glb"})", R"({"builtin": "half_plain"})"}) {
    const TemporaryFolder folder;
    const std::string techniques = R"([{"technique": "shadow_mpa"}, {"technique": "pcf", "parameters": {"tapz": 3}}])";
    const std::string file =
        folder.write("run.json", smallConfig("{\"scene\": " + std::string(scene) + ", \"techniques\": " + techniques + "}"))
            .string();
    EXPECT_THAT(gnomonProgram({"validate", file}).lines("error"),
                UnorderedElementsAre(StartsWith(file + ": /scene"), StartsWith(file + ": /techniques/0/technique: "),
                                     StartsWith(file + ": /techniques/1/parameters/tapz: ")))
        << scene;
  }
}

/// Fifteen million jobs: they are refused by their number, not made.
TEST(BadConfigs, ASweepOfTooManyCombinationsIsRefused) {
  std::string values;
  for (int i = 0; i < 250; ++i) values += (i == 0 ? "[" : ", ") + std::to_string(0.25 + i / 256.0);
  values += "]";
  const TemporaryFolder folder;
  const std::string sweep =
      R"({"spread": )" + values + R"(, "bias.constant": )" + values + R"(, "bias.slope": )" + values + "}";
  const std::string file =
      folder.write("run.json", smallConfig(R"({"techniques": [{"technique": "pcf", "sweep": )" + sweep + "}]}")).string();
  EXPECT_THAT(gnomonProgram({"validate", file}).lines("error"),
              ElementsAre(AllOf(StartsWith(file + ": /techniques/0/sweep: "), HasSubstr("more than 100000 combinations"))));
}

/// A config without a scene has techniques all the same.
TEST(BadConfigs, TechniquesAreCheckedWithoutAScene) {
  const TemporaryFolder folder;
  const std::string file = folder.write("run.json", R"({"techniques": [{"technique": "shadow_mpa"}]})").string();
  EXPECT_THAT(gnomonProgram({"validate", file}).lines("error"),
              UnorderedElementsAre(AllOf(StartsWith(file + ": "), HasSubstr("\"scene\" is missing")),
                                   StartsWith(file + ": /techniques/0/technique: ")));
}

TEST(BadConfigs, EveryFileIsReadBeforeAnythingRuns) {
  const TemporaryFolder folder;
  const std::string good = folder.write("good.json", smallConfig()).string();
  const std::string one = folder.write("one.json", smallConfig(R"({"measure": {"frames": 0}})")).string();
  const std::string two = folder.write("two.json", "[]").string();
  const Outcome outcome = gnomonProgram({"batch", good, one, two, "--out", (folder / "out").string()});
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.lines("error"), ElementsAre(StartsWith(one + ": /measure/frames: "), StartsWith(two + ": ")))
      << outcome.all();
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(BadConfigs, EarlierResultsStayAsTheyAre) {
  for (const char* command : {"batch", "render"}) {
    const TemporaryFolder folder;
    const std::string earlier = "{\"job\": \"kept\"}\n{\"torn";
    folder.write("out/results.jsonl", earlier);
    const std::string file = folder.write("run.json", kManyMistakes).string();
    EXPECT_EQ(gnomonProgram({command, file, "--out", (folder / "out").string()}).exitCode, 2);
    EXPECT_EQ(readFile(folder / "out/results.jsonl"), earlier);
    EXPECT_THAT(namesIn(folder / "out"), ElementsAre("results.jsonl"));
  }
}

TEST(BadConfigs, AFileThatIsNotThere) {
  const TemporaryFolder folder;
  const std::string file = (folder / "run.json").string();
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"batch", file, "--out", (folder / "out").string()}, {"validate", file}, {"plan", file}}) {
    const Outcome outcome = gnomonProgram(arguments);
    EXPECT_EQ(outcome.exitCode, 2);
    EXPECT_THAT(outcome.lines("error"), ElementsAre(AllOf(HasSubstr(file), HasSubstr("No such file")))) << outcome.all();
  }
  EXPECT_THAT(namesIn(folder.path()), IsEmpty());
}

TEST(BadConfigs, PlanAndValidateSayTheSameOfAReadersMistake) {
  const TemporaryFolder folder;
  const std::string file = folder.write("run.json", smallConfig(R"({"measure": {"frames": 0}})")).string();
  const Outcome plan = gnomonProgram({"plan", file});
  EXPECT_EQ(plan.exitCode, 2);
  EXPECT_EQ(plan.err, gnomonProgram({"validate", file}).err);
}

TEST(BadConfigs, PlanPlacesAMissingScene) {
  const TemporaryFolder folder;
  const std::string file =
      folder.write("run.json", smallConfig(R"({"scene": {"builtin": null, "file": "none.glb"}})")).string();
  const Outcome outcome = gnomonProgram({"plan", file});
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.lines("error"), ElementsAre(AllOf(StartsWith(file + ": /scene/file: "), HasSubstr("none.glb"))));
}

}  // namespace
}  // namespace gnomon::test
