// `gnomon report`: what it refuses, and what its page holds.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "gnomon/base/files.h"
#include "gnomon/measure/results.h"
#include "gnomon/report/packed_picture.h"
#include "gnomon/report/report.h"
#include "program.h"
#include "temporary_folder.h"

namespace gnomon::test {
namespace {

using nlohmann::json;

JobRecord record(const std::string& job, const std::string& scene = "pillars") {
  JobRecord made;
  made.job = job;
  made.config = "c";
  made.scene = scene;
  made.technique = "pcf";
  made.parametersJson = R"({"taps": 3})";
  made.error.emplace().rmse = 0.1;
  return made;
}

/// The data of a page.
json dataOf(const std::filesystem::path& page) {
  const std::string text = readFile(page);
  const std::string begin = R"(<script type="application/json" id="gnomon-data">)";
  const std::size_t at = text.find(begin) + begin.size();
  return json::parse(text.substr(at, text.find("</script>", at) - at));
}

class Report : public testing::Test {
 protected:
  void results(const std::string& text, const std::string& name = "results.jsonl") { folder_.write("out/" + name, text); }
  Outcome report(const std::vector<std::string>& options = {}) {
    std::vector<std::string> words{"report", (folder_ / "out").string()};
    words.insert(words.end(), options.begin(), options.end());
    return gnomonProgram(words);
  }
  std::filesystem::path page() { return folder_ / "out" / "report.html"; }

  TemporaryFolder folder_;
};

TEST_F(Report, HoldsEveryRecord) {
  results(toJsonLine(record("a")) + "\n" + toJsonLine(record("b")) + "\n");
  const Outcome outcome = report();
  ASSERT_EQ(outcome.exitCode, 0) << outcome.all();
  const json data = dataOf(page());
  ASSERT_EQ(data["records"].size(), 2U);
  EXPECT_EQ(data["records"][1]["job"], "b");
  EXPECT_EQ(data["records"][1]["error"]["rmse"], 0.1);
  EXPECT_EQ(data["title"], "out");
}

TEST_F(Report, TheLastOfARepeatedJobCountsOverAllFiles) {
  results(toJsonLine(record("a", "first")) + "\n");
  results(toJsonLine(record("a", "second")) + "\n", "results.1.jsonl");
  ASSERT_EQ(report().exitCode, 0);
  EXPECT_EQ(dataOf(page())["records"].size(), 1U);
}

TEST_F(Report, ADamagedLineStandsInThePage) {
  results(toJsonLine(record("a")) + "\n{\"job\": 5}\n");
  const Outcome outcome = report();
  ASSERT_EQ(outcome.exitCode, 0);
  EXPECT_NE(outcome.all().find("results.jsonl:2"), std::string::npos) << outcome.all();
  EXPECT_NE(dataOf(page())["warnings"].dump().find("results.jsonl:2"), std::string::npos);
}

TEST_F(Report, NamesAreNoMarkup) {
  JobRecord nasty = record("a", "</script><script>alert(1)</script>");
  nasty.reason = "<img src=x>";
  results(toJsonLine(nasty) + "\n");
  ASSERT_EQ(report().exitCode, 0);
  const std::string text = readFile(page());
  EXPECT_EQ(text.find("<script>alert"), std::string::npos);
  EXPECT_EQ(text.find("<img"), std::string::npos);
  EXPECT_EQ(dataOf(page())["records"][0]["scene"], nasty.scene);
}

TEST_F(Report, RefusesAFolderThatIsNotThere) {
  const Outcome outcome = report();
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_NE(outcome.all().find("is no folder"), std::string::npos) << outcome.all();
}

TEST_F(Report, RefusesAFolderWithoutResults) {
  std::filesystem::create_directories(folder_ / "out");
  const Outcome outcome = report();
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_NE(outcome.all().find("holds no results"), std::string::npos) << outcome.all();
  EXPECT_FALSE(std::filesystem::exists(page()));
}

TEST_F(Report, RefusesWhatHoldsNoWholeRecordAndKeepsTheEarlierPage) {
  results("{\"job\": \"a\", \"co");
  folder_.write("out/report.html", "earlier");
  const Outcome outcome = report();
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_NE(outcome.all().find("no whole record"), std::string::npos) << outcome.all();
  EXPECT_EQ(readFile(page()), "earlier");
}

TEST_F(Report, SaysWhereItCannotWrite) {
  results(toJsonLine(record("a")) + "\n");
  const Outcome outcome = report({"--out", "/proc/none/report.html"});
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_NE(outcome.all().find("/proc/none"), std::string::npos) << outcome.all();
}

TEST_F(Report, ABrokenPictureCostsItselfOnly) {
  results(toJsonLine(record("a")) + "\n");
  folder_.write("out/images/a.exr", "no picture");
  const Outcome outcome = report();
  ASSERT_EQ(outcome.exitCode, 0) << outcome.all();
  EXPECT_NE(outcome.all().find("a.exr"), std::string::npos) << outcome.all();
  EXPECT_TRUE(dataOf(page())["pictures"].empty());
}

TEST_F(Report, OfThreeHundredJobsIsSmallWithoutPictures) {
  JobRecord large = record("job");
  large.plan.assign(12, {"varying_penumbra", true, "a reason of an ordinary sentence's length, with its number in it", 1.0});
  large.work.passes.emplace(6, PassWork{"a pass of some name", 1, 2, 3, 4, 5, 6});
  std::string lines;
  for (int i = 0; i < 300; ++i) {
    large.job = "job-" + std::to_string(i);
    lines += toJsonLine(large) + "\n";
  }
  results(lines);
  ASSERT_EQ(report({"--no-images"}).exitCode, 0);
  EXPECT_LT(std::filesystem::file_size(page()), 10U << 20U);
  EXPECT_EQ(dataOf(page())["records"].size(), 300U);
}

TEST_F(Report, PicturesOfABatchLieInIt) {
  folder_.write("run.json", smallConfig(R"({"output": {"images": []}})"));
  const Outcome batch = gnomonProgram({"batch", (folder_ / "run.json").string(), "--out", (folder_ / "out").string()});
  ASSERT_EQ(batch.exitCode, 0) << batch.all();
  ASSERT_EQ(report().exitCode, 0);
  const json data = dataOf(page());
  const json& pictures = data["pictures"][data["records"][0]["job"].get<std::string>()];
  EXPECT_EQ(pictures["width"], 64);
  EXPECT_TRUE(data["references"].contains(pictures["reference"].get<std::string>()));
  EXPECT_FALSE(pictures["error"].get<std::string>().empty());
  EXPECT_FALSE(pictures["work"].get<std::string>().empty());
}

TEST(Base64, IsThatOfTheStandard) {  // RFC 4648, section 10
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

}  // namespace
}  // namespace gnomon::test
