#include "gnomon/run/light_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>

#include "gnomon/run/perceived.h"

namespace gnomon {

namespace {

std::vector<Light> posesOf(const Light& light, int poses) {
  std::vector<Light> all;
  for (int p = 1; p < poses; ++p) all.push_back(lightAtPose(light, p, poses));
  return all;
}

std::string processorName() {
  std::ifstream file("/proc/cpuinfo");
  std::string line;
  while (std::getline(file, line)) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

SessionSetup sessionSetup(const ResolvedRun& run, std::size_t light) {
  return {run.scene,       run.lights[light],
          run.camera,      run.config.output.size,
          run.config.plan, posesOf(run.lights[light], 2 * posesOf(run.config.measure))};
}

}  // namespace

int posesOf(const MeasureChoice& measure) {
  return std::max(1, measure.frames / (2 * measure.blocks));
}

LightStage::LightStage(const ResolvedRun& r, std::size_t l, Registry& g, LightRunOptions o)
    : run(r),
      light(l),
      registry(g),
      options(std::move(o)),
      session(sessionSetup(r, l)),
      machine{gl::currentContextInfo().renderer, processorName()} {
  if (options.timesOnly) return;
  renderReferences();
  session.runShared();
  receivers = receiverImages(session);
  referenceRecord = gnomon::referenceRecord(session, receivers, reference);
  classes = classesOf(session, receivers, reference.halves);
  Image mean = reference.halves.a;
  for (std::size_t i = 0; i < mean.data.size(); ++i) mean.data[i] = 0.5f * (mean.data[i] + reference.halves.b.data[i]);
  flip.emplace(whitePicture(session, receivers, mean));
}

void LightStage::renderReferences() {
  // A technique whose defences are off is judged by a reference that has its own.
  std::optional<Session> sound;
  if (!run.config.plan.without.empty()) {
    SessionSetup setup = sessionSetup(run, light);
    setup.overrides.without.clear();
    sound.emplace(std::move(setup));
  }
  Session& by = sound ? *sound : session;
  TraceSlice slice(options.trace, "reference");
  reference = renderReference(by, registry, {run.reference, options.referenceCache});
  slice.note("technique", run.reference.name());
  slice.note("from", reference.fromCache ? "cache" : fmt::format("{} rays", reference.rays));
  const TraceSlice inMotion(options.trace, "reference in motion");
  motion = renderMotionReference(by, registry, run, light);
}

}  // namespace gnomon
