// Batches of a technique of known cost.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "gnomon/measure/results.h"
#include "program.h"
#include "temporary_folder.h"

namespace gnomon::test {

class KnownCost : public testing::Test {
 protected:
  /// Runs a batch of small pictures by the processor's clock, which a busy machine moves little.
  Outcome batch(const std::string& config, const std::vector<std::string>& options = {}, const std::string& out = "out") {
    folder_.write("run.json", smallConfig(config));
    std::vector<std::string> words{
        "batch",           (folder_ / "run.json").string(), "--out", (folder_ / out).string(), "--timer", "cpu", "--no-exr",
        "--technique-dir", testPluginFolder("busy")};
    words.insert(words.end(), options.begin(), options.end());
    return gnomonProgram(words);
  }
  std::vector<JobRecord> results(const std::string& out = "out") { return readResults(folder_ / out); }

  std::vector<JobRecord> run(const std::string& config, const std::vector<std::string>& options = {}) {
    const Outcome outcome = batch(config, options);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
    return results();
  }

  TemporaryFolder folder_;
};

inline const TimingFigures& dynamic(const JobRecord& record) {
  return record.time.value().regimes.at("dynamic");
}

}  // namespace gnomon::test
