#include "gnomon/run/trace.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "gnomon/base/clock.h"
#include "gnomon/base/files.h"
#include "gnomon/base/json.h"

namespace gnomon {

namespace {

constexpr std::size_t kLongestName = 200;

/// Whole: an end is rounded as a start is, so that rounding never takes a slice out of the one around it.
std::int64_t nanoseconds(double milliseconds) {
  return std::llround(milliseconds * 1e6);
}

}  // namespace

Trace::Trace(std::string process, std::size_t most) : process_(std::move(process)), most_(most), beginMs_(wallMs()) {}

void Trace::add(const std::string& name, double startMs, double durationMs, Notes notes) {
  if (slices_.size() >= most_) {
    ++leftOut_;
    return;
  }
  slices_.push_back({name.substr(0, kLongestName), startMs, durationMs, std::move(notes)});
}

std::string Trace::json() const {
  std::vector<const Event*> sorted;
  for (const Event& slice : slices_) sorted.push_back(&slice);
  std::stable_sort(sorted.begin(), sorted.end(), [](const Event* a, const Event* b) {
    return a->startMs != b->startMs ? a->startMs < b->startMs : a->durationMs > b->durationMs;
  });

  Json events = Json::array();
  events.push_back({{"ph", "M"}, {"name", "process_name"}, {"pid", 1}, {"tid", 1}, {"args", {{"name", process_}}}});
  events.push_back({{"ph", "M"}, {"name", "thread_name"}, {"pid", 1}, {"tid", 1}, {"args", {{"name", "jobs"}}}});
  for (const Event* slice : sorted) {
    const std::int64_t start = nanoseconds(slice->startMs - beginMs_);
    const std::int64_t end = nanoseconds(slice->startMs - beginMs_ + slice->durationMs);
    Json event{{"ph", "X"},
               {"name", slice->name},
               {"pid", 1},
               {"tid", 1},
               {"ts", static_cast<double>(start) / 1000.0},
               {"dur", static_cast<double>(end - start) / 1000.0}};
    if (!slice->notes.empty()) event["args"] = slice->notes;
    events.push_back(std::move(event));
  }
  const Json whole{
      {"displayTimeUnit", "ms"}, {"otherData", {{"slices_left_out", leftOut_}}}, {"traceEvents", std::move(events)}};
  // Reasons may hold bytes that are no UTF-8.
  return whole.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void Trace::write(const std::filesystem::path& path) const {
  writeFileAtomically(path, json());
}

TraceSlice::TraceSlice(Trace* trace, std::string name, Trace::Notes notes)
    : trace_(trace), name_(std::move(name)), notes_(std::move(notes)), startMs_(wallMs()) {}

TraceSlice::~TraceSlice() {
  if (trace_ != nullptr) trace_->add(name_, startMs_, wallMs() - startMs_, std::move(notes_));
}

}  // namespace gnomon
