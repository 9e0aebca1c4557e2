#include "ray_log.h"

#include <dlfcn.h>

#include <atomic>
#include <bit>
#include <list>
#include <mutex>

#include "gnomon/base/error.h"

namespace gnomon::bench {

namespace {

std::atomic<bool> logging = false;
std::mutex guard;
std::list<RayLog> logs;  // one a thread and period of logging: they stay where they are
std::atomic<int> period = 0;

RayLog& logOfThisThread() {
  thread_local RayLog* mine = nullptr;
  thread_local int minePeriod = -1;
  if (minePeriod != period) {
    const std::lock_guard lock(guard);
    mine = &logs.emplace_back();
    minePeriod = period;
  }
  return *mine;
}

using Occluded16 = void (*)(const int*, RTCScene, RTCIntersectContext*, RTCRay16*);
using Occluded1 = void (*)(RTCScene, RTCIntersectContext*, RTCRay*);

/// Embree's own function of that name.
template <class Function>
Function next(const char* name) {
  void* const found = dlsym(RTLD_NEXT, name);
  if (found == nullptr) throw Error(std::string("Embree has no ") + name);
  return reinterpret_cast<Function>(found);
}

void occluded16(const int* valid, RTCScene scene, RTCIntersectContext* context, RTCRay16* rays) {
  static const auto embree = next<Occluded16>("rtcOccluded16");
  embree(valid, scene, context, rays);
}

void occluded1(RTCScene scene, RTCIntersectContext* context, RTCRay* ray) {
  static const auto embree = next<Occluded1>("rtcOccluded1");
  embree(scene, context, ray);
}

std::uint32_t blockedBits(const RTCRay16& rays, const std::array<int, 16>& valid) {
  std::uint32_t bits = 0;
  for (std::size_t lane = 0; lane < valid.size(); ++lane) {
    if (valid[lane] != 0 && rays.tfar[lane] < 0.0f) bits |= 1U << lane;  // Embree marks it by -inf
  }
  return bits;
}

}  // namespace

void startRayLog() {
  ++period;
  logging = true;
}

std::vector<RayLog> takeRayLog() {
  logging = false;
  const std::lock_guard lock(guard);
  std::vector<RayLog> taken(std::make_move_iterator(logs.begin()), std::make_move_iterator(logs.end()));
  logs.clear();
  return taken;
}

std::vector<RTCRay> singleRays(const RayLog& log) {
  std::vector<RTCRay> rays = log.singles;
  for (const auto& [packet, valid, blocked] : log.packets) {
    for (std::size_t i = 0; i < valid.size(); ++i) {
      if (valid[i] == 0) continue;
      rays.push_back({packet.org_x[i], packet.org_y[i], packet.org_z[i], packet.tnear[i], packet.dir_x[i], packet.dir_y[i],
                      packet.dir_z[i], packet.time[i], packet.tfar[i], packet.mask[i], packet.id[i], packet.flags[i]});
    }
  }
  return rays;
}

std::uint64_t traceSingly(const std::vector<RTCRay>& rays, const RayLog& log) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = log.flags;
  std::uint64_t blocked = 0;
  for (RTCRay ray : rays) {
    occluded1(log.scene, &context, &ray);
    blocked += ray.tfar < 0.0f ? 1U : 0U;
  }
  return blocked;
}

std::uint64_t tracePackets(const RayLog& log) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = log.flags;
  std::uint64_t blocked = 0;
  alignas(64) RTCRay16 rays;
  for (const LoggedPacket& packet : log.packets) {
    rays = packet.rays;
    occluded16(packet.valid.data(), log.scene, &context, &rays);
    blocked += static_cast<std::uint64_t>(std::popcount(blockedBits(rays, packet.valid)));
  }
  return blocked;
}

std::uint64_t countRays(const RayLog& log) {
  std::uint64_t rays = log.singles.size();
  for (const LoggedPacket& packet : log.packets) {
    for (const int valid : packet.valid) rays += valid != 0 ? 1U : 0U;
  }
  return rays;
}

std::uint64_t countBlocked(const RayLog& log) {
  std::uint64_t blocked = log.singlesBlocked;
  for (const LoggedPacket& packet : log.packets) blocked += static_cast<std::uint64_t>(std::popcount(packet.blocked));
  return blocked;
}

}  // namespace gnomon::bench

using namespace gnomon::bench;

// Declared by Embree's header: C linkage, and visible, so that plugins find these before the library's.
void rtcOccluded16(const int* valid, RTCScene scene, RTCIntersectContext* context, RTCRay16* rays) {
  if (!logging.load(std::memory_order_relaxed)) {
    occluded16(valid, scene, context, rays);
    return;
  }
  RayLog& log = logOfThisThread();
  log.scene = scene;
  log.flags = context->flags;
  LoggedPacket& packet = log.packets.emplace_back();
  packet.rays = *rays;
  for (std::size_t lane = 0; lane < packet.valid.size(); ++lane) packet.valid[lane] = valid[lane];
  occluded16(valid, scene, context, rays);
  packet.blocked = blockedBits(*rays, packet.valid);
}

void rtcOccluded1(RTCScene scene, RTCIntersectContext* context, RTCRay* ray) {
  if (!logging.load(std::memory_order_relaxed)) {
    occluded1(scene, context, ray);
    return;
  }
  RayLog& log = logOfThisThread();
  log.scene = scene;
  log.flags = context->flags;
  log.singles.push_back(*ray);
  occluded1(scene, context, ray);
  log.singlesBlocked += ray->tfar < 0.0f ? 1U : 0U;
}
