// What needs the real window: full screen, focus, idling; and files that come and change while it is open.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "gnomon/base/files.h"
#include "viewer_window.h"

namespace gnomon::test {
namespace {

using ::testing::HasSubstr;

constexpr const char* kTwice = R"({"scene": {"builtin": "layers"}, "reference": {"technique": "ray_traced",
    "parameters": {"samples": 16}}, "techniques": [{"technique": "my_map"}, {"technique": "my_map"}]})";

void overwrite(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << bytes;
}

bool isDone(const Json& frame) {
  return frame["reference_samples"] == 16 && frame["rmse"].is_number();
}

TEST_F(ViewerWindow, FullScreenFillsTheScreenAndBack) {
  Viewer viewer(display_.name(), folder_.path(), on("config.json"));
  viewer.waitForWindow();
  viewer.keys({"F11"});
  EXPECT_TRUE(viewer.untilFrame([](const Json& f) { return f["size"] == Json{1280, 1024}; })) << viewer.lastFrame();
  viewer.keys({"F11"});
  EXPECT_TRUE(viewer.untilFrame([](const Json& f) { return f["size"] == Json{320, 240}; })) << viewer.lastFrame();
}

TEST_F(ViewerWindow, WithNothingToDoNothingIsDrawn) {
  Json config = json("config.json");
  config["reference"]["parameters"]["samples"] = 16;
  folder_.write("few.json", config.dump());
  Viewer viewer(display_.name(), folder_.path(), on("few.json"));
  viewer.waitForWindow();
  ASSERT_TRUE(viewer.untilFrame(isDone)) << viewer.lastFrame();
  sleepMilliseconds(700);
  const std::size_t drawn = viewer.frames().size();
  sleepMilliseconds(1000);
  EXPECT_EQ(viewer.frames().size(), drawn);
}

TEST_F(ViewerWindow, WithoutTheFocusHeldKeysAreLetGo) {
  Viewer viewer(display_.name(), folder_.path(), on("config.json"));
  viewer.waitForWindow();
  viewer.keys({"e"});
  viewer.xdotool({{"search", "--onlyvisible", "--name", "Gnomon: ", "windowfocus"}, {"keydown", "w"}});
  ASSERT_TRUE(viewer.untilFrame([](const Json& f) { return f["frame"] > 8; })) << viewer.lastFrame();
  viewer.xdotool({{"search", "--name", "Gnomon: ", "windowunmap"}, {"search", "--name", "Gnomon: ", "windowmap"}});
  sleepMilliseconds(900);
  const std::size_t drawn = viewer.frames().size();
  sleepMilliseconds(500);
  EXPECT_EQ(viewer.frames().size(), drawn);
  viewer.xdotool({{"keyup", "w"}});
}

TEST_F(ViewerWindow, TheValueUnderTheCursorFollowsIt) {
  Viewer viewer(display_.name(), folder_.path(), on("config.json"));
  viewer.waitForWindow();
  viewer.keys({"e", "v"});
  ASSERT_TRUE(viewer.untilFrame([](const Json& f) { return f["inspected"] != ""; })) << viewer.lastFrame();
  const std::vector<std::string> window{"search", "--onlyvisible", "--name", "Gnomon: ", "mousemove", "--window", "%1"};
  for (const char* x : {"60", "200"}) {
    std::vector<std::string> move = window;
    move.insert(move.end(), {x, "100"});
    viewer.xdotool({move});
    const std::string pixel = std::string("(") + x + ", 100):";
    EXPECT_TRUE(viewer.untilFrame([&](const Json& f) {
      return f["inspected"].get<std::string>().find(pixel) != std::string::npos;
    })) << viewer.lastFrame();
  }
}

TEST_F(ViewerWindow, TwoScreenshotsOfOneSecondAreTwoFiles) {
  play("wait 2\nkey F12\nwait 1\nkey Right\nkey F12\nwait 1\nkey F12\nwait 1\nkey Ctrl-S\nkey Ctrl-S\n");
  EXPECT_EQ(handedOver(".png").size(), 3u);
  EXPECT_EQ(handedOver(".json").size(), 2u);
}

TEST_F(ViewerWindow, BytesThatAreNoTextReachTheFrameLog) {
  play("wait 2\nopen b\xff.json\nwait 3\n");
  EXPECT_TRUE(frames().back()["troubles"].contains("opening")) << frames().back();
}

TEST_F(ViewerWindow, ABrokenShaderOfTwoEntriesIsToldAndAResizeKeepsThePicture) {
  const std::filesystem::path plugin = copyOfPlugin("unshadowed", "my_map");
  folder_.write("my.json", kTwice);
  Viewer viewer(display_.name(), folder_.path(), on("my.json", withTechniques()));
  viewer.waitForWindow();
  viewer.keys({"h", "2"});
  ASSERT_TRUE(viewer.untilFrame(isDone)) << viewer.lastFrame();
  overwrite(plugin / "unshadowed.frag", "this is no shader\n");
  ASSERT_TRUE(viewer.untilFrame([](const Json& f) { return f["troubles"].contains("2 my_map"); })) << viewer.lastFrame();
  EXPECT_THAT(viewer.lastFrame()["troubles"]["2 my_map"].get<std::string>(), HasSubstr("unshadowed.frag"));
  EXPECT_TRUE(viewer.lastFrame()["troubles"].contains("1 my_map")) << viewer.lastFrame();
  viewer.xdotool({{"search", "--onlyvisible", "--name", "Gnomon: ", "windowsize", "400", "300"}});
  ASSERT_TRUE(viewer.untilFrame([](const Json& f) {
    return f["size"] == Json{400, 300} && f["troubles"].contains("set-up");
  })) << viewer.lastFrame();
  EXPECT_EQ(viewer.lastFrame()["shown"], "my_map");
  folder_.write("after.png", screenshot(viewer));
  const Picture after = picture("after.png");
  EXPECT_LT(after.count([&](const Picture::Pixel& p) { return p == after.at(0, 0); }), 400 * 300 * 9 / 10);
  EXPECT_GT(after.count([](const Picture::Pixel& p) { return p[0] > 60; }), 400 * 300 / 10);
}

TEST_F(ViewerWindow, AChangedShaderStartsTheReferenceAgainAndABrokenTechniqueFileSaysWhere) {
  const std::filesystem::path plugin = copyOfPlugin("unshadowed", "my_map");
  folder_.write("my.json", kTwice);
  Viewer viewer(display_.name(), folder_.path(), on("my.json", withTechniques()));
  viewer.waitForWindow();
  ASSERT_TRUE(viewer.untilFrame(isDone)) << viewer.lastFrame();
  const double lit = viewer.lastFrame()["rmse"].get<double>();
  std::string shader = readFile(plugin / "unshadowed.frag");
  shader.replace(shader.find("visibility = 1.0"), 16, "visibility = 0.0");
  overwrite(plugin / "unshadowed.frag", shader);
  ASSERT_TRUE(viewer.untilFrame([&](const Json& f) { return isDone(f) && f["rmse"].get<double>() > 1.2 * lit; }))
      << viewer.lastFrame();
  bool said = false;
  bool startedAgain = false;
  for (const Json& frame : viewer.frames()) {
    said = said || frame["message"] == "shaders changed: set up again";
    startedAgain = startedAgain || (said && frame["reference_samples"] < 16);
  }
  EXPECT_TRUE(startedAgain);
  overwrite(plugin / "unshadowed.json", "{\"techniques\": ");
  ASSERT_TRUE(viewer.untilFrame([](const Json& f) { return f["troubles"].contains("config"); })) << viewer.lastFrame();
  const std::string text = viewer.lastFrame()["troubles"]["config"].get<std::string>();
  EXPECT_THAT(text, HasSubstr("unshadowed.json"));
  EXPECT_THAT(text, ::testing::AnyOf(HasSubstr("line"), HasSubstr("unexpected"), HasSubstr("JSON"))) << text;
}

}  // namespace
}  // namespace gnomon::test
