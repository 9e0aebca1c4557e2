#include "gnomon/measure/results.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "gnomon/base/error.h"
#include "gnomon/base/files.h"

namespace gnomon {
namespace {

using nlohmann::json;

/// A record with a different value in every field.
JobRecord fullRecord() {
  JobRecord record;
  record.job = "0123abcd";
  record.config = "sphere-grid";
  record.scene = "sphere_grid";
  record.light = 2;
  record.technique = "pcf";
  record.parametersJson = R"({"taps":5,"kernel":"box"})";
  record.status = JobStatus::failed;
  record.reason = "line one\nline \"two\"";
  record.error = ErrorFigures{.mse = -1e-7,
                              .mseSe = 2e-7,
                              .rmse = 0.0,
                              .rmseSe = 4e-4,
                              .rmseBand = 0.1,
                              .mae = 0.2,
                              .bias = -0.3,
                              .p99 = 0.4,
                              .max = 0.5,
                              .over01 = 0.6,
                              .nonFinite = 7,
                              .noiseFloor = 0.8,
                              .lit = {0.1, 0.2, 0.3},
                              .umbra = {0.4, 0.5, 0.6},
                              .penumbra = {0.7, 0.8, 0.9},
                              .band = {0.11, 0.12, 0.13},
                              .terminator = {0.0, std::nullopt, std::nullopt}};
  TimeRecord time;
  time.timer = Clock::cpu;
  time.regimes["dynamic"] = {.medianMs = 1.0,
                             .wallMedianMs = 2.0,
                             .madMs = 3.0,
                             .ci95Ms = Interval{4.0, 5.0},
                             .p95Ms = 6.0,
                             .n = 60,
                             .ratio = 7.0,
                             .ratioCi95 = Interval{8.0, 9.0},
                             .pairs = {}};
  time.passes = {{"depth", 1.25, 1.5}, {"filter", std::nullopt, std::nullopt}};
  time.passSumMs = 1.25;
  time.gapMs = 0.25;
  time.repeats = 3;
  record.time = time;
  record.splits = ErrorSplits{.acne = 0.1, .leak = 0.2, .detachment = 0.3, .penumbra = 0.4, .offset = 0.5, .shimmer = 0.6};
  record.flip = FlipFigures{.mean = 0.6, .p99 = 0.7};
  record.reference = ReferenceRecord{.rays = 10, .raysSaved = 5, .standardError = 0.01, .cosineFloor = 0.02};
  record.work = {.passesRun = 1,
                 .passesSkipped = 2,
                 .draws = 3,
                 .primitives = 4,
                 .fragments = 5,
                 .texelReads = 6,
                 .texelsWritten = 7,
                 .bytesWritten = 8,
                 .rays = std::uint64_t{1} << 40,
                 .readsByFormat = std::map<std::string, std::uint64_t>{{"R32F", 6}},
                 .passes = std::vector<PassWork>{{"depth", 4, 5, 6, 7, 8, 9}}};
  record.memoryBytes = std::uint64_t{5} << 30;
  record.plan = {{"penumbra", true, "wide", 3.5}, {"motion", false, "nothing moves", std::nullopt}};
  record.without = {"clamp"};
  record.machine = {"llvmpipe", "a processor"};
  return record;
}

std::set<std::string> keysOf(const json& object) {
  std::set<std::string> names;
  for (const auto& [name, value] : object.items()) names.insert(name);
  return names;
}

TEST(Results, EveryFieldReadsBack) {
  const ParsedResults results = parseResults(toJsonLine(fullRecord()) + "\n", "r");
  ASSERT_EQ(results.records.size(), 1u);
  EXPECT_EQ(results.records[0], fullRecord());
  EXPECT_TRUE(results.warnings.empty());
}

TEST(Results, ARecordIsOneLine) {
  EXPECT_EQ(toJsonLine(fullRecord()).find('\n'), std::string::npos);
}

TEST(Results, KeysAreThoseOfTheFormat) {
  const json line = json::parse(toJsonLine(fullRecord()));
  EXPECT_EQ(keysOf(line), (std::set<std::string>{"job", "config", "scene", "light", "technique", "parameters", "status",
                                                 "reason", "error", "splits", "flip", "reference", "time", "work",
                                                 "memory_bytes", "plan", "without", "machine"}));
  EXPECT_EQ(keysOf(line["splits"]), (std::set<std::string>{"acne", "leak", "detachment", "penumbra", "offset", "shimmer"}));
  EXPECT_EQ(keysOf(line["flip"]), (std::set<std::string>{"mean", "p99"}));
  EXPECT_EQ(keysOf(line["reference"]), (std::set<std::string>{"rays", "rays_saved", "standard_error", "cosine_floor"}));
  EXPECT_EQ(keysOf(line["error"]), (std::set<std::string>{"mse", "mse_se", "rmse", "rmse_se", "rmse_band", "mae", "bias", "p99",
                                                          "max", "over_0_1", "non_finite", "noise_floor", "classes"}));
  EXPECT_EQ(keysOf(line["error"]["classes"]), (std::set<std::string>{"lit", "umbra", "penumbra", "band", "terminator"}));
  EXPECT_EQ(keysOf(line["error"]["classes"]["lit"]), (std::set<std::string>{"share", "rmse", "bias"}));
  EXPECT_EQ(keysOf(line["time"]), (std::set<std::string>{"timer", "regimes", "passes", "pass_sum_ms", "gap_ms", "repeats"}));
  EXPECT_EQ(keysOf(line["time"]["regimes"]["dynamic"]),
            (std::set<std::string>{"median_ms", "wall_median_ms", "mad_ms", "ci95_ms", "p95_ms", "n", "ratio", "ratio_ci95"}));
  EXPECT_EQ(keysOf(line["time"]["passes"][0]), (std::set<std::string>{"name", "ms", "wall_ms"}));
  EXPECT_EQ(keysOf(line["work"]),
            (std::set<std::string>{"passes_run", "passes_skipped", "draws", "primitives", "fragments", "texel_reads",
                                   "texels_written", "bytes_written", "rays", "reads_by_format", "passes"}));
  EXPECT_EQ(keysOf(line["work"]["passes"][0]), (std::set<std::string>{"name", "primitives", "fragments", "texel_reads",
                                                                      "texels_written", "bytes_written", "rays"}));
  EXPECT_EQ(keysOf(line["plan"][0]), (std::set<std::string>{"effect", "on", "reason", "value"}));
  EXPECT_EQ(keysOf(line["machine"]), (std::set<std::string>{"renderer", "cpu"}));
}

/// Every key of an object and of what it holds, but for names that the record's author chose.
void collectKeys(const json& value, std::set<std::string>& names) {
  if (value.is_array()) {
    for (const json& element : value) collectKeys(element, names);
  }
  if (!value.is_object()) return;
  for (const auto& [name, inner] : value.items()) {
    names.insert(name);
    if (name != "parameters" && name != "reads_by_format") collectKeys(inner, names);
  }
}

TEST(Results, EveryKeyIsExplainedInTheDocument) {
  std::set<std::string> names;
  collectKeys(json::parse(toJsonLine(fullRecord())), names);
  const std::string document = readFile(std::filesystem::path(GNOMON_SOURCE_DIR) / "docs" / "measuring.md");
  for (const std::string& name : names)
    EXPECT_NE(document.find("`" + name + "`"), std::string::npos) << "docs/measuring.md does not name " << name;
}

TEST(Results, WhatWasNotMeasuredIsNull) {
  JobRecord record;
  record.job = "k";
  record.error.emplace();
  record.time.emplace().regimes["dynamic"] = {};
  const json line = json::parse(toJsonLine(record));
  EXPECT_TRUE(line["memory_bytes"].is_null());
  for (const auto& [key, value] : line["work"].items()) EXPECT_TRUE(value.is_null()) << key;
  for (const auto& [key, value] : line["time"]["regimes"]["dynamic"].items()) EXPECT_TRUE(value.is_null()) << key;
  for (const auto& [key, value] : line["error"].items()) {
    EXPECT_EQ(value.is_null(), key != "non_finite" && key != "classes") << key;
  }
}

TEST(Results, ANumberThatIsNoneIsNull) {
  JobRecord record = fullRecord();
  record.error->rmse = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(json::parse(toJsonLine(record))["error"]["rmse"].is_null());
}

TEST(Results, AStaticRegimeHasNoRatio) {
  JobRecord record = fullRecord();
  record.time->regimes["static"] = record.time->regimes["dynamic"];
  const json regimes = json::parse(toJsonLine(record))["time"]["regimes"];
  EXPECT_TRUE(regimes["static"]["ratio"].is_null());
  EXPECT_TRUE(regimes["static"]["ratio_ci95"].is_null());
  EXPECT_EQ(regimes["static"]["median_ms"], 1.0);
  EXPECT_EQ(regimes["dynamic"]["ratio"], 7.0);
}

TEST(Results, ParametersAreAnObjectOrAnError) {
  JobRecord record = fullRecord();
  EXPECT_EQ(json::parse(toJsonLine(record))["parameters"]["taps"], 5);
  record.parametersJson = "{\"taps\":";
  EXPECT_THROW(toJsonLine(record), Error);
  record.parametersJson = "5";
  EXPECT_THROW(toJsonLine(record), Error);
}

TEST(Results, BytesThatAreNoUtf8AreReplaced) {
  JobRecord record = fullRecord();
  record.reason = "driver says \xff\xfe";
  EXPECT_EQ(parseResults(toJsonLine(record), "r").records.size(), 1u);
}

std::string lineOf(const std::string& job, const std::string& technique) {
  JobRecord record = fullRecord();
  record.job = job;
  record.technique = technique;
  return toJsonLine(record) + "\n";
}

TEST(Results, OfARepeatedJobTheLastWins) {
  const ParsedResults results = parseResults(lineOf("a", "old") + lineOf("b", "other") + lineOf("a", "new"), "r");
  ASSERT_EQ(results.records.size(), 2u);
  EXPECT_EQ(results.records[0].technique, "new");
  EXPECT_EQ(results.records[1].technique, "other");
}

TEST(Results, ATornTailCostsItselfOnly) {  // wherever it was torn
  const std::string whole = lineOf("a", "x");
  const std::string next = lineOf("b", "y");
  for (std::size_t length = 1; length + 2 < next.size(); length += 7) {
    const ParsedResults results = parseResults(whole + next.substr(0, length), "r");
    EXPECT_EQ(results.records.size(), 1u) << length;
    ASSERT_EQ(results.warnings.size(), 1u) << length;
    EXPECT_EQ(results.warnings[0].find("r:2: torn last line"), 0u) << results.warnings[0];
  }
}

TEST(Results, ACompleteTailWithoutItsNewlineCounts) {
  std::string text = lineOf("a", "x") + lineOf("b", "y");
  text.pop_back();
  EXPECT_EQ(parseResults(text, "r").records.size(), 2u);
}

TEST(Results, DamagedLinesCostThemselvesOnly) {
  for (const std::string& damage :
       {std::string(4096, '\0'), std::string("[]"), std::string("{}"), std::string("{\"job\": 5}"),
        std::string("{\"job\": \"c\", \"status\": \"odd\"}"), std::string("{\"job\": \"c\", \"time\": 3}"),
        std::string("{\"job\": \"c\", \"error\": {\"classes\": []}}")}) {
    const ParsedResults results = parseResults(lineOf("a", "x") + damage + "\n" + lineOf("b", "y"), "r");
    EXPECT_EQ(results.records.size(), 2u) << damage;
    EXPECT_EQ(results.warnings.size(), 1u) << damage;
  }
}

TEST(Results, NothingIsNoRecords) {
  EXPECT_TRUE(parseResults("", "r").records.empty());
  EXPECT_TRUE(parseResults("\n\n", "r").warnings.empty());
}

TEST(Results, RawPairsGoToTheSideFile) {
  TimeRecord time;
  time.regimes["dynamic"].pairs = {{1, 2, {{{1.0, 2.0, 3.0}, {4.0, 5.0}}}, {{{6.0, 7.0}, {8.0, 9.0}}}}};
  const json pair = json::parse(timingPairsJson(time))["regimes"]["dynamic"][0];
  EXPECT_EQ(pair["block"], 1);
  EXPECT_EQ(pair["pose"], 2);
  EXPECT_EQ(pair["candidate"][0]["gpu_ms"], 3.0);
  EXPECT_TRUE(pair["candidate"][1]["gpu_ms"].is_null());
  EXPECT_EQ(pair["baseline"][1]["wall_ms"], 9.0);
}

TEST(Results, RawPairsAreReadBack) {
  TimeRecord time;
  time.regimes["dynamic"].pairs = {{1, 2, {{{1.0, 2.0, 3.0}, {4.0, 5.0}}}, {{{6.0, 7.0}, {8.0, 9.0}}}}};
  time.regimes["static"];
  const auto read = parseTimingPairs(timingPairsJson(time));
  EXPECT_EQ(read.size(), 2U);
  EXPECT_EQ(read.at("dynamic"), time.regimes["dynamic"].pairs);
}

TEST(Results, ADamagedSideFileIsAnError) {
  for (const char* text : {"", "{", "[]", "{}", R"({"regimes": {"dynamic": [{"candidate": [{}]}]}})"})
    EXPECT_ANY_THROW(parseTimingPairs(text)) << text;
}

class ResultsFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) /
              ("gnomon_results_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
};

TEST_F(ResultsFolder, AppendedLinesReadBack) {
  const std::filesystem::path file = folder_ / "results.jsonl";
  appendLineSynced(file, toJsonLine(fullRecord()));
  EXPECT_EQ(readResults(file), std::vector<JobRecord>{fullRecord()});
}

TEST_F(ResultsFolder, AFolderIsReadOverAllItsWorkers) {
  writeFileAtomically(folder_ / "results.0.jsonl", lineOf("a", "old") + lineOf("b", "x"));
  writeFileAtomically(folder_ / "results.1.jsonl", lineOf("a", "new"));
  writeFileAtomically(folder_ / "other.jsonl", lineOf("c", "x"));
  const std::vector<JobRecord> records = readResults(folder_);
  ASSERT_EQ(records.size(), 2u);
  EXPECT_EQ(records[0].technique, "new");
}

TEST_F(ResultsFolder, AMissingFileIsAnError) {
  EXPECT_THROW(readResults(folder_ / "results.jsonl"), Error);
}

}  // namespace
}  // namespace gnomon
