// Footprint `prefiltered`: the map is filtered once, before any receiver looks it up.
//
// Two one-dimensional passes average what texels store, in the representation's own domain, with a box or a Gaussian of any
// width; a lookup reads four texels, and compares where the representation says that their mean is no evidence. The cost is the
// map's, not the picture's: 2 N texel reads for each of its texels, and nothing while neither light nor casters move. The
// penumbra has one width everywhere.
#include <gnomon/plugin.h>

namespace gnomon {
namespace {

enum class Filter : int { box, gaussian };

struct Parameters {
  Filter filter = Filter::box;
  int width = 5;
};

ParameterTable<Parameters> parameterTable() {
  return {choice("filter", &Parameters::filter, {"box", "gaussian"}, Binding::specialise,
                 "what taps weigh; a Gaussian ends at three standard deviations"),
          integer("width", &Parameters::width, {.min = 1, .max = 255, .unit = "texels", .odd = true}, Binding::specialise,
                  "of the filter")};
}

class Prefiltered final : public Footprint {
 public:
  explicit Prefiltered(const Parameters& parameters) : p_(parameters) {}

  /// The filter's taps, and the bilinear lookup's one texel.
  MapReach reach() const override {
    return {[this] { return 0.5 * (p_.width - 1) + 1.0; }, true};
  }
  std::vector<Effect> ignored() const override { return {Effect::varyingPenumbra, Effect::overlappingPenumbrae}; }

  Texture filter(GraphBuilder& graph, const EffectPlan& /*plan*/, const ProjectedMap& map, const StoredMap& stored) override {
    const auto blur = [&](const char* name, Texture from, bool vertical) {
      return graph.fullscreen(name, {.shader = "prefilter.frag",
                                     .reads = {{"source", from}},
                                     .constants = {{"VERTICAL", vertical}},
                                     .format = stored.format,
                                     .size = map.size});
    };
    const Texture filtered = blur("filter columns", blur("filter rows", stored.texture, false), true);
    return graph.fullscreen("look up",
                            {.shader = "prefiltered.frag", .reads = {{"storedMap", filtered}}, .clear = glm::vec4(1.0f)});
  }

 private:
  const Parameters& p_;
};

}  // namespace
}  // namespace gnomon

GNOMON_PLUGIN(gnomon::component<gnomon::Prefiltered>("prefiltered", gnomon::parameterTable(),
                                                     {.summary = "the map filtered before lookup: cost by map, not by picture"},
                                                     {.prefilters = true}))
