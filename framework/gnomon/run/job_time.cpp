#include "gnomon/run/job_time.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "gnomon/base/clock.h"
#include "gnomon/base/statistics.h"
#include "gnomon/run/regime.h"

namespace gnomon {

namespace {

constexpr int kPassTimingFrames = 3;

class JobTimer {
 public:
  explicit JobTimer(LightStage& stage) : stage_(stage), session_(stage.session) {
    if (stage_.options.clock == Clock::gpu) gpuTimer_ = gl::makeQuery(GL_TIME_ELAPSED);
  }

  /// Times the technique's own passes, finished before and after.
  FrameTime timedFrame(Slot slot) {
    session_.runShared();
    glFinish();
    const double cpu = processCpuMs();
    const double wall = wallMs();
    if (gpuTimer_) glBeginQuery(GL_TIME_ELAPSED, gpuTimer_.name());
    session_.runTechnique(slot);
    if (gpuTimer_) glEndQuery(GL_TIME_ELAPSED);
    glFinish();
    FrameTime time{processCpuMs() - cpu, wallMs() - wall};
    if (gpuTimer_) {
      GLuint64 nanoseconds = 0;
      glGetQueryObjectui64v(gpuTimer_.name(), GL_QUERY_RESULT, &nanoseconds);
      time.gpuMs = static_cast<double>(nanoseconds) * 1e-6;
    }
    return time;
  }

  CpuPasses cpuPassesOf(Slot slot) const { return session_.hasCpuPasses(slot) ? CpuPasses::some : CpuPasses::none; }

  TimeRecord time(Slot candidate, std::optional<Slot> baseline) {
    TimeRecord record;
    const Clock clock = clockForPair(*stage_.options.clock, cpuPassesOf(candidate), cpuPassesOf(baseline.value_or(candidate)));
    record.timer = clock;
    const int poses = posesOf(stage_.run.config.measure);
    const TimingPlan plan{.poses = poses, .blocks = stage_.run.config.measure.blocks, .clock = clock};
    for (const std::string& regime : stage_.run.config.measure.regimes) {
      const TraceSlice slice(stage_.options.trace, "time: " + regime, {{"clock", clockName(clock)}});
      RegimePath path(regime, stage_.run, stage_.light);
      PoseSteps steps(poses);
      TimingFigures figures = measurePaired(
          [&](Side side, int pose) {
            // Without a baseline its frames take no time at all, and there is no ratio to nothing.
            if (side == Side::baseline && !baseline) return FrameTime{.gpuMs = gpuTimer_ ? std::optional(0.0) : std::nullopt};
            path.go(session_, steps.next(side, pose), steps.count());
            return timedFrame(side == Side::candidate ? candidate : *baseline);
          },
          plan);
      if (!path.moves()) {  // nothing runs: what a ratio of two nothings says is noise
        figures.ratio.reset();
        figures.ratioCi95.reset();
      }
      record.regimes[regime] = std::move(figures);
      path.home(session_);
    }
    record.passes = passTimes(candidate, poses);
    double sum = 0.0;
    for (const PassTime& pass : record.passes) sum += pass.ms.value_or(0.0);
    record.passSumMs = sum;
    if (const auto dynamic = record.regimes.find("dynamic"); dynamic != record.regimes.end() && dynamic->second.medianMs)
      record.gapMs = sum - *dynamic->second.medianMs;
    record.repeats = 1;
    return record;
  }

  std::vector<PassTime> passTimes(Slot slot, int poses) {
    const TraceSlice slice(stage_.options.trace, "passes", {{"finish", "after each pass: their sum exceeds a timed frame"}});
    struct Times {
      std::string name;
      std::vector<double> own, wall;
    };
    std::vector<Times> times;
    const int positions = std::max(poses, 2);
    RegimePath path("dynamic", stage_.run, stage_.light);
    path.home(session_);
    session_.runShared();
    session_.runTechnique(slot);
    for (int i = 0; i < kPassTimingFrames; ++i) {  // never where the frame before stood: nothing would run
      path.go(session_, (i + 1) % positions, positions);
      session_.runShared();
      glFinish();
      const double start = wallMs();
      const GraphReport report = session_.runTechnique(slot, {.timePasses = true});
      traceFrame(start, wallMs() - start, report);
      times.resize(report.passes.size());
      for (std::size_t p = 0; p < report.passes.size(); ++p) {
        times[p].name = report.passes[p].name;
        times[p].own.push_back(stage_.options.clock == Clock::cpu ? report.passes[p].cpuMs : report.passes[p].wallMs);
        times[p].wall.push_back(report.passes[p].wallMs);
      }
    }
    path.home(session_);
    std::vector<PassTime> passes;
    for (const Times& t : times) passes.push_back({t.name, median(t.own), median(t.wall)});
    return passes;
  }

  /// Passes ran one after the other, each to its finish: each begins where the one before it ended.
  void traceFrame(double startMs, double durationMs, const GraphReport& report) const {
    if (stage_.options.trace == nullptr) return;
    stage_.options.trace->add("frame", startMs, durationMs);
    for (const PassReport& pass : report.passes) {
      if (!pass.ran) continue;
      stage_.options.trace->add(pass.name, startMs, pass.wallMs, {{"cpu_ms", fmt::format("{:.4f}", pass.cpuMs)}});
      startMs += pass.wallMs;
    }
  }

 private:
  LightStage& stage_;
  Session& session_;
  gl::QueryObject gpuTimer_;  ///< only where the GPU's timer is believed
};

}  // namespace

TimeRecord measureTime(LightStage& stage, Slot candidate, std::optional<Slot> baseline) {
  return JobTimer(stage).time(candidate, baseline);
}

}  // namespace gnomon
