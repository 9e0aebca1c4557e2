// The reference cache from end to end: it is used, it is not used for anything else, and it is not trusted.
#include "gnomon/measure/reference_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "program.h"

namespace gnomon::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class CachedReference : public ::testing::Test {
 protected:
  /// Renders; returns the error figures of the only job.
  Json render(const std::string& changes = "{}", const std::vector<std::string>& more = {}) {
    const std::string config = folder_.write("run.json", smallConfig(changes)).string();
    std::vector<std::string> arguments{"render",  config,         "--no-exr", "--out", (folder_ / "out").string(),
                                       "--cache", cache_.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    outcome_ = gnomonProgram(arguments);
    EXPECT_EQ(outcome_.exitCode, 0) << outcome_.all();
    return records(folder_ / "out/results.jsonl").at(0)["error"];
  }
  std::vector<std::string> files() const { return namesIn(cache_); }
  std::filesystem::path onlyFile() const { return cache_ / files().at(0); }

  TemporaryFolder folder_;
  std::filesystem::path cache_ = folder_ / "cache";
  Outcome outcome_;
};

/// The key in a cached file: it stands behind 8 bytes of magic and a version, with its length before it.
std::string keyIn(const std::string& bytes) {
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, sizeof length);
  return bytes.substr(16, length);
}

TEST_F(CachedReference, ALightsNameDoesNotMatter) {
  const auto named = [](const std::string& name) {
    return R"({"lights": [{"type": "spot", "position": [1, 6, 2], "target": [0, 0, 0], "cone_half_angle_degrees": 40, "name": ")" +
           name + "\"}]}";
  };
  render(named("sun"));
  const Json before = records(folder_ / "out/results.jsonl").at(0)["job"];
  render(named("lamp"));
  EXPECT_EQ(files().size(), 1U);
  EXPECT_EQ(records(folder_ / "out/results.jsonl").at(0)["job"], before);
}

TEST_F(CachedReference, TheSecondRunReadsIt) {
  render();
  ASSERT_EQ(files().size(), 1U);
  // A reference that no tracer would render: if the figures follow it, the file was read and nothing was traced.
  const std::string key = keyIn(readFile(onlyFile()));
  KeptReference kept = loadReference(cache_, key).value();
  std::fill(kept.halves.a.data.begin(), kept.halves.a.data.end(), 0.5f);
  std::fill(kept.halves.b.data.begin(), kept.halves.b.data.end(), 0.5f);
  storeReference(cache_, key, kept);
  const Json figures = render();
  EXPECT_EQ(figures["classes"]["penumbra"]["share"], 1.0);
}

TEST_F(CachedReference, TheSecondRunLeavesItAndItsFiguresAsTheyWere) {
  const Json first = render();
  const std::string before = identity(onlyFile());
  EXPECT_EQ(render(), first);
  EXPECT_EQ(identity(onlyFile()), before);
}

TEST_F(CachedReference, AFlippedByteIsNoticedAndTheReferenceMadeAgain) {
  const Json first = render();
  const std::string whole = readFile(onlyFile());
  std::string damaged = whole;
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 1);
  folder_.write("cache/" + files()[0], damaged);
  EXPECT_EQ(render(), first);
  EXPECT_THAT(outcome_.lines("warning"), ElementsAre(AllOf(HasSubstr(onlyFile().string()), HasSubstr("is made again"))));
  EXPECT_EQ(readFile(onlyFile()), whole);
}

TEST_F(CachedReference, IsNeitherReadNorWrittenWhereItIsNotWanted) {
  const Json first = render();
  folder_.write("cache/" + files()[0], "damaged");
  EXPECT_EQ(render("{}", {"--no-cache"}), first);
  EXPECT_THAT(outcome_.lines("warning"), IsEmpty());
  EXPECT_EQ(readFile(onlyFile()), "damaged");
}

TEST_F(CachedReference, OtherTechniquesShareIt) {
  render();
  const std::string before = identity(onlyFile());
  render(R"({"techniques": [{"technique": "pcf", "parameters": {"map_size": 64}}], "name": "other"})");
  EXPECT_EQ(files().size(), 1U);
  EXPECT_EQ(identity(onlyFile()), before);
}

/// A millimetre, so that nothing but the light's place differs: the plan and the picture's size stay.
TEST_F(CachedReference, AMovedLightHasAnother) {
  for (const char* height : {"4", "4.001"}) {
    render(R"({"lights": [{"type": "spot", "position": [0, )" + std::string(height) + R"(, 0], "target": [0, 0, 0],
               "cone_half_angle_degrees": 90, "source": {"shape": "rectangle", "size": [1, 1]}}]})");
  }
  EXPECT_EQ(files().size(), 2U);
}

class OtherReference : public CachedReference, public ::testing::WithParamInterface<std::pair<const char*, const char*>> {};

TEST_P(OtherReference, IsRenderedAnew) {
  render();
  render(GetParam().second);
  EXPECT_EQ(files().size(), 2U);
}

INSTANTIATE_TEST_SUITE_P(
    Input, OtherReference,
    ::testing::Values(
        std::pair{"SceneKey", R"({"scene": {"blocker_height": 1.5}})"},
        std::pair{"OtherScene", R"({"scene": {"builtin": "square"}})"}, std::pair{"Width", R"({"output": {"size": [48, 48]}})"},
        std::pair{"Height", R"({"output": {"size": [64, 64]}})"},
        std::pair{"Camera", R"({"camera": {"position": [0, 6, 9], "target": [0, 0, 0], "vertical_fov_degrees": 40}})"},
        std::pair{
            "Light",
            R"({"lights": [{"type": "spot", "position": [0, 6, 1], "target": [0, 0, 0], "cone_half_angle_degrees": 40}]})"},
        std::pair{"Samples", R"({"reference": {"parameters": {"samples": 4}}})"},
        std::pair{"Technique", R"({"reference": {"technique": "unshadowed", "parameters": null}})"},
        std::pair{"Plan", R"({"plan": {"penumbra": "off"}})"}),
    [](const auto& each) { return std::string(each.param.first); });

}  // namespace
}  // namespace gnomon::test
