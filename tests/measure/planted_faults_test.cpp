// Each fault that people see, planted in a copy of a real technique, is worst by the figure that it belongs to.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "gnomon/run/light_run.h"
#include "gnomon/run/resolve.h"
#include "planted.h"
#include "render.h"
#include "temporary_folder.h"

namespace gnomon::test {
namespace {

constexpr const char* kDepthMap = "gnomon/depth_map.glsl";
constexpr const char* kLookup = "r.uv = image * 0.5 + 0.5;";

/// A copy of a technique; without alterations and with its own parameters, the sound one.
struct Copy {
  std::string name;
  std::string parameters = "{}";
  std::vector<Alteration> alterations = {};
};

/// What all copies of a technique are measured on.
class Bench {
 public:
  /// `scene` and `lights` as in a run config; no lights: the scene's own.
  Bench(std::string technique, std::string scene, std::string lights = {})
      : technique_(std::move(technique)), scene_(std::move(scene)), lights_(std::move(lights)) {}

  ErrorSplits measure(const Copy& copy) {
    ensureContext();
    PlantedTechnique planted(technique_, copy.alterations);
    const auto path = folder_ / "run.json";
    folder_.write("run.json",
                  fmt::format(R"({{"scene": {}, {} "output": {{"size": [320, 240], "images": []}},
        "reference": {{"technique": "ray_traced", "parameters": {{"samples": 256}}}},
        "baseline": {{"technique": "planted"}}, "techniques": [{{"technique": "planted", "parameters": {}}}]}})",
                              scene_, lights_.empty() ? "" : fmt::format(R"("lights": {},)", lights_), copy.parameters));
    Problems problems;
    const std::vector<ResolvedRun> runs = resolveRuns(path, planted.registry(), problems);
    problems.throwIfAny();
    LightRun light(runs.at(0), 0, planted.registry(), {.referenceCache = folder_ / "references"});
    const JobRecord record = light.run(runs.at(0).jobs.at(0).technique);
    EXPECT_EQ(record.status, JobStatus::ok) << record.reason;
    return record.splits.value_or(ErrorSplits{});
  }

 private:
  std::string technique_, scene_, lights_;
  TemporaryFolder folder_;
};

using Figure = std::optional<double> ErrorSplits::*;

const std::map<std::string, Figure>& figures() {
  static const std::map<std::string, Figure> all{
      {"acne", &ErrorSplits::acne},         {"leak", &ErrorSplits::leak},     {"detachment", &ErrorSplits::detachment},
      {"penumbra", &ErrorSplits::penumbra}, {"offset", &ErrorSplits::offset}, {"shimmer", &ErrorSplits::shimmer}};
  return all;
}

std::string table(const std::map<std::string, ErrorSplits>& measured) {
  std::string text;
  for (const auto& [name, splits] : measured) {
    text += fmt::format("\n{:20}", name);
    for (const auto& [key, figure] : figures()) text += fmt::format(" {} {:.3g}", key, (splits.*figure).value_or(-1.0));
  }
  return text;
}

/// The copy called `fault` is the worst of all by its figure, and ten times worse than the sound one.
void expectRankedFirst(const std::map<std::string, ErrorSplits>& measured, const std::string& fault, Figure figure) {
  const double own = (measured.at(fault).*figure).value();
  for (const auto& [name, splits] : measured) {
    if (name == fault) continue;
    EXPECT_GT(own, (splits.*figure).value()) << fault << " against " << name << table(measured);
  }
  EXPECT_GE(own, 10.0 * (measured.at("sound").*figure).value()) << fault << table(measured);
}

std::map<std::string, ErrorSplits> measureAll(Bench bench, const std::vector<Copy>& copies) {
  std::map<std::string, ErrorSplits> measured;
  for (const Copy& copy : copies) measured[copy.name] = bench.measure(copy);
  return measured;
}

TEST(PlantedFaults, OfAHardShadowAreRankedFirstByTheirFigures) {
  const std::map<std::string, ErrorSplits> measured = measureAll(
      Bench("shadow_map", R"({"builtin": "pillars"})",
            R"([{"type": "spot", "position": [-6, 9, 2], "target": [0, 0, 0], "cone_half_angle_degrees": 40}])"),
      {{"sound"},
       {"no bias", R"({"bias.constant": 0, "bias.slope": 0})", {{kDepthMap, "r.slopeBias = rounding +", "r.slopeBias ="}}},
       {"huge bias", R"({"bias.slope": 16, "bias.limit": 1000000})"},
       {"shifted", "{}", {{kDepthMap, kLookup, "r.uv = image * 0.5 + 0.5 + mapTexel.xy;"}}}});
  expectRankedFirst(measured, "no bias", &ErrorSplits::acne);
  expectRankedFirst(measured, "huge bias", &ErrorSplits::detachment);
  expectRankedFirst(measured, "shifted", &ErrorSplits::offset);
}

TEST(PlantedFaults, OfASoftShadowAreRankedFirstByTheirFigures) {
  const std::map<std::string, ErrorSplits> measured = measureAll(
      Bench("pcss", R"({"builtin": "layers"})"),
      {{"sound"},
       {"shifted", "{}", {{kDepthMap, kLookup, "r.uv = image * 0.5 + 0.5 + mapTexel.xy;"}}},
       {"too wide", "{}", {{"pcss.frag", "return 0.5 * mapSource.xy", "return 1.3 * 0.5 * mapSource.xy"}}},
       {"jitter",  // by where light and camera are: another in every frame
        "{}",
        {{kDepthMap, kLookup,
          "r.uv = image * 0.5 + 0.5 + mapTexel.xy * 8.0 * (fract(1e4 * vec2(mapRowX.x + mapRowX.w, mapRowY.y + mapRowY.w)) - "
          "0.5);"}}}});
  expectRankedFirst(measured, "too wide", &ErrorSplits::penumbra);
  expectRankedFirst(measured, "jitter", &ErrorSplits::shimmer);
}

}  // namespace
}  // namespace gnomon::test
