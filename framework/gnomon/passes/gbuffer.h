// The passes every session has: camera and light blocks, G-buffer, receiver mask, shading.
#pragma once

#include <memory>

#include "gnomon/graph/passes.h"
#include "gnomon/technique/technique.h"

namespace gnomon {

/// Where receivers are looked for; set by hand, everywhere to begin with.
struct Restriction {
  std::shared_ptr<TextureResource> pixels;  ///< r8: above 0.5, inside `region`
  glm::ivec4 region{0};                     ///< x, y, width, height: nothing outside
};

/// The G-buffer and what only shading reads.
struct SessionPasses {
  GBuffer gbuffer;
  Texture shadingNormal;  ///< rgba16f
  Texture albedo;         ///< rgba8, linear
  Buffer view;            ///< block View
  Buffer lightView;       ///< block LightView
  std::shared_ptr<Restriction> restriction;
};

/// Declares them and provides gPosition, gNormal, gIds, gMask, gShadingNormal, gAlbedo, View and LightView by name.
SessionPasses sessionPasses(GraphBuilder& graph, glm::ivec2 size);

/// The picture: albedo x (ambient + N.L x V), linear, rgba16f.
Texture shadingPass(GraphBuilder& graph, Texture visibility);

}  // namespace gnomon
