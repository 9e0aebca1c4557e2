// The animations of a glTF file, checked. Internal to scene/.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "gnomon/scene/animation.h"
#include "gnomon/scene/gltf_file.h"

namespace gnomon::gltf {

struct NodeAnimations {
  std::map<int, std::vector<AnimationChannel>> channels;  ///< by the file's node; at most one for each property
  std::vector<std::string> warnings;                      ///< what was left out, a line for each kind
};

/// Translations, rotations and scales of all animations, which play together from time 0, each repeating at its own length.
/// One that moves a property which an earlier one moves (the other gaits of a walker, say) is left out and named. Throws
/// InputError that names what is at fault.
NodeAnimations readAnimations(const File& file);

}  // namespace gnomon::gltf
