// Every packet that is handed to Embree in this process, as it was asked and answered: the program defines Embree's two
// occlusion functions itself, ahead of the library's, and passes each call on.
#pragma once

#include <embree3/rtcore.h>

#include <array>
#include <cstdint>
#include <vector>

namespace gnomon::bench {

struct LoggedPacket {
  RTCRay16 rays;  ///< before it was traced
  alignas(64) std::array<int, 16> valid;
  std::uint32_t blocked = 0;  ///< a bit for each ray
};

/// What one thread traced, in its order.
struct RayLog {
  std::vector<LoggedPacket> packets;
  std::vector<RTCRay> singles;  ///< where the processor has no packets of 16
  std::uint64_t singlesBlocked = 0;
  RTCScene scene = nullptr;
  RTCIntersectContextFlags flags = RTC_INTERSECT_CONTEXT_FLAG_NONE;
};

/// Logs from here on.
void startRayLog();
/// Logs no more; what every thread traced since, in no order of the threads.
std::vector<RayLog> takeRayLog();

/// Hands Embree the same rays again in the same order, each copied to where Embree marks what is blocked, and nothing besides:
/// no filter function. Returns how many rays are blocked now.
std::uint64_t traceSingly(const std::vector<RTCRay>& rays, const RayLog& log);
std::uint64_t tracePackets(const RayLog& log);

/// All rays one after the other.
std::vector<RTCRay> singleRays(const RayLog& log);

std::uint64_t countRays(const RayLog& log);
std::uint64_t countBlocked(const RayLog& log);

}  // namespace gnomon::bench
