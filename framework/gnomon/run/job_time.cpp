#include "gnomon/run/job_time.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include "gnomon/base/clock.h"
#include "gnomon/base/statistics.h"

namespace gnomon {

namespace {

constexpr double kTurnDegrees = 0.5;
constexpr int kPassTimingFrames = 3;

class JobTimer {
 public:
  explicit JobTimer(LightStage& stage) : stage_(stage), session_(stage.session) {
    if (stage_.options.clock == Clock::gpu) gpuTimer_ = gl::makeQuery(GL_TIME_ELAPSED);
  }

  /// Moves the light and times the technique's own passes, finished before and after.
  FrameTime timedFrame(Slot slot, const Light& pose) {
    session_.moveLight(pose);
    return timedFrame(slot);
  }
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

  TimeRecord time(Slot candidate, Slot baseline) {
    TimeRecord record;
    const Clock clock = clockForPair(*stage_.options.clock, cpuPassesOf(candidate), cpuPassesOf(baseline));
    record.timer = clock;
    const int poses = posesOf(stage_.run.config.measure);
    const TimingPlan plan{.poses = poses, .blocks = stage_.run.config.measure.blocks, .clock = clock};
    for (const std::string& regime : stage_.run.config.measure.regimes) {
      const bool moving = regime == "dynamic";
      const TraceSlice slice(stage_.options.trace, "time: " + regime, {{"clock", clockName(clock)}});
      session_.moveLight(stage_.nominal());
      PoseSteps steps(poses);
      TimingFigures figures = measurePaired(
          [&](Side side, int pose) {
            const Slot slot = side == Side::candidate ? candidate : baseline;
            return moving ? timedFrame(slot, lightAtPose(stage_.nominal(), steps.next(side, pose), steps.count()))
                          : timedFrame(slot);
          },
          plan);
      if (!moving) {  // nothing runs: what a ratio of two nothings says is noise
        figures.ratio.reset();
        figures.ratioCi95.reset();
      }
      record.regimes[regime] = std::move(figures);
    }
    record.passes = passTimes(candidate, poses);
    session_.moveLight(stage_.nominal());
    return record;
  }

  std::vector<PassTime> passTimes(Slot slot, int poses) {
    const TraceSlice slice(stage_.options.trace, "passes", {{"finish", "after each pass: their sum exceeds a timed frame"}});
    std::vector<std::string> names;
    std::vector<std::vector<double>> times;
    const int positions = std::max(poses, 2);
    session_.moveLight(stage_.nominal());
    session_.runShared();
    session_.runTechnique(slot);
    for (int i = 0; i < kPassTimingFrames; ++i) {  // never where the frame before stood: nothing would run
      session_.moveLight(lightAtPose(stage_.nominal(), (i + 1) % positions, positions));
      session_.runShared();
      glFinish();
      const double start = wallMs();
      const GraphReport report = session_.runTechnique(slot, {.timePasses = true});
      traceFrame(start, wallMs() - start, report);
      times.resize(report.passes.size());
      names.resize(report.passes.size());
      for (std::size_t p = 0; p < report.passes.size(); ++p) {
        names[p] = report.passes[p].name;
        times[p].push_back(stage_.options.clock == Clock::cpu ? report.passes[p].cpuMs : report.passes[p].wallMs);
      }
    }
    std::vector<PassTime> passes;
    for (std::size_t p = 0; p < names.size(); ++p) passes.push_back({names[p], median(times[p])});
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

TimeRecord measureTime(LightStage& stage, Slot candidate, Slot baseline) {
  return JobTimer(stage).time(candidate, baseline);
}

}  // namespace gnomon
