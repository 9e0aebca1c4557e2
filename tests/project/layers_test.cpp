// Dependencies point one way: base, gl, scene, graph, technique, passes, maps, session, measure, run, report.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "source_tree.h"

namespace gnomon::test {
namespace {

using ::testing::IsEmpty;

const std::vector<std::string> kLayers{"base", "gl",      "scene",   "graph", "technique", "passes",
                                       "maps", "session", "measure", "run",   "report"};

std::size_t rank(const std::string& layer) {
  return static_cast<std::size_t>(std::find(kLayers.begin(), kLayers.end(), layer) - kLayers.begin());
}

/// "gnomon/LAYER/..." or "gnomon/LAYER.h" of every #include of the text, in either kind of brackets.
std::vector<std::string> includedLayers(const std::string& text) {
  static const std::regex include(R"re((?:^|\n)[ \t]*#[ \t]*include[ \t]*["<]gnomon/([a-z_]+)[/.])re");
  std::vector<std::string> layers;
  for (std::sregex_iterator match(text.begin(), text.end(), include); match != std::sregex_iterator(); ++match)
    layers.push_back((*match)[1]);
  return layers;
}

/// The layer of a file below framework/gnomon.
std::string layerOf(const std::string& path) {
  const std::string rest = path.substr(std::string("framework/gnomon/").size());
  return rest.substr(0, rest.find_first_of("/."));
}

bool mayInclude(const std::string& path, const std::string& layer, const std::string& included) {
  if (layer == included) return true;
  if (included == "abi_tag") return layer == "technique";        // generated
  if (layer == "plugin") return rank(included) <= rank("maps");  // the plugins' one header
  if (layer == "image") return included == "base";
  if (layer == "stability") return included == "image" || rank(included) <= rank("measure");
  if (layer == "check") return included == "stability" || rank(included) <= rank("measure");
  if (included == "image") return rank(layer) >= rank("measure") && rank(layer) < kLayers.size();
  if (rank(layer) == kLayers.size() || rank(included) == kLayers.size()) return false;  // a layer that nobody put in order
  if (layer == "scene" && included == "gl") return path.find("scene/gpu_scene.") != std::string::npos;
  return rank(included) < rank(layer);
}

std::vector<std::string> wrongWays(const std::vector<SourceFile>& files) {
  std::vector<std::string> wrong;
  for (const SourceFile& file : files) {
    for (const std::string& included : includedLayers(file.text)) {
      if (!mayInclude(file.path, layerOf(file.path), included)) wrong.push_back(file.path + " includes " + included);
    }
  }
  return wrong;
}

TEST(Layers, OfTheFrameworkDependOneWay) {
  EXPECT_THAT(wrongWays(sourceFiles({"framework/gnomon"}, {".cpp", ".h"})), IsEmpty());
}

TEST(Layers, WrongWaysAreSeen) {  // the test above would see them
  const auto wrong = [](const std::string& path, const std::string& include) {
    return wrongWays({{"framework/gnomon/" + path, "// x\n#include " + include + "\n"}}).size();
  };
  EXPECT_EQ(wrong("graph/a.h", "\"gnomon/technique/technique.h\""), 1U);
  EXPECT_EQ(wrong("passes/a.cpp", "<gnomon/session.h>"), 1U);
  EXPECT_EQ(wrong("session.cpp", "\"gnomon/measure/error.h\""), 1U);
  EXPECT_EQ(wrong("scene/scene.h", "\"gnomon/gl/objects.h\""), 1U);
  EXPECT_EQ(wrong("image/a.cpp", "\"gnomon/gl/objects.h\""), 1U);
  EXPECT_EQ(wrong("base/a.cpp", "\"gnomon/image/image_io.h\""), 1U);
  EXPECT_EQ(wrong("run/a.cpp", "\"gnomon/plugin.h\""), 1U);
  EXPECT_EQ(wrong("check/a.cpp", "\"gnomon/run/batch.h\""), 1U);
  EXPECT_EQ(wrong("stability/a.cpp", "\"gnomon/check/check.h\""), 1U);
  EXPECT_EQ(wrong("newcomer/a.cpp", "\"gnomon/run/batch.h\""), 1U);
  EXPECT_EQ(wrong("scene/gpu_scene.cpp", "\"gnomon/gl/objects.h\""), 0U);
  EXPECT_EQ(wrong("run/a.cpp", "\"gnomon/session.h\""), 0U);
}

TEST(Layers, PluginsSeeTheirContractOnly) {
  std::vector<std::string> wrong;
  for (const SourceFile& file : sourceFiles({"plugins"}, {".cpp", ".h"})) {
    if (file.isTest()) continue;
    for (const std::string& included : includedLayers(file.text)) {
      const std::vector<std::string> allowed{"plugin", "base", "scene", "graph", "technique", "passes", "maps"};
      if (std::find(allowed.begin(), allowed.end(), included) == allowed.end())
        wrong.push_back(file.path + " includes " + included);
    }
  }
  EXPECT_THAT(wrong, IsEmpty());
}

// --- names of plugins ---

/// A plugin's name is that of its folder.
std::vector<std::string> pluginNames() {
  std::vector<std::string> names;
  for (const auto& item : std::filesystem::directory_iterator(std::filesystem::path(GNOMON_SOURCE_DIR) / "plugins")) {
    if (item.is_directory()) names.push_back(item.path().filename().string());
  }
  return names;
}

/// Whole words; "shadow_maps" and "a_pcf" are other names.
std::vector<std::string> mentions(const std::vector<SourceFile>& files, const std::vector<std::string>& names) {
  std::vector<std::string> found;
  for (const SourceFile& file : files) {
    std::size_t lineNumber = 0;
    for (std::size_t begin = 0; begin < file.text.size();) {
      ++lineNumber;
      const std::size_t end = std::min(file.text.find('\n', begin), file.text.size());
      const std::string line = file.text.substr(begin, end - begin);
      for (const std::string& name : names) {
        if (std::regex_search(line, std::regex("\\b" + name + "\\b")))
          found.push_back(file.path + ":" + std::to_string(lineNumber) + ": " + name);
      }
      begin = end + 1;
    }
  }
  return found;
}

/// Unit tests may: they read examples that users would write.
TEST(PluginNames, AreKnownToNobodyInFrameworkAndViewer) {
  std::vector<std::string> endings = codeEndings();
  endings.emplace_back("CMakeLists.txt");
  std::vector<SourceFile> files = sourceFiles({"framework", "viewer"}, endings);
  std::erase_if(files, [](const SourceFile& file) { return file.isTest(); });
  ASSERT_GE(pluginNames().size(), 4U);
  EXPECT_THAT(mentions(files, pluginNames()), IsEmpty());
}

TEST(PluginNames, AreSeenAsWholeWords) {
  const std::vector<std::string> names{"pcf"};
  EXPECT_EQ(mentions({{"a.cpp", "x\n// as pcf does\n"}}, names), std::vector<std::string>{"a.cpp:2: pcf"});
  EXPECT_EQ(mentions({{"a.cpp", "\"pcf\", pcf.frag"}}, names).size(), 1U);
  EXPECT_THAT(mentions({{"a.cpp", "pcfs my_pcf pcf_gaussian PCF"}}, names), IsEmpty());
}

}  // namespace
}  // namespace gnomon::test
