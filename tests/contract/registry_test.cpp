// Registration: what is wrong with technique files and their libraries is said in one line each, and nothing is loaded.
#include "gnomon/technique/registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "plugin_folder.h"

namespace gnomon::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

std::string technique(const std::string& library, const std::string& name = "trace") {
  return R"({"library": ")" + library + R"(", "techniques": {")" + name + R"(": {"title": "t", "entry": "trace"}}})";
}

TEST(Registration, LoadsNoCode) {
  const LoadTrace trace;
  const PluginFolder plugin("trace");
  const Registry registry({plugin.path()});
  EXPECT_THAT(registry.names(), ElementsAre("trace"));
  EXPECT_NE(registry.find("trace"), nullptr);
  EXPECT_FALSE(trace.left());
}

TEST(Registration, OpeningLoadsTheCodeWhichLeavesItsTrace) {  // without this, the absence of a trace would prove nothing
  const LoadTrace trace;
  const PluginFolder plugin("trace");
  Registry registry({plugin.path()});
  EXPECT_EQ(registry.open("trace").entry->name, "trace");
  EXPECT_TRUE(trace.left());
}

TEST(Registration, LibraryThatIsNotThere) {
  const PluginFolder plugin("trace");
  plugin.setJson(technique("tracer"));
  const Registry registry({plugin.path()});
  EXPECT_THAT(registry.names(), IsEmpty());
  EXPECT_THAT(linesOf(registry.problems().list()),
              ElementsAre(AllOf(HasSubstr(plugin.json().string() + ": /library: "), HasSubstr("tracer.so"))));
}

TEST(Registration, LibraryIsNeverFollowedThroughALink) {
  const PluginFolder plugin("trace");
  std::filesystem::remove(plugin.library());
  std::filesystem::create_symlink(testPlugin("trace") / "trace.so", plugin.library());
  const Registry registry({plugin.path()});
  EXPECT_THAT(registry.names(), IsEmpty());
  EXPECT_THAT(linesOf(registry.problems().list()),
              ElementsAre(AllOf(HasSubstr(plugin.json().string() + ": /library: "), HasSubstr("symbolic link"))));
}

TEST(Registration, LibraryIsAPlainName) {
  for (const char* name : {"../trace/trace", "/trace", "sub/trace", "trace.so", "Trace"}) {
    const PluginFolder plugin("trace");
    plugin.setJson(technique(name));
    const Registry registry({plugin.path()});
    EXPECT_THAT(registry.names(), IsEmpty()) << name;
    EXPECT_THAT(linesOf(registry.problems().list()),
                ElementsAre(AllOf(HasSubstr(plugin.json().string() + ": /library: "), HasSubstr("a-z, 0-9 and _"))))
        << name;
  }
}

TEST(Registration, AFolderNamedTwiceIsReadOnce) {
  const PluginFolder plugin("trace");
  const Registry registry({plugin.path(), plugin.path() / "."});
  EXPECT_THAT(registry.names(), ElementsAre("trace"));
  EXPECT_TRUE(registry.problems().empty());
}

TEST(Registration, OfANameThatTwoFilesRegisterNeitherCounts) {
  const PluginFolder one("trace");
  const PluginFolder two("trace");
  const PluginFolder other("counter");
  Registry registry({one.path(), two.path(), other.path()});
  EXPECT_THAT(registry.names(), ElementsAre("counter"));
  EXPECT_THAT(linesOf(registry.problems().list()),
              ElementsAre(AllOf(HasSubstr(two.json().string() + ": /techniques/trace: "), HasSubstr(one.json().string()))));
  try {
    registry.open("trace");
    FAIL() << "a name registered twice was opened";
  } catch (const InputError& error) {
    EXPECT_THAT(linesOf(error.problems()), ElementsAre(HasSubstr("/techniques/trace")));
  }
}

TEST(Registration, ANameRegisteredTwiceSpeaksAgainstBothFiles) {
  const PluginFolder one("trace");
  const PluginFolder two("trace");
  const Registry registry({one.path(), two.path()});
  const auto against = [&](const PluginFolder& file, const PluginFolder& other) {
    return ElementsAre(
        AllOf(HasSubstr(file.json().string() + ": /techniques/trace: "), HasSubstr("registered by " + other.json().string())));
  };
  EXPECT_THAT(linesOf(registry.problemsOf(one.json()).list()), against(one, two));
  EXPECT_THAT(linesOf(registry.problemsOf(two.json()).list()), against(two, one));
}

TEST(Registration, ABrokenFileCostsOnlyItself) {
  const PluginFolder broken("trace");
  broken.setJson(R"({"library": "trace", "techniques": {"trace": {"titel": "t", "entry": 3}}, "more": 1})");
  const PluginFolder torn("trace");
  torn.setJson("{\"library\":\n \"trace\",,}");
  const PluginFolder good("counter");
  const Registry registry({broken.path(), torn.path(), good.path()});
  EXPECT_THAT(registry.names(), ElementsAre("counter"));
  EXPECT_THAT(linesOf(registry.problems().list()),
              UnorderedElementsAre(AllOf(HasSubstr(broken.json().string() + ": /more: "), HasSubstr("unknown")),
                                   AllOf(HasSubstr("/techniques/trace/titel: "), HasSubstr("did you mean \"title\"")),
                                   AllOf(HasSubstr("/techniques/trace: "), HasSubstr("\"title\" is missing")),
                                   AllOf(HasSubstr("/techniques/trace/entry: "), HasSubstr("found 3")),
                                   AllOf(HasSubstr(torn.json().string()), HasSubstr("line 2, column"))));
}

TEST(Registration, AFolderThatIsNotThere) {
  const Registry registry({"/no/such/folder"});
  EXPECT_THAT(linesOf(registry.problems().list()), ElementsAre(HasSubstr("/no/such/folder: is not a folder")));
}

TEST(Registration, AnUnknownNameGetsTheNearest) {
  const PluginFolder plugin("counter");
  Registry registry({plugin.path()});
  try {
    registry.open("cuonter");
    FAIL() << "an unknown name was opened";
  } catch (const InputError& error) {
    EXPECT_THAT(linesOf(error.problems()), ElementsAre(HasSubstr("did you mean 'counter'?")));
  }
}

}  // namespace
}  // namespace gnomon::test
