#include "gnomon/run/resolve.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace gnomon {
namespace {

TEST(LoadScene, CastNamesExactlyThoseWhoCast) {
  SceneChoice choice;
  choice.builtin = "layers";
  const Scene all = loadScene(choice, {"c.json", "/scene"});
  choice.cast = {all.instances[1].name};
  const Scene scene = loadScene(choice, {"c.json", "/scene"});
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    EXPECT_EQ(scene.instances[i].casts, scene.instances[i].name == all.instances[1].name) << scene.instances[i].name;
    EXPECT_EQ(scene.instances[i].receives, all.instances[i].receives);
  }
}

TEST(LoadScene, ReceiveNamesExactlyThoseWhoReceive) {
  SceneChoice choice;
  choice.builtin = "layers";
  choice.receive = std::vector<std::string>{};
  for (const Instance& instance : loadScene(choice, {"c.json", "/scene"}).instances) EXPECT_FALSE(instance.receives);
}

TEST(LoadScene, AnUnknownNodeIsToldWhereItStands) {
  SceneChoice choice;
  choice.builtin = "layers";
  choice.cast = {"nobody"};
  try {
    loadScene(choice, {"c.json", "/scene/1"});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().at(0).pointer, "/scene/1/cast");
  }
}

/// Of the instance of that name.
Bounds boundsOf(const Scene& scene, const std::string& name) {
  Bounds bounds;
  for (const Instance& instance : scene.instances)
    if (instance.name == name) bounds.add(worldBounds(scene, instance));
  return bounds;
}

/// The pointer and message of what loading ends in.
std::pair<std::string, std::string> faultOf(const SceneChoice& choice) {
  try {
    loadScene(choice, {"c.json", "/scene"});
  } catch (const InputError& error) {
    return {error.problems().at(0).pointer, error.problems().at(0).message};
  }
  return {};
}

TEST(LoadScene, MovesNamedInstancesAndOnlyThose) {
  SceneChoice choice;
  choice.builtin = "layers";
  const Scene still = loadScene(choice, {"c.json", "/scene"});
  choice.moves = {{"lower", {1.0, 0.25, -2.0}}};
  const Scene moved = loadScene(choice, {"c.json", "/scene"});
  const glm::dvec3 by = boundsOf(moved, "lower").centre() - boundsOf(still, "lower").centre();
  EXPECT_LT(glm::length(by - glm::dvec3(1.0, 0.25, -2.0)), 1e-15);
  EXPECT_EQ(boundsOf(moved, "upper").centre(), boundsOf(still, "upper").centre());
  EXPECT_NE(contentHash(moved), contentHash(still));
}

TEST(LoadScene, AMoveOfNobodyNamesTheNearest) {
  SceneChoice choice;
  choice.builtin = "layers";
  choice.moves = {{"lowr", {1.0, 0.0, 0.0}}};
  EXPECT_EQ(faultOf(choice), std::pair(std::string("/scene/move/lowr"),
                                       std::string("no node of the scene is named 'lowr'; did you mean 'lower'?")));
}

TEST(LoadScene, TimePosesWhatIsAnimated) {
  SceneChoice choice;
  choice.builtin = "animated";
  const Scene start = loadScene(choice, {"c.json", "/scene"});
  choice.time = 2.0;  // half a turn about (0.9, 0, 1.1)
  const Scene later = loadScene(choice, {"c.json", "/scene"});
  const glm::dvec3 middle = (boundsOf(later, "walker").centre() + boundsOf(start, "walker").centre()) / 2.0;
  EXPECT_NEAR(middle.x, 0.9, 1e-12);
  EXPECT_NEAR(middle.z, 1.1, 1e-12);
  EXPECT_NE(contentHash(later), contentHash(start));
}

TEST(LoadScene, TimeNeedsSomethingAnimated) {
  SceneChoice choice;
  choice.builtin = "layers";
  choice.time = 0.5;
  EXPECT_EQ(faultOf(choice).first, "/scene/time");
}

TEST(LoadScene, InstancesStandInThePoseOfTheirTime) {
  SceneChoice choice;
  choice.builtin = "animated";
  choice.time = 1.3;
  choice.moves = {{"walker", {0.0, 0.5, 0.0}}, {"mast", {0.0, 0.25, 0.0}}};
  const Scene scene = loadScene(choice, {"c.json", "/scene"});
  std::vector<glm::dmat4> worlds;
  poseAt(scene, 1.3, worlds);
  for (std::size_t i = 0; i < worlds.size(); ++i) EXPECT_EQ(worlds[i], scene.instances[i].world) << i;
}

TEST(LoadScene, MovesHoldInEveryPose) {
  SceneChoice choice;
  choice.builtin = "animated";
  const Scene still = loadScene(choice, {"c.json", "/scene"});
  choice.time = 1.3;
  choice.moves = {{"walker", {0.0, 0.5, 0.0}}, {"mast", {0.0, 0.25, 0.0}}};
  const Scene moved = loadScene(choice, {"c.json", "/scene"});
  std::vector<glm::dmat4> before, after;
  for (const double seconds : {0.0, 1.3, 2.9}) {
    poseAt(still, seconds, before);
    poseAt(moved, seconds, after);
    for (std::size_t i = 0; i < after.size(); ++i) {
      const std::string& name = moved.instances[i].name;
      const double by = name == "walker" ? 0.5 : name == "mast" ? 0.25 : 0.0;
      EXPECT_NEAR(after[i][3].y - before[i][3].y, by, 1e-15) << name << " at " << seconds;
    }
  }
}

}  // namespace
}  // namespace gnomon
