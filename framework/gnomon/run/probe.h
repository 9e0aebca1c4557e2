// What a technique does, found out by setting it up: `gnomon describe`.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "gnomon/graph/types.h"
#include "gnomon/technique/registry.h"

namespace gnomon {

/// Whether a technique takes a kind of light.
struct LightAnswer {
  std::string light;    ///< "spot with a rectangle"
  std::string refusal;  ///< its reason; empty: it takes the light
};

struct TextureFacts {
  std::string name;
  TextureInfo info;
  std::size_t bytes = 0;
};

/// A technique set up on a small built-in scene, once for each kind of light.
struct Probe {
  std::vector<LightAnswer> lights;
  // Of the effects that the scene calls for under a light that the technique takes:
  std::vector<std::string> reproduced;  ///< under every such light
  std::vector<std::string> ignored;
  // Of the set-up that holds the most passes:
  std::string setUp;                   ///< scene, size and light, "animated at 320x240, spot with a rectangle"; empty: none
  std::vector<std::string> passes;     ///< in order
  std::vector<TextureFacts> textures;  ///< the technique's own; none with integers
  std::size_t memoryBytes = 0;         ///< of textures and buffers
  /// Those that shaders of any of the set-ups hold, and those that the entry declares for its code.
  std::vector<Defence> defences;
};

/// Needs a current OpenGL context; renders nothing. Throws Error when a set-up fails.
Probe probeTechnique(const OpenTechnique& technique, const std::shared_ptr<const void>& parameters);

}  // namespace gnomon
