// glTF 2.0 import (.gltf, .glb).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gnomon/scene/scene.h"

namespace gnomon {

/// Loads the default scene of the file. Node transforms are combined in double; indexed and plain triangles; missing normals
/// are computed; each primitive of a node becomes one instance that bears the node's name. What is not supported is dropped
/// and named in one line of Scene::warnings each. Triangles with a non-finite vertex are dropped and counted there.
/// Without a camera in the file, Scene::camera is one that frames the whole scene.
/// Throws InputError (file, JSON pointer where there is one) on a file that is not valid glTF; never crashes on one.
Scene loadGltf(const std::filesystem::path& path);

}  // namespace gnomon
