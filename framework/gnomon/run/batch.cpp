#include "gnomon/run/batch.h"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "gnomon/base/files.h"
#include "gnomon/base/log.h"
#include "gnomon/measure/clock_trials.h"
#include "gnomon/run/light_run.h"

namespace gnomon {

namespace {

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

std::string label(const ResolvedRun& run, const ResolvedJob& job) {
  const std::string parameters = job.technique.parametersText();
  return fmt::format("{}: {}{}", run.sceneName, job.technique.name(), parameters.empty() ? "" : " (" + parameters + ")");
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

}  // namespace

BatchSummary runBatch(const std::vector<ResolvedRun>& runs, Registry& registry, const BatchOptions& options,
                      const BatchProgress& progress) {
  BatchSummary summary;
  summary.results = options.out / (options.shards > 1 ? fmt::format("results.{}.jsonl", options.shard) : "results.jsonl");
  const std::map<std::string, JobRecord> earlier =
      options.resume ? earlierResults(options.out) : std::map<std::string, JobRecord>{};
  if (!options.resume) writeFileAtomically(summary.results, "");

  LightRunOptions how{.referenceCache = options.referenceCache,
                      .imageDirectory = options.out / "images",
                      .exr = options.exr,
                      .checkFinite = options.checkFinite};
  if (options.measureTime) {
    const ClockChoice choice = chooseClock(runClockTrials());
    how.clock = choice.clock;
    log::info(fmt::format("clock: {} ({})", clockName(choice.clock), choice.reason));
  }

  std::size_t total = 0;
  for (const ResolvedRun& run : runs) total += run.jobs.size();
  std::size_t index = 0;
  for (const ResolvedRun& run : runs) {
    for (std::size_t light = 0; light < run.lights.size(); ++light) {
      std::unique_ptr<LightRun> lightRun;  // made when the first of its jobs is not there yet
      std::string noReference;             // why it could not be made
      for (const ResolvedJob& job : run.jobs) {
        if (job.light != light) continue;
        const std::size_t mine = index++;
        if (static_cast<int>(mine % static_cast<std::size_t>(options.shards)) != options.shard) continue;
        const std::string name = label(run, job);
        const auto found = earlier.find(jobKey(run, light, job.technique));
        if (found != earlier.end() && found->second.status == JobStatus::ok && (!options.measureTime || found->second.time)) {
          ++summary.kept;
          summary.records.push_back(found->second);
          progress(mine + 1, total, name, &summary.records.back());
          continue;
        }
        if (!lightRun && noReference.empty()) {
          progress(mine, total, fmt::format("{}: reference {}", run.sceneName, run.reference.name()), nullptr);
          try {
            lightRun = std::make_unique<LightRun>(run, light, registry, how);
          } catch (const std::exception& error) {
            noReference = error.what();  // of this light alone: the others go on
          }
        }
        progress(mine, total, name, nullptr);
        JobRecord record = lightRun ? lightRun->run(job.technique) : failedJob(run, light, job.technique, noReference);
        appendLineSynced(summary.results, toJsonLine(record));
        if (record.time) writeFileAtomically(options.out / "timing" / (record.job + ".json"), timingPairsJson(*record.time));
        summary.records.push_back(std::move(record));
        progress(mine + 1, total, name, &summary.records.back());
      }
    }
  }
  for (const JobRecord& record : summary.records) summary.notOk += record.status == JobStatus::ok ? 0 : 1;
  return summary;
}

}  // namespace gnomon
