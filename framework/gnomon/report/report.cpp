#include "gnomon/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "gnomon/base/error.h"
#include "gnomon/base/files.h"
#include "gnomon/image/image_io.h"
#include "gnomon/measure/results.h"
#include "gnomon/report/packed_picture.h"

namespace gnomon {

namespace {

namespace fs = std::filesystem;
using OrderedJson = nlohmann::ordered_json;

const std::string kAdvice = "name a folder that `gnomon batch --out` wrote";

/// Records of all its results files, of a repeated job the last, as readResults, with the damaged lines as warnings.
std::vector<JobRecord> recordsIn(const fs::path& folder, std::vector<std::string>& warnings) {
  if (!fs::is_directory(folder)) throw InputError({{folder.string(), "", "is no folder; " + kAdvice}});
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file() && name.starts_with("results") && name.ends_with(".jsonl")) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::string all;
  for (const fs::path& file : files) {
    const std::string text = readFile(file);
    for (const std::string& warning : parseResults(text, file.filename().string()).warnings) warnings.push_back(warning);
    all += text + '\n';  // a torn tail stays a line of its own
  }
  std::vector<JobRecord> records = parseResults(all, "").records;
  if (records.empty()) {
    std::string found = files.empty() ? "holds no results" : "holds no whole record";
    for (const std::string& warning : warnings) found += "; " + warning;
    throw InputError({{folder.string(), "", found + "; " + kAdvice}});
  }
  return records;
}

/// The pictures of all jobs. References that are the same lie in the page once.
class Pictures {
 public:
  Pictures(const ReportOptions& options, std::vector<std::string>& warnings) : options_(options), warnings_(warnings) {}

  void add(const JobRecord& record) {
    if (!options_.images || record.status != JobStatus::ok) return;
    const fs::path file = options_.results / "images" / (record.job + ".exr");
    if (!fs::exists(file)) return;
    if (used_ >= options_.imageBudget) {
      ++leftOut_;
      return;
    }
    try {
      addFrom(readExr(file), record.job);
    } catch (const std::exception& error) {
      warnings_.push_back(fmt::format("{}: {}", file.string(), error.what()));
    }
  }

  OrderedJson jobs = OrderedJson::object();
  OrderedJson references = OrderedJson::object();
  std::size_t leftOut() const { return leftOut_; }

 private:
  void addFrom(const ExrPicture& exr, const std::string& job) {
    constexpr float none = std::numeric_limits<float>::quiet_NaN();
    const Image& classes = exr.channel("class");
    Image error = exr.channel("error");
    Image reference = exr.channel("reference_a");
    const Image& other = exr.channel("reference_b");
    for (std::size_t i = 0; i < classes.pixels(); ++i) {
      const bool isReceiver = classes.data[i] > 0.0f;
      reference.data[i] = isReceiver ? 0.5f * (reference.data[i] + other.data[i]) : none;
      // What is not finite must not look like what is no receiver.
      if (!std::isfinite(error.data[i])) error.data[i] = std::numeric_limits<float>::infinity();
      if (!isReceiver) error.data[i] = none;
    }
    OrderedJson pictures{{"width", classes.width}, {"height", classes.height}};
    pictures["reference"] = keyOf(packedPicture(reference));
    pictures["error"] = packedPicture(error);
    if (exr.has("work")) pictures["work"] = packedPicture(exr.channel("work"));
    for (const char* key : {"error", "work"}) {
      if (pictures.contains(key)) used_ += pictures[key].get_ref<const std::string&>().size();
    }
    jobs[job] = std::move(pictures);
  }

  std::string keyOf(std::string packed) {
    const auto [known, isNew] = keys_.try_emplace(std::move(packed), fmt::format("r{}", keys_.size()));
    if (isNew) {
      references[known->second] = known->first;
      used_ += known->first.size();
    }
    return known->second;
  }

  const ReportOptions& options_;
  std::vector<std::string>& warnings_;
  std::map<std::string, std::string> keys_;
  std::uint64_t used_ = 0;
  std::size_t leftOut_ = 0;
};

/// JSON that no HTML parser takes for its own: a tag in a name stays text.
std::string embedded(const OrderedJson& json) {
  const std::string text = json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '<') {
      safe += "&lt;";
    } else if (c == '&') {
      safe += "&amp;";
    } else {
      safe += c;
    }
  }
  return safe;
}

/// Each placeholder once, in one walk: what is put in is not looked at again.
std::string filled(const std::string& page, const std::map<std::string, std::string>& parts) {
  std::string result;
  for (std::size_t at = 0; at < page.size();) {
    const auto found = std::find_if(parts.begin(), parts.end(),
                                    [&](const auto& part) { return page.compare(at, part.first.size(), part.first) == 0; });
    if (found == parts.end()) {
      result += page[at++];
    } else {
      result += found->second;
      at += found->first.size();
    }
  }
  return result;
}

std::string partOfPage(const char* name) {
  const fs::path file = installationDirectory() / "report" / name;
  if (!fs::exists(file)) {
    throw Error(
        fmt::format("{} is not there: this Gnomon was built without its report page; build it with npm and "
                    "-DGNOMON_REPORT=ON",
                    file.string()));
  }
  return readFile(file);
}

}  // namespace

ReportSummary writeReport(const ReportOptions& options) {
  ReportSummary summary;
  const std::vector<JobRecord> records = recordsIn(options.results, summary.warnings);
  Pictures pictures(options, summary.warnings);
  OrderedJson list = OrderedJson::array();
  for (const JobRecord& record : records) {
    list.push_back(OrderedJson::parse(toJsonLine(record)));
    pictures.add(record);
  }
  summary.jobs = records.size();
  summary.pictured = pictures.jobs.size();
  if (pictures.leftOut() > 0) {
    summary.warnings.push_back(fmt::format("{} jobs have no pictures here: the page would be too large; their files are in {}",
                                           pictures.leftOut(), (options.results / "images").string()));
  }
  const std::string title = fs::absolute(options.results).lexically_normal().filename().string();
  OrderedJson data{{"title", title.empty() ? "results" : title}, {"records", list}, {"warnings", summary.warnings}};
  data["pictures"] = std::move(pictures.jobs);
  data["references"] = std::move(pictures.references);
  if (!options.images) data["withoutImages"] = "The page was written without pictures.";
  const std::string page = filled(partOfPage("page.html"), {{"GNOMON_TITLE", escaped(title)},
                                                            {"GNOMON_STYLE", partOfPage("style.css")},
                                                            {"GNOMON_SCRIPT", partOfPage("report.js")},
                                                            {"GNOMON_DATA", embedded(data)}});
  summary.page = options.page.empty() ? options.results / "report.html" : options.page;
  writeFileAtomically(summary.page, page);
  summary.bytes = page.size();
  return summary;
}

}  // namespace gnomon
