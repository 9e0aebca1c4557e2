// What a frame of a job's technique did, counted. Internal to run/.
#pragma once

#include "gnomon/run/light_stage.h"

namespace gnomon {

/// Runs all of the technique's passes once more, at the light's nominal pose, and counts them. `first` is of the frame in which
/// the technique ran first: what ran in it, and what did not.
WorkCounters measureWork(LightStage& stage, Slot slot, const FrameCounters& first);

}  // namespace gnomon
