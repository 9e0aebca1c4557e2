// Known heavy drawing, timed by every clock at once, in the current OpenGL context.
#pragma once

#include <vector>

#include "gnomon/measure/clocks.h"

namespace gnomon {

/// Trials of work 1 : 2 : 4, each several full-screen draws to one target, sized so that the smallest takes some milliseconds
/// here. Takes about a tenth of a second.
std::vector<ClockTrial> runClockTrials();

}  // namespace gnomon
