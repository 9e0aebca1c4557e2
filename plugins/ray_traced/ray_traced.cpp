// Ray-traced visibility (Cook, Porter, Carpenter 1984): the reference.
//
// For every receiver of the G-buffer, `samples` points of an Owen-scrambled Sobol' sequence on the source, a scramble of its
// own for each pixel; V = share of the rays that reach the source, over those above the receiver's geometric horizon. A source
// without extent, or one whose penumbra the plan found to be narrower than half a pixel, takes one ray to its centre.
// Rays never hit the receiver's own triangle, and start off its plane by the rounding error of positions.
// With a `standard_error` to reach, pixels that are provably lit or dark take no ray (shaft.h), and the others stop when theirs
// is reached (estimate.h).
#include <gnomon/plugin.h>

#include "estimate.h"
#include "gnomon/base/parallel.h"
#include "gnomon/base/random.h"
#include "shaft.h"
#include "tracer.h"

namespace gnomon {
namespace {

struct Parameters {
  int samples = 64;
  int seed = 0;
  double standardError = 0.0;
  bool statistics = false;
};

ParameterTable<Parameters> parameterTable() {
  return {integer("samples", &Parameters::samples, {.min = 1, .max = 65536, .unit = "rays"}, Binding::uniform,
                  "rays a pixel; the most of them where standard_error is above 0"),
          integer("seed", &Parameters::seed, {.min = 0, .max = 2147483647}, Binding::uniform,
                  "of the scrambles: other seeds, other noise"),
          real("standard_error", &Parameters::standardError, {.min = 0.0, .max = 0.5}, Binding::structure,
               "of V at which a pixel stops; 0: each takes all samples"),
          boolean("statistics", &Parameters::statistics, Binding::structure,
                  "standard error of V and V_cos beside V; a reference turns it on")};
}

class RayTraced final : public Technique {
 public:
  explicit RayTraced(const Parameters& parameters) : p_(parameters) {}

  Support support(const SceneSurvey& /*survey*/, const Light& /*light*/, const Frame& /*frame*/) const override { return {}; }

  Outputs setup(GraphBuilder& graph, const Frame& frame, const EffectPlan& plan) override {
    const bool penumbra = plan.has(Effect::penumbra);
    const Buffer built = graph.buffer("acceleration structure", sizeof(int));
    const auto rays = std::make_shared<Rays>();
    // Casters that may be very near to the light: coordinates relative to it keep their distance's digits.
    const bool nearLight = plan.has(Effect::largeDepthRange) && frame.light.type != LightType::directional;
    const InputSet buildInputs = nearLight ? InputSet{Input::geometry, Input::light} : InputSet{Input::geometry};
    const bool adapts = penumbra && p_.standardError > 0.0;
    graph.cpu("build", {.inputs = buildInputs, .buffers = {built}, .run = [=](CpuContext& context) {
                          const FrameInputs& now = context.frame();
                          rays->tracer.build(now.scene, nearLight ? std::optional(now.light.position) : std::nullopt);
                          if (adapts) rays->shafts.emplace(rays->tracer);
                          context.counters().primitives += rays->tracer.triangles().size();
                          context.writeBlock(built, rays->tracer.builds());
                        }});
    const GBuffer g = frame.gbuffer;
    Outputs out{.visibility = graph.texture("visibility", {frame.size, Format::r32f})};
    std::vector<Texture> writes{out.visibility};
    if (p_.statistics) writes.push_back(out.statistics.emplace(graph.texture("statistics", {frame.size, Format::rg32f})));
    graph.cpu("trace", {.inputs = {Input::geometry, Input::light, Input::camera},
                        .reads = {g.position, g.normal, g.ids, g.mask},
                        .writes = writes,
                        .after = {built, frame.parameters},
                        .run = [=, &p = p_](CpuContext& context) { trace(context, *rays, g, out, penumbra, p); }});
    return out;
  }

 private:
  struct Rays {
    Tracer tracer;
    std::optional<ShaftTree> shafts;  ///< where pixels may stop early
  };

  static void trace(CpuContext& context, const Rays& all, const GBuffer& g, const Outputs& out, bool penumbra,
                    const Parameters& p) {
    const FrameInputs& frame = context.frame();
    const LightFrame axes = lightFrame(frame.light);
    const bool isDirection = frame.light.type == LightType::directional;
    const auto positions = context.read(g.position);
    const auto normals = context.read(g.normal);
    const auto ids = context.readIntegers(g.ids);
    const auto mask = context.read(g.mask);
    std::vector<Estimate> estimates(mask.size());
    const auto width = static_cast<std::size_t>(frame.outputSize.x);
    std::vector<std::uint64_t> traced(static_cast<std::size_t>(frame.outputSize.y), 0);
    std::vector<std::uint64_t> saved(traced.size(), 0);
    const int samples = penumbra ? p.samples : 1;
    const bool adapts = all.shafts && samples >= 2;
    const std::size_t runs = p.statistics ? std::min(kRuns, static_cast<std::size_t>(samples)) : 1;
    context.facts().samples = samples;

    parallelFor(traced.size(), [&](std::size_t row) {
      ShadowRays batch(all.tracer);
      std::vector<Tally> tallies(adapts ? 0 : width * runs);
      for (std::size_t pixel = row * width; pixel < (row + 1) * width; ++pixel) {
        if (mask[pixel] == 0.0f) continue;
        const glm::dvec3 relative(positions[4 * pixel], positions[4 * pixel + 1], positions[4 * pixel + 2]);
        const Receiver receiver{frame.camera.position + relative,
                                {normals[4 * pixel], normals[4 * pixel + 1], normals[4 * pixel + 2]},
                                ids[2 * pixel],
                                ids[2 * pixel + 1],
                                glm::length(relative)};
        batch.start(receiver);
        const std::size_t column = pixel - row * width;
        const std::uint32_t seed =
            pixelSeed(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(p.seed));
        const auto castRay = [&](const glm::dvec2& u, Tally& tally) {
          const glm::dvec3 sample = sampleSource(frame.light, axes, u, receiver.position);
          batch.add(sample, isDirection, solidAngleWeight(frame.light, axes, sample, receiver.position), tally);
        };
        if (adapts) {
          const std::uint64_t before = batch.traced();
          const Verdict verdict = proven(all, frame.light, axes, receiver, batch.origin());
          if (verdict == Verdict::open) {
            estimates[pixel] = Adaptive(seed, samples / 2, p.standardError).run(castRay, [&] { batch.finish(); });
          } else if (verdict == Verdict::dark) {
            estimates[pixel] = {0.0, 0.0, 0.0};
          }
          const std::uint64_t cast = batch.traced() - before;
          saved[row] += static_cast<std::uint64_t>(samples) - std::min(cast, static_cast<std::uint64_t>(samples));
        } else {
          const SobolOwen2 points(seed);
          for (std::size_t i = 0; i < static_cast<std::size_t>(samples); ++i) {
            castRay(penumbra ? points(static_cast<std::uint32_t>(i)) : glm::dvec2(0.5),
                    tallies[column * runs + i * runs / static_cast<std::size_t>(samples)]);
          }
        }
      }
      batch.finish();
      for (std::size_t column = 0; column < width && !adapts; ++column) {
        estimates[row * width + column] = estimateOf(std::span(tallies).subspan(column * runs, runs));
        if (!penumbra || mask[row * width + column] == 0.0f) estimates[row * width + column].standardError = 0.0;
      }
      traced[row] = batch.traced();
    });
    for (const std::uint64_t n : traced) context.counters().rays += n;
    for (const std::uint64_t n : saved) context.counters().raysSaved += n;
    write(context, out, estimates);
  }

  static Verdict proven(const Rays& all, const Light& light, const LightFrame& axes, const Receiver& receiver,
                        const glm::dvec3& start) {
    const double reach = std::max({std::abs(start.x), std::abs(start.y), std::abs(start.z)}) + all.shafts->magnitude();
    const std::optional<Shaft> shaft =
        Shaft::to(light, axes, all.tracer.origin(), start, receiver.normal, 6.0 * kRoundoff * reach);
    return shaft ? all.shafts->verdict(*shaft, receiver) : Verdict::open;
  }

  static void write(CpuContext& context, const Outputs& out, const std::vector<Estimate>& estimates) {
    std::vector<float> visibility;
    std::vector<float> statistics;
    for (const Estimate& e : estimates) {
      visibility.push_back(static_cast<float>(e.visibility));
      statistics.push_back(static_cast<float>(e.standardError));
      statistics.push_back(static_cast<float>(e.cosineVisibility));
    }
    context.write(out.visibility, visibility);
    if (out.statistics) context.write(*out.statistics, statistics);
  }

  const Parameters& p_;
};

}  // namespace
}  // namespace gnomon

GNOMON_PLUGIN(gnomon::entry<gnomon::RayTraced>("ray_traced", gnomon::parameterTable(),
                                               {.paper = "Cook, Porter, Carpenter, Distributed ray tracing, SIGGRAPH 1984",
                                                .summary = "rays to points of the source: the reference"}))
