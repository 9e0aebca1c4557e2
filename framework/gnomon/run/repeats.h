// Times of one batch by several processes: what a process shares with itself alone is no evidence.
#pragma once

#include <filesystem>
#include <span>

#include "gnomon/run/batch.h"

namespace gnomon {

/// Whether a record of the batch has times of fewer than `processes`.
bool needsRepeats(const BatchSummary& summary, int processes);

/// Forms the figures of each timed record anew from the raw pairs of the batch itself (OUT/timing) and of `folders`, which
/// other processes wrote for the same jobs; intervals are then over processes, too. Times of single passes stay the batch's
/// own. The records are appended to the batch's results, where a later record of a job replaces the earlier. A folder that
/// lacks a job's pairs, or has them by another clock, costs a warning and counts for nothing.
void mergeRepeats(BatchSummary& summary, std::span<const std::filesystem::path> folders);

}  // namespace gnomon
