// A technique of known cost: it spins and sleeps for as long as it is told to, and draws one pass of some work.
#include <gnomon/plugin.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <thread>

namespace gnomon {
namespace {

struct Parameters {
  float spin = 0.0f;
  float sleep = 0.0f;
  int loops = 64;
  int label = 0;
};

ParameterTable<Parameters> parameterTable() {
  return {real("spin", &Parameters::spin, {.min = 0.0, .max = 100.0, .unit = "ms"}, Binding::structure, "processor time"),
          real("sleep", &Parameters::sleep, {.min = 0.0, .max = 100.0, .unit = "ms"}, Binding::structure, "wall time"),
          integer("loops", &Parameters::loops, {.min = 1, .max = 4096}, Binding::specialise, "work a pixel"),
          integer("label", &Parameters::label, {.min = 0, .max = 1000}, Binding::structure, "tells equal jobs apart")};
}

double threadMs() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

class Busy final : public Technique {
 public:
  explicit Busy(const Parameters& parameters) : p_(parameters) {}

  Support support(const SceneSurvey& /*survey*/, const Light& /*light*/, const Frame& /*frame*/) const override { return {}; }

  Outputs setup(GraphBuilder& graph, const Frame& /*frame*/, const EffectPlan& /*plan*/) override {
    const Buffer done = graph.buffer("Done", sizeof(float));
    graph.cpu("spin and sleep",
              {.inputs = {Input::light, Input::camera}, .buffers = {done}, .run = [done, p = p_](CpuContext& context) {
                 const double end = threadMs() + p.spin;
                 while (threadMs() < end) continue;
                 if (p.sleep > 0.0f) std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(p.sleep));
                 context.writeBlock(done,
                                    static_cast<float>(std::fmod(threadMs(), 1.0)));  // another each time: what reads it runs
               }});
    return {.visibility = graph.fullscreen("draw", {.shader = "busy.frag", .buffers = {{"Done", done}}})};
  }

 private:
  const Parameters& p_;
};

}  // namespace
}  // namespace gnomon

GNOMON_PLUGIN(gnomon::entry<gnomon::Busy>("busy", gnomon::parameterTable(), {}))
