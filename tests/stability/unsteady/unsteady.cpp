// Never the same twice: V falls by the smallest step of a float below 1 each time that the technique is set up.
#include <gnomon/plugin.h>

#include <cmath>

namespace gnomon {
namespace {

struct Parameters {};

class Unsteady final : public Technique {
 public:
  explicit Unsteady(const Parameters& /*parameters*/) {}

  Support support(const SceneSurvey& /*survey*/, const Light& /*light*/, const Frame& /*frame*/) const override { return {}; }

  Outputs setup(GraphBuilder& graph, const Frame& frame, const EffectPlan& /*plan*/) override {
    static int times = 0;
    const float value = 1.0f - static_cast<float>(times++) * std::ldexp(1.0f, -24);
    const Texture visibility = graph.texture("visibility", {frame.size, Format::r32f});
    graph.cpu("count", {.writes = {visibility}, .run = [=](CpuContext& context) {
                          const auto pixels = static_cast<std::size_t>(frame.size.x) * static_cast<std::size_t>(frame.size.y);
                          context.write(visibility, std::vector<float>(pixels, value));
                        }});
    return {.visibility = visibility};
  }
};

}  // namespace
}  // namespace gnomon

GNOMON_PLUGIN(gnomon::entry<gnomon::Unsteady, gnomon::Parameters>("unsteady", {}, {}))
