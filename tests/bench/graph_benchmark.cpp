// The graph's own cost: forty cpu passes that do nothing, each of which has to run.
#include <fmt/format.h>

#include "benchmark.h"
#include "gnomon/graph/graph.h"
#include "gnomon/scene/survey.h"
#include "render.h"

namespace gnomon::bench {

namespace {

constexpr int kPasses = 40;

/// A chain: each pass writes a block that the next one runs after, the last one the output.
Texture declareChain(GraphBuilder& graph, int& runs) {
  const Texture output = graph.texture("output", {{1, 1}, Format::r8});
  Buffer before;
  for (int i = 0; i < kPasses; ++i) {
    CpuPass pass{.inputs = {Input::light}, .run = [&runs](CpuContext&) { ++runs; }};
    if (before) pass.after = {before};
    if (i == kPasses - 1) {
      pass.writes = {output};
    } else {
      before = graph.buffer(fmt::format("block {}", i), 16);
      pass.buffers = {before};
    }
    graph.cpu(fmt::format("pass {}", i), pass);
  }
  return output;
}

TimingFigures emptyPasses(const Effort& effort) {
  const SessionSetup setup = sceneSetup("half_plane", {8, 8});
  std::vector<Bounds> bounds;
  for (const Instance& instance : setup.scene.instances) bounds.push_back(worldBounds(setup.scene, instance));
  const GpuScene gpu(setup.scene);
  const FrameInputs inputs{setup.scene, bounds, gpu, setup.light, setup.camera, setup.outputSize, 0.0};

  gl::DebugMessages messages;
  int runs = 0;
  Graph graph("chain", setup.outputSize, {});
  const Texture output = declareChain(graph.builder(), runs);
  graph.compile(std::span(&output, 1));
  Revisions revisions;
  const auto frame = [&] {
    ++revisions[Input::light];
    graph.run(inputs, revisions, {.messages = &messages});
  };
  // A frame is shorter than the clocks' grain: many are timed as one. Both sides are the same: only their time is wanted.
  const int frames = effort.smoke ? 1 : 1000;
  return measurePaired(
      [&](Side, int) {
        runs = 0;
        FrameTime time = timed([&] {
          for (int i = 0; i < frames; ++i) frame();
        });
        if (runs != frames * kPasses) throw Error(fmt::format("{} of {} passes ran", runs, frames * kPasses));
        time.cpuMs /= frames;
        time.wallMs /= frames;
        return time;
      },
      timingPlan(effort, 2));
}

}  // namespace

std::vector<Benchmark> graphBenchmarks() {
  return {{.name = "graph_40_empty_passes",
           .meaning = fmt::format("process CPU time of a frame of {} cpu passes that do nothing", kPasses),
           .unit = " ms",
           .bound = Bound::atMost,
           .limit = 0.1,
           .run = emptyPasses}};
}

}  // namespace gnomon::bench
