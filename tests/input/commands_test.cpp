// Commands that render nothing: usage, help, what they load, and what they accept.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "program.h"

namespace gnomon::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// The commands that the program's own help lists.
std::vector<std::string> commandNames() {
  std::istringstream help(gnomonProgram({"--help"}).out);
  std::vector<std::string> names;
  bool inside = false;
  for (std::string line; std::getline(help, line);) {
    if (line.rfind("Subcommands:", 0) == 0) {
      inside = true;
    } else if (inside && line.rfind("  ", 0) == 0 && line[2] != ' ') {
      names.push_back(line.substr(2, line.find(' ', 2) - 2));
    }
  }
  return names;
}

TEST(Usage, EveryCommandHelps) {
  const std::vector<std::string> names = commandNames();
  for (const char* wanted : {"list", "describe", "scenes", "validate", "plan", "render", "batch"})
    EXPECT_THAT(names, ::testing::Contains(wanted));
  for (const std::string& name : names) {
    const Outcome outcome = gnomonProgram({name, "--help"});
    EXPECT_EQ(outcome.exitCode, 0) << name;
    EXPECT_THAT(outcome.out, HasSubstr("Usage")) << name;
    EXPECT_THAT(outcome.err, IsEmpty()) << name;
  }
}

TEST(Usage, WhatIsWrongWithItExitsWithTwo) {
  const TemporaryFolder folder;
  const std::string config = folder.write("run.json", smallConfig()).string();
  const std::string out = (folder / "out").string();
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{},
                                             {"lst"},
                                             {"list", "--nosuch"},
                                             {"describe"},
                                             {"describe", "shadow_mpa"},
                                             {"validate"},
                                             {"plan"},
                                             {"batch", config},
                                             {"batch", "--out", out},
                                             {"batch", config, "--out", out, "--shard", "2/2"},
                                             {"batch", config, "--out", out, "--shard", "-1/2"},
                                             {"batch", config, "--out", out, "--shard", "0/2x"},
                                             {"batch", config, "--out", out, "--shard", "half"},
                                             {"batch", config, "--out", out, "--gpu", "one"},
                                             {"render", config, config, "--out", out}}) {
    const Outcome outcome = gnomonProgram(arguments);
    EXPECT_EQ(outcome.exitCode, 2) << ::testing::PrintToString(arguments) << "\n" << outcome.all();
    EXPECT_THAT(outcome.err, Not(IsEmpty())) << ::testing::PrintToString(arguments);
    EXPECT_THAT(outcome.out, IsEmpty()) << ::testing::PrintToString(arguments);
  }
  EXPECT_FALSE(std::filesystem::exists(out));
}

// --- what is loaded ---

/// Shared objects that the dynamic linker opened.
std::string filesOpened(const std::vector<std::string>& arguments) {
  const TemporaryFolder folder;
  gnomonProgram(arguments, {{"LD_DEBUG", "files"}, {"LD_DEBUG_OUTPUT", (folder / "linker").string()}});
  std::string all;
  for (const std::string& name : namesIn(folder.path())) all += readFile(folder / name);
  return all;
}

TEST(Loading, ListTakesNeitherTheImageLibraryNorPlugins) {
  const std::string opened = filesOpened({"list"});
  EXPECT_THAT(opened, HasSubstr("libgnomon.so"));
  EXPECT_THAT(opened, Not(HasSubstr("OpenImageIO")));
  EXPECT_THAT(opened, Not(HasSubstr("shadow_map.so")));
  EXPECT_THAT(opened, Not(HasSubstr("embree")));
}

TEST(Loading, RenderTakesTheImageLibrary) {  // so that its absence above means something
  const TemporaryFolder folder;
  const std::string config = folder.write("run.json", smallConfig()).string();
  const std::string opened = filesOpened({"render", config, "--out", (folder / "out").string()});
  EXPECT_THAT(opened, HasSubstr("OpenImageIO"));
  EXPECT_THAT(opened, HasSubstr("shadow_map.so"));
}

// --- what is accepted ---

TEST(Validate, AcceptsAGoodConfigATechniqueFileAndGltf) {
  const TemporaryFolder folder;
  const std::string config = folder.write("run.json", smallConfig()).string();
  const std::string gltf = folder
                               .write("triangle.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
      "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [0, 0, 0]}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}],
      "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,)" +
                                                           std::string(48, 'A') + R"("}]})")
                               .string();
  const Outcome outcome = gnomonProgram({"validate", config, testPluginFolder("trace") + "/trace.json", gltf});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
  EXPECT_THAT(outcome.lines("error"), IsEmpty());
}

TEST(Validate, RefusesGltfThatIsBroken) {
  const TemporaryFolder folder;
  const std::string gltf = folder.write("broken.gltf", R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [7]}]})").string();
  const Outcome outcome = gnomonProgram({"validate", gltf});
  EXPECT_EQ(outcome.exitCode, 2) << outcome.all();
  EXPECT_THAT(outcome.lines("error"), ::testing::ElementsAre(HasSubstr(gltf)));
}

TEST(Validate, RefusesWhatItDoesNotKnow) {
  const TemporaryFolder folder;
  const std::string file = folder.write("notes.txt", "hello").string();
  EXPECT_EQ(gnomonProgram({"validate", file}).exitCode, 2);
}

TEST(Validate, SaysWhatAFileOfNoKindLacks) {
  const TemporaryFolder folder;
  for (const char* text : {"{}", "[]", "3"}) {
    const Outcome outcome = gnomonProgram({"validate", folder.write("x.json", text).string()});
    EXPECT_EQ(outcome.exitCode, 2) << text;
    EXPECT_THAT(outcome.err, HasSubstr("neither a run config (.json with scene and techniques), nor a technique file")) << text;
  }
  const Outcome components = gnomonProgram({"validate", folder.write("x.json", R"({"components": {}})").string()});
  EXPECT_THAT(components.err, HasSubstr("/components")) << "a technique file";
}

TEST(Json, OfEveryCommandThatOffersItIsJson) {
  const TemporaryFolder folder;
  const std::string config = folder.write("run.json", smallConfig()).string();
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"list", "--json"}, {"describe", "pcf", "--json"}, {"scenes", "--json"}, {"plan", config, "--json"}}) {
    const Outcome outcome = gnomonProgram(arguments);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
    EXPECT_FALSE(Json::parse(outcome.out, nullptr, false).is_discarded()) << arguments[0] << ": " << outcome.out;
  }
}

}  // namespace
}  // namespace gnomon::test
