// Footprint `pcss`: percentage-closer soft shadows (Fernando 2005), over any representation.
//
// 1. Blocker search. From the receiver at distance d the source, w wide, is seen through a region of the map that is widest at
//    near: w (d - n) / d metres there. The mean distance b of the texels in it that are nearer than the receiver stands for all
//    blockers; without any, V = 1.
// 2. Penumbra. By similar triangles the penumbra on a plane at d is (d - b) w / b wide; seen from the source that is
//    (d - b) w / (b d) of a metre at one metre: the width of the kernel in the map. Directional lights: (d - b) 2 tan(delta/2).
// 3. Filter. Taps over that width, at least one texel, averaged as the representation wants it.
// Exact for one blocker parallel to a planar receiver; several blockers at different distances are taken for one between them.
// The map's axes are the source's own, rolled as it is. Where the scene calls for no penumbra nothing is searched and one texel
// is compared, whatever the representation.
#include <gnomon/plugin.h>

namespace gnomon {
namespace {

struct Parameters {
  int searchTaps = 9;
  int taps = 13;
  float widest = 96.0f;
};

ParameterTable<Parameters> parameterTable() {
  return {integer("search_taps", &Parameters::searchTaps, {.min = 1, .max = 63}, Binding::specialise,
                  "N of the N x N texels that the blocker search reads"),
          integer("taps", &Parameters::taps, {.min = 1, .max = 63}, Binding::specialise, "N of the filter's N x N taps"),
          real("widest", &Parameters::widest, {.min = 1.0, .max = 4096.0, .unit = "texels", .logarithmic = true},
               Binding::uniform, "neither search nor filter is wider")};
}

class Pcss final : public Footprint {
 public:
  explicit Pcss(const Parameters& parameters) : p_(parameters) {}

  MapReach reach() const override {
    return {[this] { return 0.5 * static_cast<double>(p_.widest); }, true, true};
  }
  std::vector<Effect> ignored() const override { return {Effect::overlappingPenumbrae}; }
  Texture filter(GraphBuilder& graph, const EffectPlan& plan, const ProjectedMap& /*map*/,
                 const StoredMap& /*stored*/) override {
    return graph.fullscreen(
        "search and filter",
        {.shader = "pcss.frag", .constants = {{"PENUMBRA", plan.has(Effect::penumbra)}}, .clear = glm::vec4(1.0f)});
  }

 private:
  const Parameters& p_;
};

}  // namespace
}  // namespace gnomon

GNOMON_PLUGIN(gnomon::component<gnomon::Pcss>(
    "pcss", gnomon::parameterTable(),
    {.paper = "Fernando, Percentage-closer soft shadows, SIGGRAPH 2005 sketches",
     .summary = "a blocker search sets the kernel's width: penumbrae that widen with distance"}))
