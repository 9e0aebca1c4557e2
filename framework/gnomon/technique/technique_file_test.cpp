#include "gnomon/technique/technique_file.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

std::vector<std::string> faults(const std::string& text) {
  Problems problems;
  readTechniqueFileText("f.json", text, problems);
  std::vector<std::string> lines;
  for (const Problem& problem : problems.list()) lines.push_back(problem.line());
  return lines;
}

TEST(TechniqueFile, ReadsDeclarationsInTheOrderOfTheFile) {
  Problems problems;
  const TechniqueFile file =
      readTechniqueFileText("f.json", R"({"$schema": "technique.schema.json", "library": "pcf", "techniques": {
    "pcf": {"title": "Percentage-closer filtering", "entry": "pcf"},
    "exact_2": {"title": "Exact", "entry": "e", "role": "reference", "parameters": {"taps": 13, "kernel": "box"}}}})",
                            problems);
  ASSERT_TRUE(problems.empty()) << problems.list()[0].line();
  EXPECT_EQ(file.path, "f.json");
  EXPECT_EQ(file.library, "pcf");
  ASSERT_EQ(file.techniques.size(), 2U);
  EXPECT_EQ(file.techniques[0].name, "pcf");
  EXPECT_EQ(file.techniques[0].title, "Percentage-closer filtering");
  EXPECT_EQ(file.techniques[0].role, TechniqueRole::technique);
  EXPECT_EQ(file.techniques[0].parametersJsonText, "{}");
  EXPECT_EQ(file.techniques[1].entry, "e");
  EXPECT_EQ(file.techniques[1].role, TechniqueRole::reference);
  EXPECT_EQ(file.techniques[1].parametersJsonText, R"({"taps":13,"kernel":"box"})");
}

TEST(TechniqueFile, ReportsEveryFault) {
  EXPECT_EQ(
      faults(R"({"library": "../evil", "techniques": {
    "Bad Name": {"title": "t", "entry": "e"},
    "b": {"titel": "t", "entry": "e", "role": "floors", "parameters": []}}})"),
      (std::vector<std::string>{
          "f.json: /techniques/Bad Name: found \"Bad Name\"; allowed: a name of a-z, 0-9 and _",
          "f.json: /techniques/b/titel: unknown key \"titel\"; did you mean \"title\"? allowed: title, entry, compose, role, "
          "parameters",
          "f.json: /techniques/b/role: unknown choice \"floors\"; did you mean \"floor\"? allowed: technique, reference, floor",
          "f.json: /techniques/b/parameters: found []; allowed: an object of parameter values",
          "f.json: /techniques/b: the key \"title\" is missing: what people call it",
          "f.json: /library: found \"../evil\"; allowed: a name of a-z, 0-9 and _",
      }));
}

TEST(TechniqueFile, ACompositionNamesAllThreeComponents) {
  EXPECT_EQ(
      faults(R"({"techniques": {"a": {"title": "t", "compose": {"projection": "p", "footprint": "f"}}}})"),
      (std::vector<std::string>{"f.json: /techniques/a/compose: the key \"representation\" is missing: what a texel stores"}));
}

TEST(TechniqueFile, ACompositionNeedsNoLibraryAndAComponentDoes) {
  EXPECT_TRUE(faults(R"({"techniques": {"a": {"title": "t",
      "compose": {"projection": "p", "representation": "r", "footprint": "f"}}}})")
                  .empty());
  EXPECT_EQ(faults(R"({"components": {"a": {"title": "t", "axis": "footprint"}}})").size(), 1U);
  EXPECT_TRUE(faults(R"({"library": "l", "components": {"a": {"title": "t", "axis": "footprint"}}})").empty());
}

TEST(TechniqueFile, ANameTwiceInOneFileIsAFault) {
  EXPECT_EQ(faults(R"({"library": "l", "techniques": {"a": {"title": "t", "entry": "e"}, "a": {"title": "t", "entry": "e"}}})")
                .size(),
            1U);
}

TEST(TechniqueFile, MustNameLibraryAndTechniques) {
  EXPECT_EQ(faults("{}").size(), 1U);
  EXPECT_EQ(faults(R"({"techniques": {"a": {"title": "t", "entry": "e"}}})").size(), 1U);
  EXPECT_EQ(faults(R"({"library": "l", "techniques": {}})").size(), 1U);
  EXPECT_EQ(faults(R"({"library": "l", "techniques": {"a": 1}})").size(), 1U);
}

TEST(TechniqueFile, WhatCannotBeOpenedIsOneFault) {
  Problems problems;
  readTechniqueFile("/nowhere/x.json", problems);
  ASSERT_EQ(problems.list().size(), 1U);
  EXPECT_EQ(problems.list()[0].line(), "/nowhere/x.json: cannot open: No such file or directory");
}

TEST(TechniqueName, IsLowerCaseDigitsUnderscore) {
  EXPECT_TRUE(isTechniqueName("pcf_13"));
  for (const char* bad : {"", "Pcf", "a b", "a-b", "a/b", "..", "\xc3\xa4"}) EXPECT_FALSE(isTechniqueName(bad)) << bad;
}

TEST(TechniqueFileSchema, DescribesOneDeclaration) {
  const Json schema = techniqueFileSchema();
  const Json& declaration = schema["properties"]["techniques"]["additionalProperties"];
  EXPECT_EQ(declaration["required"].dump(), R"(["title"])");
  EXPECT_EQ(declaration["properties"]["role"]["default"], "technique");
  EXPECT_EQ(schema["properties"]["techniques"]["propertyNames"]["pattern"], "^[a-z0-9_]+$");
}

}  // namespace
}  // namespace gnomon
