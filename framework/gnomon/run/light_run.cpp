#include "gnomon/run/light_run.h"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>
#include <nlohmann/json.hpp>

#include "gnomon/base/clock.h"
#include "gnomon/base/files.h"
#include "gnomon/base/statistics.h"
#include "gnomon/measure/error.h"
#include "gnomon/run/pictures.h"
#include "gnomon/run/reference.h"
#include "gnomon/session.h"

namespace gnomon {

namespace {

constexpr double kTurnDegrees = 0.5;
constexpr int kPassTimingFrames = 3;

int posesOf(const MeasureChoice& measure) {
  return std::max(1, measure.frames / (2 * measure.blocks));
}

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

std::vector<PlanEntry> planEntries(const EffectPlan& plan) {
  std::vector<PlanEntry> entries;
  for (const PlanDecision& d : plan.decisions) {
    entries.push_back({d.name, d.on, d.reason, std::isfinite(d.value) ? std::optional<double>(d.value) : std::nullopt});
  }
  return entries;
}

SessionSetup sessionSetup(const ResolvedRun& run, std::size_t light) {
  return {run.scene,       run.lights[light],
          run.camera,      run.config.output.size,
          run.config.plan, posesOf(run.lights[light], 2 * posesOf(run.config.measure))};
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

Light lightAtPose(const Light& light, int pose, int poses) {
  const double phase = 2.0 * glm::pi<double>() * pose / poses;
  // A circle through the nominal pose: never farther from it than its diameter.
  const double yaw = 0.5 * kTurnDegrees * std::sin(phase);
  const double pitch = 0.5 * kTurnDegrees * (1.0 - std::cos(phase));
  const LightFrame axes = lightFrame(light);
  const glm::dquat turn = glm::angleAxis(glm::radians(yaw), axes.y) * glm::angleAxis(glm::radians(pitch), axes.x);
  Light turned = light;
  turned.position = light.target + turn * (light.position - light.target);
  return turned;
}

struct LightRun::State {
  const ResolvedRun& run;
  std::size_t light;
  Registry& registry;
  LightRunOptions options;
  Session session;
  RenderedReference reference;
  ReceiverImages receivers;
  Image classes;
  MachineRecord machine;
  gl::QueryObject gpuTimer;  ///< only where the GPU's timer is believed

  State(const ResolvedRun& r, std::size_t l, Registry& g, LightRunOptions o)
      : run(r),
        light(l),
        registry(g),
        options(std::move(o)),
        session(sessionSetup(r, l)),
        reference(tracedReference()),
        machine{gl::currentContextInfo().renderer, processorName()} {
    session.runShared();
    receivers = receiverImages(session);
    classes = classesOf(session, receivers, reference.halves);
    if (options.clock == Clock::gpu) gpuTimer = gl::makeQuery(GL_TIME_ELAPSED);
  }

  /// Does the work inside a slice of the trace.
  template <class Work>
  auto traced(const std::string& name, const Work& work) const {
    const TraceSlice slice(options.trace, name);
    return work();
  }

  /// A technique whose defences are off is judged by a reference that has its own.
  RenderedReference soundReference() {
    const ReferenceRequest request{run.reference, options.referenceCache};
    if (run.config.plan.without.empty()) return renderReference(session, registry, request);
    SessionSetup setup = sessionSetup(run, light);
    setup.overrides.without.clear();
    Session sound(std::move(setup));
    return renderReference(sound, registry, request);
  }

  RenderedReference tracedReference() {
    TraceSlice slice(options.trace, "reference");
    RenderedReference rendered = soundReference();
    slice.note("technique", run.reference.name());
    slice.note("from", rendered.fromCache ? "cache" : fmt::format("{} rays", rendered.rays));
    return rendered;
  }

  const Light& nominal() const { return run.lights[light]; }
  GraphRun graphRun() const { return {.checkFinite = options.checkFinite}; }

  /// Moves the light and times the technique's own passes, finished before and after.
  FrameTime timedFrame(Slot slot, const Light& pose) {
    session.moveLight(pose);
    return timedFrame(slot);
  }
  FrameTime timedFrame(Slot slot) {
    session.runShared();
    glFinish();
    const double cpu = processCpuMs();
    const double wall = wallMs();
    if (gpuTimer) glBeginQuery(GL_TIME_ELAPSED, gpuTimer.name());
    session.runTechnique(slot);
    if (gpuTimer) glEndQuery(GL_TIME_ELAPSED);
    glFinish();
    FrameTime time{processCpuMs() - cpu, wallMs() - wall};
    if (gpuTimer) {
      GLuint64 nanoseconds = 0;
      glGetQueryObjectui64v(gpuTimer.name(), GL_QUERY_RESULT, &nanoseconds);
      time.gpuMs = static_cast<double>(nanoseconds) * 1e-6;
    }
    return time;
  }

  CpuPasses cpuPassesOf(Slot slot) const { return session.hasCpuPasses(slot) ? CpuPasses::some : CpuPasses::none; }

  TimeRecord time(Slot candidate, Slot baseline) {
    TimeRecord record;
    const Clock clock = clockForPair(*options.clock, cpuPassesOf(candidate), cpuPassesOf(baseline));
    record.timer = clock;
    const int poses = posesOf(run.config.measure);
    const TimingPlan plan{.poses = poses, .blocks = run.config.measure.blocks, .clock = clock};
    for (const std::string& regime : run.config.measure.regimes) {
      const bool moving = regime == "dynamic";
      const TraceSlice slice(options.trace, "time: " + regime, {{"clock", clockName(clock)}});
      session.moveLight(nominal());
      PoseSteps steps(poses);
      TimingFigures figures = measurePaired(
          [&](Side side, int pose) {
            const Slot slot = side == Side::candidate ? candidate : baseline;
            return moving ? timedFrame(slot, lightAtPose(nominal(), steps.next(side, pose), steps.count())) : timedFrame(slot);
          },
          plan);
      if (!moving) {  // nothing runs: what a ratio of two nothings says is noise
        figures.ratio.reset();
        figures.ratioCi95.reset();
      }
      record.regimes[regime] = std::move(figures);
    }
    record.passes = passTimes(candidate, poses);
    session.moveLight(nominal());
    return record;
  }

  std::vector<PassTime> passTimes(Slot slot, int poses) {
    const TraceSlice slice(options.trace, "passes", {{"finish", "after each pass: their sum exceeds a timed frame"}});
    std::vector<std::string> names;
    std::vector<std::vector<double>> times;
    const int positions = std::max(poses, 2);
    session.moveLight(nominal());
    session.runShared();
    session.runTechnique(slot);
    for (int i = 0; i < kPassTimingFrames; ++i) {  // never where the frame before stood: nothing would run
      session.moveLight(lightAtPose(nominal(), (i + 1) % positions, positions));
      session.runShared();
      glFinish();
      const double start = wallMs();
      const GraphReport report = session.runTechnique(slot, {.timePasses = true});
      traceFrame(start, wallMs() - start, report);
      times.resize(report.passes.size());
      names.resize(report.passes.size());
      for (std::size_t p = 0; p < report.passes.size(); ++p) {
        names[p] = report.passes[p].name;
        times[p].push_back(options.clock == Clock::cpu ? report.passes[p].cpuMs : report.passes[p].wallMs);
      }
    }
    std::vector<PassTime> passes;
    for (std::size_t p = 0; p < names.size(); ++p) passes.push_back({names[p], median(times[p])});
    return passes;
  }

  /// Passes ran one after the other, each to its finish: each begins where the one before it ended.
  void traceFrame(double startMs, double durationMs, const GraphReport& report) const {
    if (options.trace == nullptr) return;
    options.trace->add("frame", startMs, durationMs);
    for (const PassReport& pass : report.passes) {
      if (!pass.ran) continue;
      options.trace->add(pass.name, startMs, pass.wallMs, {{"cpu_ms", fmt::format("{:.4f}", pass.cpuMs)}});
      startMs += pass.wallMs;
    }
  }

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
    record.error = measureError(visibility, reference.halves.a, reference.halves.b, classes);
    const FrameCounters& c = frame.technique.counters;
    record.work.passesRun = c.passesRun;
    record.work.passesSkipped = c.passesSkipped;
    record.work.draws = c.draws;
    record.work.primitives = c.primitives;
    record.work.texelsWritten = c.texelsWritten;
    record.work.rays = c.rays;
    record.memoryBytes = session.memoryBytes(slot);
    if (!options.imageDirectory.empty()) {
      const TraceSlice slice(options.trace, "pictures");
      const Image shaded = session.shaded(slot);
      writePictures(options.imageDirectory, record.job, run.config.output.images, options.exr,
                    {shaded, visibility, reference.halves, receivers.mask, classes, receivers.positions, receivers.normals},
                    session);
    }
    if (options.clock) {
      const Slot baseline =
          traced("baseline's set-up", [&] { return session.addSlot(run.baseline.technique, run.baseline.parameters); });
      if (session.support(baseline).ok()) record.time = time(slot, baseline);
    }
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
      "{}\n{}\n{}\n{}x{}\n{} {}\n{} {}\n{} {}\n{} {} {} {}", contentHash(run.scene), writeObject(*lightTable(), &bare).dump(),
      writeObject(*cameraTable(), &run.camera).dump(), run.config.output.size.x, run.config.output.size.y, technique.name(),
      technique.parametersJson().dump(), run.reference.name(), run.reference.parametersJson().dump(), run.baseline.name(),
      run.baseline.parametersJson().dump(), writeObject(*planOverridesTable(), &run.config.plan).dump(),
      run.config.measure.frames, run.config.measure.blocks, fmt::join(run.config.measure.regimes, " "));
  return technique.name() + "-" + hashHex(decides).substr(0, 16);
}

}  // namespace gnomon
