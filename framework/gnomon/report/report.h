// One page that shows what accuracy costs, made of a folder of results.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace gnomon {

struct ReportOptions {
  std::filesystem::path results;    ///< folder that a batch wrote
  std::filesystem::path page = {};  ///< where to write; empty: report.html in the folder
  bool images = true;               ///< pictures of jobs, from their EXR files
  /// Text that pictures may take, bytes: when it is used up, later jobs have none, and the page says so.
  std::uint64_t imageBudget = std::uint64_t{64} << 20U;
};

struct ReportSummary {
  std::filesystem::path page;
  std::size_t jobs = 0;
  std::size_t pictured = 0;           ///< jobs whose pictures are in it
  std::uint64_t bytes = 0;            ///< of the page
  std::vector<std::string> warnings;  ///< lines and pictures that could not be read: they stand in the page too
};

/// Writes the page, which needs nothing beside it and no network, in place of an earlier one; results are only read. Throws
/// InputError for a folder without results, Error where the page cannot be written or this build has none.
ReportSummary writeReport(const ReportOptions& options);

}  // namespace gnomon
