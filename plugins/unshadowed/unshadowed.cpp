// No shadows: V = 1 everywhere.
//
// The floor of every cost: one pass over the receivers that writes a constant. What a technique costs more than this is what
// its shadows cost.
#include <gnomon/plugin.h>

namespace gnomon {
namespace {

struct Parameters {};

class Unshadowed final : public Technique {
 public:
  explicit Unshadowed(const Parameters& /*parameters*/) {}

  Support support(const SceneSurvey& /*survey*/, const Light& /*light*/, const Frame& /*frame*/) const override {
    return Support::ignoring({Effect::penumbra, Effect::varyingPenumbra, Effect::selfShadowing, Effect::overlappingPenumbrae});
  }

  Outputs setup(GraphBuilder& graph, const Frame& /*frame*/, const EffectPlan& /*plan*/) override {
    return {.visibility =
                graph.fullscreen("constant", {.shader = "unshadowed.frag", .format = Format::r16f, .clear = glm::vec4(1.0f)})};
  }
};

}  // namespace
}  // namespace gnomon

GNOMON_PLUGIN(gnomon::entry<gnomon::Unshadowed, gnomon::Parameters>("unshadowed", {},
                                                                    {.paper = "", .summary = "V = 1: the floor of every cost"}))
