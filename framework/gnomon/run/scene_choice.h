// How a run config names its scene: the keys depend on which it is, so they are read by hand and not by one table.
#pragma once

#include <memory>

#include "gnomon/base/json.h"

namespace gnomon {

struct SceneChoice;

/// As a run config has it ("move" and "time" only where they say something); the reader makes the same choice of it. A file's
/// path is written as it is.
Json writeSceneChoice(const SceneChoice& choice);

/// Reads std::vector<SceneChoice>: {"builtin": NAME, keys of that scene} or {"file": PATH, "cast": [...], "receive": [...]},
/// either with "move": {NODE: [x, y, z]} and "time"; or a list of these.
std::shared_ptr<const CustomField> sceneChoiceField();

}  // namespace gnomon
