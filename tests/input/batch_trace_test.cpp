// The trace of a batch: what the file must be for a trace viewer, and what it must show.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "program.h"

namespace gnomon::test {
namespace {

using ::testing::Contains;
using ::testing::Not;

const char* const kThreeJobs =
    R"({"techniques": [{"technique": "unshadowed"}, {"technique": "shadow_map", "sweep": {"map_size": [32, 64]}}]})";

class BatchTrace : public ::testing::Test {
 protected:
  /// A batch of the small config with these changes.
  void run(const std::string& changes, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"batch",   folder_.write("run.json", smallConfig(changes)).string(),
                                       "--out",   out_.string(),
                                       "--cache", (folder_ / "cache").string(),
                                       "--no-exr"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = gnomonProgram(arguments);
    ASSERT_EQ(outcome.exitCode, 0) << outcome.all();
  }
  /// The complete events of the trace, in its order.
  std::vector<Json> slices() const {
    std::vector<Json> found;
    const Json trace = Json::parse(readFile(out_ / "trace.json"));
    for (const Json& event : trace["traceEvents"]) {
      if (event["ph"] == "X") found.push_back(event);
    }
    return found;
  }

  TemporaryFolder folder_;
  std::filesystem::path out_ = folder_ / "out";
};

double endOf(const Json& slice) {
  return slice["ts"].get<double>() + slice["dur"].get<double>();
}

constexpr double kNanosecond = 1e-3;  // in microseconds: what rounding may move an end by

/// Names of the slices from the outermost to each, such as "job/light/reference".
std::vector<std::string> pathsOf(const std::vector<Json>& slices) {
  std::vector<std::string> paths;
  std::vector<Json> open;
  for (const Json& slice : slices) {
    while (!open.empty() && endOf(open.back()) <= slice["ts"].get<double>() + kNanosecond) open.pop_back();
    open.push_back(slice);
    std::string path;
    for (const Json& each : open) path += (path.empty() ? "" : "/") + each["name"].get<std::string>();
    paths.push_back(path);
  }
  return paths;
}

TEST_F(BatchTrace, HoldsCompleteNestedEventsOfOneThread) {
  run(kThreeJobs);
  std::vector<Json> open;
  double last = 0.0;
  for (const Json& slice : slices()) {
    ASSERT_TRUE(slice["name"].is_string()) << slice;
    ASSERT_EQ(slice["pid"], 1) << slice;
    ASSERT_EQ(slice["tid"], 1) << slice;
    ASSERT_GE(slice["dur"].get<double>(), 0.0) << slice;
    const double start = slice["ts"].get<double>();
    ASSERT_GE(start, last) << "in the order of their starts: " << slice;
    last = start;
    while (!open.empty() && endOf(open.back()) <= start + kNanosecond) open.pop_back();
    if (!open.empty()) {
      ASSERT_LE(endOf(slice), endOf(open.back()) + kNanosecond) << slice << " crosses " << open.back();
    }
    open.push_back(slice);
  }
}

TEST_F(BatchTrace, ShowsEachJobsSteps) {
  run(R"({"techniques": [{"technique": "unshadowed"}, {"technique": "shadow_map"}]})");
  const std::vector<std::string> paths = pathsOf(slices());
  for (const char* job : {"half_plane: unshadowed", "half_plane: shadow_map"}) {
    for (const char* step : {"", "/set-up", "/first frame", "/pictures", "/time: dynamic", "/passes/frame"}) {
      EXPECT_THAT(paths, Contains(std::string(job) + step));
    }
  }
  EXPECT_THAT(paths, Contains("half_plane: unshadowed/light/reference"));
  EXPECT_THAT(paths, Not(Contains("half_plane: shadow_map/light/reference"))) << "the light's jobs share it";
}

TEST_F(BatchTrace, ShowsThePassesOfTheRecord) {
  run("{}");
  const std::vector<std::string> paths = pathsOf(slices());
  const Json record = records(out_ / "results.jsonl").at(0);
  for (const Json& pass : record["time"]["passes"]) {
    const std::string path = "half_plane: shadow_map (map_size 64)/passes/frame/" + pass["name"].get<std::string>();
    EXPECT_EQ(std::count(paths.begin(), paths.end(), path), 3) << path << ": it runs in each of three frames";
  }
}

TEST_F(BatchTrace, OfAResumedBatchIsOfWhatItRan) {
  run("{}");
  const std::string first = identity(out_ / "trace.json");
  run("{}", {"--resume"});
  EXPECT_EQ(identity(out_ / "trace.json"), first) << "nothing was run: it stays";
  run(kThreeJobs, {"--resume"});
  const std::vector<std::string> paths = pathsOf(slices());
  EXPECT_THAT(paths, Contains("half_plane: unshadowed"));
  EXPECT_THAT(paths, Not(Contains("half_plane: shadow_map (map_size 64)")));
}

}  // namespace
}  // namespace gnomon::test
