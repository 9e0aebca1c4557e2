// A plugin that calls a function which no library defines.
#include <gnomon/plugin.h>

namespace gnomon {

int nobodyDefinesThis();

namespace {

struct Parameters {
  int value = nobodyDefinesThis();
};

class LacksSymbol final : public Technique {
 public:
  explicit LacksSymbol(const Parameters& /*parameters*/) {}
  Support support(const SceneSurvey& /*survey*/, const Light& /*light*/, const Frame& /*frame*/) const override { return {}; }
  Outputs setup(GraphBuilder& /*graph*/, const Frame& /*frame*/, const EffectPlan& /*plan*/) override { return {}; }
};

}  // namespace
}  // namespace gnomon

GNOMON_PLUGIN(gnomon::entry<gnomon::LacksSymbol, gnomon::Parameters>("lacks_symbol", {}, {}))
