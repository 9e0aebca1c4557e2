// The two clocks that every platform has.
#pragma once

namespace gnomon {

/// CPU time of this process over all its threads, milliseconds. On a software renderer it is the steady measure of work.
double processCpuMs();
/// Monotonic wall time, milliseconds.
double wallMs();

}  // namespace gnomon
