#include "gnomon/run/jobs.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

RunConfig configWith(const std::string& techniques) {
  Problems problems;
  RunConfig config =
      readRunConfigText("c.json", R"({"scene": {"builtin": "half_plane"}, "techniques": )" + techniques + "}", problems);
  EXPECT_TRUE(problems.empty()) << problems.list().front().line();
  return config;
}

std::vector<std::string> names(const std::vector<JobRequest>& jobs) {
  std::vector<std::string> all;
  for (const JobRequest& job : jobs)
    all.push_back(std::to_string(job.light) + " " + job.technique + " " + job.parameters->dump());
  return all;
}

TEST(Jobs, WithoutSweepOneForEachLightAndEntry) {
  EXPECT_EQ(names(expandJobs(configWith(R"([{"technique": "a"}, {"technique": "b", "parameters": {"x": 1}}])"), 2)),
            (std::vector<std::string>{"0 a {}", "0 b {\"x\":1}", "1 a {}", "1 b {\"x\":1}"}));
}

TEST(Jobs, SweepIsTheCartesianProductInTheOrderOfTheFile) {
  EXPECT_EQ(names(expandJobs(
                configWith(R"([{"technique": "a", "parameters": {"k": "box"}, "sweep": {"y": [2, 1], "x": [3, 4]}}])"), 1)),
            (std::vector<std::string>{R"(0 a {"k":"box","y":2,"x":3})", R"(0 a {"k":"box","y":2,"x":4})",
                                      R"(0 a {"k":"box","y":1,"x":3})", R"(0 a {"k":"box","y":1,"x":4})"}));
}

TEST(Jobs, WithoutLightsThereAreNone) {
  EXPECT_TRUE(expandJobs(configWith(R"([{"technique": "a"}])"), 0).empty());
}

TEST(Jobs, KnowTheirEntry) {
  const auto jobs = expandJobs(configWith(R"([{"technique": "a", "sweep": {"x": [1, 2]}}, {"technique": "a"}])"), 1);
  ASSERT_EQ(jobs.size(), 3U);
  EXPECT_EQ(jobs[1].entry, 0U);
  EXPECT_EQ(jobs[2].entry, 1U);
}

TEST(Jobs, FaultsAreMovedToWhereTheValuesStand) {
  const auto jobs =
      expandJobs(configWith(R"([{"technique": "a", "parameters": {"k": 0, "x2": 0}, "sweep": {"x": [3, 4]}}])"), 1);
  Problems found;
  found.add("c.json", jobs[1].where.child("x").pointer, "swept");
  found.add("c.json", jobs[1].where.child("x").child(1).pointer, "inside");
  found.add("c.json", jobs[1].where.child("x2").pointer, "set");
  found.add("c.json", jobs[1].where.pointer, "whole");
  const Problems moved = atTheirPlaces(found, jobs[1]);
  std::vector<std::string> lines;
  for (const Problem& problem : moved.list()) lines.push_back(problem.line());
  EXPECT_EQ(lines,
            (std::vector<std::string>{"c.json: /techniques/0/sweep/x/1: swept", "c.json: /techniques/0/sweep/x/1/1: inside",
                                      "c.json: /techniques/0/parameters/x2: set", "c.json: /techniques/0/parameters: whole"}));
}

}  // namespace
}  // namespace gnomon
