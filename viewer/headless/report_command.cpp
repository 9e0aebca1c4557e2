// report: the page of a folder of results.
#include <fmt/format.h>

#include "commands.h"
#include "gnomon/base/log.h"
#include "gnomon/report/report.h"

namespace gnomon {

int reportCommand(const std::filesystem::path& results, const std::filesystem::path& page, bool images) {
  const ReportSummary summary = writeReport({.results = results, .page = page, .images = images});
  for (const std::string& warning : summary.warnings) log::warning(warning);
  fmt::print("{}\n{} jobs, {} with pictures, {:.1f} MB\n", summary.page.string(), summary.jobs, summary.pictured,
             static_cast<double>(summary.bytes) * 1e-6);
  return 0;
}

}  // namespace gnomon
