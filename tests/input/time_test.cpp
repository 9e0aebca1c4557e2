// Times of a batch: every regime, with and without a baseline.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "gnomon/base/files.h"
#include "gnomon/base/json.h"
#include "program.h"
#include "temporary_folder.h"

namespace gnomon::test {
namespace {

class Times : public ::testing::Test {
 protected:
  Json only(const std::string& changes) {
    folder_.write("run.json", smallConfig(changes));
    const Outcome outcome = gnomonProgram(
        {"batch", (folder_ / "run.json").string(), "--out", (folder_ / "out").string(), "--no-cache", "--no-exr"});
    EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
    return Json::parse(readFile(folder_ / "out" / "results.jsonl"));
  }

  TemporaryFolder folder_;
};

TEST_F(Times, EveryRegimeHasItsFigures) {
  const Json time =
      only(R"({"measure": {"regimes": ["dynamic", "animated", "camera", "static"], "frames": 8, "blocks": 2}})")["time"];
  for (const char* regime : {"dynamic", "animated", "camera", "static"}) {
    const Json& figures = time["regimes"][regime];
    EXPECT_EQ(figures["n"], 8) << regime;
    EXPECT_GE(figures["median_ms"], 0.0) << regime;
    EXPECT_EQ(figures["ratio"].is_null(), std::string(regime) == "static") << regime;
  }
  // What moves is rendered again; where nothing moves a frame is next to nothing.
  EXPECT_LT(time["regimes"]["static"]["median_ms"].get<double>(), 0.2 * time["regimes"]["dynamic"]["median_ms"].get<double>());
}

TEST_F(Times, PassesSumToTheTotalAndWhatTheirFinishesCost) {
  const Json time = only(R"({"measure": {"regimes": ["dynamic"], "frames": 8, "blocks": 2}})")["time"];
  double sum = 0.0;
  for (const Json& pass : time["passes"]) sum += pass["ms"].get<double>();
  EXPECT_NEAR(time["pass_sum_ms"], sum, 1e-9);
  EXPECT_NEAR(time["gap_ms"], sum - time["regimes"]["dynamic"]["median_ms"].get<double>(), 1e-9);
}

TEST_F(Times, ABaselineThatRefusesCostsTheRatioAlone) {
  const Json record = only(R"({"lights": [{"type": "point", "position": [0, 6, 1]}], "baseline": {"technique": "shadow_map"},
                               "techniques": [{"technique": "ray_traced", "parameters": {"samples": 1}}]})");
  const Json& dynamic = record["time"]["regimes"]["dynamic"];
  EXPECT_GT(dynamic["median_ms"], 0.0);
  EXPECT_TRUE(dynamic["ratio"].is_null());
  EXPECT_THAT(record["reason"].get<std::string>(), ::testing::HasSubstr("no ratio: the baseline 'shadow_map' refuses"));
}

}  // namespace
}  // namespace gnomon::test
