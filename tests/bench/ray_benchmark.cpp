// ray_traced against a loop that only hands Embree the same rays in the same order.
#include <fmt/format.h>

#include <numeric>

#include "benchmark.h"
#include "gnomon/base/parallel.h"
#include "ray_log.h"
#include "render.h"

namespace gnomon::bench {

namespace {

enum class BareLoop { singleRays, packets };

TimingFigures bareAgainstTechnique(BareLoop loop, const Effort& effort) {
  const SessionSetup setup = sceneSetup("sphere_grid", effort.smoke ? glm::ivec2(64, 48) : glm::ivec2(400, 300));
  Session session(setup);
  const Slot slot = test::addSlot(session, "ray_traced", R"({"samples": 16})");
  session.runShared();
  const auto trace = [&] {
    session.moveLight(setup.light);  // it stays, but its rays are traced again
    return session.runTechnique(slot).counters.rays;
  };
  trace();  // the acceleration structure too
  startRayLog();
  const std::uint64_t wanted = trace();
  const std::vector<RayLog> logs = takeRayLog();

  std::uint64_t rays = 0;
  std::uint64_t blocked = 0;
  std::vector<std::vector<RTCRay>> single;
  for (const RayLog& log : logs) {
    rays += countRays(log);
    blocked += countBlocked(log);
    single.push_back(singleRays(log));
    if (loop == BareLoop::packets && !log.singles.empty()) throw NotHere("this processor has no packets of 16 rays");
  }
  if (rays != wanted) throw Error(fmt::format("ray_traced says that it traced {} rays, {} were seen", wanted, rays));
  std::vector<std::uint64_t> again(logs.size());
  const auto bare = [&] {
    parallelFor(logs.size(), [&](std::size_t i) {
      again[i] = loop == BareLoop::packets ? tracePackets(logs[i]) : traceSingly(single[i], logs[i]);
    });
  };
  bare();
  const std::uint64_t blockedAgain = std::accumulate(again.begin(), again.end(), std::uint64_t{0});
  if (blockedAgain != blocked) {
    throw Error(fmt::format("of {} rays {} are blocked for ray_traced, {} in the bare loop", rays, blocked, blockedAgain));
  }

  // The same number of rays on both sides: the ratio of their rates is the inverse of that of their times.
  return measurePaired([&](Side side, int) { return side == Side::candidate ? timed(bare) : timed([&] { trace(); }); },
                       timingPlan(effort, 2));
}

Benchmark rayBenchmark(const std::string& name, const std::string& against, BareLoop loop, double limit) {
  return {.name = name,
          .meaning = "rays per second of ray_traced, 16 samples on sphere_grid, 400x300 / of " + against,
          .unit = {},
          .bound = Bound::atLeast,
          .limit = limit,
          .run = [loop](const Effort& effort) { return bareAgainstTechnique(loop, effort); }};
}

}  // namespace

std::vector<Benchmark> rayBenchmarks() {
  // Packets that lie ready have cost nothing: Embree takes 9 ns a ray here, and 0.9 of that rate would leave 1 ns for a
  // scrambled sample, its direction, its length and its place in a packet. The limit there only guards what has been reached.
  return {rayBenchmark("rays_single", "a bare loop of rtcOccluded1 over the same rays in the same order", BareLoop::singleRays,
                       0.9),
          rayBenchmark("rays_packets", "a bare loop of rtcOccluded16 over the same packets, made beforehand", BareLoop::packets,
                       0.45)};
}

}  // namespace gnomon::bench
