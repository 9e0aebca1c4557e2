// All jobs of one light: one session, one reference, then each technique against it.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gnomon/measure/clocks.h"
#include "gnomon/measure/results.h"
#include "gnomon/run/resolve.h"
#include "gnomon/run/trace.h"

namespace gnomon {

struct LightRunOptions {
  std::filesystem::path referenceCache = {};  ///< empty: none
  std::optional<Clock> clock = {};            ///< times are measured with it; empty: no times
  bool timesOnly = false;                     ///< no reference, errors, counters or pictures
  std::filesystem::path imageDirectory = {};  ///< empty: no pictures
  bool exr = false;
  bool checkFinite = false;
  Trace* trace = nullptr;  ///< gets a slice for each step, the passes' too; none of them inside what is timed
};

/// The light at pose p of n of the dynamic regime: turned about its target on a closed path within +-0.5 degrees; pose 0 is
/// the nominal one.
Light lightAtPose(const Light& light, int pose, int poses);

/// Key under which a job's result is kept: the technique's name and a hash of all that decides the result.
std::string jobKey(const ResolvedRun& run, std::size_t light, const ResolvedTechnique& technique);

class LightRun {
 public:
  /// Renders or loads the reference. Throws Error.
  LightRun(const ResolvedRun& run, std::size_t light, Registry& registry, LightRunOptions options);
  ~LightRun();

  bool referenceFromCache() const;
  /// Never throws for what a technique does: a refusal or failure is in the record.
  JobRecord run(const ResolvedTechnique& technique);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gnomon
