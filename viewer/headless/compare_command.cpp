// compare: two result folders, before and after a change.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.h"
#include "gnomon/base/error.h"
#include "gnomon/base/json.h"
#include "gnomon/base/log.h"
#include "gnomon/measure/compare.h"
#include "gnomon/run/summary.h"

namespace gnomon {

namespace {

namespace fs = std::filesystem;

std::vector<JobRecord> resultsIn(const fs::path& path) {
  if (!fs::exists(path)) {
    throw InputError(
        {{path.string(), "", "is not there; name a folder that `gnomon batch --out` wrote, or its results.jsonl"}});
  }
  std::vector<JobRecord> records = readResults(path);
  if (records.empty())
    throw InputError({{path.string(), "", "holds no results; name a folder that `gnomon batch --out` wrote"}});
  return records;
}

std::string nameOf(const JobRecord& record) {
  return fmt::format("{}, light {}: {}", record.scene, record.light, record.technique);
}

std::string valueText(const std::optional<double>& value) {
  return value ? fmt::format("{:.6g}", *value) : "-";
}

/// "+3.2 %", "x 12": what became of the value.
std::string movement(const FigureChange& figure) {
  if (!figure.before || !figure.after || !(*figure.before > 0.0)) return "-";
  const double ratio = *figure.after / *figure.before;
  return ratio < 10.0 ? fmt::format("{:+.1f} %", (ratio - 1.0) * 100.0) : fmt::format("x {:.3g}", ratio);
}

bool isShown(Change change, bool all) {
  return all || change == Change::better || change == Change::worse;
}

void print(const ResultsComparison& comparison, bool all) {
  std::vector<std::vector<std::string>> rows{{"job", "figure", "before", "after", "change", "verdict", "key"}};
  for (const JobChange& job : comparison.jobs) {
    const std::string name = nameOf(job.before);
    if (isShown(job.status, all)) {
      rows.push_back({name, "status", jobStatusName(job.before.status), jobStatusName(job.after.status), "-",
                      changeName(job.status), job.after.job});
    }
    for (const FigureChange& figure : job.figures) {
      if (!isShown(figure.change, all)) continue;
      rows.push_back({name, figure.figure, valueText(figure.before), valueText(figure.after), movement(figure),
                      changeName(figure.change), job.after.job});
    }
  }
  if (rows.size() > 1) fmt::print("{}\n", alignedTable(rows));
  for (const JobRecord& record : comparison.onlyBefore) fmt::print("only before: {} ({})\n", nameOf(record), record.job);
  for (const JobRecord& record : comparison.onlyAfter) fmt::print("only after: {} ({})\n", nameOf(record), record.job);
  for (const std::string& refusal : comparison.refusals) fmt::print("{}\n", refusal);
  fmt::print("{} jobs compared: {} figures better, {} worse, {} moved within their intervals, {} the same\n",
             comparison.jobs.size(), comparison.count(Change::better), comparison.count(Change::worse),
             comparison.count(Change::within), comparison.count(Change::same));
}

Json json(const std::optional<double>& value) {
  return value ? Json(*value) : Json();
}

Json json(const JobRecord& record) {
  return {{"job", record.job},     {"config", record.config},       {"scene", record.scene},
          {"light", record.light}, {"technique", record.technique}, {"parameters", Json::parse(record.parametersJson)}};
}

Json json(const ResultsComparison& comparison) {
  Json jobs = Json::array();
  for (const JobChange& job : comparison.jobs) {
    Json figures = Json::array();
    for (const FigureChange& f : job.figures) {
      figures.push_back(
          {{"figure", f.figure}, {"before", json(f.before)}, {"after", json(f.after)}, {"change", changeName(f.change)}});
    }
    Json entry = json(job.after);
    entry["job_before"] = job.before.job;
    entry["status"] = {{"before", jobStatusName(job.before.status)},
                       {"after", jobStatusName(job.after.status)},
                       {"change", changeName(job.status)}};
    entry["figures"] = figures;
    jobs.push_back(entry);
  }
  const auto list = [](const std::vector<JobRecord>& records) {
    Json all = Json::array();
    for (const JobRecord& record : records) all.push_back(json(record));
    return all;
  };
  return {{"worse", comparison.anyWorse()},
          {"jobs", jobs},
          {"only_before", list(comparison.onlyBefore)},
          {"only_after", list(comparison.onlyAfter)},
          {"refusals", comparison.refusals}};
}

}  // namespace

int compareCommand(const CommonOptions& common, const CompareOptions& options) {
  std::error_code ignored;
  if (fs::equivalent(options.before, options.after, ignored)) {
    throw InputError({{options.after.string(), "", "is the same folder twice; name the results before and after a change"}});
  }
  const std::vector<JobRecord> before = resultsIn(options.before);
  const std::vector<JobRecord> after = resultsIn(options.after);
  const ResultsComparison comparison = compareResults(before, after);
  if (comparison.jobs.empty()) {
    throw InputError({{options.after.string(), "",
                       fmt::format("has no job in common with {}; jobs are the same by config, scene, light, technique and "
                                   "parameters",
                                   options.before.string())}});
  }
  if (common.json) {
    fmt::print("{}\n", json(comparison).dump(2));
  } else {
    print(comparison, options.all);
  }
  return comparison.anyWorse() || (options.same && comparison.count(Change::better) > 0) ? 1 : 0;
}

}  // namespace gnomon
