// The contract: what a technique is. A plugin author reads this page, and parameters in base/table.h.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gnomon/graph/passes.h"
#include "gnomon/scene/camera.h"
#include "gnomon/scene/light.h"
#include "gnomon/scene/scene.h"
#include "gnomon/scene/survey.h"
#include "gnomon/technique/effects.h"

namespace gnomon {

/// What every technique reads of the picture. All of the output's size. Shaders get them by these names without listing them:
/// gPosition, gNormal, gIds, gMask.
struct GBuffer {
  Texture position;  ///< rgba32f: world axes, relative to the camera, metres; w: 0 background, 0.5 no receiver, 1 receiver
  Texture normal;    ///< rgba32f: unit geometric normal on the side that the camera sees; 0 for degenerate triangles
  Texture ids;       ///< rg32ui: instance, triangle of its mesh; 0xffffffff for background
  Texture depth;     ///< d32f_s8, reversed, infinite far
  Texture mask;      ///< r8: receiver mask, 1 inside
};

/// What holds while the structure holds.
struct Frame {
  glm::ivec2 size{1, 1};
  Light light;  ///< its kind and shape; its pose may change without set-up
  GBuffer gbuffer;
  int maxTextureSize = 0;  ///< of this driver
  /// The generated block; it changes with every uniform and specialise parameter, and a cpu pass that uses one names it in
  /// CpuPass::after.
  Buffer parameters = {};
};

/// Whether and how a technique can serve here.
struct Support {
  std::string refusal;          ///< empty: supported; else why not, and what to do
  std::vector<Effect> ignored;  ///< called-for effects that it will not reproduce

  static Support refused(std::string reason) { return {std::move(reason), {}}; }
  static Support ignoring(std::vector<Effect> effects) { return {{}, std::move(effects)}; }
  bool ok() const { return refusal.empty(); }
};

struct Outputs {
  Texture visibility;  ///< r16f or r32f, the output's size, V in [0,1]; 1 outside the receiver mask
  std::optional<Texture> admissible =
      {};  ///< r8: 1 where a technique claims to be valid; reported apart, never shrinks the mask
  /// rg32f, of a reference whose parameter `statistics` is on. Red: the standard error of V, an upper estimate. Green: V_cos,
  /// the share of N.w over the solid angle of the source that the visible part holds, in [0,1]; 1 where no direction counts.
  std::optional<Texture> statistics = {};
};

/// A technique is made with a reference to its parameters and keeps that reference: they are the session's copy, outlive the
/// technique and its graph, and the values of those bound as `uniform` or `specialise` change between frames. Support and setup
/// therefore rest on `structure` ones alone. The others reach shaders by themselves, as the block and as constants; a cpu pass
/// reads them while it runs and names Frame::parameters in CpuPass::after. A parameter that decides which passes there are, or
/// their sizes, formats or constants, is a structural one.
class Technique {
 public:
  virtual ~Technique() = default;

  /// Which called-for effects it will reproduce here, which it ignores, or why it refuses (size, driver limit, light kind).
  virtual Support support(const SceneSurvey& survey, const Light& light, const Frame& frame) const = 0;

  /// Declares the passes. Runs when structure changes (size, light kind, plan, structural parameters), never because
  /// something moved. May throw Error.
  virtual Outputs setup(GraphBuilder& graph, const Frame& frame, const EffectPlan& plan) = 0;

  /// Per-frame values that are not parameters, written to buffers declared in setup. Most techniques need none: what depends
  /// on light or camera is best a cpu pass, which the graph skips when nothing changed.
  virtual void update(const FrameInputs& /*inputs*/, UniformWriter& /*writer*/) {}
};

}  // namespace gnomon
