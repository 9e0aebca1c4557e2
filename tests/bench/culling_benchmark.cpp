// What culling and fitting are worth in the frame they are made for: configs/culling.json.
#include <fmt/format.h>

#include "benchmark.h"
#include "gnomon/measure/error.h"
#include "gnomon/run/reference.h"
#include "render.h"

namespace gnomon::bench {

namespace {

constexpr int kReferenceSamples = 64;  // both sides are judged by the same reference, whose noise they share

ResolvedRun cullingRun(bool smoke) {
  Problems problems;
  std::vector<ResolvedRun> runs =
      resolveRuns(std::filesystem::path(GNOMON_SOURCE_DIR) / "configs" / "culling.json", test::registry(), problems);
  problems.throwIfAny();
  ResolvedRun run = std::move(runs.at(0));
  if (smoke) run.config.output.size = {64, 48};
  return run;
}

SessionSetup setupOf(const ResolvedRun& run, Toggle toggle) {
  SessionSetup setup{run.scene, run.lights.at(0), run.camera, run.config.output.size, run.config.plan, {}};
  setup.overrides[Rule::culling] = toggle;
  setup.overrides[Rule::fitting] = toggle;
  return setup;
}

double meanSquaredError(Session& session, Slot slot, const RenderedReference& reference) {
  session.frame(slot);
  const Image classes = classesOf(session, receiverImages(session), reference.halves);
  const ErrorFigures error = measureError(session.visibility(slot), reference.halves.a, reference.halves.b, classes);
  if (!error.mse) throw Error("no receiver is in view");
  return *error.mse;
}

TimingFigures offAgainstOn(const Effort& effort) {
  const ResolvedRun run = cullingRun(effort.smoke);
  const ResolvedTechnique& technique = run.jobs.at(0).technique;
  Session on(setupOf(run, Toggle::on));
  Session off(setupOf(run, Toggle::off));
  const ResolvedTechnique judge = copyOf(run.reference, test::registry());
  if (int* samples = reservedParameter(judge, "samples")) *samples = effort.smoke ? 2 : kReferenceSamples;
  const RenderedReference reference = renderReference(on, test::registry(), {judge, {}});
  on.removeSlots();
  const Slot withRules = on.addSlot(technique.technique, technique.parameters);
  const Slot without = off.addSlot(technique.technique, technique.parameters);
  const double errorOn = meanSquaredError(on, withRules, reference);
  const double errorOff = meanSquaredError(off, without, reference);
  if (errorOn > errorOff) {
    throw Error(fmt::format("{}: the mean squared error is {:.6g} with culling and fitting, {:.6g} without", technique.name(),
                            errorOn, errorOff));
  }

  const TimingPlan plan = timingPlan(effort, 6);
  PoseSteps steps(plan.poses);
  return measurePaired(
      [&](Side side, int pose) {
        Session& session = side == Side::candidate ? off : on;
        const Slot slot = side == Side::candidate ? without : withRules;
        const int step = steps.next(side, pose);
        return timed([&] {
          moveTo(session, run.lights[0], run.camera, step, steps.count());
          session.frame(slot);
        });
      },
      plan);
}

}  // namespace

std::vector<Benchmark> cullingBenchmarks() {
  return {{.name = "culling_off_over_on",
           .meaning = "shadow_map in configs/culling.json: a whole frame with culling and fitting off / with both on",
           .unit = {},
           .bound = Bound::atLeast,
           .limit = 1.2,
           .run = offAgainstOn}};
}

}  // namespace gnomon::bench
