// The viewer where things go wrong: broken files, misbehaving plugins, odd windows, long use.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "gnomon/base/files.h"
#include "viewer_window.h"

namespace gnomon::test {
namespace {

using ::testing::HasSubstr;

constexpr const char* kMine = R"({"scene": {"builtin": "layers"}, "techniques": [{"technique": "my_map"}]})";

/// In place, as a compiler or `cp` writes: whoever has the file mapped sees it change.
void overwrite(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << bytes;
}

bool hasTrouble(const Json& frame, const std::string& what) {
  return frame["troubles"].contains(what);
}
bool hasNoTrouble(const Json& frame) {
  return frame["troubles"].empty();
}

TEST_F(ViewerWindow, ABrokenShaderLeavesTheLastGoodPictureAndSaysWhy) {
  const std::filesystem::path plugin = copyOfPlugin("unshadowed", "my_map");
  folder_.write("my.json", kMine);
  Viewer viewer(display_.name(), folder_.path(), on("my.json", withTechniques()));
  viewer.waitForWindow();
  viewer.keys({"h"});
  const std::string before = screenshot(viewer);
  const std::string shader = readFile(plugin / "unshadowed.frag");
  overwrite(plugin / "unshadowed.frag", "this is no shader\n");
  ASSERT_TRUE(viewer.untilFrame([](const Json& f) { return hasTrouble(f, "1 my_map"); })) << viewer.lastFrame();
  EXPECT_THAT(viewer.lastFrame()["troubles"]["1 my_map"].get<std::string>(), HasSubstr("unshadowed.frag"));
  EXPECT_TRUE(screenshot(viewer) == before);
  overwrite(plugin / "unshadowed.frag", shader);
  EXPECT_TRUE(viewer.untilFrame(hasNoTrouble)) << viewer.lastFrame();
  EXPECT_TRUE(screenshot(viewer) == before);
}

TEST_F(ViewerWindow, ABrokenLibraryLeavesTheLastGoodPictureAndARebuiltOneIsTaken) {
  const std::filesystem::path plugin = copyOfPlugin("unshadowed", "my_map");
  folder_.write("my.json", kMine);
  const std::string library = readFile(plugin / "unshadowed.so");
  Viewer viewer(display_.name(), folder_.path(), on("my.json", withTechniques()));
  viewer.waitForWindow();
  viewer.keys({"h"});
  const std::string before = screenshot(viewer);
  overwrite(plugin / "unshadowed.so", library.substr(0, library.size() / 2));
  ASSERT_TRUE(viewer.untilFrame([](const Json& f) { return hasTrouble(f, "config"); })) << viewer.lastFrame();
  EXPECT_TRUE(screenshot(viewer) == before);
  overwrite(plugin / "unshadowed.so", library);
  EXPECT_TRUE(viewer.untilFrame(hasNoTrouble)) << viewer.lastFrame();
  EXPECT_TRUE(screenshot(viewer) == before);
}

TEST_F(ViewerWindow, ARebuiltLibraryIsTakenWithoutRestart) {
  const std::filesystem::path to = folder_ / "techniques/generation";
  std::filesystem::create_directories(to.parent_path());
  const std::filesystem::path built = std::filesystem::path(GNOMON_BINARY_DIR) / "test_plugins";
  std::filesystem::copy(built / "generation", to);
  folder_.write("my.json", R"({"scene": {"builtin": "layers"}, "techniques": [{"technique": "generation"}]})");
  Viewer viewer(display_.name(), folder_.path(), on("my.json", withTechniques()));
  viewer.waitForWindow();
  ASSERT_TRUE(viewer.untilFrame([](const Json& f) { return f["failure"].get<std::string>().rfind("first", 0) == 0; }))
      << viewer.lastFrame();
  overwrite(to / "generation.so", readFile(built / "next_generation/next_generation.so"));
  EXPECT_TRUE(viewer.untilFrame([](const Json& f) { return f["failure"].get<std::string>().rfind("second", 0) == 0; }))
      << viewer.lastFrame();
}

TEST_F(ViewerWindow, AChangedConfigIsTakenAndABrokenOneChangesNothing) {
  Viewer viewer(display_.name(), folder_.path(), on("config.json"));
  viewer.waitForWindow();
  viewer.keys({"h", "2"});
  const std::string before = screenshot(viewer);
  const std::string config = bytes("config.json");
  overwrite(folder_ / "config.json", "{\"scene\": ");
  ASSERT_TRUE(viewer.untilFrame([](const Json& f) { return hasTrouble(f, "config"); })) << viewer.lastFrame();
  EXPECT_TRUE(screenshot(viewer) == before);
  Json changed = Json::parse(config);
  changed["camera"] = {{"position", {3, 9, 3}}, {"target", {0, 0, 0}}};
  overwrite(folder_ / "config.json", changed.dump());
  ASSERT_TRUE(viewer.untilFrame(hasNoTrouble)) << viewer.lastFrame();
  EXPECT_EQ(viewer.lastFrame()["technique"], "shadow_map");  // the choice stays
  EXPECT_FALSE(screenshot(viewer) == before);
}

TEST_F(ViewerWindow, APresetChangedInATechniqueFileIsTaken) {
  Json file = Json::parse(R"({"techniques": {"my_map": {"title": "Mine", "parameters": {"map_size": 128},
      "compose": {"projection": "single", "representation": "depth", "footprint": "nearest"}}}})");
  folder_.write("techniques/my_map.json", file.dump());
  folder_.write("my.json", kMine);
  Viewer viewer(display_.name(), folder_.path(), on("my.json", withTechniques()));
  viewer.waitForWindow();
  file["techniques"]["my_map"]["parameters"]["map_size"] = 64;
  overwrite(folder_ / "techniques/my_map.json", file.dump());
  ASSERT_TRUE(viewer.untilFrame([](const Json& f) { return f["message"] == "loaded again"; })) << viewer.lastFrame();
  // The preset is the technique's own: the saved config names it alone, and it is what the runner takes.
  const Json saved = savedConfig(viewer);
  EXPECT_FALSE(saved["techniques"][0].contains("parameters")) << saved.dump();
  viewer.keys({"plus"});
  EXPECT_EQ(savedConfig(viewer)["techniques"][0]["parameters"]["map_size"], 128);
}

TEST_F(ViewerWindow, EveryMisbehavingPluginIsSurvivedWithAMessage) {
  const std::vector<std::string> faults{"refuse",
                                        "throw_in_create",
                                        "throw_in_support",
                                        "throw_in_setup",
                                        "throw_number_in_setup",
                                        "throw_in_update",
                                        "throw_in_pass",
                                        "throw_number_in_pass",
                                        "no_visibility",
                                        "unknown_handle",
                                        "wrong_size",
                                        "syntax_error",
                                        "gl_error",
                                        "undeclared_read",
                                        "undeclared_write",
                                        "wrong_amount"};
  Json config = json("config.json");
  config["techniques"] = {{{"technique", "shadow_map"}}, {{"technique", "mischief"}, {"sweep", {{"fault", faults}}}}};
  folder_.write("bad.json", config.dump());
  std::string script = "key H\nwait 2\nscreenshot before.png\n";
  for (std::size_t i = 0; i < faults.size(); ++i) script += "key Right\nwait 3\n";
  script += "screenshot at_last.png\nkey Right\nwait 3\nscreenshot after.png\n";
  play(script, "bad.json", {"--technique-dir", std::string(GNOMON_BINARY_DIR) + "/test_plugins/mischief"});
  std::set<std::string> failures;
  for (const Json& frame : frames()) {
    if (frame["technique"] != "mischief" || frame["compiling"].get<bool>()) continue;
    EXPECT_NE(frame["failure"], "") << frame;
    EXPECT_EQ(frame["shown"], "shadow_map") << frame;  // the picture stays
    failures.insert(frame["failure"].get<std::string>());
  }
  EXPECT_EQ(failures.size(), faults.size()) << ::testing::PrintToString(failures);
  EXPECT_TRUE(bytes("before.png") == bytes("at_last.png"));
  EXPECT_TRUE(bytes("before.png") == bytes("after.png"));
}

TEST_F(ViewerWindow, FiveHundredFlipsCostNoMemory) {
  std::string script = "refine\n";
  for (int i = 0; i < 550; ++i) script += "key Right\nwait 1\n";
  play(script);
  const Json* warm = nullptr;
  for (const Json& frame : frames()) {
    if (frame["events"] == 50) warm = &frame;
  }
  ASSERT_NE(warm, nullptr);
  const Json& last = frames().back();
  EXPECT_EQ(last["events"], 550);
  EXPECT_EQ(last["gl_objects"], (*warm)["gl_objects"]);
  EXPECT_LE(last["resident_bytes"].get<double>() - (*warm)["resident_bytes"].get<double>(), 4e6);
}

TEST_F(ViewerWindow, AStormOfSizesEndsInTheRunnersPicture) {
  std::string script = "key H\nkey 2\nwait 3\n";
  for (const char* size : {"321 240", "1 1", "0 0", "640 2", "2 400", "0 5", "500 400", "123 77"})
    script += std::string("resize ") + size + "\nwait 1\n";
  script += "wait 15\nresize 200 150\nwait 15\nscreenshot view.png\nsave view.json\n";
  play(script);
  EXPECT_TRUE(bytes("view.png") == runnersPicture("view.json"));
}

TEST_F(ViewerWindow, RealResizingUnmappingAndMappingAreSurvived) {
  Viewer viewer(display_.name(), folder_.path(), on("config.json"));
  viewer.waitForWindow();
  const auto onWindow = [](std::vector<std::string> words) {
    std::vector<std::string> all{"search", "--name", "Gnomon: "};
    all.insert(all.end(), words.begin(), words.end());
    return all;
  };
  for (const int size : {400, 1, 700, 33, 512}) {
    viewer.xdotool({onWindow({"windowsize", std::to_string(size), std::to_string(size / 2 + 1)})});
  }
  ASSERT_TRUE(viewer.untilFrame([](const Json& f) { return f["size"] == Json{512, 257}; })) << viewer.lastFrame();
  viewer.xdotool({onWindow({"windowunmap"})});
  sleepMilliseconds(500);
  EXPECT_TRUE(viewer.running()) << viewer.errors();
  viewer.xdotool({onWindow({"windowmap"})});
  viewer.keys({"Right"});
  EXPECT_TRUE(viewer.untilFrame([](const Json& f) { return f["technique"] == "shadow_map"; })) << viewer.lastFrame();
  viewer.keys({"Escape"});
  EXPECT_EQ(viewer.exitCode(), 0) << viewer.errors();
}

TEST_F(ViewerWindow, OpeningABrokenFileSaysSoAndKeepsThePicture) {
  folder_.write("broken.glb", "glTF");
  play("key H\nwait 3\nscreenshot before.png\nopen broken.glb\nwait 2\nscreenshot after.png\nopen config.json\nwait 3\n");
  EXPECT_TRUE(bytes("before.png") == bytes("after.png"));
  bool told = false;
  for (const Json& frame : frames()) told = told || !frame["troubles"].empty();
  EXPECT_TRUE(told);
  EXPECT_TRUE(frames().back()["troubles"].empty()) << frames().back();
}

}  // namespace
}  // namespace gnomon::test
