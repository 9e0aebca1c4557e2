// Representation `vsm`: variance shadow maps (Donnelly, Lauritzen 2006).
//
// A texel stores the first two moments of depth, M1 = E[t] and M2 = E[t^2], which may be averaged by any linear filter. A
// receiver at t beyond M1 is lit to at most sigma^2 / (sigma^2 + (t - M1)^2) (Chebyshev's inequality, one-tailed), and that
// bound is taken for V. It is exact for one planar blocker over one planar receiver; with more depths under the kernel light
// leaks through the nearer ones. t is depth along the light's axis from 0 at near to 1 at far, less 1/2: centred, M2 - M1^2
// cancels less. M2 takes a quarter of the squared slope of the texel's own surface besides: its depth varies within the texel.
#include <gnomon/plugin.h>

namespace gnomon {
namespace {

enum class Moments : int { half, single };

struct Parameters {
  Moments moments = Moments::single;
  float minVariance = 1e-5f;
  float bleedingReduction = 0.2f;
};

ParameterTable<Parameters> parameterTable() {
  return {choice("moments", &Parameters::moments, {"rg16f", "rg32f"}, Binding::structure, "how moments are stored"),
          real("min_variance", &Parameters::minVariance,
               {.min = 1e-12, .max = 1.0, .unit = "of the squared depth range", .logarithmic = true}, Binding::uniform,
               "least variance: guards against cancellation and against texels on sloped receivers"),
          real("bleeding_reduction", &Parameters::bleedingReduction, {.min = 0.0, .max = 0.95}, Binding::uniform,
               "V below it counts as dark, what is above is stretched: darkens leaks, and narrows penumbrae")};
}

class Vsm final : public Representation {
 public:
  explicit Vsm(const Parameters& parameters) : p_(parameters) {}

  StoredMap store(GraphBuilder& graph, const ProjectedMap& map) override {
    const Format format = p_.moments == Moments::half ? Format::rg16f : Format::rg32f;
    return {graph.fullscreen("moments", {.shader = "vsm_moments.frag", .format = format, .size = map.size}), format};
  }

 private:
  const Parameters& p_;
};

}  // namespace
}  // namespace gnomon

GNOMON_PLUGIN(gnomon::component<gnomon::Vsm>(
    "vsm", gnomon::parameterTable(),
    {.paper = "Donnelly, Lauritzen, Variance shadow maps, I3D 2006",
     .summary = "two moments of depth, and Chebyshev's bound",
     .defences = {{"min_variance", "a least variance: what cancellation leaves of it may be 0 or negative"}}},
    {.shader = "vsm.glsl"}))
