// Ray-traced visibility (Cook, Porter, Carpenter 1984): the reference.
//
// For every receiver of the G-buffer, `samples` points of an Owen-scrambled Sobol' sequence on the source, a scramble of its
// own for each pixel; V = share of the rays that reach the source, over those above the receiver's geometric horizon. A source
// without extent, or one whose penumbra the plan found to be narrower than half a pixel, takes one ray to its centre.
// Rays never hit the receiver's own triangle, and start off its plane by the rounding error of positions.
#include <gnomon/plugin.h>

#include "gnomon/base/parallel.h"
#include "gnomon/base/random.h"
#include "tracer.h"

namespace gnomon {
namespace {

struct Parameters {
  int samples = 64;
  int seed = 0;
};

ParameterTable<Parameters> parameterTable() {
  return {integer("samples", &Parameters::samples, {.min = 1, .max = 65536, .unit = "rays"}, Binding::uniform, "rays a pixel"),
          integer("seed", &Parameters::seed, {.min = 0, .max = 2147483647}, Binding::uniform,
                  "of the scrambles: other seeds, other noise")};
}

class RayTraced final : public Technique {
 public:
  explicit RayTraced(const Parameters& parameters) : p_(parameters) {}

  Support support(const SceneSurvey& /*survey*/, const Light& /*light*/, const Frame& /*frame*/) const override { return {}; }

  Outputs setup(GraphBuilder& graph, const Frame& frame, const EffectPlan& plan) override {
    const bool penumbra = plan.has(Effect::penumbra);
    const Buffer built = graph.buffer("acceleration structure", sizeof(int));
    const auto tracer = std::make_shared<Tracer>();
    // Casters that may be very near to the light: coordinates relative to it keep their distance's digits.
    const bool nearLight = plan.has(Effect::largeDepthRange) && frame.light.type != LightType::directional;
    const InputSet buildInputs = nearLight ? InputSet{Input::geometry, Input::light} : InputSet{Input::geometry};
    graph.cpu("build", {.inputs = buildInputs, .buffers = {built}, .run = [=](CpuContext& context) {
                          const FrameInputs& now = context.frame();
                          tracer->build(now.scene, nearLight ? std::optional(now.light.position) : std::nullopt);
                          context.writeBlock(built, tracer->builds());
                        }});
    const GBuffer g = frame.gbuffer;
    const Texture visibility = graph.texture("visibility", {frame.size, Format::r32f});
    graph.cpu("trace", {.inputs = {Input::geometry, Input::light, Input::camera},
                        .reads = {g.position, g.normal, g.ids, g.mask},
                        .writes = {visibility},
                        .after = {built, frame.parameters},
                        .run = [=, &p = p_](CpuContext& context) { trace(context, *tracer, g, visibility, penumbra, p); }});
    return {.visibility = visibility};
  }

 private:
  static void trace(CpuContext& context, const Tracer& tracer, const GBuffer& g, Texture target, bool penumbra,
                    const Parameters& p) {
    const FrameInputs& frame = context.frame();
    const LightFrame axes = lightFrame(frame.light);
    const auto positions = context.read(g.position);
    const auto normals = context.read(g.normal);
    const auto ids = context.readIntegers(g.ids);
    const auto mask = context.read(g.mask);
    std::vector<float> visibility(mask.size(), 1.0f);
    const auto width = static_cast<std::size_t>(frame.outputSize.x);
    std::vector<std::uint64_t> rays(static_cast<std::size_t>(frame.outputSize.y), 0);
    const int samples = penumbra ? p.samples : 1;
    context.facts().samples = samples;

    parallelFor(rays.size(), [&](std::size_t row) {
      ShadowRays batch(tracer);
      for (std::size_t pixel = row * width; pixel < (row + 1) * width; ++pixel) {
        if (mask[pixel] == 0.0f) continue;
        const glm::dvec3 relative(positions[4 * pixel], positions[4 * pixel + 1], positions[4 * pixel + 2]);
        const Receiver receiver{frame.camera.position + relative,
                                {normals[4 * pixel], normals[4 * pixel + 1], normals[4 * pixel + 2]},
                                ids[2 * pixel],
                                ids[2 * pixel + 1],
                                glm::length(relative)};
        batch.start(receiver, visibility[pixel]);
        const SobolOwen2 points(pixelSeed(static_cast<std::uint32_t>(pixel - row * width), static_cast<std::uint32_t>(row),
                                          static_cast<std::uint32_t>(p.seed)));
        for (int i = 0; i < samples; ++i) {
          const glm::dvec2 u = penumbra ? points(static_cast<std::uint32_t>(i)) : glm::dvec2(0.5);
          const glm::dvec3 sample = sampleSource(frame.light, axes, u, receiver.position);
          batch.add(sample, frame.light.type == LightType::directional);
        }
      }
      batch.finish();
      rays[row] = batch.traced();
    });
    for (const std::uint64_t n : rays) context.counters().rays += n;
    context.write(target, visibility);
  }

  const Parameters& p_;
};

}  // namespace
}  // namespace gnomon

GNOMON_PLUGIN(gnomon::entry<gnomon::RayTraced>("ray_traced", gnomon::parameterTable(),
                                               {.paper = "Cook, Porter, Carpenter, Distributed ray tracing, SIGGRAPH 1984",
                                                .summary = "rays to points of the source: the reference"}))
