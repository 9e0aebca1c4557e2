// Lights and what runs in a frame.
#include "gnomon/session/state.h"

#include "gnomon/base/files.h"

namespace gnomon {

namespace {

/// One plan that holds at every pose: what any of them calls for is on.
EffectPlan planForAll(const Scene& scene, const SessionSetup& setup, const Light& light, std::span<const Light> poses,
                      const SceneSurvey& nominal) {
  EffectPlan plan = planEffects(nominal, light, setup.camera, setup.overrides);
  for (const Light& pose : poses) {
    const EffectPlan other =
        planEffects(survey(scene, pose, setup.camera, setup.outputSize), pose, setup.camera, setup.overrides);
    for (std::size_t i = 0; i < plan.decisions.size(); ++i) {
      if (other.decisions[i].on && !plan.decisions[i].on) plan.decisions[i] = other.decisions[i];
    }
  }
  return plan;
}

/// Of a slot that runs nothing.
const GraphReport kNothing;

}  // namespace

gl::ShaderSources frameworkShaders() {
  return {{installationDirectory() / "shaders"}, {}};
}

// --- JoinedReport ---

void JoinedReport::clear() {
  report_.counters = {};
  passes_ = 0;
}

void JoinedReport::add(const GraphReport& report) {
  report_.counters += report.counters;
  if (report_.passes.size() < passes_ + report.passes.size()) report_.passes.resize(passes_ + report.passes.size());
  for (const PassReport& pass : report.passes) report_.passes[passes_++] = pass;
}

const GraphReport& JoinedReport::finish() {
  report_.passes.resize(passes_);
  return report_;
}

// --- set-up ---

Session::State::State(SessionSetup setup)
    : scene(std::move(setup.scene)),
      camera(setup.camera),
      outputSize(setup.outputSize),
      gpu(scene),
      alone{std::make_shared<gl::ProgramCache>(), nullptr},
      shared("session", outputSize, frameworkShaders(), alone),
      passes(sessionPasses(shared.builder(), outputSize)),
      restriction(everywhere(outputSize)) {
  const GBuffer& g = passes.gbuffer;
  const std::vector<Texture> kept{g.position, g.normal, g.ids, g.depth, passes.shadingNormal, passes.albedo};
  shared.compile(kept);
  addLight(setup, setup.light, setup.lightPoses);
  for (const Light& light : setup.moreLights) addLight(setup, light, {});
  fullyLit = std::make_shared<TextureResource>();
  fullyLit->name = "fully lit";
  fullyLit->info = {outputSize, Format::r16f};
  fullyLit->object = gl::makeTexture2D(GL_R16F, outputSize, "fully lit");
  const float one = 1.0f;
  glClearTexImage(fullyLit->object.name(), 0, GL_RED, GL_FLOAT, &one);
  messages.throwIfError("session set-up");
}

void Session::State::addLight(const SessionSetup& setup, const Light& light, std::span<const Light> poses) {
  auto made = std::make_unique<LightState>();
  made->light = light;
  made->survey = gnomon::survey(scene, light, camera, outputSize);
  made->plan = planForAll(scene, setup, light, poses, made->survey);
  made->shares = {alone.programs, setup.sharePasses ? makeSharedPasses() : nullptr};
  // The name is that of labels in debuggers.
  const std::string name = lights.empty() ? "session" : fmt::format("session, light {}", lights.size());
  made->graph = std::make_unique<Graph>(name, outputSize, frameworkShaders(), alone);
  importGBuffer(made->graph->builder());
  made->passes = lightPasses(made->graph->builder(), restriction);
  made->graph->compile(std::span(&made->passes.mask, 1));
  lights.push_back(std::move(made));
}

LightState& Session::State::lightAt(std::size_t light) const {
  if (light < lights.size()) return *lights[light];
  throw Error(fmt::format("light {}: the session has {}, counted from 0", light, lights.size()));
}

// --- running ---

FrameInputs Session::State::inputs(const LightState& light) const {
  return {scene, light.survey.instanceBounds, gpu, light.light, camera, outputSize, 0.0};
}

const GraphReport& Session::State::run(Graph& graph, const LightState& light, const GraphRun& options) {
  GraphRun all = options;
  all.skipUnchanged = options.skipUnchanged && light.plan.has(Rule::skipping);
  all.messages = &messages;
  Revisions seen = revisions;
  seen[Input::light] = light.revision;
  return graph.run(inputs(light), seen, all);
}

const GraphReport& Session::State::runShared(const GraphRun& options) {
  sharedReport.clear();
  sharedReport.add(run(shared, *lights.front(), options));
  for (const auto& light : lights) sharedReport.add(run(*light->graph, *light, options));
  return sharedReport.finish();
}

const GraphReport& Session::State::runTechnique(SlotState& slot, const GraphRun& options) {
  if (slot.isSum()) {
    slot.joined.clear();
    for (const std::size_t index : slot.summed) slot.joined.add(runTechnique(*slots[index], options));
    return slot.joined.finish();
  }
  if (!slot.graph) return kNothing;
  return guarded(slot.name, [&]() -> const GraphReport& {
    slot.technique->update(inputs(*lights[slot.light]), slot.graph->uniforms());
    return run(*slot.graph, *lights[slot.light], options);
  });
}

}  // namespace gnomon
