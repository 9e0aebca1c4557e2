// Representation `esm`: exponential shadow maps (Annen et al. 2008; Salvi 2008), filtered in the log domain.
//
// The step [d <= z] is approximated by exp(c (z - d)), clamped to 1: the blocker's part, exp(c z), may be averaged by any
// filter before the receiver's depth is known. exp(c z) leaves a float's range at c z > 88, so a texel stores c z itself, and
// means are taken in the log domain: ln(a e^x + b e^y) = m + ln(a e^(x-m) + b e^(y-m)) with m the larger of the two, which no c
// overflows. Valid where no texel under the kernel is farther than the receiver: one that is weighs more than 1, and drowns the
// blockers beside it. So the largest c z of a kernel is kept too; where it exceeds c d the lookup compares depths instead
// (Annen et al. 2008 fall back likewise), and taps that are filtered for one receiver are limited to c d. Light
// leaks near contacts, the more the smaller c. V^k darkens what the filter made too light.
#include <gnomon/plugin.h>

namespace gnomon {
namespace {

struct Parameters {
  float exponent = 50.0f;
  float overDarkening = 1.0f;
};

ParameterTable<Parameters> parameterTable() {
  return {real("exponent", &Parameters::exponent, {.min = 1.0, .max = 5000.0, .unit = "per depth range", .logarithmic = true},
               Binding::uniform, "c: how steep the step is; small leaks at contacts, large shows noise on slopes"),
          real("over_darkening", &Parameters::overDarkening, {.min = 0.25, .max = 16.0}, Binding::uniform,
               "k: V^k is shown; above 1 it darkens leaks and narrows penumbrae")};
}

class Esm final : public Representation {
 public:
  explicit Esm(const Parameters& /*uniform, all of them*/) {}

  StoredMap store(GraphBuilder& graph, const ProjectedMap& map) override {
    constexpr Format kFormat = Format::rg32f;
    return {graph.fullscreen("exponents", {.shader = "esm_exponents.frag", .format = kFormat, .size = map.size}), kFormat};
  }
};

}  // namespace
}  // namespace gnomon

GNOMON_PLUGIN(gnomon::component<gnomon::Esm>(
    "esm", gnomon::parameterTable(),
    {.paper = "Annen, Mertens, Seidel, Flerackers, Kautz, Exponential shadow maps, GI 2008; Salvi, Rendering filtered shadows "
              "with exponential shadow maps, ShaderX6 2008",
     .summary = "the step as an exponential, averaged in the log domain",
     .defences = {{"log_domain", "means of exponentials about the larger exponent, which no exponent overflows"},
                  {"straddling_kernel", "kernels with texels beyond the receiver are compared, or limited to it"}}},
    {.shader = "esm.glsl"}))
