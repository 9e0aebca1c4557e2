// New technique: replace this by what it computes, whose idea it is, and where it is wrong.
#include <gnomon/plugin.h>

namespace gnomon {
namespace {

// What a user may set, each with its default. The table below gives it a name, a range, a unit and a meaning; from that come
// the JSON keys, `gnomon describe`, sweeps, and the values that shaders see.
struct Parameters {
  float strength = 1.0f;   // an example, read by the shader; replace it
  DepthMapParameters map;  // size, format and biases of the depth map: the keys map_size, map_format, bias.slope, ...
};

ParameterTable<Parameters> parameterTable() {
  return {real("strength", &Parameters::strength, {.min = 0.0, .max = 1.0}, Binding::uniform, "how dark a shadow is"),
          inlined(&Parameters::map, depthMapTable())};
}

class NewTechnique final : public Technique {
 public:
  explicit NewTechnique(const Parameters& parameters) : p_(parameters) {}

  // Says no, with the reason, where the technique cannot serve: here what one planar depth map cannot do.
  Support support(const SceneSurvey& survey, const Light& light, const Frame& frame) const override {
    return depthMapSupport(survey, light, frame, p_.map);
  }

  // Declares the passes. Runs once, not when something moves: the graph runs a pass again when what it reads has changed.
  Outputs setup(GraphBuilder& graph, const Frame& frame, const EffectPlan& plan) override {
    // Depth seen from the light, which shaders read as depthMap. The 0 is how many texels beside the receiver's own they read.
    lightDepth(graph, frame, p_.map, plan, 0.0);
    // One pass over the picture gives V, the visible part of the light's source at each pixel: 1 lit, 0 in shadow. Pixels that
    // the shader discards keep `clear`: V is 1 wherever the light cannot reach.
    return {.visibility = graph.fullscreen("visibility", {.shader = "new_technique.frag", .clear = glm::vec4(1.0f)})};
  }

 private:
  const Parameters& p_;  // the framework's copy: a technique keeps the reference
};

}  // namespace
}  // namespace gnomon

// The name is that of "entry" in new_technique.json.
GNOMON_PLUGIN(gnomon::entry<gnomon::NewTechnique>("new_technique", gnomon::parameterTable(),
                                                  {.paper = "", .summary = "one sentence for `gnomon describe`"}))
