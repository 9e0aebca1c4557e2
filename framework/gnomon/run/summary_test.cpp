#include "gnomon/run/summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

namespace gnomon {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::vector<std::string> linesOf(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::string lineWith(const std::string& text, const std::string& word) {
  for (const std::string& line : linesOf(text)) {
    if (line.find(word) != std::string::npos) return line;
  }
  return {};
}

JobRecord record(const std::string& technique, const std::string& parameters = "{}") {
  JobRecord r;
  r.job = technique + "-0123";
  r.scene = "layers";
  r.technique = technique;
  r.parametersJson = parameters;
  r.error = ErrorFigures{};
  r.error->rmse = 0.12345;
  r.error->rmseSe = 0.00211;
  r.error->rmseBand = 0.25;
  r.error->bias = 0.0321;
  r.error->noiseFloor = 0.0004;
  return r;
}

JobRecord timed(JobRecord r, double ms, std::optional<double> ratio) {
  r.time = TimeRecord{};
  r.time->timer = Clock::cpu;
  TimingFigures& dynamic = r.time->regimes["dynamic"];
  dynamic.medianMs = ms;
  dynamic.ratio = ratio;
  if (ratio) dynamic.ratioCi95 = Interval{*ratio - 0.5, *ratio + 0.5};
  return r;
}

TEST(AlignedTable, TextIsLeftNumbersAreRightAndNoLineEndsInBlanks) {
  EXPECT_EQ(alignedTable({{"name", "what", "number", "last"}, {"a", "bb", "1.5", "x"}, {"long name", "c", "-", "yy"}}),
            "name       what  number  last\n"
            "-----------------------------\n"
            "a          bb       1.5  x\n"
            "long name  c          -  yy\n");
}

TEST(AlignedTable, WidthIsCountedInCodePoints) {
  const std::vector<std::string> lines =
      linesOf(alignedTable({{"a", "b", "n", "z"}, {"±±", "x", "1", "|"}, {"cc", "x", "2", "|"}}));
  EXPECT_EQ(lines[2].find('x') - 2, lines[3].find('x'));  // each sign is two bytes and one column
}

TEST(AlignedTable, TheSentenceOfAShortRowWidensNoColumn) {
  const std::string sentence = "refused: a sentence that is longer than all columns together";
  const std::vector<std::string> lines = linesOf(alignedTable({{"a", "b", "n", "z"}, {"x", "y", sentence}}));
  EXPECT_EQ(lines[0], "a  b  n  z");
  EXPECT_THAT(lines[2], HasSubstr(sentence));
}

TEST(SummaryTable, HasOneRowAJobWithItsFigures) {
  const std::string table = summaryTable({timed(record("pcf"), 12.34, 2.0)});
  const std::string row = lineWith(table, "pcf");
  for (const char* figure : {"0.1235 ± 0.0021", "0.2500", "+0.0321", "12.3", "2.00 [1.50, 2.50]", "pcf-0123"}) {
    EXPECT_THAT(row, HasSubstr(figure));
  }
}

TEST(SummaryTable, NamesTheClock) {
  EXPECT_THAT(summaryTable({timed(record("pcf"), 1.0, {})}), HasSubstr("cpu ms"));
}

TEST(SummaryTable, TellsTheReferencesNoise) {
  EXPECT_THAT(summaryTable({record("pcf")}), HasSubstr("0.0004"));
}

TEST(SummaryTable, WhatWasNotMeasuredIsADashAndNeverZero) {
  JobRecord r = record("pcf");
  r.error = std::nullopt;
  const std::string row = lineWith(summaryTable({r}), "pcf");
  EXPECT_THAT(row, AllOf(HasSubstr(" - "), Not(HasSubstr("0.0"))));
}

TEST(SummaryTable, AStaticMedianIsNeverShownAsTheCost) {
  JobRecord r = record("pcf");
  r.time = TimeRecord{};
  r.time->timer = Clock::wall;
  r.time->regimes["static"].medianMs = 0.777;
  EXPECT_THAT(summaryTable({r}), Not(HasSubstr("0.777")));
}

TEST(SummaryTable, ShowsOnlyParametersThatTellJobsApart) {
  const std::string table = summaryTable({record("pcf", R"({"taps": 3, "map_size": 512})"),
                                          record("pcf", R"({"taps": 9, "map_size": 512})"), record("other", R"({"taps": 5})")});
  EXPECT_THAT(table, AllOf(HasSubstr("taps 3"), HasSubstr("taps 9"), Not(HasSubstr("map_size")), Not(HasSubstr("taps 5"))));
}

TEST(SummaryTable, ARefusalIsOneSentenceInItsRow) {
  JobRecord r = record("shadow_map");
  r.status = JobStatus::refused;
  r.reason = "a point light shines in all directions";
  EXPECT_THAT(lineWith(summaryTable({record("pcf"), r}), "shadow_map"),
              HasSubstr("refused: a point light shines in all directions"));
}

TEST(SummaryTable, AReasonOfManyLinesIsOneAndCannotPaintTheTerminal) {
  JobRecord r = record("pcf");
  r.status = JobStatus::failed;
  r.reason = "one\ntwo\r\n\x1b[31mred";
  EXPECT_THAT(lineWith(summaryTable({r}), "pcf"), HasSubstr("failed: one | two | ?[31mred"));
}

TEST(SummaryTable, EachSceneAndLightHasItsOwnTable) {
  JobRecord second = record("pcf");
  second.light = 1;
  JobRecord third = record("pcf");
  third.scene = "pillars";
  const std::string table = summaryTable({record("pcf"), second, third});
  EXPECT_THAT(table, AllOf(HasSubstr("layers, light 0\n"), HasSubstr("layers, light 1\n"), HasSubstr("pillars, light 0\n")));
}

TEST(SummaryTable, OfNothingIsEmpty) {
  EXPECT_EQ(summaryTable({}), "");
}

}  // namespace
}  // namespace gnomon
