// plan, render, batch.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <set>

#include "commands.h"
#include "gnomon/base/clock.h"
#include "gnomon/base/files.h"
#include "gnomon/base/json.h"
#include "gnomon/base/log.h"
#include "gnomon/gl/context.h"
#include "gnomon/run/batch.h"
#include "gnomon/run/repeats.h"
#include "gnomon/run/summary.h"
#include "tools.h"

namespace gnomon {

namespace {

/// Progress with rate and time left on a terminal, plain lines otherwise.
class ProgressLine {
 public:
  void operator()(std::size_t done, std::size_t total, const std::string& what, const JobRecord* record) {
    const double elapsed = (wallMs() - start_) / 1000.0;
    if (terminal_) {
      const std::string left = done > 0
                                   ? fmt::format(", {:.1f} jobs/min, {:.0f} s left", 60.0 * static_cast<double>(done) / elapsed,
                                                 elapsed / static_cast<double>(done) * static_cast<double>(total - done))
                                   : "";
      fmt::print(stderr, "\r\033[K[{}/{}{}] {}", done, total, left, what);
      if (record != nullptr && !record->reason.empty())
        fmt::print(stderr, "\r\033[K{} {}: {}\n", what, jobStatusName(record->status), oneLine(record->reason));
      if (done == total && record != nullptr) fmt::print(stderr, "\r\033[K");
    } else if (record != nullptr) {
      fmt::print(stderr, "[{}/{}, {:.0f} s] {}: {}{}\n", done, total, elapsed, what, jobStatusName(record->status),
                 record->reason.empty() ? "" : ", " + oneLine(record->reason));
    }
    std::fflush(stderr);
  }

 private:
  bool terminal_ = isatty(STDERR_FILENO) != 0;
  double start_ = wallMs();
};

void printLightsPictures(const std::vector<LightsPictureRecord>& pictures) {
  for (const LightsPictureRecord& picture : pictures) {
    if (picture.path.empty()) {
      fmt::print("{}, all lights: no picture: {}\n", picture.what, fmt::join(picture.notes, "; "));
    } else {
      fmt::print("{}, all lights: {}{}{}\n", picture.what, picture.path.filename().string(),
                 picture.notes.empty() ? "" : ", without ", fmt::join(picture.notes, "; "));
    }
  }
}

void readShard(const std::string& text, BatchOptions& options) {
  if (text.empty()) return;
  int i = 0;
  int n = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%d/%d%c", &i, &n, &rest) != 2 || n < 1 || i < 0 || i >= n) {
    throw InputError({{"", "", fmt::format("--shard {}: expected i/n with 0 <= i < n, such as 0/4", text)}});
  }
  options.shard = i;
  options.shards = n;
}

}  // namespace

int planCommand(const CommonOptions& common, const std::filesystem::path& config) {
  Registry registry(techniqueDirectories(common));
  Problems problems;
  const RunConfig read = readRunConfig(config, problems);
  problems.throwIfAny();
  Json all = Json::array();
  for (const SceneChoice& choice : read.scenes) {
    const Scene scene = loadScene(choice, {config.string(), "/scene"});
    const std::string name = choice.builtin.empty() ? choice.file.filename().string() : choice.builtin;
    const std::vector<Light> lights = read.lights.value_or(scene.lights);
    const Camera camera = read.camera.value_or(scene.camera.value_or(Camera{}));
    if (lights.empty()) throw InputError({{config.string(), "/lights", "neither the config nor " + name + " has a light"}});
    for (std::size_t i = 0; i < lights.size(); ++i) {
      const SceneSurvey facts = survey(scene, lights[i], camera, read.output.size);
      const EffectPlan plan = planEffects(facts, lights[i], camera, read.plan);
      if (common.json) {
        Json decisions = Json::array();
        for (const PlanDecision& d : plan.decisions) decisions.push_back(writeObject(*planDecisionTable(), &d));
        all.push_back({{"scene", name}, {"light", i}, {"plan", decisions}});
      } else {
        fmt::print("{}, light {}: {} triangles, {} cast, {} receive\n", name, i, facts.triangles, facts.casterTriangles,
                   facts.receiverTriangles);
        for (const PlanDecision& d : plan.decisions) fmt::print("  {:<21} {:<4} {}\n", d.name, d.on ? "on" : "off", d.reason);
      }
    }
  }
  if (common.json) fmt::print("{}\n", all.dump(2));
  return 0;
}

int renderCommand(const CommonOptions& common, const RenderOptions& options) {
  Registry registry(techniqueDirectories(common));
  BatchOptions how{.out = options.out,
                   .resume = options.resume,
                   .measureTime = options.measureTime,
                   .timesOnly = options.timesOnly,
                   .timer = clockFromName(options.timer),
                   .exr = options.exr,
                   .checkFinite = options.checkFinite};
  readShard(options.shard, how);
  how.referenceCache = options.noCache         ? std::filesystem::path()
                       : options.cache.empty() ? cacheDirectory() / "references"
                                               : options.cache;

  Problems problems;
  std::vector<ResolvedRun> runs;
  for (const auto& config : options.configs) {
    for (ResolvedRun& run : resolveRuns(config, registry, problems)) runs.push_back(std::move(run));
  }
  for (ResolvedRun& run : runs) {
    for (const std::string& name : options.without) {
      reportIfUndeclared(name, entriesOf(run), {"--without", ""}, problems);
      run.config.plan.without.push_back(name);
    }
  }
  problems.unique().throwIfAny();
  for (const ResolvedRun& run : runs) {
    for (const std::string& warning : run.scene.warnings) log::warning(run.sceneName + ": " + warning);
  }

  const gl::HeadlessContext context({common.gpu, common.debug});
  log::info("renderer: " + gl::currentContextInfo().renderer);
  BatchSummary summary = runBatch(runs, registry, how, ProgressLine{});
  if (needsRepeats(summary, options.repeat)) mergeRepeats(summary, runRepeats(common, options, *summary.clock));
  fmt::print("{}\n", summaryTable(summary.records));
  if (summary.kept > 0) fmt::print("{} of {} results were there already\n", summary.kept, summary.records.size());
  printLightsPictures(summary.lightsPictures);
  fmt::print("images   {}\nresults  {}\n", (options.out / "images").string(), summary.results.string());
  if (!summary.trace.empty()) fmt::print("trace    {}\n", summary.trace.string());
  if (summary.notOk > 0)
    fmt::print("{} of {} jobs were refused or failed; their reasons are above\n", summary.notOk, summary.records.size());
  const bool failed = std::any_of(summary.records.begin(), summary.records.end(), [](const JobRecord& r) {
    return r.status == JobStatus::failed || r.status == JobStatus::crashed;
  });
  const bool pictureFailed = std::any_of(summary.lightsPictures.begin(), summary.lightsPictures.end(),
                                         [](const auto& picture) { return picture.failed; });
  return failed || pictureFailed ? 1 : 0;
}

}  // namespace gnomon
