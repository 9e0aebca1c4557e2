// What a job costs in time: each regime against the baseline, and its passes one by one. Internal to run/.
#pragma once

#include "gnomon/run/light_stage.h"

namespace gnomon {

/// The regimes of the config, by the stage's clock (which must be one). The light stands at its nominal pose afterwards.
TimeRecord measureTime(LightStage& stage, Slot candidate, Slot baseline);

}  // namespace gnomon
