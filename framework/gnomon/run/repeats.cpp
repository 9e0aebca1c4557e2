#include "gnomon/run/repeats.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <vector>

#include "gnomon/base/files.h"
#include "gnomon/base/log.h"

namespace gnomon {

namespace {

using RegimePairs = std::map<std::string, std::vector<TimedPair>>;

bool isTimed(const JobRecord& record) {
  return record.time && record.time->timer;
}

/// The figures of every regime, of the processes that measured them all. Throws where one lacks a regime or the record's clock.
TimeRecord withProcesses(const TimeRecord& own, const std::vector<RegimePairs>& processes) {
  TimeRecord merged = own;
  for (auto& [name, figures] : merged.regimes) {
    std::vector<std::vector<TimedPair>> pairs;
    for (const RegimePairs& process : processes) {
      if (!process.contains(name)) throw Error(fmt::format("it has no times of the regime '{}'", name));
      pairs.push_back(process.at(name));
    }
    const bool hasRatio = figures.ratio.has_value();
    figures = timingFigures(pairs, *own.timer);
    if (hasRatio) continue;
    figures.ratio.reset();
    figures.ratioCi95.reset();
  }
  merged.repeats = static_cast<int>(processes.size());
  if (const auto dynamic = merged.regimes.find("dynamic"); dynamic != merged.regimes.end() && merged.passSumMs)
    merged.gapMs = *merged.passSumMs - dynamic->second.medianMs.value();
  return merged;
}

}  // namespace

bool needsRepeats(const BatchSummary& summary, int processes) {
  return std::any_of(summary.records.begin(), summary.records.end(),
                     [&](const JobRecord& record) { return isTimed(record) && record.time->repeats.value_or(1) < processes; });
}

void mergeRepeats(BatchSummary& summary, std::span<const std::filesystem::path> folders) {
  std::vector<std::filesystem::path> all{summary.results.parent_path()};
  all.insert(all.end(), folders.begin(), folders.end());
  for (JobRecord& record : summary.records) {
    if (!isTimed(record)) continue;
    TimeRecord merged = *record.time;
    std::vector<RegimePairs> processes;
    for (const std::filesystem::path& folder : all) {
      const std::filesystem::path file = folder / "timing" / (record.job + ".json");
      processes.push_back({});
      try {
        processes.back() = parseTimingPairs(readFile(file));
        merged = withProcesses(*record.time, processes);
      } catch (const std::exception& error) {
        log::warning(fmt::format("{}: not counted among the repeats: {}", file.string(), error.what()));
        processes.pop_back();
      }
    }
    record.time = std::move(merged);
    appendLineSynced(summary.results, toJsonLine(record));
  }
}

}  // namespace gnomon
