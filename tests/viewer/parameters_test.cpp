// Parameters by keys, scenes of a config, and what a reload keeps.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "gnomon/base/files.h"
#include "viewer_window.h"

namespace gnomon::test {
namespace {

using ::testing::HasSubstr;

class ViewerParameters : public ViewerWindow {
 protected:
  /// The value in a saved config; null where it is the technique's own.
  Json value(const std::string& file, const std::string& name) const {
    const Json config = json(file);
    const Json& entry = config["techniques"][0];
    return entry.contains("parameters") && entry["parameters"].contains(name) ? entry["parameters"][name] : Json();
  }
};

TEST_F(ViewerParameters, AChoiceStepsBothWays) {
  // map_format: d16, d24, d32f, which is the default.
  play("key 2\nwait 3\nkey Down\nkey +\nsave up.json\nkey -\nkey -\nsave down.json\nkey Up\nkey -\nwait 2\nsave size.json\n");
  EXPECT_EQ(value("up.json", "map_format"), "d16");
  EXPECT_EQ(value("down.json", "map_format"), "d24");
  EXPECT_EQ(value("size.json", "map_size"), 128);
}

TEST_F(ViewerParameters, BackspaceRestoresWhatTheFilesSay) {
  play("key 2\nwait 3\nkey +\nwait 2\nsave a.json\nkey Backspace\nwait 2\nsave b.json\n");
  EXPECT_EQ(value("a.json", "map_size"), 512);
  EXPECT_EQ(value("b.json", "map_size"), 256);
}

TEST_F(ViewerParameters, AValueThatIsRefusedIsRevertedWithAMessage) {
  // No texture is that wide.
  folder_.write("wide.json", R"({"scene": {"builtin": "layers"}, "output": {"size": [320, 240]},
      "techniques": [{"technique": "shadow_map", "parameters": {"map_size": [16384, 16]}}]})");
  play("key H\nkey E\nwait 3\nscreenshot a.png\nkey +\nwait 2\nsave view.json\nscreenshot b.png\n", "wide.json");
  EXPECT_EQ(value("view.json", "map_size"), (Json{16384, 16}));
  EXPECT_THAT(frames().back()["message"].get<std::string>(), HasSubstr("32768"));
  EXPECT_TRUE(frames().back()["troubles"].empty()) << frames().back();
  EXPECT_EQ(frames().back()["failure"], "");
  EXPECT_TRUE(bytes("a.png") == bytes("b.png"));
}

TEST_F(ViewerParameters, AReloadOfWhatHasNotChangedKeepsAllOfTheView) {
  play(
      "key 2\nwait 3\nkey +\nmouse 100 100\npress left\nmouse 140 120\nrelease left\nwheel 1\nkey N\nkey N\nhold M\nwheel 1\n"
      "release M\nhold L\nmouse 160 100\nrelease L\nkey ]\nwait 30\nsave a.json\nkey F5\nwait 5\nsave b.json\n");
  EXPECT_EQ(value("a.json", "map_size"), 512);
  EXPECT_EQ(json("a.json"), json("b.json"));
  bool loaded = false;
  for (const Json& frame : frames()) loaded = loaded || frame["message"] == "loaded again";
  EXPECT_TRUE(loaded);
}

TEST_F(ViewerParameters, TheNextSceneIsShown) {
  folder_.write("scenes.json", R"({"scene": [{"builtin": "layers"}, {"builtin": "square"}], "output": {"size": [320, 240]},
      "techniques": [{"technique": "shadow_map"}]})");
  play("key H\nkey E\nwait 3\nsave a.json\nkey +\nkey O\nwait 20\nscreenshot b.png\nsave b.json\nkey O\nwait 3\nsave c.json\n",
       "scenes.json");
  EXPECT_EQ(json("a.json")["scene"]["builtin"], "layers");
  EXPECT_EQ(json("b.json")["scene"]["builtin"], "square");
  EXPECT_EQ(json("c.json")["scene"]["builtin"], "layers");
  EXPECT_EQ(value("b.json", "map_size"), 2048);  // edits go along
  EXPECT_TRUE(bytes("b.png") == runnersPicture("b.json"));
}

TEST_F(ViewerParameters, TexturesStepBothWays) {
  play(
      "key H\nkey 2\nwait 3\nscreenshot 0.png\nkey V\nwait 2\nscreenshot 1.png\nkey V\nwait 2\nscreenshot 2.png\nkey B\n"
      "wait 2\nscreenshot 1b.png\nkey B\nwait 2\nscreenshot 0b.png\nkey B\nwait 2\nscreenshot last.png\nkey V\nwait 2\n"
      "screenshot 0c.png\n");
  for (const char* other : {"1.png", "2.png", "last.png"}) EXPECT_FALSE(bytes("0.png") == bytes(other)) << other;
  EXPECT_FALSE(bytes("1.png") == bytes("2.png"));
  EXPECT_FALSE(bytes("1.png") == bytes("last.png"));
  EXPECT_TRUE(bytes("1.png") == bytes("1b.png"));
  EXPECT_TRUE(bytes("0.png") == bytes("0b.png"));
  EXPECT_TRUE(bytes("0.png") == bytes("0c.png"));
}

TEST_F(ViewerParameters, TheValueUnderTheCursorIsTold) {
  // The first texture holds positions; the camera looks straight down on a floor, 10 m high in the picture.
  folder_.write("above.json", R"({"scene": {"builtin": "layers"}, "techniques": [{"technique": "unshadowed"}],
      "camera": {"type": "orthographic", "position": [0, 9, 0], "target": [0, 0, 0], "up": [0, 0, -1], "height": 10}})");
  play("key H\nkey E\nwait 2\nkey V\nmouse 232 144\nwait 2\nmouse 88 192\nwait 2\n", "above.json");
  std::vector<std::string> told;
  for (const Json& frame : frames()) {
    const std::string text = frame["inspected"].get<std::string>();
    if (told.empty() || told.back() != text) told.push_back(text);
  }
  ASSERT_EQ(told.size(), 3u) << ::testing::PrintToString(told);
  EXPECT_EQ(told[0], "");
  EXPECT_THAT(told[1], HasSubstr("position  320x240"));
  const auto valuesOf = [](const std::string& text) {
    std::istringstream in(text.substr(text.rfind(':') + 1));
    std::vector<double> values;
    for (double v = 0.0; in >> v;) values.push_back(v);
    return values;
  };
  const std::vector<double> first = valuesOf(told[1]);
  const std::vector<double> second = valuesOf(told[2]);
  ASSERT_GE(first.size(), 3u) << told[1];
  ASSERT_GE(second.size(), 3u) << told[2];
  EXPECT_NEAR(first[0], 3.0, 0.05);  // 72 pixels right of the middle, 24 to the metre
  EXPECT_NEAR(first[2], 1.0, 0.05);
  EXPECT_NEAR(second[0], -3.0, 0.05);
  EXPECT_NEAR(second[2], 3.0, 0.05);
}

}  // namespace
}  // namespace gnomon::test
