// Shadow map (Williams 1978), as the three components that it is made of.
//
// Renders depth from the light (projection `single`), compares each receiver's depth with what a texel holds (representation
// `depth`), and takes the one texel that the receiver falls into (footprint `nearest`): V is 0 or 1. Edges are staircases of
// texels; surfaces that slope within a texel shadow themselves unless a bias moves the comparison. Lights with extent get the
// hard shadow of their centre.
#include <gnomon/plugin.h>

namespace gnomon {
namespace {

class Single final : public Projection {
 public:
  explicit Single(const DepthMapParameters& parameters) : p_(parameters) {}

  Support support(const SceneSurvey& survey, const Light& light, const Frame& frame) const override {
    return depthMapSupport(survey, light, frame, p_);
  }
  ProjectedMap project(GraphBuilder& graph, const Frame& frame, const EffectPlan& plan, const MapReach& reach) override {
    const LightDepth depth = lightDepth(graph, frame, p_, plan, reach);
    return {depth.map, p_.size, depth.averaged};
  }

 private:
  const DepthMapParameters& p_;
};

class Depth final : public Representation {
 public:
  explicit Depth(const NoParameters& /*none*/) {}
};

class Nearest final : public Footprint {
 public:
  explicit Nearest(const NoParameters& /*none*/) {}

  MapReach reach() const override { return 0.0; }
  std::vector<Effect> ignored() const override {
    return {Effect::penumbra, Effect::varyingPenumbra, Effect::overlappingPenumbrae};
  }
  Texture filter(GraphBuilder& graph, const EffectPlan& /*plan*/, const ProjectedMap& /*map*/,
                 const StoredMap& /*stored*/) override {
    return graph.fullscreen("compare", {.shader = "nearest.frag", .clear = glm::vec4(1.0f)});
  }
};

}  // namespace
}  // namespace gnomon

GNOMON_PLUGIN(
    gnomon::component<gnomon::Single>("single", gnomon::depthMapTable(),
                                      {.paper = "Williams, Casting curved shadows on curved surfaces, SIGGRAPH 1978",
                                       .summary = "one planar map of a spot or a directional light"},
                                      {.shader = "gnomon/depth_map.glsl"}),
    gnomon::component<gnomon::Depth>("depth", gnomon::ParameterTable<gnomon::NoParameters>{},
                                     {.summary = "the nearest depth: compared first, then averaged"},
                                     {.shader = "depth.glsl", .compares = true}),
    gnomon::component<gnomon::Nearest>("nearest", gnomon::ParameterTable<gnomon::NoParameters>{},
                                       {.summary = "the one texel under the receiver: hard shadows of the source's centre"}))
