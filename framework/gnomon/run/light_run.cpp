#include "gnomon/run/light_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "gnomon/base/files.h"
#include "gnomon/measure/error.h"
#include "gnomon/run/job_time.h"
#include "gnomon/run/job_work.h"
#include "gnomon/run/perceived.h"
#include "gnomon/run/pictures.h"
#include "gnomon/run/shimmer.h"

namespace gnomon {

namespace {

std::vector<PlanEntry> planEntries(const EffectPlan& plan) {
  std::vector<PlanEntry> entries;
  for (const PlanDecision& d : plan.decisions) {
    entries.push_back({d.name, d.on, d.reason, std::isfinite(d.value) ? std::optional<double>(d.value) : std::nullopt});
  }
  return entries;
}

/// Rounding may carry V this far out of [0,1]: two units in the last place of a half float at 1.
constexpr float kRounding = 2.0f / 1024.0f;

/// What the record says of values that no visibility has; empty if there are none.
std::string impossibleValues(const Image& visibility) {
  const auto isPossible = [](float v) { return v >= -kRounding && v <= 1.0f + kRounding; };  // NaN is not
  const auto first = std::find_if_not(visibility.data.begin(), visibility.data.end(), isPossible);
  if (first == visibility.data.end()) return {};
  const auto at = first - visibility.data.begin();
  return fmt::format("V is {} at pixel ({}, {}), and outside [0,1] at {} pixels", *first, at % visibility.width,
                     at / visibility.width,
                     std::count_if(first, visibility.data.end(), [&](float v) { return !isPossible(v); }));
}

}  // namespace

struct LightRun::State : LightStage {
  using LightStage::LightStage;

  void measure(JobRecord& record, const ResolvedTechnique& technique) {
    session.removeSlots();
    session.moveLight(nominal());
    const Slot slot = traced("set-up", [&] { return session.addSlot(technique.technique, technique.parameters); });
    if (!session.support(slot).ok()) {
      record.status = JobStatus::refused;
      record.reason = session.support(slot).refusal;
      return;
    }
    Image visibility;
    const FrameReport frame = traced("first frame", [&] {  // what it draws with is compiled in it
      FrameReport report = session.frame(slot, graphRun());
      visibility = session.visibility(slot);
      return report;
    });
    record.reason = impossibleValues(visibility);
    record.memoryBytes = session.memoryBytes(slot);
    if (!options.timesOnly) judge(record, slot, visibility, frame);
    if (options.clock) time(record, slot);
  }

  void judge(JobRecord& record, Slot slot, const Image& visibility, const FrameReport& frame) {
    record.reference = referenceRecord;
    traced("error", [&] {
      record.error = measureError(visibility, reference.halves.a, reference.halves.b, classes);
      record.splits = measureSplits({visibility, reference.halves.a, reference.halves.b, classes, receivers.positions,
                                     receivers.normals, nominal(), run.camera.position});
    });
    record.flip =
        traced("flip", [&] { return flipFigures((*flip)(whitePicture(session, receivers, visibility)), receivers.mask); });
    JobWork work = traced("work", [&] { return measureWork(*this, slot, frame.technique.counters); });
    record.work = std::move(work.counters);
    if (record.reason.empty()) record.reason = work.uncounted;
    if (!options.imageDirectory.empty()) {
      const TraceSlice slice(options.trace, "pictures");
      const Image shaded = session.shaded(slot);
      writePictures(options.imageDirectory, record.job, run.config.output.images, options.exr,
                    {shaded, visibility, reference.halves, receivers.mask, classes, receivers.positions, receivers.normals,
                     work.pixelReads, reference.standardError, reference.cosineVisibility},
                    session);
    }
    record.splits->shimmer = traced("shimmer", [&] { return measureShimmer(session, slot, run, light, motion); });
  }

  void time(JobRecord& record, Slot slot) {
    const Slot baseline =
        traced("baseline's set-up", [&] { return session.addSlot(run.baseline.technique, run.baseline.parameters); });
    const std::string& refusal = session.support(baseline).refusal;
    record.time = measureTime(*this, slot, refusal.empty() ? std::optional(baseline) : std::nullopt);
    if (!refusal.empty() && record.reason.empty())
      record.reason = fmt::format("no ratio: the baseline '{}' refuses this light: {}", run.baseline.name(), refusal);
  }
};

LightRun::LightRun(const ResolvedRun& run, std::size_t light, Registry& registry, LightRunOptions options)
    : state_(std::make_unique<State>(run, light, registry, std::move(options))) {}
LightRun::~LightRun() = default;

bool LightRun::referenceFromCache() const {
  return state_->reference.fromCache;
}

JobRecord LightRun::run(const ResolvedTechnique& technique) {
  State& s = *state_;
  JobRecord record;
  record.job = jobKey(s.run, s.light, technique);
  record.config = s.run.config.name;
  record.scene = s.run.sceneName;
  record.light = static_cast<int>(s.light);
  record.technique = technique.name();
  record.parametersJson = technique.parametersJson().dump();
  record.plan = planEntries(s.session.plan());
  record.without = s.run.config.plan.without;
  record.machine = s.machine;
  try {
    s.measure(record, technique);
  } catch (const std::exception& error) {
    record.status = JobStatus::failed;
    record.reason = error.what();
  }
  return record;
}

std::string jobKey(const ResolvedRun& run, std::size_t light, const ResolvedTechnique& technique) {
  const Light bare = withoutName(run.lights[light]);
  const std::string decides = fmt::format(
      "{}\n{}\n{}\n{}x{}\n{} {}\n{} {}\n{} {}\n{} {} {} {} {}", contentHash(run.scene),
      writeObject(*lightTable(), &bare).dump(), writeObject(*cameraTable(), &run.camera).dump(), run.config.output.size.x,
      run.config.output.size.y, technique.name(), technique.parametersJson().dump(), run.reference.name(),
      run.reference.parametersJson().dump(), run.baseline.name(), run.baseline.parametersJson().dump(),
      writeObject(*planOverridesTable(), &run.config.plan).dump(), run.config.measure.frames, run.config.measure.blocks,
      fmt::join(run.config.measure.regimes, " "), run.config.measure.shimmerFrames);
  return technique.name() + "-" + hashHex(decides).substr(0, 16);
}

}  // namespace gnomon
