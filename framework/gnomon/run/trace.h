// What a run did when, as nested slices that a trace viewer draws on a time line (Perfetto, chrome://tracing).
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace gnomon {

/// Collects slices on the wall clock; none of it touches a file before write(). One thread.
class Trace {
 public:
  /// Shown beside a slice: names and texts.
  using Notes = std::map<std::string, std::string>;

  /// `process` names the one process of the trace. Of more slices than `most` the first are kept and the rest are counted.
  explicit Trace(std::string process, std::size_t most = 100'000);

  /// A slice that was timed elsewhere: both in milliseconds, `start` on the clock of wallMs(). Names longer than 200 bytes are
  /// cut. Slices may be added in any order; one that lies inside another is drawn inside it.
  void add(const std::string& name, double startMs, double durationMs, Notes notes = {});
  bool empty() const { return slices_.empty(); }

  /// JSON in the Trace Event Format (Google, 2016): complete events ("X") with ts and dur in microseconds since the trace
  /// began, one process and one thread, sorted by their start, the longer first; slices that were left out are told as
  /// "otherData".
  std::string json() const;
  /// The same to a file, which appears whole. Throws Error.
  void write(const std::filesystem::path& path) const;

 private:
  struct Event {
    std::string name;
    double startMs;
    double durationMs;
    Notes notes;
  };
  std::string process_;
  std::size_t most_;
  std::size_t leftOut_ = 0;
  double beginMs_;
  std::vector<Event> slices_;
};

/// A slice from its making to its end, however that comes. Without a trace it does nothing.
class TraceSlice {
 public:
  TraceSlice(Trace* trace, std::string name, Trace::Notes notes = {});
  ~TraceSlice();
  TraceSlice(const TraceSlice&) = delete;
  TraceSlice& operator=(const TraceSlice&) = delete;

  void note(const std::string& name, const std::string& text) { notes_[name] = text; }

 private:
  Trace* trace_;
  std::string name_;
  Trace::Notes notes_;
  double startMs_;
};

}  // namespace gnomon
