// Shadow map (Williams 1978).
//
// Renders depth from the light, then compares each receiver's depth with the one texel it falls into: V is 0 or 1. Edges are
// staircases of texels; surfaces that slope within a texel shadow themselves unless a bias moves the comparison. Lights with
// extent get the hard shadow of their centre.
#include <gnomon/plugin.h>

namespace gnomon {
namespace {

class ShadowMap final : public Technique {
 public:
  explicit ShadowMap(const DepthMapParameters& parameters) : map_(parameters) {}

  Support support(const SceneSurvey& survey, const Light& light, const Frame& frame) const override {
    return depthMapSupport(survey, light, frame, map_);
  }

  Outputs setup(GraphBuilder& graph, const Frame& frame, const EffectPlan& plan) override {
    const LightDepth depth = lightDepth(graph, frame, map_, plan, 0.0);
    return {.visibility = graph.fullscreen(
                "compare", {.shader = "shadow_map.frag", .reads = {{"depthMap", depth.map}}, .clear = glm::vec4(1.0f)})};
  }

 private:
  const DepthMapParameters& map_;
};

}  // namespace
}  // namespace gnomon

GNOMON_PLUGIN(
    gnomon::entry<gnomon::ShadowMap>("shadow_map", gnomon::depthMapTable(),
                                     {.paper = "Williams, Casting curved shadows on curved surfaces, SIGGRAPH 1978",
                                      .summary = "one depth comparison a pixel: hard shadows of the source's centre"}))
