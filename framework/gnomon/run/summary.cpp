#include "gnomon/run/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "gnomon/base/json.h"

namespace gnomon {

namespace {

std::size_t codePoints(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; }));
}

bool isNumeric(const std::string& cell) {
  return !cell.empty() && (cell[0] == '-' || cell[0] == '+' || (cell[0] >= '0' && cell[0] <= '9'));
}

std::string number(const std::optional<double>& value, const char* format) {
  return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

/// 0.123, 1.23, 12.3, 123.
std::string threeDigits(double value) {
  const int decimals = value < 0.9995 ? 3 : value < 9.995 ? 2 : value < 99.95 ? 1 : 0;
  return fmt::format("{:.{}f}", value, decimals);
}

/// What differs between the records of one technique and scene: only that tells them apart.
class Varying {
 public:
  explicit Varying(const std::vector<JobRecord>& records) {
    for (const JobRecord& record : records) {
      const Json parameters = Json::parse(record.parametersJson, nullptr, false);
      if (!parameters.is_object()) continue;
      for (const auto& [name, value] : parameters.items()) values_[{record.scene, record.technique, name}].insert(value.dump());
    }
  }

  /// "taps 5, map_size 512"
  std::string parametersOf(const JobRecord& record) const {
    const Json parameters = Json::parse(record.parametersJson, nullptr, false);
    std::string text;
    if (!parameters.is_object()) return text;
    for (const auto& [name, value] : parameters.items()) {
      if (values_.at({record.scene, record.technique, name}).size() < 2) continue;
      text +=
          fmt::format("{}{} {}", text.empty() ? "" : ", ", name, value.is_string() ? value.get<std::string>() : value.dump());
    }
    return text;
  }

 private:
  std::map<std::tuple<std::string, std::string, std::string>, std::set<std::string>> values_;  ///< by scene, technique, name
};

std::vector<std::string> row(const JobRecord& r, const Varying& varying) {
  std::vector<std::string> cells{r.technique, varying.parametersOf(r)};
  if (r.status != JobStatus::ok) {
    cells.push_back(jobStatusName(r.status) + ": " + oneLine(r.reason));
    return cells;
  }
  const ErrorFigures error = r.error.value_or(ErrorFigures{});
  cells.push_back(error.rmse ? fmt::format("{:.4f}{}", *error.rmse, error.rmseSe ? fmt::format(" ± {:.4f}", *error.rmseSe) : "")
                             : "-");
  cells.push_back(number(error.rmseBand, "{:.4f}"));
  cells.push_back(number(error.bias, "{:+.4f}"));
  const TimingFigures* time = nullptr;
  if (r.time) {
    const auto dynamic = r.time->regimes.find("dynamic");
    if (dynamic != r.time->regimes.end()) time = &dynamic->second;
  }
  cells.push_back(time != nullptr && time->medianMs ? threeDigits(*time->medianMs) : "-");
  std::string ratio = "-";
  if (time != nullptr && time->ratio) {
    ratio = threeDigits(*time->ratio);
    if (time->ratioCi95)
      ratio += fmt::format(" [{}, {}]", threeDigits(time->ratioCi95->low), threeDigits(time->ratioCi95->high));
  }
  cells.push_back(ratio);
  cells.push_back(r.job);
  return cells;
}

}  // namespace

std::string oneLine(const std::string& text) {
  std::string line;
  for (const char c : text) {
    if (c == '\n') {
      line += line.empty() ? "" : " | ";
    } else if (c != '\r') {
      line += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
    }
  }
  return line;
}

std::string alignedTable(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& cells : rows) {
    widths.resize(std::max(widths.size(), cells.size()), 0);
    // The last cell of a short row is a sentence: it makes no column wider.
    const std::size_t counted = cells.size() < rows[0].size() ? cells.size() - 1 : cells.size();
    for (std::size_t c = 0; c < counted; ++c) widths[c] = std::max(widths[c], codePoints(cells[c]));
  }
  std::string text;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    std::string line;
    for (std::size_t c = 0; c < rows[r].size(); ++c) {
      const std::string& cell = rows[r][c];
      const std::size_t room = widths[c] > codePoints(cell) ? widths[c] - codePoints(cell) : 0;
      const bool right = c >= 2 && c + 1 < rows[0].size() && (r == 0 || isNumeric(cell) || cell == "-");
      line += (c == 0 ? "" : "  ") + (right ? std::string(room, ' ') + cell : cell + std::string(room, ' '));
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
    if (r == 0) {
      std::size_t width = 0;
      for (const std::size_t w : widths) width += w + 2;
      text += std::string(width > 2 ? width - 2 : width, '-') + "\n";
    }
  }
  return text;
}

std::string summaryTable(const std::vector<JobRecord>& records) {
  const Varying varying(records);
  std::vector<std::pair<std::string, int>> groups;
  for (const JobRecord& r : records) {
    const std::pair<std::string, int> group{r.scene, r.light};
    if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(group);
  }
  std::string text;
  for (const auto& [scene, light] : groups) {
    const JobRecord* first = nullptr;
    std::vector<std::vector<std::string>> rows;
    for (const JobRecord& r : records) {
      if (r.scene != scene || r.light != light) continue;
      if (first == nullptr || (!first->time && r.time)) first = &r;
      rows.push_back(row(r, varying));
    }
    const std::string timer = first->time && first->time->timer ? clockName(*first->time->timer) + " " : "";
    rows.insert(rows.begin(), {"technique", "parameters", "RMSE", "band RMSE", "bias", timer + "ms", "x baseline", "job"});
    text += fmt::format("{}{}, light {}\n{}", text.empty() ? "" : "\n", scene, light, alignedTable(rows));
    for (const JobRecord& r : records) {
      if (r.scene == scene && r.light == light && r.error && r.error->noiseFloor) {
        text += fmt::format("reference noise {:.4f}: nothing below it is told apart\n", *r.error->noiseFloor);
        break;
      }
    }
  }
  return text;
}

}  // namespace gnomon
