// glTF 2.0 import (.gltf, .glb).
#pragma once

#include <filesystem>

#include "gnomon/scene/scene.h"

namespace gnomon {

/// Loads the default scene of the file. Node transforms are combined in double; indexed and plain triangles; missing normals
/// are computed (smooth over shared indices, weighted by area); vertices that no triangle uses are left out. Each primitive of
/// a node becomes one instance that bears the node's name ("node_7" where it has none). What is not supported is dropped and
/// named in Scene::warnings, one line for each kind. Triangles with a non-finite vertex are dropped and counted there.
/// Lights come from KHR_lights_punctual, without extent, colour, falloff or range. Without a camera in the file,
/// Scene::camera is one that frames the whole scene. Cameras and lights bear their node's name, else their own. All animations
/// of nodes play together, each repeating at its own length; of those that move the same thing only the first plays. Skins and
/// morph targets are not animated, and neither are cameras and lights. Only files in the glTF's own folder and below are read;
/// no image is. Throws InputError (file, JSON pointer where there is one) on a file that is not valid glTF or requires an
/// extension that is not supported; never crashes on one.
Scene loadGltf(const std::filesystem::path& path);

}  // namespace gnomon
