// Batches from end to end: what is recorded, what the exit code says, and what --resume and --shard do.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "gnomon/image/image_io.h"
#include "program.h"

namespace gnomon::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A config and where its results go.
class Batch : public ::testing::Test {
 protected:
  void configure(const std::string& changes) { folder_.write("run.json", smallConfig(changes)); }
  Outcome run(const std::vector<std::string>& more = {}) const { return command("batch", more); }
  Outcome command(const std::string& name, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{name,      (folder_ / "run.json").string(), "--out", out_.string(),
                                       "--cache", (folder_ / "cache").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return gnomonProgram(arguments);
  }
  std::vector<Json> results() const { return records(out_ / "results.jsonl"); }

  TemporaryFolder folder_;
  std::filesystem::path out_ = folder_ / "out";
};

const char* const kThreeJobs =
    R"({"techniques": [{"technique": "unshadowed"}, {"technique": "shadow_map", "sweep": {"map_size": [32, 64]}}]})";

std::set<std::string> jobsOf(const std::vector<Json>& all) {
  std::set<std::string> jobs;
  for (const Json& record : all) jobs.insert(record["job"].get<std::string>());
  return jobs;
}

// --- statuses ---

TEST_F(Batch, AFailedJobIsRecordedAndTheOthersAreAsIfItHadNotBeen) {
  configure(R"({"techniques": [{"technique": "shadow_map", "parameters": {"map_size": 64}}]})");
  ASSERT_EQ(run({"--no-exr"}).exitCode, 0);
  const Json alone = results()[0]["error"];

  configure(
      R"({"techniques": [{"technique": "mischief", "sweep": {"fault": ["throw_in_setup", "throw_in_pass", "gl_error", "refuse"]}},
                               {"technique": "shadow_map", "parameters": {"map_size": 64}}]})");
  const Outcome outcome = run({"--no-exr", "--technique-dir", testPluginFolder("mischief")});
  EXPECT_EQ(outcome.exitCode, 1) << outcome.all();
  const std::vector<Json> all = results();
  ASSERT_EQ(all.size(), 5U);
  EXPECT_EQ(all[0]["status"], "failed");
  EXPECT_THAT(all[0]["reason"].get<std::string>(), AllOf(HasSubstr("'mischief'"), HasSubstr("thrown in setup")));
  EXPECT_EQ(all[1]["status"], "failed");
  EXPECT_THAT(all[1]["reason"].get<std::string>(), AllOf(HasSubstr("pass 'work'"), HasSubstr("thrown in the pass")));
  EXPECT_EQ(all[2]["status"], "failed");
  EXPECT_THAT(all[2]["reason"].get<std::string>(), AllOf(HasSubstr("pass 'work'"), HasSubstr("OpenGL")));
  EXPECT_EQ(all[3]["status"], "refused");
  EXPECT_EQ(all[3]["reason"], "it was asked to refuse");
  EXPECT_EQ(all[4]["status"], "ok");
  EXPECT_EQ(all[4]["error"], alone);
  EXPECT_TRUE(all[0]["error"].is_null());
  EXPECT_TRUE(all[0]["time"].is_null());
}

TEST_F(Batch, ARefusalIsNoFailure) {
  configure(R"({"techniques": [{"technique": "mischief", "parameters": {"fault": "refuse"}}]})");
  EXPECT_EQ(run({"--technique-dir", testPluginFolder("mischief")}).exitCode, 0);
  EXPECT_EQ(results().at(0)["status"], "refused");
}

// --- records ---

/// Every key of the format as JSON pointers; whether its value may be null is not said here.
const std::vector<const char*> kKeys{"/job",
                                     "/config",
                                     "/scene",
                                     "/light",
                                     "/technique",
                                     "/parameters",
                                     "/status",
                                     "/reason",
                                     "/error/mse",
                                     "/error/rmse",
                                     "/error/rmse_se",
                                     "/error/rmse_band",
                                     "/error/mae",
                                     "/error/bias",
                                     "/error/p99",
                                     "/error/max",
                                     "/error/over_0_1",
                                     "/error/non_finite",
                                     "/error/noise_floor",
                                     "/error/classes/lit/share",
                                     "/error/classes/lit/rmse",
                                     "/error/classes/umbra/share",
                                     "/error/classes/umbra/rmse",
                                     "/error/classes/penumbra/share",
                                     "/error/classes/penumbra/rmse",
                                     "/error/classes/band/share",
                                     "/error/classes/band/rmse",
                                     "/error/classes/terminator/share",
                                     "/error/classes/terminator/rmse",
                                     "/time/timer",
                                     "/time/regimes/dynamic/median_ms",
                                     "/time/regimes/dynamic/wall_median_ms",
                                     "/time/regimes/dynamic/mad_ms",
                                     "/time/regimes/dynamic/ci95_ms",
                                     "/time/regimes/dynamic/p95_ms",
                                     "/time/regimes/dynamic/n",
                                     "/time/regimes/dynamic/ratio",
                                     "/time/regimes/dynamic/ratio_ci95",
                                     "/time/regimes/static/ratio",
                                     "/time/passes/0/name",
                                     "/time/passes/0/ms",
                                     "/work/passes_run",
                                     "/work/passes_skipped",
                                     "/work/draws",
                                     "/work/primitives",
                                     "/work/fragments",
                                     "/work/texel_reads",
                                     "/work/texels_written",
                                     "/work/rays",
                                     "/memory_bytes",
                                     "/plan/0/effect",
                                     "/plan/0/on",
                                     "/plan/0/reason",
                                     "/plan/0/value",
                                     "/machine/renderer",
                                     "/machine/cpu"};

TEST_F(Batch, ARecordHasEveryKeyOfTheFormat) {
  configure(R"({"measure": {"regimes": ["dynamic", "static"]}})");
  ASSERT_EQ(run({"--no-exr"}).exitCode, 0);
  const Json record = results().at(0);
  for (const char* key : kKeys) EXPECT_TRUE(record.contains(Json::json_pointer(key))) << key;
  EXPECT_EQ(record["config"], "run");
  EXPECT_EQ(record["scene"], "half_plane");
  EXPECT_EQ(record["parameters"]["map_size"], 64);
}

TEST_F(Batch, WhatWasNotMeasuredIsNull) {
  configure(R"({"measure": {"regimes": ["dynamic", "static"]}})");
  ASSERT_EQ(run({"--no-exr"}).exitCode, 0);
  const Json record = results().at(0);
  EXPECT_TRUE(record["reason"].is_null());
  EXPECT_TRUE(record["time"]["regimes"]["static"]["ratio"].is_null()) << "a ratio of two nothings";
  EXPECT_TRUE(record["splits"]["detachment"].is_null()) << "nothing stands on anything";
  EXPECT_TRUE(record["work"]["passes"][0]["texel_reads"].is_null()) << "a pass on the CPU";
}

TEST_F(Batch, RenderMeasuresNoTime) {
  configure("{}");
  ASSERT_EQ(command("render").exitCode, 0);
  EXPECT_TRUE(results().at(0)["time"].is_null());
  EXPECT_TRUE(results().at(0)["error"]["mse"].is_number());
}

// --- pictures ---

TEST_F(Batch, WritesThePicturesThatWereAskedFor) {
  configure(R"({"output": {"images": ["shaded", "visibility", "error", "class", "reference"]}})");
  ASSERT_EQ(run().exitCode, 0);
  const std::string job = results().at(0)["job"];
  EXPECT_THAT(namesIn(out_ / "images"), ElementsAre(job + ".exr", job + "_class.png", job + "_error.png",
                                                    job + "_reference.png", job + "_shaded.png", job + "_visibility.png"));
}

TEST_F(Batch, ExrHoldsTheChannelsOfTheFormat) {
  configure("{}");
  ASSERT_EQ(run().exitCode, 0);
  const ExrPicture picture = readExr(out_ / "images" / (results().at(0)["job"].get<std::string>() + ".exr"));
  for (const char* name : {"visibility", "reference_a", "reference_b", "error", "class", "position.x", "position.y",
                           "position.z", "normal.x", "normal.y", "normal.z"}) {
    ASSERT_TRUE(picture.has(name)) << name;
    EXPECT_EQ(picture.channel(name).width, 64) << name;
    EXPECT_EQ(picture.channel(name).height, 48) << name;
  }
  const Image& v = picture.channel("visibility");
  for (std::size_t i = 0; i < v.data.size(); ++i) {
    const float reference = 0.5f * (picture.channel("reference_a").data[i] + picture.channel("reference_b").data[i]);
    ASSERT_EQ(picture.channel("error").data[i], v.data[i] - reference) << i;
  }
  EXPECT_EQ(Json::parse(picture.metadataValue("gnomon.light"))["type"], "spot");
  EXPECT_TRUE(Json::parse(picture.metadataValue("gnomon.camera")).contains("position"));
}

TEST_F(Batch, ErrorInTheRecordIsThatOfThePicture) {  // both say the same of one technique, from two ends
  configure("{}");
  ASSERT_EQ(run().exitCode, 0);
  const Json record = results().at(0);
  const ExrPicture picture = readExr(out_ / "images" / (record["job"].get<std::string>() + ".exr"));
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < picture.channel("class").data.size(); ++i) {
    if (picture.channel("class").data[i] == 0.0f) continue;  // outside the receiver mask
    const double v = static_cast<double>(picture.channel("visibility").data[i]);
    sum += (v - static_cast<double>(picture.channel("reference_a").data[i])) *
           (v - static_cast<double>(picture.channel("reference_b").data[i]));
    count += 1.0;
  }
  ASSERT_GT(count, 0.0);
  EXPECT_NEAR(record["error"]["mse"].get<double>(), sum / count, 1e-12)
      << "two orders of summing at most 3072 values in double";
}

// --- resume ---

TEST_F(Batch, ResumeRunsOnlyWhatIsMissing) {
  configure(kThreeJobs);
  ASSERT_EQ(run({"--no-exr"}).exitCode, 0);
  const std::string whole = readFile(out_ / "results.jsonl");
  const std::size_t first = whole.find('\n') + 1;
  const std::size_t second = whole.find('\n', first) + 1;
  // The second record is lost; a crash tore the third.
  folder_.write("out/results.jsonl", whole.substr(0, first) + whole.substr(second, (whole.size() - second) / 2));
  std::map<std::string, std::string> pictures;
  for (const std::string& name : namesIn(out_ / "images")) pictures[name] = identity(out_ / "images" / name);

  const Outcome outcome = run({"--no-exr", "--resume"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.all();
  EXPECT_THAT(outcome.out, HasSubstr("1 of 3 results were there already"));
  const std::string resumed = readFile(out_ / "results.jsonl");
  EXPECT_EQ(resumed.substr(0, first), whole.substr(0, first));
  const std::vector<Json> all = results();  // throws on a torn line that was left
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(jobsOf(all).size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string picture = all[i]["job"].get<std::string>() + "_visibility.png";
    EXPECT_EQ(identity(out_ / "images" / picture) == pictures.at(picture), i == 0)
        << "job " << i << " was " << (i == 0 ? "" : "not ") << "run again";
  }
}

TEST_F(Batch, ResumeOfAWholeBatchDoesNothing) {
  configure(kThreeJobs);
  ASSERT_EQ(run({"--no-exr"}).exitCode, 0);
  const std::string whole = readFile(out_ / "results.jsonl");
  std::filesystem::remove_all(folder_ / "cache");
  EXPECT_EQ(run({"--no-exr", "--resume"}).exitCode, 0);
  EXPECT_EQ(readFile(out_ / "results.jsonl"), whole);
  EXPECT_THAT(namesIn(folder_ / "cache"), IsEmpty()) << "no reference is needed";
}

TEST_F(Batch, ResumeRunsAJobAgainWhosePictureIsMissing) {
  configure(kThreeJobs);
  ASSERT_EQ(run().exitCode, 0);
  const std::vector<Json> first = results();
  std::filesystem::remove(out_ / "images" / (first[0]["job"].get<std::string>() + "_visibility.png"));
  std::filesystem::remove(out_ / "images" / (first[2]["job"].get<std::string>() + ".exr"));
  const Outcome outcome = run({"--resume"});
  EXPECT_THAT(outcome.out, HasSubstr("1 of 3 results were there already")) << outcome.all();
  EXPECT_TRUE(std::filesystem::exists(out_ / "images" / (first[0]["job"].get<std::string>() + "_visibility.png")));
  EXPECT_TRUE(std::filesystem::exists(out_ / "images" / (first[2]["job"].get<std::string>() + ".exr")));
}

TEST_F(Batch, ResumeWithoutExrDoesNotMissThem) {
  configure(kThreeJobs);
  ASSERT_EQ(run({"--no-exr"}).exitCode, 0);
  EXPECT_THAT(run({"--no-exr", "--resume"}).out, HasSubstr("3 of 3 results were there already"));
}

TEST_F(Batch, ResumeRunsAFailedJobAgain) {
  configure(R"({"techniques": [{"technique": "mischief", "parameters": {"fault": "throw_in_setup"}}]})");
  const std::vector<std::string> options{"--no-exr", "--resume", "--technique-dir", testPluginFolder("mischief")};
  ASSERT_EQ(run(options).exitCode, 1);
  EXPECT_EQ(run(options).exitCode, 1);
  EXPECT_EQ(results().size(), 2U);
}

TEST_F(Batch, WithoutResumeResultsStartAnew) {
  configure(kThreeJobs);
  ASSERT_EQ(run({"--no-exr"}).exitCode, 0);
  configure("{}");
  ASSERT_EQ(run({"--no-exr"}).exitCode, 0);
  EXPECT_EQ(results().size(), 1U);
}

TEST_F(Batch, ResumeKnowsThatARenderedJobWasNotTimed) {
  configure("{}");
  ASSERT_EQ(command("render", {"--no-exr"}).exitCode, 0);
  ASSERT_EQ(run({"--no-exr", "--resume"}).exitCode, 0);
  EXPECT_TRUE(results().back()["time"].is_object());
}

/// What decides a result is in its job's key: a config that asks for something else is not served with the old result.
class ChangedConfig : public Batch, public ::testing::WithParamInterface<std::pair<const char*, const char*>> {};

TEST_P(ChangedConfig, IsAnotherJob) {
  configure("{}");
  ASSERT_EQ(run({"--no-exr"}).exitCode, 0);
  configure(GetParam().second);
  ASSERT_EQ(run({"--no-exr", "--resume"}).exitCode, 0);
  EXPECT_EQ(jobsOf(results()).size(), 2U);
}

INSTANTIATE_TEST_SUITE_P(
    Input, ChangedConfig,
    ::testing::Values(
        std::pair{"Scene", R"({"scene": {"blocker_height": 1.5}})"}, std::pair{"Size", R"({"output": {"size": [48, 64]}})"},
        std::pair{"Camera", R"({"camera": {"position": [0, 6, 9], "target": [0, 0, 0], "vertical_fov_degrees": 40}})"},
        std::pair{
            "Light",
            R"({"lights": [{"type": "spot", "position": [0, 6, 1], "target": [0, 0, 0], "cone_half_angle_degrees": 40}]})"},
        std::pair{"Parameter", R"({"techniques": [{"technique": "shadow_map", "parameters": {"map_size": 32}}]})"},
        std::pair{"ReferenceSamples", R"({"reference": {"parameters": {"samples": 4}}})"},
        std::pair{"Plan", R"({"plan": {"culling": "off"}})"},
        std::pair{"Baseline", R"({"baseline": {"technique": "shadow_map"}})"},
        std::pair{"Frames", R"({"measure": {"frames": 4}})"}, std::pair{"Blocks", R"({"measure": {"blocks": 2}})"},
        std::pair{"Regimes", R"({"measure": {"regimes": ["static"]}})"}),
    [](const auto& each) { return std::string(each.param.first); });

// --- two at once ---

/// Holds the results as another batch would.
class OtherBatch {
 public:
  explicit OtherBatch(const std::filesystem::path& lock) : file_(::open(lock.c_str(), O_RDWR)) {
    held = file_ >= 0 && ::flock(file_, LOCK_EX | LOCK_NB) == 0;
  }
  ~OtherBatch() { ::close(file_); }
  OtherBatch(const OtherBatch&) = delete;
  OtherBatch& operator=(const OtherBatch&) = delete;
  bool held = false;

 private:
  int file_;
};

TEST_F(Batch, ResultsThatAnotherBatchIsWritingAreLeftAlone) {
  configure("{}");
  ASSERT_EQ(run({"--no-exr"}).exitCode, 0);
  const std::string before = readFile(out_ / "results.jsonl");
  const OtherBatch other(out_ / ".results.jsonl.lock");
  ASSERT_TRUE(other.held);
  for (const std::vector<std::string>& options : {std::vector<std::string>{"--no-exr"}, {"--no-exr", "--resume"}}) {
    const Outcome outcome = run(options);
    EXPECT_EQ(outcome.exitCode, 2);
    EXPECT_THAT(outcome.lines("error"), ElementsAre(AllOf(HasSubstr("results.jsonl: another batch"), HasSubstr("--shard"))));
  }
  EXPECT_EQ(readFile(out_ / "results.jsonl"), before);
}

TEST_F(Batch, AnotherShardMayRunBesideIt) {
  configure(kThreeJobs);
  ASSERT_EQ(run({"--no-exr", "--shard", "0/2"}).exitCode, 0);
  const OtherBatch other(out_ / ".results.0.jsonl.lock");
  ASSERT_TRUE(other.held);
  EXPECT_EQ(run({"--no-exr", "--shard", "1/2"}).exitCode, 0);
}

// --- shards ---

TEST_F(Batch, ShardsTogetherMakeAllJobsOnce) {
  configure(kThreeJobs);
  ASSERT_EQ(run({"--no-exr"}).exitCode, 0);
  const std::set<std::string> whole = jobsOf(results());
  out_ = folder_ / "sharded";
  ASSERT_EQ(run({"--no-exr", "--shard", "0/2"}).exitCode, 0);
  ASSERT_EQ(run({"--no-exr", "--shard", "1/2"}).exitCode, 0);
  ASSERT_THAT(namesIn(out_, ".jsonl"), ElementsAre("results.0.jsonl", "results.1.jsonl"));
  const std::vector<Json> zero = records(out_ / "results.0.jsonl");
  const std::vector<Json> one = records(out_ / "results.1.jsonl");
  EXPECT_EQ(zero.size() + one.size(), whole.size());
  std::set<std::string> together = jobsOf(zero);
  together.merge(jobsOf(one));
  EXPECT_EQ(together, whole);
}

}  // namespace
}  // namespace gnomon::test
