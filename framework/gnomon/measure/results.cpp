#include "gnomon/measure/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "gnomon/base/error.h"
#include "gnomon/base/files.h"
#include "gnomon/base/log.h"

namespace gnomon {
namespace {

using OrderedJson = nlohmann::ordered_json;  // files keep the order in which keys are listed here

constexpr std::array kStatuses = {JobStatus::ok, JobStatus::refused, JobStatus::failed, JobStatus::crashed};

// Each record's keys are listed once, in its `keys` function: Writer and Reader both walk it.

template <typename Visitor>
void keys(Visitor& visit, ClassFigures& figures) {
  visit("share", figures.share);
  visit("rmse", figures.rmse);
  visit("bias", figures.bias);
}

/// The five classes, which are an object of their own inside the error's.
struct ClassesView {
  ErrorFigures* figures;
};

template <typename Visitor>
void keys(Visitor& visit, ClassesView& view) {
  visit("lit", view.figures->lit);
  visit("umbra", view.figures->umbra);
  visit("penumbra", view.figures->penumbra);
  visit("band", view.figures->band);
  visit("terminator", view.figures->terminator);
}

template <typename Visitor>
void keys(Visitor& visit, ErrorFigures& figures) {
  visit("mse", figures.mse);
  visit("mse_se", figures.mseSe);
  visit("rmse", figures.rmse);
  visit("rmse_se", figures.rmseSe);
  visit("rmse_band", figures.rmseBand);
  visit("mae", figures.mae);
  visit("bias", figures.bias);
  visit("p99", figures.p99);
  visit("max", figures.max);
  visit("over_0_1", figures.over01);
  visit("non_finite", figures.nonFinite);
  visit("noise_floor", figures.noiseFloor);
  ClassesView classes{&figures};
  visit("classes", classes);
}

template <typename Visitor>
void keys(Visitor& visit, TimingFigures& figures) {
  visit("median_ms", figures.medianMs);
  visit("wall_median_ms", figures.wallMedianMs);
  visit("mad_ms", figures.madMs);
  visit("ci95_ms", figures.ci95Ms);
  visit("p95_ms", figures.p95Ms);
  visit("n", figures.n);
  visit("ratio", figures.ratio);
  visit("ratio_ci95", figures.ratioCi95);
}

template <typename Visitor>
void keys(Visitor& visit, PassTime& pass) {
  visit("name", pass.name);
  visit("ms", pass.ms);
  visit("wall_ms", pass.wallMs);
}

template <typename Visitor>
void keys(Visitor& visit, TimeRecord& time) {
  visit("timer", time.timer);
  visit("regimes", time.regimes);
  visit("passes", time.passes);
  visit("pass_sum_ms", time.passSumMs);
  visit("gap_ms", time.gapMs);
  visit("repeats", time.repeats);
}

template <typename Visitor>
void keys(Visitor& visit, ErrorSplits& splits) {
  visit("acne", splits.acne);
  visit("leak", splits.leak);
  visit("detachment", splits.detachment);
  visit("penumbra", splits.penumbra);
  visit("offset", splits.offset);
  visit("shimmer", splits.shimmer);
}

template <typename Visitor>
void keys(Visitor& visit, FlipFigures& flip) {
  visit("mean", flip.mean);
  visit("p99", flip.p99);
}

template <typename Visitor>
void keys(Visitor& visit, ReferenceRecord& reference) {
  visit("rays", reference.rays);
  visit("rays_saved", reference.raysSaved);
  visit("standard_error", reference.standardError);
  visit("cosine_floor", reference.cosineFloor);
}

template <typename Visitor>
void keys(Visitor& visit, PassWork& pass) {
  visit("name", pass.name);
  visit("primitives", pass.primitives);
  visit("fragments", pass.fragments);
  visit("texel_reads", pass.texelReads);
  visit("texels_written", pass.texelsWritten);
  visit("bytes_written", pass.bytesWritten);
  visit("rays", pass.rays);
}

template <typename Visitor>
void keys(Visitor& visit, WorkCounters& work) {
  visit("passes_run", work.passesRun);
  visit("passes_skipped", work.passesSkipped);
  visit("draws", work.draws);
  visit("primitives", work.primitives);
  visit("fragments", work.fragments);
  visit("texel_reads", work.texelReads);
  visit("texels_written", work.texelsWritten);
  visit("bytes_written", work.bytesWritten);
  visit("rays", work.rays);
  visit("reads_by_format", work.readsByFormat);
  visit("passes", work.passes);
}

template <typename Visitor>
void keys(Visitor& visit, PlanEntry& entry) {
  visit("effect", entry.effect);
  visit("on", entry.on);
  visit("reason", entry.reason);
  visit("value", entry.value);
}

template <typename Visitor>
void keys(Visitor& visit, MachineRecord& machine) {
  visit("renderer", machine.renderer);
  visit("cpu", machine.cpu);
}

/// JSON text that is embedded as it is.
struct RawObject {
  std::string* text;
};

template <typename Visitor>
void keys(Visitor& visit, JobRecord& record) {
  visit("job", record.job);
  visit("config", record.config);
  visit("scene", record.scene);
  visit("light", record.light);
  visit("technique", record.technique);
  RawObject parameters{&record.parametersJson};
  visit("parameters", parameters);
  visit("status", record.status);
  visit("reason", record.reason);
  visit("error", record.error);
  visit("splits", record.splits);
  visit("flip", record.flip);
  visit("reference", record.reference);
  visit("time", record.time);
  visit("work", record.work);
  visit("memory_bytes", record.memoryBytes);
  visit("plan", record.plan);
  visit("without", record.without);
  visit("machine", record.machine);
}

template <typename Visitor>
void keys(Visitor& visit, FrameTime& time) {
  visit("cpu_ms", time.cpuMs);
  visit("wall_ms", time.wallMs);
  visit("gpu_ms", time.gpuMs);
}

template <typename Visitor>
void keys(Visitor& visit, TimedPair& pair) {
  visit("block", pair.block);
  visit("pose", pair.pose);
  visit("candidate", pair.candidate);
  visit("baseline", pair.baseline);
}

template <typename T>
concept Plain = std::is_arithmetic_v<T>;

/// Values to JSON. Numbers that are not finite come out as null.
class Writer {
 public:
  template <typename T>
  static OrderedJson json(T& value) {
    Writer writer;
    keys(writer, value);
    return std::move(writer.json_);
  }
  template <typename T>
  void operator()(const char* key, T& value) {
    json_[key] = json(value);
  }

  template <Plain T>
  static OrderedJson json(T& value) {
    return value;
  }
  static OrderedJson json(std::string& text) { return text.empty() ? OrderedJson() : OrderedJson(text); }
  static OrderedJson json(Interval& interval) { return OrderedJson::array({interval.low, interval.high}); }
  static OrderedJson json(Clock& clock) { return clockName(clock); }
  static OrderedJson json(JobStatus& status) { return jobStatusName(status); }
  static OrderedJson json(RawObject& raw) {
    OrderedJson object = OrderedJson::parse(*raw.text, nullptr, /*allow_exceptions=*/false);
    if (!object.is_object()) throw Error("results: parameters are no JSON object: " + *raw.text);
    return object;
  }
  template <typename T>
  static OrderedJson json(std::optional<T>& value) {
    return value ? json(*value) : OrderedJson();
  }
  template <typename T>
  static OrderedJson json(std::vector<T>& list) {
    return arrayOf(list);
  }
  template <typename T, std::size_t N>
  static OrderedJson json(std::array<T, N>& list) {
    return arrayOf(list);
  }
  template <typename T>
  static OrderedJson json(std::map<std::string, T>& map) {
    OrderedJson object = OrderedJson::object();
    for (auto& [key, value] : map) object[key] = json(value);
    return object;
  }

 private:
  template <typename List>
  static OrderedJson arrayOf(List& list) {
    OrderedJson array = OrderedJson::array();
    for (auto& value : list) array.push_back(json(value));
    return array;
  }

  OrderedJson json_ = OrderedJson::object();
};

/// JSON to values; a missing key and a null leave the value as it is made. Throws nlohmann's exceptions on a wrong type.
class Reader {
 public:
  template <typename T>
  static void read(const OrderedJson& json, T& value) {
    if (!json.is_object()) throw Error("expected an object");
    Reader reader(json);
    keys(reader, value);
  }
  template <typename T>
  void operator()(const char* key, T& value) {
    const auto found = json_->find(key);
    if (found != json_->end() && !found->is_null()) read(*found, value);
  }

  template <Plain T>
  static void read(const OrderedJson& json, T& value) {
    value = json.get<T>();
  }
  static void read(const OrderedJson& json, std::string& text) { text = json.get<std::string>(); }
  static void read(const OrderedJson& json, Interval& interval) {
    interval = {json.at(0).get<double>(), json.at(1).get<double>()};
  }
  static void read(const OrderedJson& json, Clock& clock) {
    const auto named = clockFromName(json.get<std::string>());
    if (!named) throw Error("unknown timer");
    clock = *named;
  }
  static void read(const OrderedJson& json, JobStatus& status) {
    const auto named = std::find_if(kStatuses.begin(), kStatuses.end(),
                                    [&](JobStatus s) { return jobStatusName(s) == json.get<std::string>(); });
    if (named == kStatuses.end()) throw Error("unknown status");
    status = *named;
  }
  static void read(const OrderedJson& json, RawObject& raw) {
    if (!json.is_object()) throw Error("parameters are no object");
    *raw.text = json.dump();
  }
  template <typename T>
  static void read(const OrderedJson& json, std::optional<T>& value) {
    read(json, value.emplace());
  }
  template <typename T>
  static void read(const OrderedJson& json, std::vector<T>& list) {
    for (const OrderedJson& element : json) read(element, list.emplace_back());
  }
  template <typename T, std::size_t N>
  static void read(const OrderedJson& json, std::array<T, N>& list) {
    for (std::size_t i = 0; i < N; ++i) read(json.at(i), list[i]);
  }
  template <typename T>
  static void read(const OrderedJson& json, std::map<std::string, T>& map) {
    if (!json.is_object()) throw Error("expected an object");
    for (const auto& [key, element] : json.items()) read(element, map[key]);
  }

 private:
  explicit Reader(const OrderedJson& json) : json_(&json) {}

  const OrderedJson* json_;
};

std::string dumped(const OrderedJson& json) {
  return json.dump(/*indent=*/-1, ' ', /*ensure_ascii=*/false, OrderedJson::error_handler_t::replace);
}

JobRecord parseRecord(std::string_view line) {
  const OrderedJson json = OrderedJson::parse(line);
  JobRecord record;
  Reader::read(json, record);
  if (record.job.empty()) throw Error("it names no job");
  return record;
}

/// Records of repeated jobs are merged: the last wins, at the place of the first.
class Merger {
 public:
  void add(JobRecord record) {
    const auto [place, isNew] = places_.try_emplace(record.job, records_.size());
    if (isNew) {
      records_.push_back(std::move(record));
    } else {
      records_[place->second] = std::move(record);
    }
  }
  std::vector<JobRecord> take() { return std::move(records_); }

 private:
  std::vector<JobRecord> records_;
  std::unordered_map<std::string, std::size_t> places_;
};

std::vector<std::filesystem::path> resultFiles(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return {path};
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file() && name.starts_with("results") && name.ends_with(".jsonl")) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

std::string jobStatusName(JobStatus status) {
  switch (status) {
    case JobStatus::ok:
      return "ok";
    case JobStatus::refused:
      return "refused";
    case JobStatus::failed:
      return "failed";
    case JobStatus::crashed:
      return "crashed";
  }
  throw Error("results: no such status");
}

std::string toJsonLine(const JobRecord& record) {
  JobRecord written = record;
  if (written.time && written.time->regimes.contains("static")) {  // nothing runs there: a ratio would be of noise
    written.time->regimes["static"].ratio.reset();
    written.time->regimes["static"].ratioCi95.reset();
  }
  return dumped(Writer::json(written));
}

std::string timingPairsJson(const TimeRecord& time) {
  OrderedJson regimes = OrderedJson::object();
  for (const auto& [name, figures] : time.regimes) {
    std::vector<TimedPair> pairs = figures.pairs;
    regimes[name] = Writer::json(pairs);
  }
  return dumped({{"regimes", regimes}});
}

std::map<std::string, std::vector<TimedPair>> parseTimingPairs(std::string_view text) {
  std::map<std::string, std::vector<TimedPair>> regimes;
  Reader::read(OrderedJson::parse(text).at("regimes"), regimes);
  return regimes;
}

ParsedResults parseResults(std::string_view text, const std::string& name) {
  ParsedResults results;
  Merger merger;
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = text.find('\n');
    const bool isTail = end == std::string_view::npos;
    const std::string_view content = text.substr(0, end);
    text.remove_prefix(isTail ? text.size() : end + 1);
    if (content.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    try {
      merger.add(parseRecord(content));
    } catch (const std::exception& error) {
      results.warnings.push_back(
          fmt::format("{}:{}: {} passed over: {}", name, line, isTail ? "torn last line" : "damaged record", error.what()));
    }
  }
  results.records = merger.take();
  return results;
}

std::vector<JobRecord> readResults(const std::filesystem::path& path) {
  Merger merger;
  for (const std::filesystem::path& file : resultFiles(path)) {
    ParsedResults results = parseResults(readFile(file), file.string());
    for (const std::string& warning : results.warnings) log::warning(warning);
    for (JobRecord& record : results.records) merger.add(std::move(record));
  }
  return merger.take();
}

}  // namespace gnomon
