#include "gnomon/run/resolve.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace gnomon
