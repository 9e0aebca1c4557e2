#include "gnomon/base/json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

std::vector<std::string> faults(const std::string& text) {
  Problems problems;
  parseJson("f", text, problems);
  std::vector<std::string> lines;
  for (const Problem& problem : problems.list()) lines.push_back(problem.line());
  return lines;
}

TEST(ParseJson, BuildsTheSameDocumentAsTheLibrary) {
  const std::string text = R"({"b": [1, -2, 3.5, true, null, {"x": "y"}, []], "a": {}, "c": {"d": {"e": [[0]]}}})";
  Problems problems;
  const std::optional<Json> parsed = parseJson("f", text, problems);
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->dump(), Json::parse(text).dump());
  EXPECT_TRUE(problems.empty());
}

TEST(ParseJson, KeysKeepTheirOrder) {
  Problems problems;
  EXPECT_EQ(parseJson("f", R"({"z":1,"a":2})", problems)->dump(), R"({"z":1,"a":2})");
}

TEST(ParseJson, EveryRepeatedKeyIsReportedAtItsPlace) {
  EXPECT_EQ(faults(R"({"a": 1, "b": [{"c/d": 1, "c/d": 2, "c/d": 3}], "a": 2})"),
            (std::vector<std::string>{"f: /b/0/c~1d: this key is given twice", "f: /b/0/c~1d: this key is given twice",
                                      "f: /a: this key is given twice"}));
}

TEST(ParseJson, TheLastOfRepeatedKeysStays) {
  Problems problems;
  EXPECT_EQ(parseJson("f", R"({"a": {"x": 1}, "b": 2, "a": [3]})", problems)->dump(), R"({"a":[3],"b":2})");
}

TEST(ParseJson, SyntaxErrorTellsLineAndColumn) {
  const auto lines = faults("{\n  \"a\": 1,\n  \"b\": }\n");
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].rfind("f: /b: line 3, column 8: syntax error while parsing value - unexpected '}'", 0), 0U) << lines[0];
}

TEST(ParseJson, EmptyTextIsASyntaxError) {
  EXPECT_EQ(faults("").size(), 1U);
}

TEST(ParseJson, CommentsTrailingTextAndNansAreRefused) {
  for (const char* text : {"{} // c", "/* c */ {}", "{} {}", "{\"a\": NaN}", "[1,]", "{\"a\": Infinity}", "\"\xff\""}) {
    EXPECT_EQ(faults(text).size(), 1U) << text;
  }
}

TEST(ParseJson, NumberThatOverflowsIsReportedAtItsPlace) {
  const auto lines = faults(R"({"a": [0, 1e999]})");
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NE(lines[0].find("f: /a/1: line 1, column 15: number overflow"), std::string::npos) << lines[0];
}

TEST(ParseJson, DeepNestingIsRefused) {
  const auto nested = [](std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
  EXPECT_TRUE(faults(nested(64)).empty());
  const auto lines = faults(nested(1000000));
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NE(lines[0].find("nested deeper than 64 levels"), std::string::npos);
}

TEST(ParseJson, ManyKeysTakeLinearTime) {  // seconds become minutes where each key is searched in a list
  std::string text = "{";
  for (int i = 0; i < 200000; ++i) text += (i == 0 ? "\"k" : ",\"k") + std::to_string(i) + "\":1";
  Problems problems;
  EXPECT_EQ(parseJson("f", text + "}", problems)->size(), 200000U);
}

TEST(ShortText, CutsLongValuesBetweenCharacters) {
  const std::string text = shortText(Json("a" + std::string(5, 'b') + [] {
    std::string umlauts;
    for (int i = 0; i < 50; ++i) umlauts += "\xc3\xa4";
    return umlauts;
  }()));
  EXPECT_LE(text.size(), 60U);
  EXPECT_NO_THROW(Json(text).dump()) << text;  // throws on half a character
  EXPECT_EQ(text.substr(text.size() - 3), "...");
}

}  // namespace
}  // namespace gnomon
