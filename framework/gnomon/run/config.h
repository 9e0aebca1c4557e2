// The run config: what a person asks to be rendered, compared and measured.
#pragma once

#include <cstddef>
#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gnomon/base/error.h"
#include "gnomon/base/json.h"
#include "gnomon/scene/builtin.h"
#include "gnomon/scene/camera.h"
#include "gnomon/scene/light.h"
#include "gnomon/technique/effects.h"

namespace gnomon {

/// A built-in scene with its keys, or a glTF file.
struct SceneChoice {
  std::string builtin;  ///< name out of builtinScenes(); empty where a file is named
  BuiltinParameters parameters;
  std::filesystem::path file;                    ///< as the program opens it: relative names were joined to the config's folder
  std::optional<std::vector<std::string>> cast;  ///< names of the nodes that cast; nullopt: all
  std::optional<std::vector<std::string>> receive;  ///< names of the nodes that receive; nullopt: all
  /// By how much the instances of a name are moved: metres along the world's axes, on top of any animation. Each name once.
  std::vector<std::pair<std::string, glm::dvec3>> moves = {};
  double time = 0.0;  ///< seconds, at least 0: the pose of a scene in which something moves
};

/// A registered technique. Whether its parameters are right is for those to say who have its table: they report at `where`.
struct TechniqueChoice {
  std::string technique;
  std::shared_ptr<const Json> parameters;  ///< object of values; null: none given
  std::shared_ptr<const Json> sweep;       ///< object of non-empty lists of different values; null: none given
  Location where;                          ///< of the entry
};

struct OutputChoice {
  glm::ivec2 size{800, 600};                  ///< pixels
  std::vector<std::string> images{"shaded"};  ///< some of shaded, visibility, error, work, class, reference
};

struct MeasureChoice {
  std::vector<std::string> regimes{"dynamic"};  ///< some of dynamic, static
  int frames = 30;                              ///< timed frames of a regime
  int blocks = 5;                               ///< ABBA blocks that share the frames
  int shimmerFrames = 6;                        ///< of each path along which shimmer is measured; 0: it is not
};

struct RunConfig {
  std::filesystem::path path;       ///< of the config itself, as given
  std::string name;                 ///< without one, the file's name without extension
  std::vector<SceneChoice> scenes;  ///< one or more: each is rendered with everything below
  PlanOverrides plan;
  std::optional<Camera> camera;              ///< nullopt: the scene's own
  std::optional<std::vector<Light>> lights;  ///< nullopt: the scene's own
  OutputChoice output;
  std::optional<TechniqueChoice> reference;  ///< nullopt: the technique whose role is reference
  std::optional<TechniqueChoice> baseline;   ///< what times are compared with
  std::vector<TechniqueChoice> techniques;
  MeasureChoice measure;
};

/// Most jobs that one entry's sweep may ask for.
inline constexpr std::size_t kMostSweepCombinations = 100000;

/// Reads the file; every fault, also that it cannot be opened, goes to `problems`, and the result is then only part of it.
RunConfig readRunConfig(const std::filesystem::path& path, Problems& problems);
RunConfig readRunConfigText(const std::filesystem::path& path, std::string_view text, Problems& problems);

/// JSON Schema of run configs.
Json runConfigSchema();

}  // namespace gnomon
