// The built-in scenes: generated, deterministic, each with a camera, a light and a sentence on what it is for.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gnomon/scene/scene.h"

namespace gnomon {

/// What may be chosen of built-in scenes; each names the keys that mean something to it.
struct BuiltinParameters {
  int count = 9;               ///< sphere_grid: count x count spheres; pillars: their number
  double blockerHeight = 1.0;  ///< half_plane, square: metres of the blocker above the receiver (receiver at y = 0)
  double sourceSize = 1.0;     ///< metres, edge of the square source
};

struct BuiltinScene {
  std::string name;
  std::string purpose;                      ///< one sentence
  std::shared_ptr<const FieldTable> table;  ///< of BuiltinParameters: only the keys this scene uses
  BuiltinParameters defaults;
  std::function<Scene(const BuiltinParameters&)> make;
};

/// All of them, in the order in which they are listed.
const std::vector<BuiltinScene>& builtinScenes();
const BuiltinScene* findBuiltinScene(const std::string& name);

/// Meshes shared by scenes and tests. All face outward / upward, counter-clockwise.
Mesh quadMesh(double halfX, double halfZ);  ///< in y = 0, facing +Y
Mesh boxMesh(const glm::dvec3& halfSize);
Mesh sphereMesh(double radius, int segments, int rings);  ///< 2 * segments * (rings - 1) triangles, poles on Y

}  // namespace gnomon
