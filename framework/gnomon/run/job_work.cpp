#include "gnomon/run/job_work.h"

#include <fmt/format.h>

namespace gnomon {

namespace {

/// One pass's work goes into its own figures and the sums. What was read is known of a frame only if it is of all its shaders.
void addPass(const PassReport& pass, JobWork& work) {
  WorkCounters& sums = work.counters;
  PassWork& own = sums.passes->emplace_back();
  own.name = pass.name;
  own.primitives = pass.work.primitives;
  own.fragments = pass.fragments;
  own.texelsWritten = pass.work.texelsWritten;
  own.bytesWritten = pass.work.bytesWritten;
  own.rays = pass.work.rays;
  *sums.fragments += pass.fragments.value_or(0);
  if (!pass.uncounted.empty() && work.uncounted.empty())
    work.uncounted = fmt::format("texel reads are not known: {}", pass.uncounted);
  if (!pass.reads) return;
  own.texelReads = 0;
  for (const auto& [format, texels] : *pass.reads) {
    *own.texelReads += texels;
    *sums.texelReads += texels;
    (*sums.readsByFormat)[formatFacts(format).name] += texels;
  }
}

}  // namespace

JobWork measureWork(LightStage& stage, Slot slot, const FrameCounters& first) {
  JobWork work;
  WorkCounters& sums = work.counters;
  sums.passesRun = first.passesRun;
  sums.passesSkipped = first.passesSkipped;
  sums.draws = first.draws;
  sums.primitives = first.primitives;
  sums.texelsWritten = first.texelsWritten;
  sums.bytesWritten = first.bytesWritten;
  sums.rays = first.rays;
  sums.fragments = 0;
  sums.texelReads = 0;
  sums.readsByFormat.emplace();
  sums.passes.emplace();
  const GraphReport& report =
      stage.session.runTechnique(slot, {.skipUnchanged = false, .countFragments = true, .countReads = true});
  for (const PassReport& pass : report.passes) addPass(pass, work);
  if (!work.uncounted.empty()) {
    sums.texelReads.reset();
    sums.readsByFormat.reset();
  }
  work.pixelReads = report.pixelReads;
  return work;
}

}  // namespace gnomon
