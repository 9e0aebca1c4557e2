// How a run config names its scene: the keys depend on which it is, so they are read by hand and not by one table.
#pragma once

#include <memory>

#include "gnomon/base/json.h"

namespace gnomon {

/// Reads std::vector<SceneChoice>: {"builtin": NAME, keys of that scene} or {"file": PATH, "cast": [...], "receive": [...]},
/// or a list of these.
std::shared_ptr<const CustomField> sceneChoiceField();

}  // namespace gnomon
