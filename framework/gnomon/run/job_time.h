// What a job costs in time: each regime against the baseline, and its passes one by one. Internal to run/.
#pragma once

#include "gnomon/run/light_stage.h"

namespace gnomon {

/// The regimes of the config, by the stage's clock (which must be one). Without a baseline there are no ratios. Light, camera
/// and casters stand at their nominal poses afterwards.
TimeRecord measureTime(LightStage& stage, Slot candidate, std::optional<Slot> baseline);

}  // namespace gnomon
