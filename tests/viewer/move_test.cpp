// What moves camera, light and nodes, by value: in which direction, and by how much.
#include <gmock/gmock.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

#include "viewer_window.h"

namespace gnomon::test {
namespace {

constexpr double kPi = 3.14159265358979323846;
// The camera of the built-in scene `layers` opens by this much.
constexpr double kHeightAtOneMetre = 2.0 * 0.41421356237309503;  // 2 tan(45 / 2)

glm::dvec3 vector(const Json& json) {
  return {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
}

/// Where camera and light are in a saved config.
struct Pose {
  explicit Pose(const Json& config)
      : position(vector(config["camera"]["position"])),
        target(vector(config["camera"]["target"])),
        light(vector(config["lights"][0]["position"])),
        lightTarget(vector(config["lights"][0]["target"])) {}
  glm::dvec3 look() const { return glm::normalize(target - position); }
  glm::dvec3 right() const { return glm::normalize(glm::cross(look(), glm::dvec3(0.0, 1.0, 0.0))); }
  glm::dvec3 up() const { return glm::cross(right(), look()); }

  glm::dvec3 position, target, light, lightTarget;
};

void expectNear(const glm::dvec3& a, const glm::dvec3& b) {
  EXPECT_LT(glm::length(a - b), 1e-6 * (1.0 + glm::length(b)))
      << a.x << " " << a.y << " " << a.z << " against " << b.x << " " << b.y << " " << b.z;
}

/// `offset` turned about the vertical, counter-clockwise as seen from above.
glm::dvec3 turned(const glm::dvec3& offset, double angle) {
  return {offset.x * std::cos(angle) + offset.z * std::sin(angle), offset.y,
          offset.z * std::cos(angle) - offset.x * std::sin(angle)};
}

double height(const glm::dvec3& offset) {
  return std::asin(glm::normalize(offset).y);
}

class ViewerMoves : public ViewerWindow {
 protected:
  Pose pose(const std::string& saved) const { return Pose(json(saved)); }
};

TEST_F(ViewerMoves, AnOrbitTurnsTheCameraAboutItsTarget) {
  play(
      "save a.json\nmouse 100 100\npress left\nmouse 124 100\nrelease left\nsave b.json\npress left\nmouse 124 112\n"
      "release left\nsave c.json\n");
  const Pose a = pose("a.json");
  const Pose b = pose("b.json");
  const Pose c = pose("c.json");
  expectNear(b.target, a.target);
  expectNear(b.position - b.target, turned(a.position - a.target, -0.1 * kPi));  // half a turn for the window's height
  EXPECT_NEAR(height(c.position - c.target) - height(b.position - b.target), 0.05 * kPi, 1e-6);
  EXPECT_NEAR(glm::length(c.position - c.target), glm::length(a.position - a.target), 1e-6);
}

TEST_F(ViewerMoves, APanTakesTheTargetsPlaneWithTheMouse) {
  play("save a.json\nmouse 100 100\npress right\nmouse 124 100\nsave b.json\nmouse 124 148\nrelease right\nsave c.json\n");
  const Pose a = pose("a.json");
  const Pose b = pose("b.json");
  const Pose c = pose("c.json");
  const double window = kHeightAtOneMetre * glm::length(a.target - a.position);
  expectNear(b.position - a.position, a.right() * (-0.1 * window));
  expectNear(b.target - a.target, b.position - a.position);
  expectNear(c.position - b.position, a.up() * (0.2 * window));
}

TEST_F(ViewerMoves, TheWheelZoomsAndNoAmountOfItLosesTheView) {
  play(
      "save a.json\nwheel 1\nsave b.json\nwheel 100000\nwait 2\nsave near.json\nwheel -100000\nwait 2\nsave far.json\n"
      "hold L\nwheel 100000\nwait 2\nsave light_near.json\nwheel -100000\nwait 2\nrelease L\nsave light_far.json\n"
      "key Home\nwait 20\nscreenshot home.png\n");
  const Pose a = pose("a.json");
  expectNear(pose("b.json").position - a.target, (a.position - a.target) * 0.9);
  const Pose near = pose("near.json");
  const Pose far = pose("far.json");
  EXPECT_GT(glm::length(near.position - near.target), 0.0);
  EXPECT_LT(glm::length(near.position - near.target), 1e-3);
  EXPECT_GT(glm::length(far.position - far.target), 1e6);
  EXPECT_TRUE(std::isfinite(glm::length(far.position - far.target)));
  const Pose lightNear = pose("light_near.json");
  const Pose lightFar = pose("light_far.json");
  EXPECT_GT(glm::length(lightNear.light - lightNear.lightTarget), 0.0);
  EXPECT_TRUE(std::isfinite(glm::length(lightFar.light - lightFar.lightTarget)));
}

TEST_F(ViewerMoves, FlyingGoesWhereTheKeysSay) {
  std::string script = "save 0.json\n";
  for (const char* key : {"W", "S", "A", "D", "PageUp", "PageDown"})
    script += std::string("hold ") + key + "\nwait 5\nrelease " + key + "\nsave " + key + ".json\n";
  play(script);
  Pose before = pose("0.json");
  const auto expectTowards = [&](const std::string& key, const glm::dvec3& direction) {
    const Pose after = pose(key + ".json");
    const glm::dvec3 by = after.position - before.position;
    EXPECT_GT(glm::length(by), 0.01) << key;
    expectNear(by, direction * glm::length(by));
    expectNear(after.target - before.target, by);
    before = after;
  };
  const Pose axes = before;
  expectTowards("W", axes.look());
  expectTowards("S", -axes.look());
  expectTowards("A", -axes.right());
  expectTowards("D", axes.right());
  expectTowards("PageUp", axes.up());
  expectTowards("PageDown", -axes.up());
}

TEST_F(ViewerMoves, TheWholeSceneIsFramed) {
  play(
      "wheel -20\nmouse 100 100\npress right\nmouse 300 20\nrelease right\nkey F\nsave view.json\nwait 20\nscreenshot "
      "all.png\n");
  const Pose view = pose("view.json");
  expectNear(view.target, {0.0, 1.1, 0.0});  // a floor of 8 m, and quads up to 2.2 m
  EXPECT_NEAR(glm::length(view.position - view.target) * std::sin(kPi / 8.0), 0.5 * std::hypot(8.0, 8.0, 2.2), 1e-6);
}

TEST_F(ViewerMoves, TheNextCameraIsTaken) {
  folder_.write("cameras.gltf",
                R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
      "nodes": [{"mesh": 0, "name": "floor"}, {"camera": 0, "name": "one", "translation": [0, 1, 3]},
                {"camera": 0, "name": "two", "translation": [1, 2, 5]}],
      "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.01}}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3", "min": [-2, 0, -2], "max": [2, 0, 2]}],
      "bufferViews": [{"buffer": 0, "byteLength": 72}],
      "buffers": [{"byteLength": 72, "uri": "data:application/octet-stream;base64,)"
                R"(AAAAwAAAAAAAAADAAAAAwAAAAAAAAABAAAAAQAAAAAAAAABAAAAAwAAAAAAAAADAAAAAQAAAAAAAAABAAAAAQAAAAAAAAADA"}]})");
  play("save a.json\nkey K\nsave b.json\nkey K\nsave c.json\n", "cameras.gltf");
  expectNear(pose("a.json").position, {0.0, 1.0, 3.0});
  expectNear(pose("b.json").position, {1.0, 2.0, 5.0});
  expectNear(pose("c.json").position, {0.0, 1.0, 3.0});
}

TEST_F(ViewerMoves, TheLightTurnsShiftsAndComesNearer) {
  play(
      "save a.json\nmouse 100 100\nhold L\nmouse 124 100\nsave turned.json\nmouse 124 112\nsave raised.json\nwheel 1\n"
      "save nearer.json\nwheel -1\npress right\nmouse 148 112\nsave shifted.json\nmouse 148 136\nsave lowered.json\n"
      "release right\nrelease L\n");
  const Pose a = pose("a.json");
  const Pose b = pose("turned.json");
  expectNear(b.lightTarget, a.lightTarget);
  expectNear(b.light - b.lightTarget, turned(a.light - a.lightTarget, -0.1 * kPi));
  const Pose c = pose("raised.json");
  EXPECT_NEAR(height(c.light - c.lightTarget) - height(b.light - b.lightTarget),
              std::min(0.05 * kPi, kPi / 2.0 - 0.02 - height(b.light - b.lightTarget)), 1e-6);
  EXPECT_NEAR(glm::length(c.light - c.lightTarget), glm::length(a.light - a.lightTarget), 1e-6);
  expectNear(pose("nearer.json").light - c.lightTarget, (c.light - c.lightTarget) * 0.9);
  const Pose d = pose("shifted.json");
  const Pose e = pose("lowered.json");
  const double window = kHeightAtOneMetre * glm::dot(c.light - a.position, a.look());
  expectNear(d.light - c.light, a.right() * (0.1 * window));
  expectNear(d.lightTarget - c.lightTarget, d.light - c.light);
  expectNear(e.light - d.light, a.up() * (-0.1 * window));
  expectNear(e.position, a.position);  // the camera stood still all the time
}

TEST_F(ViewerMoves, ALightOverheadAndOneAtItsTargetCanBeTurned) {
  folder_.write("above.json", R"({"scene": {"builtin": "square"}, "techniques": [{"technique": "unshadowed"}]})");
  play("save a.json\nmouse 100 200\nhold L\nmouse 100 80\nsave b.json\n", "above.json");
  const Pose b = pose("b.json");
  EXPECT_NEAR(height(b.light - b.lightTarget), 0.0, 1e-6);  // half the window's height is a quarter turn
  EXPECT_NEAR(glm::length(b.light - b.lightTarget), glm::length(pose("a.json").light), 1e-6);
  folder_.write("inside.json", R"({"scene": {"builtin": "layers"}, "techniques": [{"technique": "unshadowed"}],
      "lights": [{"type": "point", "position": [0, 1, 0], "target": [0, 1, 0]}]})");
  play("mouse 100 200\nhold L\nmouse 150 80\nsave c.json\n", "inside.json");
  expectNear(pose("c.json").light, {0.0, 1.0, 0.0});
}

TEST_F(ViewerMoves, TheSourceGrowsAndShrinks) {
  play("key ]\nsave larger.json\nkey [\nkey [\nsave smaller.json\n");
  EXPECT_NEAR(json("larger.json")["lights"][0]["source"]["size"][0].get<double>(), 1.1, 1e-9);
  EXPECT_NEAR(json("smaller.json")["lights"][0]["source"]["size"][1].get<double>(), 1.0 / 1.1, 1e-9);
}

TEST_F(ViewerMoves, ANodeFollowsTheMouseAndTheWheel) {
  play(
      "wait 2\nsave a.json\nmouse 100 100\nkey N\nkey N\nhold M\nmouse 124 100\nsave right.json\nmouse 124 112\n"
      "save down.json\nwheel 2\nsave wheel.json\nrelease M\n");
  const Pose a = pose("a.json");
  const auto by = [&](const std::string& file) { return vector(json(file)["scene"]["move"]["lower"]); };
  const glm::dvec3 centre(-0.4, 0.7, 0.0);
  const double window = kHeightAtOneMetre * glm::dot(centre - a.position, a.look());
  expectNear(glm::normalize(by("right.json")), a.right());
  EXPECT_NEAR(glm::length(by("right.json")), 0.1 * window, 0.01 * window);
  expectNear(glm::normalize(by("down.json") - by("right.json")), -a.up());
  const glm::dvec3 nearer = by("wheel.json") - by("down.json");
  expectNear(glm::normalize(nearer), -a.look());
  EXPECT_NEAR(glm::length(nearer), 0.1 * glm::length(centre - a.position), 0.05);
  expectNear(pose("wheel.json").position, a.position);
}

TEST_F(ViewerMoves, NodesComeInTurn) {
  std::string script = "wait 2\nmouse 100 100\n";
  for (const char* name : {"1", "2", "3", "4"})
    script += std::string("key N\nhold M\nwheel 1\nrelease M\nsave ") + name + ".json\n";
  play(script);
  const auto moved = [&](const std::string& file) {
    std::vector<std::string> names;
    const Json config = json(file);
    for (const auto& [name, by] : config["scene"]["move"].items()) names.push_back(name);
    return names;
  };
  EXPECT_EQ(moved("1.json"), std::vector<std::string>{"floor"});
  EXPECT_EQ(moved("2.json"), (std::vector<std::string>{"floor", "lower"}));
  EXPECT_EQ(moved("3.json"), (std::vector<std::string>{"floor", "lower", "upper"}));
  EXPECT_EQ(moved("4.json").size(), 3u);
  EXPECT_GT(glm::length(vector(json("4.json")["scene"]["move"]["floor"])),
            1.5 * glm::length(vector(json("1.json")["scene"]["move"]["floor"])));
}

TEST_F(ViewerMoves, TimeStepsForwardsAndBackwards) {
  folder_.write("moving.json", R"({"scene": {"builtin": "animated"}, "techniques": [{"technique": "unshadowed"}]})");
  play("key .\nkey .\nkey .\nsave a.json\nkey ,\nsave b.json\nkey ,\nkey ,\nkey ,\nsave c.json\n", "moving.json");
  EXPECT_NEAR(json("a.json")["scene"]["time"].get<double>(), 3.0 / 30.0, 1e-9);
  EXPECT_NEAR(json("b.json")["scene"]["time"].get<double>(), 2.0 / 30.0, 1e-9);
  EXPECT_NEAR(json("c.json")["scene"]["time"].get<double>(), 4.0 - 1.0 / 30.0, 1e-9);
}

TEST_F(ViewerMoves, HomeRestoresAllThatMoved) {
  folder_.write("moving.json", R"({"scene": {"builtin": "animated", "time": 0.5, "move": {"mast": [0.5, 0, 0]}},
      "techniques": [{"technique": "unshadowed"}]})");
  play(
      "wait 2\nsave a.json\nkey N\nkey N\nhold M\nwheel 2\nrelease M\nhold L\nwheel 2\nrelease L\nkey ]\nwheel 2\nkey .\n"
      "wait 2\nsave moved.json\nkey Home\nsave b.json\nkey P\nkey Home\nwait 5\nsave c.json\n",
      "moving.json");
  const Json a = json("a.json");
  const Json moved = json("moved.json");
  EXPECT_NE(moved["scene"]["move"], a["scene"]["move"]);
  EXPECT_NE(moved["scene"]["time"], a["scene"]["time"]);
  EXPECT_NE(moved["lights"], a["lights"]);
  EXPECT_NE(moved["camera"], a["camera"]);
  EXPECT_EQ(json("b.json"), a);
  EXPECT_EQ(json("c.json"), a);  // it does not play on
}

TEST_F(ViewerMoves, TheConfigsOwnMoveIsAppliedOnce) {
  folder_.write("moved.json", R"({"scene": {"builtin": "layers", "move": {"upper": [0.6, 0, 0.2]}},
      "output": {"size": [320, 240]}, "techniques": [{"technique": "shadow_map"}]})");
  play(
      "key H\nwait 3\nscreenshot view.png\nsave view.json\nkey N\nkey N\nkey N\nhold M\nwheel 1\nwait 20\nrelease M\n"
      "key H\nkey H\nwait 2\nscreenshot more.png\nsave more.json\n",
      "moved.json");
  expectNear(vector(json("view.json")["scene"]["move"]["upper"]), {0.6, 0.0, 0.2});
  EXPECT_TRUE(bytes("view.png") == runnersPicture("moved.json"));
  EXPECT_NE(json("more.json")["scene"]["move"]["upper"], json("view.json")["scene"]["move"]["upper"]);
}

TEST_F(ViewerMoves, AMovementThatChangesThePlanSetsUpAgain) {
  // Turned below the floor, the light reaches no receiver: nothing can be shadowed.
  folder_.write("one.json", R"({"scene": {"builtin": "square"}, "output": {"size": [320, 240]}, "plan": {"culling": "off"},
      "techniques": [{"technique": "shadow_map"}]})");
  play(
      "key H\nkey E\nwait 3\nmouse 100 239\nhold L\nmouse 100 0\nrelease L\nwait 30\nscreenshot view.png\nsave view.json\n"
      "key Home\nwait 30\nscreenshot home.png\nsave home.json\n",
      "one.json");
  int setUps = 0;
  std::string said;
  for (const Json& frame : frames()) {
    const std::string message = frame["message"].get<std::string>();
    if (message != said && message.find("the scene calls for other effects now") == 0) ++setUps;
    said = message;
  }
  EXPECT_EQ(setUps, 2);
  EXPECT_LT(pose("view.json").light.y, pose("view.json").lightTarget.y);
  EXPECT_EQ(json("view.json")["plan"]["culling"], "off");  // what the config sets by hand goes with it
  EXPECT_TRUE(bytes("view.png") == runnersPicture("view.json"));
  EXPECT_TRUE(bytes("home.png") == runnersPicture("home.json"));
}

}  // namespace
}  // namespace gnomon::test
