// A session's whole frame against the same passes in bare OpenGL.
#include <fmt/format.h>

#include <cstring>

#include "bare_frame.h"
#include "benchmark.h"
#include "render.h"

namespace gnomon::bench {

namespace {

struct FrameCase {
  std::string technique;
  std::string parameters;
  int poses = 3;
};

void requireSameBits(const Image& a, const Image& b, const std::string& name, int step) {
  if (a.data.size() == b.data.size() && std::memcmp(a.data.data(), b.data.data(), a.data.size() * sizeof(float)) == 0) return;
  throw Error(fmt::format("{}: at step {} the bare program's visibility is not the session's", name, step));
}

TimingFigures sessionAgainstBare(const FrameCase& what, const Effort& effort) {
  const SessionSetup setup = sceneSetup("sphere_grid", effort.smoke ? glm::ivec2(64, 48) : glm::ivec2(800, 600));
  const TimingPlan plan = timingPlan(effort, what.poses);
  PoseSteps steps(plan.poses);
  Session session(setup);
  const Slot slot = test::addSlot(session, what.technique, what.parameters);
  session.runShared();
  session.runTechnique(slot);

  BareFrame bare(session, slot, what.technique);
  const auto drawBySession = [&](int step) {
    moveTo(session, setup.light, setup.camera, step, steps.count());
    const std::uint64_t shared = session.runShared().counters.primitives;
    const std::uint64_t own = session.runTechnique(slot).counters.primitives;
    return shared + own;
  };
  const auto requireWhole = [&](std::uint64_t primitives) {  // nothing was culled, nothing was skipped
    if (primitives == bare.primitives()) return;
    throw Error(
        fmt::format("{}: the session draws {} triangles, the bare program {}", what.technique, primitives, bare.primitives()));
  };
  std::vector<BarePose> recorded;
  drawBySession(1);
  for (int step = 0; step < steps.count(); ++step) {
    requireWhole(drawBySession(step));
    recorded.push_back(bare.pose(session));
    bare.draw(recorded.back());
    requireSameBits(session.visibility(slot), bare.visibility(), what.technique, step);
  }

  return measurePaired(
      [&](Side side, int pose) {
        const int step = steps.next(side, pose);
        if (side == Side::baseline) return timed([&] { bare.draw(recorded[static_cast<std::size_t>(step)]); });
        std::uint64_t primitives = 0;
        const FrameTime time = timed([&] { primitives = drawBySession(step); });
        requireWhole(primitives);
        return time;
      },
      plan);
}

Benchmark frameBenchmark(const std::string& name, const FrameCase& what) {
  return {
      .name = name,
      .meaning = fmt::format("{} {} on sphere_grid, 800x600: G-buffer, mask, depth and filter by a session / in bare OpenGL",
                             what.technique, what.parameters),
      .unit = {},
      .bound = Bound::atMost,
      .limit = 1.05,
      .run = [what](const Effort& effort) { return sessionAgainstBare(what, effort); }};
}

}  // namespace

std::vector<Benchmark> frameBenchmarks() {
  return {frameBenchmark("frame_shadow_map_1024", {"shadow_map", R"({"map_size": 1024})"}),
          frameBenchmark("frame_pcf_9x9", {"pcf", R"({"map_size": 1024, "taps": 9})"}),
          frameBenchmark("frame_pcf_19x19", {"pcf", R"({"map_size": 1024, "taps": 19})", 2})};
}

}  // namespace gnomon::bench
