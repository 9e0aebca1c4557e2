// The viewer as a person uses it: a real window, real keys, and what it shows against what the runner renders.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "display.h"
#include "gnomon/base/files.h"
#include "program.h"
#include "temporary_folder.h"

namespace gnomon::test {
namespace {

using ::testing::HasSubstr;

constexpr const char* kConfig = R"({
  "scene": {"builtin": "layers"},
  "output": {"size": [320, 240]},
  "reference": {"technique": "ray_traced", "parameters": {"samples": 4}},
  "techniques": [{"technique": "unshadowed"}, {"technique": "shadow_map", "parameters": {"map_size": 256}},
                 {"technique": "pcf", "parameters": {"map_size": 256}}, {"technique": "ray_traced", "parameters": {"samples": 4}}]})";

const std::vector<std::string> kSize{"--size", "320", "240"};

std::vector<std::string> with(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

class ViewerWindow : public ::testing::Test {
 protected:
  ViewerWindow() { folder_.write("config.json", kConfig); }

  /// Finished files that the viewer named by itself: not those under the temporary names that files have until they are whole.
  std::vector<std::string> handedOver(const std::string& ending) const {
    std::vector<std::string> names = namesIn(folder_.path(), ending);
    std::erase_if(names,
                  [](const std::string& name) { return !std::regex_match(name, std::regex("gnomon-[0-9]+-[0-9]+\\.[a-z]+")); });
    return names;
  }

  /// The runner's picture of a config that the viewer saved.
  std::string runnersPicture(const std::string& config) const {
    const Outcome outcome =
        gnomonProgram({"render", (folder_ / config).string(), "--out", (folder_ / "render").string(), "--no-cache"});
    EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
    const std::vector<std::string> pictures = namesIn(folder_ / "render/images", "_shaded.png");
    return pictures.size() == 1 ? readFile(folder_ / "render/images" / pictures[0]) : "";
  }

  TemporaryFolder folder_;
  Display display_;
};

TEST_F(ViewerWindow, FlippedThroughAllTechniquesAndBackShowsTheRunnersPicture) {
  folder_.write("script",
                "key H\nkey 2\nwait 2\nkey Right\nwait 2\nkey Right\nwait 2\nkey Right\nwait 2\nkey Right\nwait 2\n"
                "screenshot view.png\nsave view.json\nquit\n");
  Viewer viewer(display_.name(), folder_.path(), with({"config.json", "--script", "script"}, kSize));
  ASSERT_EQ(viewer.exitCode(), 0) << viewer.errors();
  EXPECT_TRUE(readFile(folder_ / "view.png") == runnersPicture("view.json"));
}

TEST_F(ViewerWindow, MovedCameraLightAndParameterAreInTheSavedConfig) {
  folder_.write("script",
                "key H\nkey 3\nwait 2\nmouse 100 100\npress left\nmouse 130 90\nrelease left\nwheel 2\nhold L\nmouse 150 110\n"
                "release L\nkey ]\nkey Down\nkey +\nwait 2\nscreenshot view.png\nsave view.json\nquit\n");
  Viewer viewer(display_.name(), folder_.path(), with({"config.json", "--script", "script"}, kSize));
  ASSERT_EQ(viewer.exitCode(), 0) << viewer.errors();
  EXPECT_TRUE(readFile(folder_ / "view.png") == runnersPicture("view.json"));
}

TEST_F(ViewerWindow, RealKeysFlipScreenshotAndQuit) {
  Viewer viewer(display_.name(), folder_.path(), with({"config.json"}, kSize));
  viewer.waitForWindow();
  viewer.keys({"h", "Right", "F12"});
  EXPECT_TRUE(eventually([&] { return !handedOver(".png").empty(); })) << viewer.errors();
  viewer.keys({"ctrl+s"});
  ASSERT_TRUE(eventually([&] { return handedOver(".json").size() == 1; })) << viewer.errors();
  viewer.keys({"Escape"});
  EXPECT_EQ(viewer.exitCode(), 0) << viewer.errors();
  const Json saved = Json::parse(readFile(folder_ / handedOver(".json")[0]));
  EXPECT_EQ(saved["techniques"][0]["technique"], "shadow_map");
}

TEST_F(ViewerWindow, ABrokenShaderLeavesTheLastGoodPictureAndIsSurvived) {
  const std::filesystem::path plugin = folder_ / "techniques/shadow_map";
  std::filesystem::create_directories(plugin.parent_path());
  std::filesystem::copy(std::string(GNOMON_BINARY_DIR) + "/lib/gnomon/plugins/shadow_map", plugin);
  std::string json = readFile(plugin / "shadow_map.json");
  json.replace(json.find("\"shadow_map\": {"), 12, "\"my_map\"");
  writeFileAtomically(plugin / "shadow_map.json", json);
  folder_.write("my.json", R"({"scene": {"builtin": "layers"}, "techniques": [{"technique": "my_map"}]})");
  Viewer viewer(display_.name(), folder_.path(),
                with({"my.json", "--technique-dir", (folder_ / "techniques").string()}, kSize));
  viewer.waitForWindow();
  viewer.keys({"h", "F12"});
  ASSERT_TRUE(eventually([&] { return handedOver(".png").size() == 1; })) << viewer.errors();
  const std::string before = readFile(folder_ / handedOver(".png")[0]);
  std::filesystem::remove(folder_ / handedOver(".png")[0]);
  sleepMilliseconds(1100);  // another second in the file's time stamp
  writeFileAtomically(plugin / "shadow_map.frag", "this is no shader\n");
  sleepMilliseconds(1500);  // files are looked after twice a second
  ASSERT_TRUE(viewer.running()) << viewer.errors();
  viewer.keys({"F12"});
  ASSERT_TRUE(eventually([&] { return handedOver(".png").size() == 1; })) << viewer.errors();
  EXPECT_TRUE(readFile(folder_ / handedOver(".png")[0]) == before);
  viewer.keys({"Escape"});
  EXPECT_EQ(viewer.exitCode(), 0) << viewer.errors();
}

TEST_F(ViewerWindow, FaultsOfAScriptAreToldWithTheirLines) {
  folder_.write("script", "key Right\nklick 1\nkey Rigth\nwait x\n");
  Viewer viewer(display_.name(), folder_.path(), with({"config.json", "--script", "script"}, kSize));
  EXPECT_EQ(viewer.exitCode(), 2);
  const std::string errors = viewer.errors();
  EXPECT_THAT(errors, HasSubstr("script:2: "));
  EXPECT_THAT(errors, HasSubstr("script:3: "));
  EXPECT_THAT(errors, HasSubstr("script:4: "));
}

TEST(Viewer, WithoutADisplayPointsToTheRunner) {
  const TemporaryFolder folder;
  folder.write("config.json", kConfig);
  Viewer viewer("", folder.path(), {"config.json"});
  EXPECT_EQ(viewer.exitCode(), 2);
  EXPECT_THAT(viewer.errors(), HasSubstr("gnomon render"));
}

}  // namespace
}  // namespace gnomon::test
