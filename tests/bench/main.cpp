// gnomon_bench: what the framework costs beside the same work written by hand.
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <exception>

#include "benchmark.h"
#include "gnomon/base/clock.h"
#include "gnomon/gl/context.h"
#include "gnomon/run/light_run.h"
#include "gnomon/scene/builtin.h"

namespace gnomon::bench {

TimingPlan timingPlan(const Effort& effort, int poses) {
  if (effort.smoke) return {.poses = 1, .blocks = 1, .warmup = 0, .clock = Clock::cpu};
  return {.poses = poses, .blocks = 3, .clock = Clock::cpu, .halfWidth = kHalfWidth, .seconds = effort.seconds};
}

SessionSetup sceneSetup(const std::string& name, glm::ivec2 size) {
  const BuiltinScene* builtin = findBuiltinScene(name);
  if (builtin == nullptr) throw Error("no built-in scene '" + name + "'");
  SessionSetup setup;
  setup.scene = builtin->make(builtin->defaults);
  setup.light = setup.scene.lights.at(0);
  setup.camera = setup.scene.camera.value();
  setup.outputSize = size;
  return setup;
}

void moveTo(Session& session, const Light& light, const Camera& camera, int step, int steps) {
  session.moveLight(lightAtPose(light, step, steps));
  Camera aside = camera;
  aside.position.x += 0.01 * step;
  session.moveCamera(aside);
}

FrameTime timed(const std::function<void()>& work) {
  glFinish();
  const double cpu = processCpuMs();
  const double wall = wallMs();
  work();
  glFinish();
  return {processCpuMs() - cpu, wallMs() - wall};
}

namespace {

/// Runnable processes, averaged over the last minute: other work shares caches and memory even where it takes no CPU time.
double load() {
  double oneMinute = 0.0;
  return getloadavg(&oneMinute, 1) == 1 ? oneMinute : 0.0;
}

/// One line of the result; whether the limit holds. Ratios are of the candidate to the baseline, others the candidate's time.
bool report(const Benchmark& benchmark, const TimingFigures& figures, bool details) {
  const bool isRatio = benchmark.unit.empty();
  const std::optional<double> value = isRatio ? figures.ratio : figures.medianMs;
  const std::optional<Interval> interval = isRatio ? figures.ratioCi95 : figures.ci95Ms;
  if (!value || !interval) throw Error("the clock is too coarse for what was timed");
  const bool ok = benchmark.bound == Bound::atMost ? *value <= benchmark.limit : *value >= benchmark.limit;
  fmt::print("{:<28} {:>8.4f}{} +-{:.4f}  limit {} {}{}  {}\n", benchmark.name, *value, benchmark.unit,
             0.5 * (interval->high - interval->low), benchmark.bound == Bound::atMost ? "<=" : ">=", benchmark.limit,
             benchmark.unit, ok ? "ok" : "NOT OK");
  if (details) {
    fmt::print("    {}\n    median {:.4g} ms, wall {:.4g} ms, {} pairs, load {:.1f}\n", benchmark.meaning, *figures.medianMs,
               *figures.wallMedianMs, figures.pairs.size(), load());
  }
  std::fflush(stdout);
  return ok;
}

std::vector<Benchmark> allBenchmarks() {
  std::vector<Benchmark> all;
  for (const auto& part : {frameBenchmarks(), cullingBenchmarks(), graphBenchmarks(), rayBenchmarks()}) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

int run(int argc, char** argv) {
  CLI::App app{"Process CPU time against the same work written by hand, with limits.", "gnomon_bench"};
  app.footer("Exit codes: 0 all within their limits, 1 some are not, 2 a comparison is void or cannot be made.");
  Effort effort;
  bool ratios = false;
  bool list = false;
  std::string only;
  app.add_flag("--ratios", ratios, "one line each: name, ratio, half width of its 95 % interval, limit, ok or not");
  app.add_flag("--smoke", effort.smoke, "one tiny iteration each: checks what is compared, judges no time");
  app.add_flag("--list", list, "names and meanings alone");
  app.add_option("--only", only, "benchmarks whose name holds this text");
  app.add_option("--seconds", effort.seconds, "most wall time for each, after three blocks")
      ->check(CLI::Range(0.001, 86400.0))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  const gl::HeadlessContext context;  // not one for debugging: that is slower
  if (!ratios && !list) fmt::print("process CPU time on all cores; load {:.1f} when it began\n", load());
  int exitCode = 0;
  bool any = false;
  for (const Benchmark& benchmark : allBenchmarks()) {
    if (benchmark.name.find(only) == std::string::npos) continue;
    any = true;
    if (list) {
      fmt::print("{:<28} {}\n", benchmark.name, benchmark.meaning);
      continue;
    }
    try {
      const TimingFigures figures = benchmark.run(effort);
      if (effort.smoke) {
        fmt::print("{:<28} the same on both sides\n", benchmark.name);
      } else if (!report(benchmark, figures, !ratios)) {
        exitCode = std::max(exitCode, 1);
      }
    } catch (const NotHere& reason) {
      fmt::print("{:<28} not here: {}\n", benchmark.name, reason.what());
    } catch (const std::exception& error) {
      fmt::print("{:<28} void: {}\n", benchmark.name, error.what());
      exitCode = 2;
    }
  }
  if (!any) throw Error("no benchmark's name holds '" + only + "'; see --list");
  return exitCode;
}

}  // namespace
}  // namespace gnomon::bench

int main(int argc, char** argv) {
  try {
    return gnomon::bench::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 2;
  }
}
