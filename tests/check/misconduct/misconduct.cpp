// Techniques that each break one promise, and one that breaks none: what `gnomon check` must tell apart.
#include <epoxy/gl.h>
#include <gnomon/plugin.h>

#include <cmath>
#include <limits>

namespace gnomon {
namespace {

enum class Misdeed {
  none,
  writesNan,
  writesTwo,
  darkOutside,
  darkAtTheEnd,    // of its parameter's range
  darkWhenNarrow,  // outputs of one column
  neverTheSame,    // counts its set-ups
  hidesItsInput,   // uses the camera without declaring it
  leavesState,
  leaksTextures,
  leaksMemory,
  keepsItsParameter  // a uniform one, read at set-up
};

struct Parameters {
  float level = 0.5f;
};

ParameterTable<Parameters> parameterTable() {
  return {real("level", &Parameters::level, {.min = 0.0, .max = 1.0}, Binding::uniform, "factor of V")};
}

constexpr int kLeakedFloats = 64 * 64;

/// V is one number at all receivers, made of light, camera and `level`: nobody's shadow, but all that the contract asks.
template <Misdeed misdeed>
class Misconduct final : public Technique {
 public:
  explicit Misconduct(const Parameters& parameters) : p_(parameters) {}

  Support support(const SceneSurvey& /*survey*/, const Light& /*light*/, const Frame& /*frame*/) const override { return {}; }

  Outputs setup(GraphBuilder& graph, const Frame& frame, const EffectPlan& /*plan*/) override {
    static int setUps = 0;
    const int serial = setUps++;
    if constexpr (misdeed == Misdeed::leaksMemory) {
      // Kept where leak checkers find it: what grows is no less a leak to whoever runs it for a day.
      static std::vector<std::vector<float>> kept;
      kept.emplace_back(kLeakedFloats, 1.0f);
    }
    // What light and camera give. The mask changes with both too, so that this stands in a pass that does not read it.
    const Texture seen = graph.texture("seen", {{1, 1}, Format::r32f});
    const InputSet inputs = misdeed == Misdeed::hidesItsInput ? InputSet{Input::light} : InputSet{Input::light, Input::camera};
    graph.cpu("look", {.inputs = inputs, .writes = {seen}, .run = [=](CpuContext& context) {
                         const FrameInputs& now = context.frame();
                         const double sum = now.light.position.x + now.light.position.z + now.camera.position.x;
                         const float value = 0.5f + 0.25f * static_cast<float>(std::sin(sum));
                         context.write(seen, std::span(&value, 1));
                       }});
    const Texture mask = frame.gbuffer.mask;
    const Texture visibility = graph.texture("visibility", {frame.size, Format::r32f});
    const float atSetUp = p_.level;
    graph.cpu(
        "work",
        {.reads = {mask, seen}, .writes = {visibility}, .after = {frame.parameters}, .run = [=, &p = p_](CpuContext& context) {
           const float level = misdeed == Misdeed::keepsItsParameter ? atSetUp : p.level;
           const float lit = context.read(seen)[0] * level;
           context.write(visibility, work(context.frame(), context.read(mask), lit, level, serial));
         }});
    return {.visibility = visibility};
  }

 private:
  static std::vector<float> work(const FrameInputs& frame, std::span<const float> mask, float lit, float level, int serial) {
    if (misdeed == Misdeed::neverTheSame) lit /= static_cast<float>(serial + 1);
    std::vector<float> v(mask.size(), 1.0f);
    for (std::size_t i = 0; i < v.size(); ++i) {
      if (mask[i] > 0.0f) v[i] = lit;
    }
    if (misdeed == Misdeed::darkOutside) {
      for (std::size_t i = 0; i < v.size(); ++i) v[i] = mask[i] > 0.0f ? v[i] : 0.25f;
    }
    disturb(frame, v, level);
    return v;
  }

  static void disturb(const FrameInputs& frame, std::vector<float>& v, float level) {
    if (misdeed == Misdeed::writesNan) v.back() = std::numeric_limits<float>::quiet_NaN();
    if (misdeed == Misdeed::writesTwo) v.back() = 2.0f;
    if (misdeed == Misdeed::darkAtTheEnd && level == 1.0f) v.front() = -1.0f;
    if (misdeed == Misdeed::darkWhenNarrow && frame.outputSize.x == 1) v.front() = -1.0f;
    if (misdeed == Misdeed::leavesState) glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    if (misdeed == Misdeed::leaksTextures) {
      GLuint name = 0;
      glCreateTextures(GL_TEXTURE_2D, 1, &name);
    }
  }

  const Parameters& p_;
};

template <Misdeed misdeed>
Entry misconduct(const char* name) {
  return entry<Misconduct<misdeed>>(name, parameterTable(), {});
}

}  // namespace
}  // namespace gnomon

GNOMON_PLUGIN(gnomon::misconduct<gnomon::Misdeed::none>("well_behaved"),
              gnomon::misconduct<gnomon::Misdeed::writesNan>("writes_nan"),
              gnomon::misconduct<gnomon::Misdeed::writesTwo>("writes_two"),
              gnomon::misconduct<gnomon::Misdeed::darkOutside>("dark_outside"),
              gnomon::misconduct<gnomon::Misdeed::darkAtTheEnd>("dark_at_the_end"),
              gnomon::misconduct<gnomon::Misdeed::darkWhenNarrow>("dark_when_narrow"),
              gnomon::misconduct<gnomon::Misdeed::neverTheSame>("never_the_same"),
              gnomon::misconduct<gnomon::Misdeed::hidesItsInput>("hides_its_input"),
              gnomon::misconduct<gnomon::Misdeed::leavesState>("leaves_state"),
              gnomon::misconduct<gnomon::Misdeed::leaksTextures>("leaks_textures"),
              gnomon::misconduct<gnomon::Misdeed::leaksMemory>("leaks_memory"),
              gnomon::misconduct<gnomon::Misdeed::keepsItsParameter>("keeps_its_parameter"))
