#include "gnomon/run/config.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "gnomon/run/scene_choice.h"

namespace gnomon {
namespace {

std::vector<std::string> faults(const std::string& text) {
  Problems problems;
  readRunConfigText("runs/c.json", text, problems);
  std::vector<std::string> lines;
  for (const Problem& problem : problems.list()) lines.push_back(problem.line());
  return lines;
}

RunConfig readWell(const std::string& text) {
  Problems problems;
  RunConfig config = readRunConfigText("runs/c.json", text, problems);
  EXPECT_TRUE(problems.empty()) << problems.list().front().line();
  return config;
}

/// A config with one more key (and its comma).
std::string with(const std::string& more) {
  return R"({"scene": {"builtin": "half_plane"}, "techniques": [{"technique": "pcf"}])" + (more.empty() ? "" : ", " + more) +
         "}";
}

std::string withTechnique(const std::string& entry) {
  return R"({"scene": {"builtin": "half_plane"}, "techniques": [)" + entry + "]}";
}

TEST(RunConfig, ReadsTheExampleOfTheDocumentation) {
  const RunConfig config = readWell(R"({"$schema": "schema/run.schema.json", "name": "sphere-grid",
 "scene": {"builtin": "sphere_grid", "count": 7}, "plan": {"penumbra": "off"},
 "camera": {"position": [0, 9, 14], "target": [0, 0, 0], "vertical_fov_degrees": 45},
 "lights": [{"type": "spot", "position": [6, 10, 4], "target": [0, 0, 0], "cone_half_angle_degrees": 30,
             "source": {"shape": "rectangle", "size": [1, 1], "roll_degrees": 0}}],
 "output": {"size": [1024, 768], "images": ["shaded", "visibility", "error"]},
 "reference": {"technique": "ray_traced", "parameters": {"samples": 1024}},
 "baseline": {"technique": "shadow_map"},
 "techniques": [{"technique": "shadow_map", "sweep": {"map_size": [512, 1024, 2048]}},
                {"technique": "pcf", "parameters": {"kernel": "box"}, "sweep": {"taps": [3, 5, 9]}}],
 "measure": {"regimes": ["dynamic", "static"], "frames": 20, "blocks": 4}})");
  EXPECT_EQ(config.name, "sphere-grid");
  EXPECT_EQ(config.scenes[0].builtin, "sphere_grid");
  EXPECT_EQ(config.scenes[0].parameters.count, 7);
  EXPECT_EQ(config.plan[Effect::penumbra], Toggle::off);
  EXPECT_EQ(config.camera->position, glm::dvec3(0.0, 9.0, 14.0));
  ASSERT_EQ(config.lights->size(), 1U);
  EXPECT_EQ(config.lights->front().source.shape, SourceShape::rectangle);
  EXPECT_EQ(config.output.size, glm::ivec2(1024, 768));
  EXPECT_EQ(config.output.images.size(), 3U);
  EXPECT_EQ(config.reference->technique, "ray_traced");
  EXPECT_EQ(config.reference->parameters->dump(), R"({"samples":1024})");
  EXPECT_EQ(config.baseline->technique, "shadow_map");
  ASSERT_EQ(config.techniques.size(), 2U);
  EXPECT_EQ(config.techniques[0].sweep->dump(), R"({"map_size":[512,1024,2048]})");
  EXPECT_EQ(config.techniques[1].parameters->dump(), R"({"kernel":"box"})");
  EXPECT_EQ(config.techniques[1].where.pointer, "/techniques/1");
  EXPECT_EQ(config.measure.regimes.size(), 2U);
  EXPECT_EQ(config.measure.frames, 20);
  EXPECT_EQ(config.measure.blocks, 4);
}

TEST(RunConfig, WhatIsNotNamedIsLeftToTheScene) {
  const RunConfig config = readWell(with(""));
  EXPECT_EQ(config.name, "c");
  EXPECT_FALSE(config.camera);
  EXPECT_FALSE(config.lights);
  EXPECT_FALSE(config.reference);
  EXPECT_FALSE(config.baseline);
  EXPECT_EQ(config.output.size, glm::ivec2(800, 600));
  EXPECT_EQ(config.measure.frames, 30);
  EXPECT_FALSE(config.techniques[0].parameters);
}

TEST(RunConfig, MustNameSceneAndTechniques) {
  EXPECT_EQ(faults("{}"), (std::vector<std::string>{
                              "runs/c.json: the key \"scene\" is missing: a built-in scene or a glTF file, or a list of them",
                              "runs/c.json: the key \"techniques\" is missing: what is rendered, compared and "
                              "measured"}));
  EXPECT_EQ(faults(withTechnique("")).size(), 1U);
  EXPECT_EQ(faults(withTechnique("{}")).size(), 1U);
}

TEST(RunConfig, UnknownAndRepeatedKeysAreFaults) {
  EXPECT_EQ(faults(with(R"("outputs": {}, "name": "a", "name": "b")")).size(), 2U);
}

TEST(RunConfig, SizesEndAt16384) {
  EXPECT_TRUE(faults(with(R"("output": {"size": [16384, 1]})")).empty());
  EXPECT_EQ(faults(with(R"("output": {"size": [16385, 1]})")).size(), 1U);
  EXPECT_EQ(faults(with(R"("output": {"size": [0, 1]})")).size(), 1U);
}

TEST(RunConfig, ImagesAndRegimesAreNames) {
  EXPECT_EQ(faults(with(R"("output": {"images": ["shadde"]}, "measure": {"regimes": ["dynamics"], "frames": 0})")),
            (std::vector<std::string>{
                "runs/c.json: /output/images/0: unknown name \"shadde\"; did you mean \"shaded\"? allowed: shaded, visibility, "
                "error, "
                "work, class, reference",
                "runs/c.json: /measure/regimes/0: unknown name \"dynamics\"; did you mean \"dynamic\"? allowed: dynamic, "
                "animated, camera, static",
                "runs/c.json: /measure/frames: found 0; allowed: an integer from 1 to 100000"}));
}

TEST(RunConfig, AnEmptyListOfLightsIsAFault) {
  EXPECT_EQ(faults(with(R"("lights": [])")).size(), 1U);
}

TEST(RunConfig, AFaultInALightTellsItsPlace) {
  const auto lines = faults(with(R"("lights": [{"type": "spot"}, {"type": "sun"}])"));
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].rfind("runs/c.json: /lights/1/type: unknown choice \"sun\"", 0), 0U) << lines[0];
}

TEST(SceneChoice, BuiltinScenesHaveTheirOwnKeys) {
  const auto scene = [](const std::string& text) {
    return R"({"scene": )" + text + R"(, "techniques": [{"technique": "a"}]})";
  };
  EXPECT_TRUE(faults(scene(R"({"builtin": "half_plane", "blocker_height": 2})")).empty());
  EXPECT_EQ(faults(scene(R"({"builtin": "half_plane", "count": 2})")).size(), 1U);  // a key of others
  const auto lines = faults(scene(R"({"builtin": "half_plan"})"));
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NE(lines[0].find("/scene/builtin: unknown built-in scene \"half_plan\"; did you mean \"half_plane\"?"),
            std::string::npos);
}

TEST(SceneChoice, FilesLieBesideTheConfig) {
  const RunConfig config = readWell(
      R"({"scene": {"file": "../scenes/x.glb", "cast": ["a", "b"], "receive": []}, "techniques": [{"technique": "a"}]})");
  EXPECT_EQ(config.scenes[0].file, "scenes/x.glb");
  EXPECT_EQ(config.scenes[0].cast->size(), 2U);
  EXPECT_TRUE(config.scenes[0].receive->empty());
  EXPECT_TRUE(config.scenes[0].builtin.empty());
}

TEST(SceneChoice, FileWithoutNodesMeansAll) {
  const RunConfig config = readWell(R"({"scene": {"file": "/x.glb"}, "techniques": [{"technique": "a"}]})");
  EXPECT_EQ(config.scenes[0].file, "/x.glb");
  EXPECT_FALSE(config.scenes[0].cast);
}

TEST(SceneChoice, IsOneOfTwo) {
  for (const char* scene : {"{}", "1", R"({"builtin": "square", "file": "x"})", R"({"builtin": 1})", R"({"file": ""})",
                            R"({"file": 1})", R"({"file": "x", "casts": []})", R"({"file": "x", "cast": "a"})"}) {
    EXPECT_EQ(faults(std::string(R"({"scene": )") + scene + R"(, "techniques": [{"technique": "a"}]})").size(), 1U) << scene;
  }
}

TEST(SceneChoice, MoveAndTimeBelongToEveryScene) {
  for (const char* which : {R"("builtin": "animated")", R"("file": "x.glb")"}) {
    const RunConfig config = readWell(std::string(R"({"scene": {)") + which +
                                      R"(, "move": {"a": [1, -2, 0.5], "b/~": [0, 0, 0]}, "time": 1.5},
                                          "techniques": [{"technique": "a"}]})");
    ASSERT_EQ(config.scenes[0].moves.size(), 2U) << which;
    EXPECT_EQ(config.scenes[0].moves[0], std::pair(std::string("a"), glm::dvec3(1.0, -2.0, 0.5))) << which;
    EXPECT_EQ(config.scenes[0].moves[1].first, "b/~") << which;
    EXPECT_EQ(config.scenes[0].time, 1.5) << which;
  }
}

TEST(SceneChoice, FaultsOfMoveAndTimeTellTheirPlace) {
  const auto placeOf = [](const std::string& keys) {
    const auto lines = faults(R"({"scene": {"builtin": "layers", )" + keys + R"(}, "techniques": [{"technique": "a"}]})");
    return lines.size() == 1 ? lines[0].substr(0, lines[0].find(": ", 14)) : std::to_string(lines.size()) + " faults";
  };
  EXPECT_EQ(placeOf(R"("time": -0.1)"), "runs/c.json: /scene/time");
  EXPECT_EQ(placeOf(R"("move": [1, 2, 3])"), "runs/c.json: /scene/move");
  EXPECT_EQ(placeOf(R"("move": {"a/b": [1, 2]})"), "runs/c.json: /scene/move/a~1b");
  EXPECT_EQ(placeOf(R"("move": {"a": [1, 2, 1e10]})"), "runs/c.json: /scene/move/a");
  EXPECT_EQ(placeOf(R"("move": {"a": [0, 0, 0], "a": [1, 1, 1]})"), "runs/c.json: /scene/move/a");
}

TEST(SceneChoice, IsWrittenAsItIsRead) {
  const std::vector<std::string> scenes{
      R"({"builtin":"half_plane","blocker_height":0.1,"source_size":1.0})",
      R"({"builtin":"animated","source_size":0.5,"move":{"bob":[0.1,0.0,-3.0],"a/b":[0.0,0.0,1.0]},"time":0.3})",
      R"({"file":"/x/y.glb","cast":["a"],"receive":[],"move":{"a":[1.0,2.0,3.0]},"time":12.0})", R"({"file":"/x/y.glb"})"};
  for (const std::string& text : scenes)
    EXPECT_EQ(writeSceneChoice(readWell(R"({"scene": )" + text + R"(, "techniques": [{"technique": "a"}]})").scenes[0]).dump(),
              text);
}

TEST(Sweep, ValuesAreNonEmptyListsOfDifferentValues) {
  EXPECT_EQ(faults(withTechnique(R"({"technique": "a", "sweep": {"x": [], "y": 1, "z": [1, 2, 1.0]}})")),
            (std::vector<std::string>{"runs/c.json: /techniques/0/sweep/x: found []; allowed: a list of at least one value",
                                      "runs/c.json: /techniques/0/sweep/y: found 1; allowed: a list of at least one value",
                                      "runs/c.json: /techniques/0/sweep/z/2: 1.0 is listed twice"}));
}

TEST(Sweep, OfASetParameterIsAFault) {
  EXPECT_EQ(
      faults(withTechnique(R"({"technique": "a", "parameters": {"x": 1}, "sweep": {"x": [1, 2]}})")),
      (std::vector<std::string>{"runs/c.json: /techniques/0/sweep/x: \"x\" is also set in parameters; allowed: one of both"}));
}

TEST(Sweep, SeedIsReserved) {
  EXPECT_EQ(faults(withTechnique(R"({"technique": "a", "parameters": {"seed": 1}})")),
            (std::vector<std::string>{
                "runs/c.json: /techniques/0/parameters/seed: \"seed\" is reserved: the framework chooses seeds itself"}));
  EXPECT_EQ(faults(withTechnique(R"({"technique": "a", "sweep": {"seed": [1, 2]}})")).size(), 1U);
  EXPECT_EQ(faults(with(R"("reference": {"technique": "r", "parameters": {"seed": 1}})")).size(), 1U);
}

TEST(Sweep, CombinationsAreBounded) {
  const auto sweepOf = [](int parameters) {
    std::string lists;
    for (int i = 0; i < parameters; ++i)
      lists += (i == 0 ? "\"p" : ", \"p") + std::to_string(i) + "\": [0, 1, 2, 3, 4, 5, 6, 7, 8, 9]";
    return withTechnique(R"({"technique": "a", "sweep": {)" + lists + "}}");
  };
  EXPECT_TRUE(faults(sweepOf(5)).empty());
  EXPECT_EQ(faults(sweepOf(6)).size(), 1U);
  EXPECT_EQ(faults(sweepOf(64)).size(), 1U);  // 10^64 does not fit in a counter
}

TEST(Sweep, IsNotForReferenceAndBaseline) {
  EXPECT_EQ(faults(with(R"("reference": {"technique": "r", "sweep": {"x": [1]}})")).size(), 1U);
}

TEST(RunConfig, WhatCannotBeOpenedIsOneFault) {
  Problems problems;
  readRunConfig("/nowhere/c.json", problems);
  ASSERT_EQ(problems.list().size(), 1U);
  EXPECT_EQ(problems.list()[0].line(), "/nowhere/c.json: cannot open: No such file or directory");
}

TEST(RunConfigSchema, KnowsEveryBuiltinSceneWithItsKeys) {
  const Json scene = runConfigSchema()["properties"]["scene"]["else"];
  ASSERT_EQ(scene["then"]["allOf"].size(), builtinScenes().size());
  EXPECT_TRUE(scene["then"]["allOf"][0]["then"]["properties"].contains("builtin"));
  EXPECT_EQ(scene["then"]["allOf"][0]["then"]["additionalProperties"], false);
  EXPECT_EQ(scene["else"]["required"].dump(), R"(["file"])");
}

}  // namespace
}  // namespace gnomon
