// A well-behaved technique (V = 1) whose library leaves a trace as soon as it is loaded.
#include <gnomon/plugin.h>

#include "../leave_trace.h"

namespace gnomon {
namespace {

struct Parameters {
  int steps = 1;
};

ParameterTable<Parameters> parameterTable() {
  return {integer("steps", &Parameters::steps, {.min = 1, .max = 8}, Binding::specialise, "does nothing")};
}

class Trace final : public Technique {
 public:
  explicit Trace(const Parameters& /*parameters*/) {}
  Support support(const SceneSurvey& /*survey*/, const Light& /*light*/, const Frame& /*frame*/) const override { return {}; }
  Outputs setup(GraphBuilder& graph, const Frame& /*frame*/, const EffectPlan& /*plan*/) override {
    return {.visibility = graph.fullscreen("lit", {.shader = "trace.frag"})};
  }
};

}  // namespace
}  // namespace gnomon

GNOMON_PLUGIN(gnomon::entry<gnomon::Trace>("trace", gnomon::parameterTable(), {}))
