// Depth seen from a light, in one planar map: fitted, culled, biased. Shared by every technique that reads such a map.
#pragma once

#include "gnomon/base/table.h"
#include "gnomon/technique/component.h"
#include "gnomon/technique/technique.h"

namespace gnomon {

enum class MapFormat : int { d16, d24, d32f };

/// Corrections against a surface shadowing itself; see shaders/gnomon/depth_map.glsl for where each enters.
struct DepthBias {
  float constant = 2.0f;
  float slope = 1.0f;
  float normal = 0.0f;
  float curvature = 0.0f;
  bool receiverPlane = false;
  float limit = 4096.0f;
};

struct DepthMapParameters {
  glm::ivec2 size{1024, 1024};
  MapFormat format = MapFormat::d32f;
  DepthBias bias;
};

/// map_size, map_format, bias.constant, bias.slope, bias.normal, bias.curvature, bias.receiver_plane, bias.limit.
ParameterTable<DepthMapParameters> depthMapTable();

/// Refuses lights that one planar map cannot cover and maps larger than the driver allows.
Support depthMapSupport(const SceneSurvey& survey, const Light& light, const Frame& frame,
                        const DepthMapParameters& parameters);

struct LightDepth {
  Texture map;  ///< reversed depth: 1 at near, 0 at far and where nothing is
  /// For maps that are averaged (MapReach::averages) where the plan knows idle receivers: texels that no caster covers hold the
  /// farthest of them. Nothing lit lies beyond it there, so it blocks nothing; without it such a texel would weigh as a surface
  /// at far. None elsewhere: `map` serves.
  Texture averaged = {};
};

/// Declares two passes: `fit` on the CPU (the light's matrices, near and far, which casters to draw) and `light depth`.
/// Casters that could only matter beyond what `reach` says are culled. Provides the block LightMap and the sampler depthMap to
/// later shaders and fills the graph's facts.
/// `parameters` must outlive the graph, as a technique's do: `fit` follows the biases while they change.
LightDepth lightDepth(GraphBuilder& graph, const Frame& frame, const DepthMapParameters& parameters, const EffectPlan& plan,
                      const MapReach& reach);
LightDepth lightDepth(GraphBuilder&, const Frame&, const DepthMapParameters&&, const EffectPlan&, const MapReach&) = delete;

}  // namespace gnomon
