// The viewer as a person uses it: a real window, real keys, and what it shows against what the runner renders.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "viewer_window.h"

namespace gnomon::test {
namespace {

using ::testing::HasSubstr;

TEST_F(ViewerWindow, FlippedThroughAllTechniquesAndBackShowsTheRunnersPicture) {
  play(
      "key H\nkey 2\nwait 2\nkey Right\nwait 2\nkey Right\nwait 2\nkey Right\nwait 2\nkey Right\nwait 2\n"
      "screenshot view.png\nsave view.json\n");
  EXPECT_TRUE(bytes("view.png") == runnersPicture("view.json"));
}

TEST_F(ViewerWindow, MovedCameraLightAndParameterAreInTheSavedConfig) {
  play(
      "key H\nkey 3\nwait 2\nmouse 100 100\npress left\nmouse 130 90\nrelease left\nwheel 2\nhold L\nmouse 150 110\nwheel 1\n"
      "release L\nkey ]\nkey Down\nkey +\nwait 20\nscreenshot view.png\nsave view.json\n");
  EXPECT_TRUE(bytes("view.png") == runnersPicture("view.json"));
}

TEST_F(ViewerWindow, AMovedNodeAndTheTimeAreInTheSavedConfig) {
  folder_.write("moving.json", R"({"scene": {"builtin": "animated"}, "output": {"size": [320, 240]},
      "techniques": [{"technique": "shadow_map"}]})");
  play(
      "key H\nwait 2\nkey .\nkey .\nkey .\nkey N\nhold M\nmouse 100 100\nmouse 120 90\nrelease M\nwait 20\n"
      "key H\nkey H\nwait 2\nscreenshot view.png\nsave view.json\n",
      "moving.json");
  const Json saved = json("view.json");
  EXPECT_NEAR(saved["scene"]["time"].get<double>(), 0.1, 1e-9);
  EXPECT_EQ(saved["scene"]["move"].size(), 1u) << saved.dump();
  EXPECT_TRUE(bytes("view.png") == runnersPicture("view.json"));
}

TEST_F(ViewerWindow, PlayingMovesTheSceneAndPausingStopsIt) {
  folder_.write("moving.json", R"({"scene": {"builtin": "animated"}, "techniques": [{"technique": "shadow_map"}]})");
  play(
      "key H\nwait 2\nscreenshot start.png\nkey P\nwait 30\nkey P\nwait 1\nscreenshot paused.png\nwait 10\n"
      "screenshot still.png\n",
      "moving.json");
  EXPECT_FALSE(bytes("start.png") == bytes("paused.png"));
  EXPECT_TRUE(bytes("paused.png") == bytes("still.png"));
}

TEST_F(ViewerWindow, AClickSelectsTheNodeUnderTheCursor) {
  // The middle of the picture is where the camera looks: at the blocker.
  folder_.write("one.json", R"({"scene": {"builtin": "square"}, "camera": {"position": [0, 6, 0.1], "target": [0, 1, 0]},
      "techniques": [{"technique": "unshadowed"}]})");
  play("wait 2\nmouse 160 120\npress left\nrelease left\nwait 2\nhold M\nmouse 170 120\nrelease M\nsave view.json\n",
       "one.json");
  EXPECT_TRUE(json("view.json")["scene"]["move"].contains("blocker")) << bytes("view.json");
}

TEST_F(ViewerWindow, RealKeysFlipScreenshotAndQuit) {
  Viewer viewer(display_.name(), folder_.path(), on("config.json"));
  viewer.waitForWindow();
  viewer.keys({"h", "Right"});
  EXPECT_FALSE(screenshot(viewer).empty());
  EXPECT_EQ(savedConfig(viewer)["techniques"][0]["technique"], "shadow_map");
  viewer.keys({"Escape"});
  EXPECT_EQ(viewer.exitCode(), 0) << viewer.errors();
}

TEST_F(ViewerWindow, RealMouseOrbitsAndZooms) {
  Viewer viewer(display_.name(), folder_.path(), on("config.json"));
  viewer.waitForWindow();
  const Json before = savedConfig(viewer);
  const std::vector<std::string> find{"search", "--onlyvisible", "--name", "Gnomon: "};
  const auto onWindow = [&](std::vector<std::string> words) {
    std::vector<std::string> all = find;
    all.insert(all.end(), words.begin(), words.end());
    return all;
  };
  viewer.xdotool({onWindow({"mousemove", "--window", "%1", "100", "100"}),
                  {"mousedown", "1"},
                  {"mousemove_relative", "40", "0"},
                  {"mouseup", "1"},
                  {"click", "4"}});
  const Json after = savedConfig(viewer);
  const auto distance = [&](const Json& config) {
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double d = config["camera"]["position"][i].get<double>() - config["camera"]["target"][i].get<double>();
      sum += d * d;
    }
    return std::sqrt(sum);
  };
  EXPECT_NE(before["camera"]["position"], after["camera"]["position"]);
  EXPECT_NEAR(distance(after) / distance(before), 0.9, 1e-6);  // one click of the wheel
}

TEST_F(ViewerWindow, AWarmTechniqueIsShownInTheFrameAfterItsKey) {
  Viewer viewer(display_.name(), folder_.path(), on("config.json"));
  viewer.waitForWindow();
  viewer.keys({"Right", "Right", "Right", "Right"});
  ASSERT_TRUE(viewer.untilFrame([](const Json& f) { return f["technique"] == "unshadowed" && f["events"] == 4; }));
  const std::size_t warm = viewer.frames().size();
  viewer.keys({"Right", "Left", "3", "2", "Tab"});
  ASSERT_TRUE(viewer.untilFrame([](const Json& f) { return f["events"] == 9; })) << viewer.lastFrame();
  const std::vector<Json> all = viewer.frames();
  int keys = 0;
  for (std::size_t i = warm; i < all.size(); ++i) {
    if (all[i]["events"] == all[i - 1]["events"]) continue;
    ++keys;
    EXPECT_EQ(all[i]["shown"], all[i]["technique"]) << all[i];  // the very frame that sees the key
    EXPECT_FALSE(all[i]["compiling"].get<bool>());
  }
  EXPECT_EQ(keys, 5);
}

TEST_F(ViewerWindow, AFirstUseShowsThePictureBeforeAndSaysThatItCompiles) {
  play("wait 2\nkey Right\nwait 3\nkey Left\nwait 2\nkey Right\nwait 2\n");
  int compiling = 0;
  for (const Json& frame : frames()) {
    if (!frame["compiling"].get<bool>() || frame["technique"] != "shadow_map") continue;
    ++compiling;
    EXPECT_EQ(frame["shown"], "unshadowed");
  }
  EXPECT_EQ(compiling, 1);
}

TEST_F(ViewerWindow, AUniformParameterChangesWithoutSetUp) {
  // bias.constant of shadow_map is the third parameter: map_size, map_format, bias.constant.
  play("key 2\nwait 3\nkey Down\nkey Down\nwait 2\nkey +\nwait 2\nsave view.json\n");
  const auto& all = frames();
  const Json& before = all[all.size() - 3];
  const Json& after = all.back();
  EXPECT_EQ(before["gl_objects"], after["gl_objects"]);
  EXPECT_GT(json("view.json")["techniques"][0]["parameters"]["bias.constant"].get<double>(), 2.0);
}

TEST_F(ViewerWindow, TheReferenceRefinesInTheBackgroundAndGivesTheError) {
  play("key 2\nwait 3\nrefine\nwait 1\n");
  const Json last = frames().back();
  EXPECT_EQ(last["reference_samples"], 64);
  ASSERT_TRUE(last["rmse"].is_number()) << last;
  EXPECT_GT(last["rmse"].get<double>(), 0.01);
  EXPECT_LT(last["rmse"].get<double>(), 0.2);
  // In slices: several frames were drawn on the way, with fewer rays.
  bool partly = false;
  for (const Json& frame : frames()) partly = partly || (frame["reference_samples"] > 0 && frame["reference_samples"] < 64);
  EXPECT_TRUE(partly);
}

TEST_F(ViewerWindow, TheDividerUncoversThePictureThatSpaceShows) {
  // Against the technique before, then against the reference.
  const std::string dragged = "mouse 160 200\npress left\nmouse 0 200\nrelease left\nwait 2\n";
  play("key H\nkey 2\nwait 3\nhold Space\nwait 2\nscreenshot held.png\nrelease Space\nkey C\n" + dragged +
       "screenshot split.png\nkey C\nkey R\nrefine\nhold Space\nwait 2\nscreenshot held_reference.png\nrelease Space\nkey C\n"
       "wait 2\nscreenshot split_reference.png\n");
  EXPECT_TRUE(bytes("held.png") == bytes("split.png"));
  EXPECT_TRUE(bytes("held_reference.png") == bytes("split_reference.png"));
  EXPECT_FALSE(bytes("held.png") == bytes("held_reference.png"));
}

TEST_F(ViewerWindow, TheDifferenceOfEqualsIsBlank) {
  folder_.write("twice.json", R"({"scene": {"builtin": "layers"}, "techniques": [{"technique": "unshadowed"},
      {"technique": "unshadowed"}, {"technique": "shadow_map"}, {"technique": "shadow_map"}]})");
  play(
      "key H\nkey X\nkey 2\nwait 3\nscreenshot lit.png\nkey 3\nwait 3\nscreenshot unequal.png\nkey 4\nwait 3\n"
      "screenshot shadowed.png\n",
      "twice.json");
  EXPECT_TRUE(bytes("lit.png") == bytes("shadowed.png"));
  EXPECT_FALSE(bytes("lit.png") == bytes("unequal.png"));
}

TEST_F(ViewerWindow, AMovementStartsTheReferenceAgain) {
  play("key 2\nwait 3\nrefine\nmouse 100 100\npress left\nmouse 130 100\nrelease left\nwait 1\nwait 2\nrefine\nwait 1\n");
  bool forgotten = false;
  bool seen = false;
  for (const Json& frame : frames()) {
    seen = seen || frame["rmse"].is_number();
    forgotten = forgotten || (seen && frame["rmse"].is_null());
  }
  EXPECT_TRUE(forgotten);
  EXPECT_TRUE(frames().back()["rmse"].is_number());
}

TEST_F(ViewerWindow, CaptureWritesEveryTechniquesViewsAndTextures) {
  play("wait 3\nkey Ctrl-E\nwait 2\n");
  std::vector<std::string> files;
  for (const auto& item : std::filesystem::recursive_directory_iterator(folder_.path())) {
    const std::string name = item.path().filename().string();
    if (item.path().parent_path().filename().string().rfind("gnomon-", 0) == 0 && name.ends_with(".exr")) files.push_back(name);
  }
  const std::vector<std::string> wanted{"scene-position.exr", "1-unshadowed.exr",           "2-shadow_map.exr", "3-pcf.exr",
                                        "4-ray_traced.exr",   "2-shadow_map-depth_map.exr", "3-pcf-filter.exr"};
  for (const std::string& name : wanted)
    EXPECT_TRUE(std::find(files.begin(), files.end(), name) != files.end())
        << name << " is not among " << ::testing::PrintToString(files);
}

TEST_F(ViewerWindow, ASlowMovingPictureIsDrawnAtLowerResolutionAndThenWhole) {
  play(
      "key H\nkey 2\nwait 3\nsave a.json\nmouse 100 100\npress left\nmouse 101 100\nwait 1\nmouse 102 100\nwait 1\nmouse 103 "
      "100\n"
      "wait 1\nrelease left\nwait 30\nscreenshot view.png\nsave view.json\n",
      "config.json", {"--frame-budget", "0.001"});
  int lowest = 1;
  for (const Json& frame : frames()) lowest = std::max(lowest, frame["reduction"].get<int>());
  EXPECT_EQ(lowest, 4);
  EXPECT_EQ(frames().back()["reduction"], 1);
  EXPECT_TRUE(bytes("view.png") == runnersPicture("view.json"));
}

TEST_F(ViewerWindow, ADenserScreenGetsALargerWindowAndText) {
  const Display dense(192);
  Viewer viewer(dense.name(), folder_.path(), on("config.json"));
  viewer.waitForWindow();
  EXPECT_EQ(viewer.lastFrame()["size"], (Json{640, 480}));
  EXPECT_EQ(viewer.lastFrame()["scale"], 2.0);
  viewer.keys({"Escape"});
  EXPECT_EQ(viewer.exitCode(), 0) << viewer.errors();
}

TEST_F(ViewerWindow, FaultsOfAScriptAreToldWithTheirLines) {
  folder_.write("script", "key Right\nklick 1\nkey Rigth\nwait x\n");
  Viewer viewer(display_.name(), folder_.path(), on("config.json", {"--script", "script"}));
  EXPECT_EQ(viewer.exitCode(), 2);
  const std::string errors = viewer.errors();
  EXPECT_THAT(errors, HasSubstr("script:2: "));
  EXPECT_THAT(errors, HasSubstr("script:3: "));
  EXPECT_THAT(errors, HasSubstr("script:4: "));
}

TEST_F(ViewerWindow, WithoutADisplayPointsToTheRunner) {
  Viewer viewer("", folder_.path(), {"config.json"});
  EXPECT_EQ(viewer.exitCode(), 2);
  EXPECT_THAT(viewer.errors(), HasSubstr("gnomon render"));
}

}  // namespace
}  // namespace gnomon::test
