// Footprint `fixed`: N x N taps about the receiver. Over depth it is percentage-closer filtering (Reeves, Salesin, Cook 1987);
// over what may be averaged it filters at lookup time.
//
// Compares the receiver's depth with each texel under the kernel, then averages the comparisons: V = mean of [d <= z_i]. The
// penumbra has one width everywhere, so contact shadows are too soft and distant ones too hard; the cost grows with N^2 texel
// reads. A wide kernel reaches texels where the receiver's own surface is nearer to the light: taps follow its plane
// (bias.receiver_plane), and a bias that grows with the kernel (bias.curvature) covers how far the surface may bend away from
// that plane (45 degrees over its radius).
#include <gnomon/plugin.h>

namespace gnomon {
namespace {

enum class Kernel : int { box };

struct Parameters {
  Kernel kernel = Kernel::box;
  int taps = 5;
  float spread = 1.0f;
};

ParameterTable<Parameters> parameterTable() {
  return {choice("kernel", &Parameters::kernel, {"box"}, Binding::specialise, "where the taps lie and what they weigh"),
          integer("taps", &Parameters::taps, {.min = 2, .max = 31, .unit = "texels"}, Binding::specialise,
                  "kernel width N, odd or even"),
          real("spread", &Parameters::spread, {.min = 0.25, .max = 16.0, .unit = "texels"}, Binding::specialise,
               "distance between taps")};
}

class Fixed final : public Footprint {
 public:
  explicit Fixed(const Parameters& parameters) : p_(parameters) {}

  MapReach reach() const override {
    return {[this] { return 0.5 * (p_.taps - 1) * static_cast<double>(p_.spread); }, false};
  }
  std::vector<Effect> ignored() const override { return {Effect::varyingPenumbra, Effect::overlappingPenumbrae}; }
  Texture filter(GraphBuilder& graph, const EffectPlan& /*plan*/, const ProjectedMap& /*map*/,
                 const StoredMap& /*stored*/) override {
    return graph.fullscreen("filter", {.shader = "fixed.frag", .clear = glm::vec4(1.0f)});
  }

 private:
  const Parameters& p_;
};

}  // namespace
}  // namespace gnomon

GNOMON_PLUGIN(gnomon::component<gnomon::Fixed>(
    "fixed", gnomon::parameterTable(),
    {.paper = "Reeves, Salesin, Cook, Rendering antialiased shadows with depth maps, SIGGRAPH 1987",
     .summary = "the mean of N x N taps: penumbrae of one width"}))
