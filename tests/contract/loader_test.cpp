// Loading: a library that is not a plugin of this very framework is refused, and its code does not run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "gnomon/base/files.h"
#include "gnomon/technique/registry.h"
#include "plugin_folder.h"

namespace gnomon::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// What opening says, which must be problems with places: a registry that opens it fails the test.
std::vector<std::string> refusal(Registry& registry, const std::string& name) {
  try {
    registry.open(name);
  } catch (const InputError& error) {
    return linesOf(error.problems());
  } catch (const std::exception& error) {
    ADD_FAILURE() << "an error without file and pointer: " << error.what();
    return {};
  }
  ADD_FAILURE() << "'" << name << "' was opened";
  return {};
}

std::vector<std::string> refusal(const PluginFolder& plugin, const std::string& name) {
  Registry registry({plugin.path()});
  return refusal(registry, name);
}

TEST(Loader, ForeignTagIsRefusedBeforeItsCodeRuns) {
  const LoadTrace trace;
  const PluginFolder plugin("trace");
  std::string bytes = readFile(plugin.library());
  const std::string tag = frameworkAbiTag();
  const std::size_t at = bytes.find(tag);
  ASSERT_NE(at, std::string::npos);
  char& last = bytes[at + tag.size() - 1];
  last = last == '0' ? '1' : '0';
  plugin.folder().write("trace.so", bytes);
  EXPECT_THAT(refusal(plugin, "trace"),
              ElementsAre(AllOf(HasSubstr(plugin.json().string() + ": /library: trace.so was built for another framework"),
                                HasSubstr(tag))));
  EXPECT_FALSE(trace.left());
}

TEST(Loader, LibraryWithoutNoteIsRefusedBeforeItsCodeRuns) {
  const LoadTrace trace;
  const PluginFolder plugin("no_note");
  EXPECT_THAT(refusal(plugin, "no_note"),
              ElementsAre(AllOf(HasSubstr(plugin.json().string() + ": /library: "), HasSubstr("its tag is 'none'"))));
  EXPECT_FALSE(trace.left());
}

TEST(Loader, FileThatIsNoLibrary) {
  const PluginFolder plugin("trace");
  plugin.folder().write("trace.so", "#!/bin/sh\necho no library\n");
  EXPECT_THAT(refusal(plugin, "trace"),
              ElementsAre(AllOf(HasSubstr(plugin.json().string() + ": /library: "), HasSubstr("ELF"))));
}

TEST(Loader, LibraryOfAnotherWordLength) {
  const PluginFolder plugin("trace");
  std::string bytes = readFile(plugin.library());
  bytes[4] = 1;  // e_ident[EI_CLASS] = ELFCLASS32
  plugin.folder().write("trace.so", bytes);
  EXPECT_THAT(refusal(plugin, "trace"),
              ElementsAre(AllOf(HasSubstr(plugin.json().string() + ": /library: "), HasSubstr("64-bit ELF"))));
}

TEST(Loader, LibraryCutShortAnywhere) {
  const LoadTrace trace;
  const std::size_t whole = std::filesystem::file_size(testPlugin("trace") / "trace.so");
  for (const std::size_t percent : {0, 1, 5, 10, 20, 30, 50, 70, 90, 95}) {
    const PluginFolder plugin("trace");
    plugin.cutLibrary(whole * percent / 100);
    EXPECT_THAT(refusal(plugin, "trace"), ElementsAre(HasSubstr(plugin.json().string() + ": /library: "))) << percent << " %";
  }
  EXPECT_FALSE(trace.left());
}

/// The note is read from bytes that may be anything, and the system's loader would fault on a library that ends too early.
TEST(Loader, WhatIsCutShortHasNoTag) {
  const PluginFolder plugin("trace");
  const std::string whole = readFile(plugin.library());
  EXPECT_EQ(pluginAbiTag(plugin.library()), frameworkAbiTag());
  for (std::size_t size = 0; size < whole.size(); size += 101) {
    const std::filesystem::path cut = plugin.folder().write("cut.so", whole.substr(0, size));
    EXPECT_THROW(pluginAbiTag(cut), Error) << size << " of " << whole.size() << " bytes";
  }
}

TEST(Loader, NoteWithHostileSizes) {
  const PluginFolder plugin("trace");
  const std::string whole = readFile(plugin.library());
  const std::size_t header = whole.find(frameworkAbiTag()) - 8 - 12;  // before the tag: a name of 8 bytes, a header of 12
  ASSERT_EQ(whole.substr(header + 12, 6), "Gnomon");
  for (const std::size_t field : {0, 4}) {
    std::string bytes = whole;
    for (std::size_t i = 0; i < 4; ++i) bytes[header + field + i] = '\xff';
    plugin.folder().write("hostile.so", bytes);
    EXPECT_EQ(pluginAbiTag(plugin.folder() / "hostile.so"), "") << "field " << field;
  }
}

TEST(Loader, LibraryWithoutEntries) {
  const PluginFolder plugin("no_symbol");
  EXPECT_THAT(refusal(plugin, "no_symbol"), ElementsAre(AllOf(HasSubstr(plugin.json().string() + ": /library: "),
                                                              HasSubstr("does not export gnomon_plugin"))));
}

TEST(Loader, LibraryThatNeedsAnotherWhichIsNotThere) {
  const PluginFolder plugin("trace");
  std::string bytes = readFile(plugin.library());
  const std::string needed = "libstdc++.so.6";
  const std::size_t at = bytes.find(needed);
  ASSERT_NE(at, std::string::npos);
  plugin.folder().write("trace.so", bytes.replace(at, needed.size(), "libnowhere.so9"));
  EXPECT_THAT(refusal(plugin, "trace"), ElementsAre(AllOf(HasSubstr(plugin.json().string() + ": /library: trace.so "),
                                                          HasSubstr("libnowhere.so9"), HasSubstr("cannot open"))));
}

TEST(Loader, LibraryThatNeedsASymbolWhichNobodyHas) {
  const PluginFolder plugin("lacks_symbol");
  EXPECT_THAT(refusal(plugin, "lacks_symbol"),
              ElementsAre(AllOf(HasSubstr(plugin.json().string() + ": /library: lacks_symbol.so "),
                                HasSubstr("undefined symbol"), HasSubstr("nobodyDefinesThis"))));
}

TEST(Loader, EntryThatTheLibraryDoesNotHave) {
  const PluginFolder plugin("trace");
  plugin.setJson(R"({"library": "trace", "techniques": {"trace": {"title": "t", "entry": "trase"}}})");
  EXPECT_THAT(refusal(plugin, "trace"), ElementsAre(AllOf(HasSubstr(plugin.json().string() + ": /techniques/trace/entry: "),
                                                          HasSubstr("'trase'"), HasSubstr("it has trace"))));
}

TEST(Loader, LibraryWithoutEntriesIsRefusedEveryTime) {
  const PluginFolder plugin("no_symbol");
  Registry registry({plugin.path()});
  EXPECT_EQ(refusal(registry, "no_symbol"), refusal(registry, "no_symbol"));
}

TEST(Loader, OneLibraryServesAllItsTechniques) {
  const PluginFolder plugin("trace");
  plugin.setJson(
      R"({"library": "trace", "techniques": {"a": {"title": "a", "entry": "trace"}, "b": {"title": "b", "entry": "trace"}}})");
  Registry registry({plugin.path()});
  EXPECT_EQ(registry.open("a").entry, registry.open("b").entry);
}

// --- presets ---

std::vector<std::string> presetProblems(const std::string& preset) {
  const PluginFolder plugin("trace");
  plugin.setJson(R"({"library": "trace", "techniques": {"few": {"title": "t", "entry": "trace", "parameters": )" + preset +
                 "}}}");
  Registry registry({plugin.path()});
  Problems problems;
  registry.parameters(registry.open("few"), Json::object(), {"config", "/techniques/0/parameters"}, problems);
  std::vector<std::string> lines = linesOf(problems.list());
  for (std::string& line : lines) {
    if (line.rfind(plugin.json().string(), 0) == 0) line.replace(0, plugin.json().string().size(), "JSON");
  }
  return lines;
}

TEST(Preset, UnknownParameterIsPlacedInTheTechniquesFile) {
  EXPECT_THAT(presetProblems(R"({"stepz": 2})"), ElementsAre(AllOf(HasSubstr("JSON: /techniques/few/parameters/stepz: unknown"),
                                                                   HasSubstr("did you mean \"steps\""))));
}

TEST(Preset, ValueOutOfRangeIsPlacedInTheTechniquesFile) {
  EXPECT_THAT(presetProblems(R"({"steps": 9})"),
              ElementsAre(AllOf(HasSubstr("JSON: /techniques/few/parameters/steps: found 9"), HasSubstr("from 1 to 8"))));
}

TEST(Preset, StandsBetweenDefaultsAndTheConfig) {
  const PluginFolder plugin("trace");
  plugin.setJson(
      R"({"library": "trace", "techniques": {"few": {"title": "t", "entry": "trace", "parameters": {"steps": 3}}}})");
  Registry registry({plugin.path()});
  const OpenTechnique few = registry.open("few");
  Problems problems;
  const FieldTable& table = *few.entry->parameters;
  EXPECT_EQ(valueText(*table.find("steps"), few.entry->makeParameters().get()), "1");
  EXPECT_EQ(valueText(*table.find("steps"), registry.parameters(few, Json::object(), {}, problems).get()), "3");
  EXPECT_EQ(valueText(*table.find("steps"), registry.parameters(few, Json{{"steps", 5}}, {}, problems).get()), "5");
  EXPECT_TRUE(problems.empty());
}

}  // namespace
}  // namespace gnomon::test
