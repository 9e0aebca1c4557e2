// Percentage-closer filtering (Reeves, Salesin, Cook 1987).
//
// Compares the receiver's depth with each texel under an N x N box, then averages the comparisons: V = mean of [d <= z_i].
// The penumbra has one width everywhere, so contact shadows are too soft and distant ones too hard; the cost grows with N^2
// texel reads. A wide kernel reaches texels where the receiver's own surface is nearer to the light: taps follow its plane, and
// a bias that grows with the kernel covers how far the surface may bend away from that plane (45 degrees over its radius).
#include <gnomon/plugin.h>

namespace gnomon {
namespace {

enum class Kernel : int { box };

struct Parameters {
  Kernel kernel = Kernel::box;
  int taps = 5;
  float spread = 1.0f;
  DepthMapParameters map{.bias = {.constant = 2.0f, .slope = 0.0f, .curvature = 1.0f, .receiverPlane = true}};
};

ParameterTable<Parameters> parameterTable() {
  return {choice("kernel", &Parameters::kernel, {"box"}, Binding::specialise, "where the taps lie and what they weigh"),
          integer("taps", &Parameters::taps, {.min = 2, .max = 31, .unit = "texels"}, Binding::specialise,
                  "kernel width N, odd or even"),
          real("spread", &Parameters::spread, {.min = 0.25, .max = 16.0, .unit = "texels"}, Binding::structure,
               "distance between taps"),
          inlined(&Parameters::map, depthMapTable())};
}

class Pcf final : public Technique {
 public:
  explicit Pcf(const Parameters& parameters) : p_(parameters) {}

  Support support(const SceneSurvey& survey, const Light& light, const Frame& frame) const override {
    Support support = depthMapSupport(survey, light, frame, p_.map);
    if (support.ok()) support.ignored = {Effect::varyingPenumbra, Effect::overlappingPenumbrae};
    return support;
  }

  Outputs setup(GraphBuilder& graph, const Frame& frame, const EffectPlan& plan) override {
    const double radius = 0.5 * (p_.taps - 1) * static_cast<double>(p_.spread);
    const LightDepth depth = lightDepth(graph, frame, p_.map, plan, radius);
    return {.visibility = graph.fullscreen("filter", {.shader = "pcf.frag",
                                                      .reads = {{"depthMap", depth.map}},
                                                      .constants = {{"SPREAD", p_.spread}},
                                                      .clear = glm::vec4(1.0f)})};
  }

 private:
  const Parameters& p_;
};

}  // namespace
}  // namespace gnomon

GNOMON_PLUGIN(
    gnomon::entry<gnomon::Pcf>("pcf", gnomon::parameterTable(),
                               {.paper = "Reeves, Salesin, Cook, Rendering antialiased shadows with depth maps, SIGGRAPH 1987",
                                .summary = "mean of N x N depth comparisons: penumbrae of one width"}))
