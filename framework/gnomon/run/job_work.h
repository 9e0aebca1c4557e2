// What one frame of a technique does.
#pragma once

#include <string>

#include "gnomon/base/image.h"
#include "gnomon/measure/results.h"
#include "gnomon/run/light_stage.h"

namespace gnomon {

struct JobWork {
  WorkCounters counters;
  Image pixelReads;       ///< GraphReport::pixelReads
  std::string uncounted;  ///< why texel reads are not known, where they are not
};

/// `first` are the counters of a frame in which everything ran. Runs the technique once more, counting.
JobWork measureWork(LightStage& stage, Slot slot, const FrameCounters& first);

}  // namespace gnomon
