// What the panels draw: each is there when asked for, and nothing of it when not.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "viewer_window.h"

namespace gnomon::test {
namespace {

using ::testing::HasSubstr;

constexpr int kWidth = 900;  // room for every panel
constexpr int kHeight = 600;

class ViewerPanels : public ViewerWindow {
 protected:
  void playLarge(const std::string& script, const std::string& subject = "config.json") {
    play("key E\nwait 3\n" + script, subject, {"--size", std::to_string(kWidth), std::to_string(kHeight)});
  }
  /// How many pixels of the rectangle differ between two screenshots.
  int changed(const std::string& a, const std::string& b, int left, int top, int right, int bottom) const {
    return differing(picture(a), picture(b), left, top, right, bottom);
  }
};

bool isYellow(const Picture::Pixel& p) {  // headings and the light
  return p[0] > 200 && p[1] > 150 && p[2] < 140;
}

TEST_F(ViewerPanels, TextIsDrawnUntilItIsHidden) {
  playLarge("key 2\nwait 3\nscreenshot text.png\nkey H\nwait 2\nscreenshot plain.png\nkey H\nwait 2\nscreenshot again.png\n");
  const Picture text = picture("text.png");
  const Picture plain = picture("plain.png");
  // The technique's box, the parameters' box, and the line of keys.
  EXPECT_GT(differing(text, plain, 0, 0, 300, 80), 15000);
  EXPECT_GT(differing(text, plain, 700, 0, kWidth, 100), 15000);
  EXPECT_GT(differing(text, plain, 0, 585, kWidth, kHeight), 10000);
  EXPECT_EQ(differing(text, plain, 0, 300, kWidth, 550), 0);
  EXPECT_GT(text.count(isYellow), plain.count(isYellow) + 50);  // letters too, not boxes alone
  EXPECT_EQ(differing(text, picture("again.png"), 0, 80, 300, kHeight), 0);
}

TEST_F(ViewerPanels, HelpPlanAndTimesAreDrawnWhenAskedFor) {
  playLarge(
      "key 2\nwait 3\nscreenshot a.png\nkey G\nwait 2\nscreenshot plan.png\nkey G\nkey T\nwait 3\nscreenshot times.png\nkey T\n"
      "key F1\nwait 2\nscreenshot help.png\nkey F1\nwait 2\nscreenshot b.png\n");
  EXPECT_GT(changed("a.png", "plan.png", 0, 300, 450, 560), 40000);
  EXPECT_GT(picture("plan.png").count(isYellow), picture("a.png").count(isYellow) + 50);  // its heading
  EXPECT_GT(changed("a.png", "times.png", 600, 400, kWidth, 560), 20000);
  EXPECT_GT(changed("a.png", "help.png", 0, 100, kWidth, 500), 100000);
  EXPECT_EQ(changed("a.png", "b.png", 0, 100, kWidth, 560), 0);
}

TEST_F(ViewerPanels, AnErrorIsDrawnInARedFrame) {
  folder_.write("broken.glb", "glTF");
  playLarge("screenshot a.png\nopen broken.glb\nwait 2\nscreenshot b.png\n");
  const auto isFrame = [](const Picture::Pixel& p) {
    return std::abs(p[0] - 191) < 8 && std::abs(p[1] - 46) < 8 && std::abs(p[2] - 31) < 8;
  };
  EXPECT_EQ(picture("a.png").count(isFrame), 0);
  EXPECT_GT(picture("b.png").count(isFrame), 500);
  EXPECT_GT(changed("a.png", "b.png", 300, 500, 600, 560), 5000);
}

TEST_F(ViewerPanels, TheDifferenceHasALegend) {
  playLarge("key 2\nwait 3\nkey X\nwait 3\nscreenshot text.png\nkey H\nwait 2\nscreenshot plain.png\n");
  // Ends of the scale, which the picture's own colours do not reach: it is encoded otherwise.
  const auto reddest = [](const Picture::Pixel& p) { return p[0] > 150 && p[1] < 80 && p[2] < 80; };
  EXPECT_GT(picture("text.png").count(reddest), 100);
  EXPECT_EQ(picture("plain.png").count(reddest), 0);
}

TEST_F(ViewerPanels, LightAndNodeAreMarked) {
  playLarge(
      "mouse 450 300\nwait 2\nkey H\nwait 2\nkey H\nscreenshot a.png\nwait 2\nscreenshot b.png\nhold L\nwait 2\n"
      "screenshot light.png\nrelease L\nkey N\nkey N\nwait 2\nscreenshot node.png\n");
  EXPECT_GT(changed("b.png", "light.png", 200, 120, 700, 500), 150);
  const auto isCyan = [](const Picture::Pixel& p) { return p[0] < 160 && p[1] > 190 && p[2] > 230; };
  EXPECT_GT(picture("node.png").count(isCyan), picture("b.png").count(isCyan) + 300);
}

TEST_F(ViewerPanels, MessagesGoAfterAWhile) {
  play("key E\nwait 3\nkey J\nwait 300\nkey R\nwait 100\n");  // R says nothing
  bool kept = false;
  for (const Json& frame : frames()) kept = kept || (frame["events"] == 3 && frame["message"] == "there is one light");
  EXPECT_TRUE(kept);  // after five seconds
  EXPECT_EQ(frames().back()["message"], "");
}

TEST_F(ViewerPanels, ADenserScreenGetsLargerLetters) {
  const std::string script = "key E\nwait 3\nscreenshot text.png\nkey H\nwait 2\nscreenshot plain.png\n";
  const auto heightOfBox = [&] {
    const Picture text = picture("text.png");
    const Picture plain = picture("plain.png");
    int rows = 0;
    while (rows < text.height && differing(text, plain, 0, rows, 3, rows + 1) > 0) ++rows;
    return rows;
  };
  play(script);
  const int usual = heightOfBox();
  const Display dense(192);
  folder_.write("script", script + "quit\n");
  Viewer viewer(dense.name(), folder_.path(), on("config.json", {"--script", "script"}));
  ASSERT_EQ(viewer.exitCode(), 0) << viewer.errors();
  EXPECT_GT(usual, 40);
  EXPECT_NEAR(heightOfBox(), 2 * usual, 0.1 * usual);
}

}  // namespace
}  // namespace gnomon::test
