// Batches: configs in, results and pictures out; a finished result is never lost.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gnomon/measure/results.h"
#include "gnomon/run/resolve.h"

namespace gnomon {

struct BatchOptions {
  std::filesystem::path out = {};
  /// Keep results that are there, run what is missing: jobs without a record or, of one, without a picture that this batch
  /// would write. Else the results file starts anew.
  bool resume = false;
  int shard = 0;  ///< this process takes jobs shard, shard + shards, ... of all
  int shards = 1;
  bool measureTime = true;
  bool timesOnly = false;           ///< no reference, errors, counters or pictures
  std::optional<Clock> timer = {};  ///< empty: one that proves itself (chooseClock)
  bool exr = true;
  bool checkFinite = false;
  std::filesystem::path referenceCache = {};
};

/// A picture under all lights of a run.
struct LightsPictureRecord {
  std::string what;                ///< scene and technique
  std::filesystem::path path;      ///< where it lies; empty where there is none
  std::vector<std::string> notes;  ///< lights that it leaves out, or why there is none
  bool failed = false;             ///< that is no refusal
};

struct BatchSummary {
  std::vector<JobRecord> records;                   ///< those of this batch, in the order of the configs
  std::vector<LightsPictureRecord> lightsPictures;  ///< of runs with several lights and "shaded" pictures
  std::size_t kept = 0;                             ///< records found by --resume
  std::size_t notOk = 0;
  std::filesystem::path results;
  std::filesystem::path trace;  ///< empty where nothing had to be run
  std::optional<Clock> clock;   ///< that times were measured by
};

/// Called when a job starts (record null) and when it has ended.
using BatchProgress =
    std::function<void(std::size_t done, std::size_t total, const std::string& what, const JobRecord* record)>;

/// Runs all jobs of all runs in the current OpenGL context, and after those of each run with several lights draws the pictures
/// under all of them; a shard draws every n-th of these too. One that fails or is refused ends nothing. Each record is appended
/// whole and synced. OUT/trace.json (of a shard, trace.I.json) shows where the time went: a slice for each job that was run,
/// and in it its steps and passes; it is of this run alone, written at its end, and stays as it was if nothing had to be run.
/// Throws Error only for what ends a batch: a timer that does not prove itself, a folder that cannot be written, a results file
/// that another process is writing.
BatchSummary runBatch(const std::vector<ResolvedRun>& runs, Registry& registry, const BatchOptions& options,
                      const BatchProgress& progress);

}  // namespace gnomon
