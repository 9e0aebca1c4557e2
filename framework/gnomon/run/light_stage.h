// What the jobs of one light share: a session, a reference, what pixels are judged by. Internal to run/.
#pragma once

#include <optional>
#include <string>

#include "gnomon/measure/flip.h"
#include "gnomon/run/light_run.h"
#include "gnomon/run/reference.h"
#include "gnomon/run/shimmer.h"
#include "gnomon/session.h"

namespace gnomon {

struct LightStage {
  const ResolvedRun& run;
  std::size_t light;
  Registry& registry;
  LightRunOptions options;
  Session session;
  RenderedReference reference;  ///< as all below but the machine: nothing where only times are measured
  ReferenceRecord referenceRecord;
  MotionReference motion;
  ReceiverImages receivers;
  Image classes;
  std::optional<HdrFlip> flip;  ///< of whitePicture, against that of the mean of the reference's halves
  MachineRecord machine;

  /// Renders or loads the references. Throws Error.
  LightStage(const ResolvedRun& r, std::size_t l, Registry& g, LightRunOptions o);

  const Light& nominal() const { return run.lights[light]; }
  GraphRun graphRun() const { return {.checkFinite = options.checkFinite}; }

  /// Does the work inside a slice of the trace.
  template <class Work>
  auto traced(const std::string& name, const Work& work) const {
    const TraceSlice slice(options.trace, name);
    return work();
  }

 private:
  void renderReferences();
};

/// How many poses a regime's path has.
int posesOf(const MeasureChoice& measure);

}  // namespace gnomon
