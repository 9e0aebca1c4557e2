// Batches: configs in, results and pictures out; a finished result is never lost.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "gnomon/measure/results.h"
#include "gnomon/run/resolve.h"

namespace gnomon {

struct BatchOptions {
  std::filesystem::path out = {};
  bool resume = false;  ///< keep results that are there, run what is missing; else the results file starts anew
  int shard = 0;        ///< this process takes jobs shard, shard + shards, ... of all
  int shards = 1;
  bool measureTime = true;
  bool exr = true;
  bool checkFinite = false;
  std::filesystem::path referenceCache = {};
};

struct BatchSummary {
  std::vector<JobRecord> records;  ///< those of this batch, in the order of the configs
  std::size_t kept = 0;            ///< found by --resume
  std::size_t notOk = 0;
  std::filesystem::path results;
};

/// Called when a job starts (record null) and when it has ended.
using BatchProgress =
    std::function<void(std::size_t done, std::size_t total, const std::string& what, const JobRecord* record)>;

/// Runs all jobs of all runs in the current OpenGL context. Each record is appended whole and synced. Throws Error only for
/// what ends a batch: a folder that cannot be written, a reference that cannot be rendered.
BatchSummary runBatch(const std::vector<ResolvedRun>& runs, Registry& registry, const BatchOptions& options,
                      const BatchProgress& progress);

}  // namespace gnomon
