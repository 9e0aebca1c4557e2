// `gnomon compare`: what it prints, and its exit code.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "gnomon/base/files.h"
#include "gnomon/base/json.h"
#include "program.h"
#include "temporary_folder.h"

namespace gnomon::test {
namespace {

using ::testing::HasSubstr;

/// A record with little in it, as a batch writes them.
Json record(int memory) {
  return {{"job", "pcf-1"}, {"config", "c"},         {"scene", "s"},
          {"light", 0},     {"technique", "pcf"},    {"parameters", Json::object()},
          {"status", "ok"}, {"memory_bytes", memory}};
}

class Compare : public ::testing::Test {
 protected:
  std::string results(const std::string& name, const Json& of) {
    folder_.write(name + "/results.jsonl", of.dump() + "\n");
    return (folder_ / name).string();
  }

  TemporaryFolder folder_;
};

TEST_F(Compare, NothingWorseIsNoFailure) {
  const Outcome outcome = gnomonProgram({"compare", results("before", record(100)), results("after", record(100))});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
  EXPECT_THAT(outcome.out, HasSubstr("1 jobs compared: 0 figures better, 0 worse"));
}

TEST_F(Compare, SomethingWorseIsToldAndFails) {
  const Outcome outcome = gnomonProgram({"compare", results("before", record(100)), results("after", record(200))});
  EXPECT_EQ(outcome.exitCode, 1) << outcome.all();
  EXPECT_THAT(outcome.out, HasSubstr("memory_bytes"));
  EXPECT_THAT(outcome.out, HasSubstr("+100.0 %"));
}

TEST_F(Compare, SomethingBetterIsToldAndIsNoFailure) {
  const Outcome outcome = gnomonProgram({"compare", results("before", record(200)), results("after", record(100))});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
  EXPECT_THAT(outcome.out, HasSubstr("better"));
}

TEST_F(Compare, AJobThatFailsNowIsWorse) {
  Json failed = record(100);
  failed["status"] = "failed";
  EXPECT_EQ(gnomonProgram({"compare", results("before", record(100)), results("after", failed)}).exitCode, 1);
}

TEST_F(Compare, JsonSaysTheSame) {
  const Outcome outcome = gnomonProgram({"compare", results("before", record(100)), results("after", record(200)), "--json"});
  EXPECT_EQ(outcome.exitCode, 1);
  const Json said = Json::parse(outcome.out);
  EXPECT_EQ(said["worse"], true);
  EXPECT_EQ(said["jobs"][0]["technique"], "pcf");
}

TEST_F(Compare, BadInputExitsWithTwoAndSaysWhatToDo) {
  const std::string before = results("before", record(100));
  std::filesystem::create_directories(folder_ / "empty");
  for (const std::string& after : {before, (folder_ / "nowhere").string(), (folder_ / "empty").string()}) {
    const Outcome outcome = gnomonProgram({"compare", before, after});
    EXPECT_EQ(outcome.exitCode, 2) << after;
    EXPECT_THAT(outcome.lines("error"), ::testing::ElementsAre(HasSubstr(after))) << after;
  }
}

}  // namespace
}  // namespace gnomon::test
