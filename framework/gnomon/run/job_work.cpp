#include "gnomon/run/job_work.h"

namespace gnomon {

WorkCounters measureWork(LightStage& stage, Slot slot, const FrameCounters& first) {
  WorkCounters work;
  work.passesRun = first.passesRun;
  work.passesSkipped = first.passesSkipped;
  work.draws = first.draws;
  work.primitives = first.primitives;
  work.texelsWritten = first.texelsWritten;
  work.rays = first.rays;
  const GraphReport& report = stage.session.runTechnique(slot, {.skipUnchanged = false, .countFragments = true});
  work.fragments = 0;
  for (const PassReport& pass : report.passes) {
    PassWork& one = work.passes.has_value() ? work.passes->emplace_back() : work.passes.emplace().emplace_back();
    one.name = pass.name;
    one.primitives = pass.work.primitives;
    one.fragments = pass.fragments;
    one.texelsWritten = pass.work.texelsWritten;
    one.rays = pass.work.rays;
    *work.fragments += pass.fragments.value_or(0);
  }
  return work;
}

}  // namespace gnomon
