// Counts its frames in `update` and shows the count: V = frames * step * GAIN. Between them the three reach the shader on the
// three ways there are: a block of the technique's own, the generated block, and a constant.
#include <gnomon/plugin.h>

namespace gnomon {
namespace {

struct Parameters {
  float step = 0.125f;
  int gain = 1;
};

ParameterTable<Parameters> parameterTable() {
  return {real("step", &Parameters::step, {.min = 0.0, .max = 1.0}, Binding::uniform, "visibility a frame"),
          integer("gain", &Parameters::gain, {.min = 1, .max = 8}, Binding::specialise, "factor")};
}

struct CountBlock {  // std140: as in counter.frag
  float frames;
};

class Counter final : public Technique {
 public:
  explicit Counter(const Parameters& /*parameters*/) {}

  Support support(const SceneSurvey& /*survey*/, const Light& /*light*/, const Frame& /*frame*/) const override { return {}; }

  Outputs setup(GraphBuilder& graph, const Frame& /*frame*/, const EffectPlan& /*plan*/) override {
    count_ = graph.buffer("Count", sizeof(CountBlock));
    return {.visibility = graph.fullscreen("show", {.shader = "counter.frag", .buffers = {{"Count", count_}}})};
  }

  void update(const FrameInputs& /*inputs*/, UniformWriter& writer) override {
    writer.writeBlock(count_, CountBlock{static_cast<float>(++frames_)});
  }

 private:
  Buffer count_;
  int frames_ = 0;
};

}  // namespace
}  // namespace gnomon

GNOMON_PLUGIN(gnomon::entry<gnomon::Counter>("counter", gnomon::parameterTable(), {}))
