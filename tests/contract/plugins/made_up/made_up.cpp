// A representation that nobody published: the mean of depths, and a shadow that fades in behind it.
#include <gnomon/plugin.h>

namespace gnomon {
namespace {

struct Parameters {
  float hardness = 100.0f;
};

ParameterTable<Parameters> parameterTable() {
  return {real("hardness", &Parameters::hardness, {.min = 1.0, .max = 1e4}, Binding::uniform, "of what lies behind")};
}

class MadeUp final : public Representation {
 public:
  explicit MadeUp(const Parameters& /*uniform*/) {}
  StoredMap store(GraphBuilder& graph, const ProjectedMap& map) override {
    return {graph.fullscreen("mean depth", {.shader = "made_up_store.frag", .format = Format::r32f, .size = map.size}),
            Format::r32f};
  }
};

}  // namespace
}  // namespace gnomon

GNOMON_PLUGIN(gnomon::component<gnomon::MadeUp>("made_up", gnomon::parameterTable(), {.summary = "the mean depth"},
                                                {.shader = "made_up.glsl"}))
