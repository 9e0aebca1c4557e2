// The passes every session has: the camera's block and the G-buffer, each light's block and receiver mask, shading.
#pragma once

#include <memory>
#include <span>

#include "gnomon/graph/passes.h"
#include "gnomon/technique/technique.h"

namespace gnomon {

/// Where receivers are looked for; set by hand, everywhere to begin with.
struct Restriction {
  std::shared_ptr<TextureResource> pixels;  ///< r8: above 0.5, inside `region`
  glm::ivec4 region{0};                     ///< x, y, width, height: nothing outside
};
std::shared_ptr<Restriction> everywhere(glm::ivec2 size);

/// The G-buffer and what only shading reads: the same for all lights.
struct SessionPasses {
  GBuffer gbuffer;        ///< without a mask, which is a light's: LightPasses
  Texture shadingNormal;  ///< rgba16f
  Texture albedo;         ///< rgba8, linear
  Buffer view;            ///< block View
};

/// Declares them and provides gPosition, gNormal, gIds, gShadingNormal, gAlbedo and View by name.
SessionPasses sessionPasses(GraphBuilder& graph, glm::ivec2 size);

/// What a light has of its own.
struct LightPasses {
  Texture mask;      ///< GBuffer::mask
  Buffer lightView;  ///< block LightView
};

/// Declares them for FrameInputs::light, and provides gMask and LightView by name. Reads gPosition and gNormal by name.
LightPasses lightPasses(GraphBuilder& graph, const std::shared_ptr<Restriction>& restriction);

/// One light in the picture: the visibility of it that is shown, with its own passes.
struct ShownLight {
  Texture visibility;
  LightPasses light;
};

/// The picture: albedo x (ambient + the sum of N.L x V over the lights), linear, rgba16f. At least one light; the first is lit
/// together with the ambient term, each further one is a pass that adds to what the ones before it gave, in full floats, so
/// that one light's change leaves the passes before its own alone. Reads gPosition, gNormal, gShadingNormal, gAlbedo by name.
Texture shadingPasses(GraphBuilder& graph, std::span<const ShownLight> lights);

}  // namespace gnomon
