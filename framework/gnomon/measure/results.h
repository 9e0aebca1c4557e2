// Results: one record a job, one line a record (JSONL). What was not measured is null and never 0.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gnomon/measure/clocks.h"
#include "gnomon/measure/error.h"
#include "gnomon/measure/flip.h"
#include "gnomon/measure/splits.h"
#include "gnomon/measure/timing.h"

namespace gnomon {

enum class JobStatus { ok, refused, failed, crashed };

/// "ok", "refused", "failed" or "crashed".
std::string jobStatusName(JobStatus status);

/// One effect or rule of the plan and what decided it.
struct PlanEntry {
  std::string effect;
  bool on = false;
  std::string reason = {};
  std::optional<double> value = std::nullopt;  ///< the deciding number, where there is one

  bool operator==(const PlanEntry&) const = default;
};

/// Time of one pass, with a finish after each: sums to more than the total, which is measured without.
struct PassTime {
  std::string name;
  std::optional<double> ms = std::nullopt;      ///< median, on the record's timer where a pass can be timed by it, else wall
  std::optional<double> wallMs = std::nullopt;  ///< median

  bool operator==(const PassTime&) const = default;
};

struct TimeRecord {
  std::optional<Clock> timer;                    ///< the clock of the figures and the ratios
  std::map<std::string, TimingFigures> regimes;  ///< dynamic, animated, camera, static; in "static" the ratio is always null
  std::vector<PassTime> passes;
  std::optional<double> passSumMs;  ///< of `passes`
  std::optional<double> gapMs;      ///< passSumMs less the dynamic regime's median: what the finishes between passes cost
  std::optional<int> repeats;       ///< processes whose blocks the figures hold (--repeat)

  bool operator==(const TimeRecord&) const = default;
};

/// What one pass did in a frame in which everything ran.
struct PassWork {
  std::string name;
  std::optional<std::uint64_t> primitives = std::nullopt, fragments = std::nullopt, texelReads = std::nullopt,
                               texelsWritten = std::nullopt, bytesWritten = std::nullopt, rays = std::nullopt;

  bool operator==(const PassWork&) const = default;
};

/// What one frame of the technique did. `texelReads` are from the instrumented build of the same shaders.
struct WorkCounters {
  std::optional<std::uint64_t> passesRun, passesSkipped, draws, primitives;
  std::optional<std::uint64_t> fragments;   ///< samples that passed, of raster passes and full-screen ones
  std::optional<std::uint64_t> texelReads;  ///< in texels: a bilinear tap or a gather is 4
  std::optional<std::uint64_t> texelsWritten, bytesWritten, rays;
  std::optional<std::map<std::string, std::uint64_t>> readsByFormat;  ///< texelReads, by the texture's format
  std::optional<std::vector<PassWork>> passes;

  bool operator==(const WorkCounters&) const = default;
};

/// What the reference cost and how far it can be believed.
struct ReferenceRecord {
  std::optional<std::uint64_t> rays;       ///< traced for it, in whatever run made it
  std::optional<std::uint64_t> raysSaved;  ///< that an adaptive reference left out of `samples` a pixel
  std::optional<double> standardError;     ///< root mean square over the mask of the standard error of R
  /// Root mean square over the mask of the difference between N.L V and the exact integral of N.w over the visible source,
  /// both relative to a receiver that faces the light and sees all of it: what a picture shaded with the right V still gets
  /// wrong.
  std::optional<double> cosineFloor;

  bool operator==(const ReferenceRecord&) const = default;
};

struct MachineRecord {
  std::string renderer;
  std::string cpu;

  bool operator==(const MachineRecord&) const = default;
};

struct JobRecord {
  std::string job;  ///< the job's key: a hash of all that decides it
  std::string config;
  std::string scene;
  int light = 0;  ///< index into the config's lights
  std::string technique;
  std::string parametersJson = "{}";  ///< an object, as JSON text
  JobStatus status = JobStatus::ok;
  std::string reason;  ///< why not ok; "" is written as null
  std::optional<ErrorFigures> error;
  std::optional<ErrorSplits> splits;
  std::optional<FlipFigures> flip;
  std::optional<ReferenceRecord> reference;
  std::optional<TimeRecord> time;
  WorkCounters work;
  std::optional<std::uint64_t> memoryBytes;
  std::vector<PlanEntry> plan;
  std::vector<std::string> without = {};  ///< names of the defences that were off
  MachineRecord machine;

  bool operator==(const JobRecord&) const = default;
};

/// One line of results.jsonl, without its newline (see appendLineSynced). Timing's raw pairs are left out. Bytes that are not
/// UTF-8 (drivers' messages) are replaced. Throws Error when parametersJson is no JSON object.
std::string toJsonLine(const JobRecord& record);

/// The raw pairs of every regime, for the record's side file.
std::string timingPairsJson(const TimeRecord& time);
/// The reverse. Throws on text that timingPairsJson did not write.
std::map<std::string, std::vector<TimedPair>> parseTimingPairs(std::string_view text);

struct ParsedResults {
  std::vector<JobRecord> records;     ///< in the order in which jobs first appear; of a repeated job the last record
  std::vector<std::string> warnings;  ///< one for each line that was passed over: "name:line: what is wrong with it"
};

/// Reads what toJsonLine wrote. A torn tail and damaged lines cost themselves only; unknown keys are passed over.
ParsedResults parseResults(std::string_view text, const std::string& name);

/// parseResults of a file, or of all results*.jsonl of a folder in the order of their names (one a worker), with the warnings
/// logged. A folder without results has no records; a file that cannot be read is an Error.
std::vector<JobRecord> readResults(const std::filesystem::path& path);

}  // namespace gnomon
