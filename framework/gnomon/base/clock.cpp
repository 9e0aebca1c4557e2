#include "gnomon/base/clock.h"

#include <ctime>

namespace gnomon {

namespace {
double milliseconds(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}
}  // namespace

double processCpuMs() {
  return milliseconds(CLOCK_PROCESS_CPUTIME_ID);
}
double wallMs() {
  return milliseconds(CLOCK_MONOTONIC);
}

}  // namespace gnomon
