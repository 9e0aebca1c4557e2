// Two sets of results, before and after a change: what got faster, slower, better or worse beyond its intervals.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gnomon/measure/results.h"

namespace gnomon {

enum class Change {
  same,     ///< equal
  within,   ///< other values, but no further apart than their intervals explain
  better,   ///< less of it: less error, less time, less work
  worse,    ///< more of it
  unknown,  ///< only one side has it
};
/// "same", "within", "better", "worse" or "unknown".
std::string changeName(Change change);

/// One figure of one job. Of every figure that is compared, less is better.
struct FigureChange {
  std::string figure;  ///< its path in a record: "error.mse", "time.dynamic.median_ms"
  std::optional<double> before;
  std::optional<double> after;
  Change change = Change::same;
};

/// A job that both sides have.
struct JobChange {
  JobRecord before;
  JobRecord after;
  std::vector<FigureChange> figures;
  /// ok before and not after is worse, the reverse better; refused, failed and crashed are not told apart.
  Change status = Change::same;
};

struct ResultsComparison {
  std::vector<JobChange> jobs;  ///< in the order of `before`
  std::vector<JobRecord> onlyBefore;
  std::vector<JobRecord> onlyAfter;
  std::vector<std::string> refusals;  ///< why some times were not compared, a sentence for each pair of machines

  std::size_t count(Change change) const;  ///< figures and statuses
  bool anyWorse() const;
};

/// Below this share of its value a figure without an interval has not moved: pictures that differ by rounding.
inline constexpr double kGrain = 0.01;

/// Jobs are the same that have the same key; of the rest, those with the same config, scene, light, technique and switched-off
/// defences whose parameters agree wherever both have them (an older version may have fewer). Times, ratios and mean square
/// errors differ where their 95 % intervals say so at `familyWiseSignificance` over all of them together (compareFamily); the
/// reference's noise is common to both errors and counted twice, so small changes of error may hide. Counters, memory, splits
/// and FLIP have no interval: counters and memory differ when they differ, the rest beyond kGrain. Times of different machines,
/// renderers or timers are not compared, nor are their ratios: another machine has another balance of passes. Static times are
/// no technique's cost and never compared.
ResultsComparison compareResults(std::span<const JobRecord> before, std::span<const JobRecord> after,
                                 double familyWiseSignificance = 0.05);

}  // namespace gnomon
