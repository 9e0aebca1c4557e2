// The summary that a batch prints.
#pragma once

#include <string>
#include <vector>

#include "gnomon/measure/results.h"

namespace gnomon {

/// One table a scene and light: technique, parameters, RMSE with its error, band RMSE, bias, milliseconds, times the
/// baseline's, and the job's key, by which its pictures are named. Plain text, columns aligned by code points.
std::string summaryTable(const std::vector<JobRecord>& records);

/// Text of any kind as one line for a terminal: lines parted by " | ", other control characters as '?'.
std::string oneLine(const std::string& text);

/// Rows of cells, the first row the headings, as aligned text; numbers to the right.
std::string alignedTable(const std::vector<std::vector<std::string>>& rows);

}  // namespace gnomon
