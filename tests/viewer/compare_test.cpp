// Comparisons, errors and the reference they need.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "viewer_window.h"

namespace gnomon::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class ViewerCompares : public ViewerWindow {
 protected:
  double lastRmse() const {
    const Json& rmse = frames().back()["rmse"];
    EXPECT_TRUE(rmse.is_number()) << frames().back();
    return rmse.is_number() ? rmse.get<double>() : -1.0;
  }
};

bool isBlue(const Picture::Pixel& p) {
  return p[2] > p[0] + 40;
}
bool isRed(const Picture::Pixel& p) {
  return p[0] > p[2] + 40;
}

TEST_F(ViewerCompares, ADifferenceIsBlueWhereThisIsDarkerAndRedWhereItIsLighter) {
  play(
      "key H\nkey 2\nwait 3\nkey X\nwait 3\nscreenshot darker.png\nkey Tab\nwait 3\nscreenshot lighter.png\nkey X\nwait 3\n"
      "screenshot plain.png\n");
  const Picture darker = picture("darker.png");
  const Picture lighter = picture("lighter.png");
  EXPECT_GT(darker.count(isBlue), 1000);
  EXPECT_EQ(darker.count(isRed), 0);
  EXPECT_EQ(lighter.count(isRed), darker.count(isBlue));
  EXPECT_EQ(lighter.count(isBlue), 0);
  std::set<std::string> said;
  for (const Json& frame : frames()) said.insert(frame["comparison"].get<std::string>());
  EXPECT_TRUE(said.contains("V of this minus V of unshadowed")) << ::testing::PrintToString(said);
  EXPECT_EQ(frames().back()["comparison"], "");
}

TEST_F(ViewerCompares, ASideThatIsRefusedIsSaid) {
  folder_.write("point.json", R"({"scene": {"builtin": "layers"}, "lights": [{"type": "point", "position": [-1, 7, 0.6]}],
      "techniques": [{"technique": "shadow_map"}, {"technique": "unshadowed"}]})");
  play(
      "key H\nkey 2\nwait 3\nscreenshot plain.png\nkey X\nwait 3\nscreenshot difference.png\nkey C\nwait 2\nscreenshot c.png\n",
      "point.json");
  EXPECT_THAT(frames().back()["comparison"].get<std::string>(), HasSubstr("nothing to compare with: shadow_map"));
  EXPECT_TRUE(bytes("plain.png") == bytes("difference.png"));
  EXPECT_TRUE(bytes("plain.png") == bytes("c.png"));
}

TEST_F(ViewerCompares, WhileTheReferenceIsNotThereThePictureIsPlain) {
  play(
      "key H\nkey 2\nwait 3\nkey R\nrefine\nkey X\nwait 2\nscreenshot difference.png\nmouse 100 100\npress left\n"
      "mouse 130 100\nwait 1\nscreenshot moved.png\nrelease left\nkey X\nkey R\nwait 30\nscreenshot plain.png\n");
  EXPECT_TRUE(bytes("moved.png") == bytes("plain.png"));
  EXPECT_FALSE(bytes("difference.png") == bytes("plain.png"));
  bool said = false;
  for (const Json& frame : frames())
    said = said || frame["comparison"].get<std::string>().find("as soon as nothing moves") != std::string::npos;
  EXPECT_TRUE(said);
}

TEST_F(ViewerCompares, ErrorsAreMeasuredAgainAsTheRaysGrow) {
  Json config = json("config.json");
  config["reference"]["parameters"]["samples"] = 1024;
  folder_.write("many.json", config.dump());
  play("key 2\nwait 3\nrefine\nwait 1\n", "many.json");
  std::set<double> errors;
  for (const Json& frame : frames()) {
    if (frame["rmse"].is_number() && frame["technique"] == "shadow_map") errors.insert(frame["rmse"].get<double>());
  }
  EXPECT_GE(errors.size(), 3u);
  EXPECT_GT(frames().back()["cpu_ms"].get<double>(), 0.0);
}

TEST_F(ViewerCompares, WithoutMeasuringNothingIsTraced) {
  play("key E\nwait 30\nkey 2\nwait 30\n");
  for (const Json& frame : frames()) {
    EXPECT_EQ(frame["reference_samples"], 0) << frame;
    EXPECT_TRUE(frame["rmse"].is_null()) << frame;
  }
  play("key E\nwait 10\nkey E\nrefine\nwait 1\n");
  EXPECT_TRUE(frames().back()["rmse"].is_number());
}

TEST_F(ViewerCompares, AParametersChangeForgetsItsError) {
  play("key 2\nwait 3\nrefine\nwait 1\nkey -\nwait 1\nrefine\nwait 2\n");
  bool wasMeasured = false;
  bool forgotten = false;
  std::set<double> errors;
  for (const Json& frame : frames()) {
    if (frame["events"] == 1 && frame["rmse"].is_number()) wasMeasured = true;
    if (frame["events"] == 2 && frame["rmse"].is_null()) forgotten = true;
    if (frame["reference_samples"] == 64 && frame["rmse"].is_number()) errors.insert(frame["rmse"].get<double>());
  }
  EXPECT_TRUE(wasMeasured);
  EXPECT_TRUE(forgotten);
  EXPECT_EQ(errors.size(), 2u) << "a map of half the size has another error";
}

TEST_F(ViewerCompares, TheReferenceFollowsTheLightAndTheNodes) {
  play("key 2\nwait 3\nrefine\nwait 1\n");
  const double before = lastRmse();
  // Each after a reference has been there: it is told, not made again.
  play(
      "key 2\nwait 3\nrefine\nmouse 100 100\nhold L\nmouse 180 60\nrelease L\nkey ]\nkey ]\nwait 1\nrefine\nwait 1\n"
      "save light.json\n");
  const double light = lastRmse();
  play(
      "key 2\nwait 3\nrefine\nmouse 100 100\nkey N\nkey N\nkey N\nhold M\nmouse 150 160\nrelease M\nwait 1\nrefine\nwait 1\n"
      "save nodes.json\n");
  const double nodes = lastRmse();
  play(
      "key 2\nwait 3\nrefine\nmouse 100 100\npress left\nmouse 180 60\nrelease left\nwait 1\nrefine\nwait 1\n"
      "save camera.json\n");
  const double camera = lastRmse();
  const auto expectFresh = [&](const std::string& config, double rmse) {
    play("wait 3\nrefine\nwait 1\n", config);
    EXPECT_NEAR(lastRmse(), rmse, 0.03 * rmse) << config;
    EXPECT_GT(std::abs(rmse - before), 0.05 * before) << config;
  };
  expectFresh("light.json", light);
  expectFresh("nodes.json", nodes);
  expectFresh("camera.json", camera);
}

TEST_F(ViewerCompares, ASavedConfigHoldsReferenceAndBaselineAndRenders) {
  Json config = json("config.json");
  config["reference"]["parameters"]["samples"] = 32;
  folder_.write("few.json", config.dump());
  play("key H\nkey 4\nwait 3\nscreenshot view.png\nsave view.json\n", "few.json");
  Json saved = json("view.json");  // not const: what is missing reads as null
  EXPECT_EQ(saved["reference"]["technique"], "ray_traced");
  EXPECT_EQ(saved["reference"]["parameters"]["samples"], 32);
  EXPECT_EQ(saved["baseline"]["technique"], "unshadowed");
  EXPECT_EQ(saved["techniques"][0]["technique"], "ray_traced");
  EXPECT_EQ(saved["techniques"][0]["parameters"]["samples"], 4) << saved.dump();
  EXPECT_THAT(bytes("view.json"), Not(HasSubstr("seed")));
  EXPECT_TRUE(bytes("view.png") == runnersPicture("view.json"));
}

TEST_F(ViewerCompares, NoKeyChangesTheReferencesSeed) {
  // A config with a seed of ray_traced would be refused.
  std::string script = "key E\nkey 4\nwait 3\n";
  for (int i = 0; i < 8; ++i) script += "key +\nkey Down\n";
  play(script + "save view.json\n");
  EXPECT_THAT(bytes("view.json"), Not(HasSubstr("seed")));
  EXPECT_FALSE(runnersPicture("view.json").empty());
}

TEST_F(ViewerCompares, LeftAndTabGoBack) {
  play("wait 2\nkey Left\nwait 3\nkey 2\nwait 3\nkey Tab\nwait 2\nkey Tab\nwait 2\n");
  std::vector<std::string> seen;
  for (const Json& frame : frames()) {
    const std::string name = frame["technique"].get<std::string>();
    if (seen.empty() || seen.back() != name) seen.push_back(name);
  }
  EXPECT_EQ(seen, (std::vector<std::string>{"unshadowed", "ray_traced", "shadow_map", "ray_traced", "shadow_map"}));
}

}  // namespace
}  // namespace gnomon::test
