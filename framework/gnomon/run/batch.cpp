#include "gnomon/run/batch.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "gnomon/base/files.h"
#include "gnomon/base/log.h"
#include "gnomon/measure/clock_trials.h"
#include "gnomon/run/light_run.h"
#include "gnomon/run/lights_picture.h"
#include "gnomon/run/pictures.h"
#include "gnomon/run/trace.h"

namespace gnomon {

namespace {

/// Holds results.jsonl for this process while it lives, by a lock on a file beside it: the results file itself is locked by
/// each append, and replaced at the start. The lock ends with the process, however that ends; its file stays.
class ResultsLock {
 public:
  explicit ResultsLock(const std::filesystem::path& results) {
    std::filesystem::path path = results;
    path.replace_filename("." + results.filename().string() + ".lock");
    std::error_code code;
    std::filesystem::create_directories(path.parent_path(), code);
    if (code) throw Error(fmt::format("{}: cannot create the folder: {}", path.parent_path().string(), code.message()));
    file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0) throw Error(fmt::format("{}: cannot open: {}", path.string(), std::strerror(errno)));
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
      const std::string holder = contents();
      ::close(file_);
      throw Error(
          fmt::format("{}: another batch{} is writing it; wait for its end, give another --out, or share the jobs of "
                      "one batch between processes with --shard",
                      results.string(), holder.empty() ? "" : " (process " + holder + ")"));
    }
    const std::string self = std::to_string(::getpid());
    if (::ftruncate(file_, 0) != 0 || ::pwrite(file_, self.data(), self.size(), 0) < 0) {
      log::warning(fmt::format("{}: cannot write: {}", path.string(), std::strerror(errno)));  // it only names the holder
    }
  }
  ~ResultsLock() { ::close(file_); }
  ResultsLock(const ResultsLock&) = delete;
  ResultsLock& operator=(const ResultsLock&) = delete;

 private:
  std::string contents() const {
    std::array<char, 24> text{};
    const ssize_t got = ::pread(file_, text.data(), text.size(), 0);
    return {text.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0))};
  }

  int file_ = -1;
};

std::map<std::string, JobRecord> earlierResults(const std::filesystem::path& directory) {
  std::map<std::string, JobRecord> byJob;
  std::error_code ignored;
  if (!std::filesystem::is_directory(directory, ignored)) return byJob;
  for (JobRecord& record : readResults(directory)) {
    const std::string key = record.job;
    byJob.insert_or_assign(key, std::move(record));
  }
  return byJob;
}

/// Whether a job's earlier record holds all that this batch would make again, and its pictures are there.
bool isWhole(const JobRecord& record, const ResolvedRun& run, const BatchOptions& options) {
  if (record.status != JobStatus::ok || (options.measureTime && !record.time)) return false;
  if (options.timesOnly) return true;
  const auto paths = picturePaths(options.out / "images", record.job, run.config.output.images, options.exr);
  return std::all_of(paths.begin(), paths.end(), [](const auto& path) { return fileStamp(path).has_value(); });
}

std::string label(const ResolvedRun& run, const ResolvedTechnique& technique) {
  const std::string parameters = technique.parametersText();
  return fmt::format("{}: {}{}", run.sceneName, technique.name(), parameters.empty() ? "" : " (" + parameters + ")");
}

JobRecord failedJob(const ResolvedRun& run, std::size_t light, const ResolvedTechnique& technique, const std::string& reason) {
  JobRecord record;
  record.job = jobKey(run, light, technique);
  record.config = run.config.name;
  record.scene = run.sceneName;
  record.light = static_cast<int>(light);
  record.technique = technique.name();
  record.parametersJson = technique.parametersJson().dump();
  record.status = JobStatus::failed;
  record.reason = reason;
  return record;
}

/// Draws them in one session that is made for the first of them.
class LightsPictures {
 public:
  LightsPictures(const ResolvedRun& run, const BatchOptions& options, Trace& trace)
      : run_(run), options_(options), trace_(trace) {}

  std::filesystem::path pathOf(const ResolvedTechnique& technique) const {
    return lightsPicturePath(options_.out / "images", run_, technique);
  }

  LightsPictureRecord make(const ResolvedTechnique& technique) {
    LightsPictureRecord record{label(run_, technique), pathOf(technique), {}, false};
    const TraceSlice slice(&trace_, record.what + ", all lights", {{"config", run_.config.name}});
    try {
      if (!lights_) lights_ = std::make_unique<LightsPicture>(run_);
      record.notes = lights_->write(record.path, technique, {.checkFinite = options_.checkFinite});
      if (record.notes.size() == run_.lights.size()) record.path.clear();
    } catch (const std::exception& error) {  // the records hold: only the picture is missing
      record.path.clear();
      record.notes = {error.what()};
      record.failed = true;
    }
    return record;
  }

 private:
  const ResolvedRun& run_;
  const BatchOptions& options_;
  Trace& trace_;
  std::unique_ptr<LightsPicture> lights_;
};

}  // namespace

BatchSummary runBatch(const std::vector<ResolvedRun>& runs, Registry& registry, const BatchOptions& options,
                      const BatchProgress& progress) {
  BatchSummary summary;
  const std::string shard = options.shards > 1 ? fmt::format(".{}", options.shard) : "";
  summary.results = options.out / fmt::format("results{}.jsonl", shard);
  const ResultsLock lock(summary.results);
  Trace trace(fmt::format("gnomon batch{}", shard));
  if (options.measureTime) {
    const TraceSlice slice(&trace, "clock trials");
    const std::vector<ClockTrial> trials = runClockTrials();
    const ClockChoice choice = options.timer ? provenClock(trials, *options.timer) : chooseClock(trials);
    summary.clock = choice.clock;
    log::info(fmt::format("clock: {} ({})", clockName(choice.clock), choice.reason));
  }
  const std::map<std::string, JobRecord> earlier =
      options.resume ? earlierResults(options.out) : std::map<std::string, JobRecord>{};
  if (!options.resume) writeFileAtomically(summary.results, "");

  const LightRunOptions how{.referenceCache = options.referenceCache,
                            .clock = summary.clock,
                            .timesOnly = options.timesOnly,
                            .imageDirectory = options.out / "images",
                            .exr = options.exr,
                            .checkFinite = options.checkFinite,
                            .trace = &trace};

  std::size_t total = 0;
  for (const ResolvedRun& run : runs) total += run.jobs.size();
  const auto isMine = [&](std::size_t number) {
    return static_cast<int>(number % static_cast<std::size_t>(options.shards)) == options.shard;
  };
  std::size_t index = 0;
  std::size_t pictures = 0;
  bool ran = false;
  for (const ResolvedRun& run : runs) {
    for (std::size_t light = 0; light < run.lights.size(); ++light) {
      std::unique_ptr<LightRun> lightRun;  // made when the first of its jobs is not there yet
      std::string noReference;             // why it could not be made
      for (const ResolvedJob& job : run.jobs) {
        if (job.light != light) continue;
        const std::size_t mine = index++;
        if (!isMine(mine)) continue;
        const std::string name = label(run, job.technique);
        const auto found = earlier.find(jobKey(run, light, job.technique));
        if (found != earlier.end() && isWhole(found->second, run, options)) {
          ++summary.kept;
          summary.records.push_back(found->second);
          progress(mine + 1, total, name, &summary.records.back());
          continue;
        }
        ran = true;
        TraceSlice slice(&trace, name, {{"config", run.config.name}, {"light", std::to_string(light)}});
        if (!lightRun && noReference.empty()) {
          progress(mine, total, fmt::format("{}: reference {}", run.sceneName, run.reference.name()), nullptr);
          const TraceSlice making(&trace, "light");
          try {
            lightRun = std::make_unique<LightRun>(run, light, registry, how);
          } catch (const std::exception& error) {
            noReference = error.what();  // of this light alone: the others go on
          }
        }
        progress(mine, total, name, nullptr);
        JobRecord record = lightRun ? lightRun->run(job.technique) : failedJob(run, light, job.technique, noReference);
        slice.note("job", record.job);
        slice.note("status", jobStatusName(record.status));
        const TraceSlice writing(&trace, "record");
        appendLineSynced(summary.results, toJsonLine(record));
        if (record.time) writeFileAtomically(options.out / "timing" / (record.job + ".json"), timingPairsJson(*record.time));
        summary.records.push_back(std::move(record));
        progress(mine + 1, total, name, &summary.records.back());
      }
    }
    if (options.timesOnly) continue;
    LightsPictures ofAllLights(run, options, trace);
    for (const ResolvedTechnique& technique : lightsPictureTechniques(run)) {
      if (!isMine(pictures++)) continue;
      const std::filesystem::path path = ofAllLights.pathOf(technique);
      if (options.resume && fileStamp(path)) {
        summary.lightsPictures.push_back({label(run, technique), path, {}, false});
        continue;
      }
      ran = true;
      progress(index, total, fmt::format("all lights: {}", path.filename().string()), nullptr);
      summary.lightsPictures.push_back(ofAllLights.make(technique));
    }
  }
  if (ran) {
    summary.trace = options.out / fmt::format("trace{}.json", shard);
    trace.write(summary.trace);
  }
  for (const JobRecord& record : summary.records) summary.notOk += record.status == JobStatus::ok ? 0 : 1;
  return summary;
}

}  // namespace gnomon
