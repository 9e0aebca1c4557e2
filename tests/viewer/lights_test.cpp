// Several lights in the viewer: the picture sums them, and each can be taken in hand.
#include <gmock/gmock.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "gnomon/base/files.h"
#include "picture.h"
#include "program.h"
#include "viewer_window.h"

namespace gnomon::test {
namespace {

constexpr const char* kTwoLights = R"({"scene": {"builtin": "layers"}, "output": {"size": [320, 240]},
  "lights": [{"type": "spot", "position": [-1, 7, 0.6], "target": [0, 0, 0], "cone_half_angle_degrees": 45, "name": "key"},
             {"type": "spot", "position": [3, 6, 2], "target": [0, 0, 0], "cone_half_angle_degrees": 45, "intensity": 0.5,
              "source": {"shape": "disc", "radius": 0.3}}],
  "techniques": [{"technique": "shadow_map", "parameters": {"map_size": 256}}]})";

class ViewerLights : public ViewerWindow {
 protected:
  ViewerLights() { folder_.write("two.json", kTwoLights); }

  /// The runner's picture of all lights of a config that the viewer saved.
  Picture runnersSum(const std::string& config) const {
    const std::filesystem::path out = folder_ / ("sum of " + config);
    const Outcome outcome = gnomonProgram({"render", (folder_ / config).string(), "--out", out.string(), "--no-cache"});
    EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
    const std::vector<std::string> pictures = namesIn(out / "images", "_lights_shaded.png");
    if (pictures.size() != 1) throw Error("one picture of all lights was wanted: " + outcome.all());
    return readPicture(out / "images" / pictures[0]);
  }
};

/// Largest difference of a channel, of 255.
int largestDifference(const Picture& a, const Picture& b) {
  if (a.width != b.width || a.height != b.height) return 255;
  int largest = 0;
  for (std::size_t i = 0; i < a.bytes.size(); ++i) largest = std::max(largest, std::abs(int{a.bytes[i]} - int{b.bytes[i]}));
  return largest;
}

TEST_F(ViewerLights, ThePictureSumsThemAsTheRunnersDoes) {
  play("key H\nwait 20\nscreenshot view.png\nsave view.json\n", "two.json");
  EXPECT_LE(largestDifference(readPicture(folder_ / "view.png"), runnersSum("view.json")), 1);
}

TEST_F(ViewerLights, TheNextIsTakenInHandAndTheFirstAfterTheLast) {
  play("wait 2\nkey J\nwait 2\nkey J\nwait 2\n", "two.json");
  std::vector<int> inHand;
  for (const Json& frame : frames()) {
    if (inHand.empty() || inHand.back() != frame["light"]) inHand.push_back(frame["light"]);
  }
  EXPECT_THAT(inHand, ::testing::ElementsAre(0, 1, 0));
}

/// The second of three lights is one that shadow_map refuses.
constexpr const char* kOneRefused = R"({"scene": {"builtin": "layers"}, "output": {"size": [320, 240]},
  "lights": [{"type": "spot", "position": [-1, 7, 0.6], "target": [0, 0, 0], "cone_half_angle_degrees": 45, "name": "key"},
             {"type": "point", "position": [2, 5, 2], "name": "bulb", "intensity": 0.5},
             {"type": "spot", "position": [3, 6, 2], "target": [0, 0, 0], "cone_half_angle_degrees": 45, "name": "fill"}],
  "techniques": [{"technique": "shadow_map", "parameters": {"map_size": 256}}]})";

TEST_F(ViewerLights, OneThatIsRefusedIsLeftOutWhicheverIsInHandAndTheViewerSaysSo) {
  folder_.write("three.json", kOneRefused);
  play(
      "key H\nwait 20\nscreenshot first.png\nsave view.json\nkey J\nwait 20\nscreenshot second.png\nkey V\nkey T\nwait 5\n"
      "key T\nkey J\nwait 20\nscreenshot third.png\n",
      "three.json");
  const Picture sum = runnersSum("view.json");
  for (const char* name : {"first.png", "second.png", "third.png"}) {
    EXPECT_LE(largestDifference(readPicture(folder_ / name), sum), 1) << name;
  }
  for (const Json& frame : frames()) {
    EXPECT_EQ(frame["failure"], "");
  }
  EXPECT_THAT(frames().back()["left_out"][0].get<std::string>(), ::testing::HasSubstr("without light 'bulb': a point light"));
}

TEST_F(ViewerLights, EachMovesByItselfAndStaysWhereItWasPut) {
  play(
      "key H\nwait 3\nhold L\nmouse 100 100\nmouse 112 100\nrelease L\nkey J\nwait 3\nhold L\nmouse 100 130\nrelease L\nwait "
      "20\n"
      "screenshot view.png\nsave view.json\nkey Home\nwait 20\nsave home.json\n",
      "two.json");
  const Json before = Json::parse(kTwoLights)["lights"];
  const Json after = json("view.json")["lights"];
  ASSERT_EQ(after.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NE(after[i]["position"], before[i]["position"]) << i;
  EXPECT_LE(largestDifference(readPicture(folder_ / "view.png"), runnersSum("view.json")), 1);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(json("home.json")["lights"][i]["position"][0], before[i]["position"][0]) << i;
}

}  // namespace
}  // namespace gnomon::test
