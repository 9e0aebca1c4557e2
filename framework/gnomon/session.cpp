#include "gnomon/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "gnomon/base/error.h"
#include "gnomon/base/files.h"
#include "gnomon/gl/state.h"
#include "gnomon/technique/parameter_block.h"

namespace gnomon {

namespace {

gl::ShaderSources frameworkShaders() {
  return {{installationDirectory() / "shaders"}, {}};
}

/// One plan that holds at every pose: what any of them calls for is on.
EffectPlan planForAll(const SessionSetup& setup, const SceneSurvey& nominal) {
  EffectPlan plan = planEffects(nominal, setup.light, setup.camera, setup.overrides);
  for (const Light& pose : setup.lightPoses) {
    const EffectPlan other =
        planEffects(survey(setup.scene, pose, setup.camera, setup.outputSize), pose, setup.camera, setup.overrides);
    for (std::size_t i = 0; i < plan.decisions.size(); ++i) {
      if (other.decisions[i].on && !plan.decisions[i].on) plan.decisions[i] = other.decisions[i];
    }
  }
  return plan;
}

/// From the first row with a pixel above 0.5 to the one behind the last; 0 and 0 where there is none.
glm::ivec2 rowsWithAny(const Image& pixels) {
  const auto above = [](float v) { return v > 0.5f; };
  const auto first = std::find_if(pixels.data.begin(), pixels.data.end(), above);
  if (first == pixels.data.end()) return {0, 0};
  const auto last = std::find_if(pixels.data.rbegin(), pixels.data.rend(), above);
  return {static_cast<int>(first - pixels.data.begin()) / pixels.width,
          static_cast<int>(pixels.data.rend() - last - 1) / pixels.width + 1};
}

/// Of a slot that runs nothing.
const GraphReport kNothing;

/// Never moved: technique and graph refer to `parameters`, and go before them.
struct SlotState {
  std::string name;
  const Entry* entry = nullptr;      ///< null of a picture
  std::shared_ptr<void> parameters;  ///< the session's copy
  std::unique_ptr<Technique> technique;
  Support support;
  std::unique_ptr<Graph> graph;  ///< null when refused, or when no receiver faces the light
  Buffer block;                  ///< the uniform ones of `parameters`
  std::unique_ptr<Graph> shading;
  Texture shaded;
  std::shared_ptr<TextureResource> visibility;
  FrameReport report;  ///< kept, so that frames take no memory
  std::shared_ptr<std::set<std::string>> defences = std::make_shared<std::set<std::string>>();  ///< of its shaders
};

}  // namespace

struct Session::State {
  SessionSetup setup;
  gl::DebugMessages messages;
  SceneSurvey survey;
  EffectPlan plan;
  GpuScene gpu;
  Revisions revisions;
  GraphShares ofSlots;
  GraphShares programsAlone;  ///< for what belongs to no technique
  Graph shared;
  SessionPasses passes;
  std::shared_ptr<TextureResource> fullyLit;
  std::vector<std::unique_ptr<SlotState>> slots;

  explicit State(SessionSetup s)
      : setup(std::move(s)),
        survey(gnomon::survey(setup.scene, setup.light, setup.camera, setup.outputSize)),
        plan(planForAll(setup, survey)),
        gpu(setup.scene),
        ofSlots{std::make_shared<gl::ProgramCache>(), setup.sharePasses ? makeSharedPasses() : nullptr},
        programsAlone{ofSlots.programs, nullptr},
        shared("session", setup.outputSize, frameworkShaders(), programsAlone) {
    passes = sessionPasses(shared.builder(), setup.outputSize);
    const std::vector<Texture> kept{passes.gbuffer.position, passes.gbuffer.normal, passes.gbuffer.ids, passes.gbuffer.depth,
                                    passes.gbuffer.mask,     passes.shadingNormal,  passes.albedo};
    shared.compile(kept);
    fullyLit = std::make_shared<TextureResource>();
    fullyLit->name = "fully lit";
    fullyLit->info = {setup.outputSize, Format::r16f};
    fullyLit->object = gl::makeTexture2D(GL_R16F, setup.outputSize, "fully lit");
    const float one = 1.0f;
    glClearTexImage(fullyLit->object.name(), 0, GL_RED, GL_FLOAT, &one);
    messages.throwIfError("session set-up");
  }

  FrameInputs inputs() const {
    return {setup.scene, survey.instanceBounds, gpu, setup.light, setup.camera, setup.outputSize, 0.0};
  }

  const GraphReport& run(Graph& graph, const GraphRun& options) {
    GraphRun all = options;
    all.skipUnchanged = options.skipUnchanged && plan.has(Rule::skipping);
    all.messages = &messages;
    return graph.run(inputs(), revisions, all);
  }

  GBuffer importGBuffer(GraphBuilder& graph) const {
    const auto bring = [&](const char* name, Texture texture) {
      const Texture imported = graph.import(name, shared.resource(texture));
      graph.provide(name, imported);
      return imported;
    };
    const GBuffer& g = passes.gbuffer;
    graph.provide("View", graph.import("View", shared.resource(passes.view)));
    graph.provide("LightView", graph.import("LightView", shared.resource(passes.lightView)));
    return {bring("gPosition", g.position), bring("gNormal", g.normal), bring("gIds", g.ids), bring("gDepth", g.depth),
            bring("gMask", g.mask)};
  }

  /// Whether a texture can be shown as visibility.
  void requireVisibility(const TextureInfo& info) const {
    if (info.size == setup.outputSize && (info.format == Format::r16f || info.format == Format::r32f)) return;
    throw Error(fmt::format("its visibility is {}x{} {}; it must be r16f or r32f of the output's size, {}x{}", info.size.x,
                            info.size.y, formatFacts(info.format).name, setup.outputSize.x, setup.outputSize.y));
  }

  void setUpTechnique(SlotState& slot, const OpenTechnique& technique) {
    gl::ShaderSources sources = frameworkShaders();
    sources.directories.insert(sources.directories.begin(), technique.directories.begin(), technique.directories.end());
    sources.defencesOff = plan.defencesOff();
    sources.defencesMet = slot.defences;
    slot.graph = std::make_unique<Graph>(slot.name, setup.outputSize, std::move(sources), ofSlots);
    GraphBuilder& graph = slot.graph->builder();
    const FieldTable& table = *technique.entry->parameters;
    const std::vector<std::byte> block = parameterBlockBytes(table, slot.parameters.get());
    slot.block = graph.buffer("Parameters", block.size());
    slot.graph->uniforms().write(slot.block, block);
    graph.provide("Parameters", slot.block);
    graph.include("parameters", parameterBlockText(table));
    slot.graph->specialise(parameterConstants(table, slot.parameters.get()));

    Frame frame{setup.outputSize, setup.light, importGBuffer(graph), 0, slot.block};
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &frame.maxTextureSize);
    slot.support = slot.technique->support(survey, setup.light, frame);
    if (!slot.support.ok()) {
      slot.graph.reset();
      return;
    }
    const Outputs outputs = slot.technique->setup(graph, frame, plan);
    if (!outputs.visibility) throw Error("setup gave no visibility texture");
    slot.visibility = slot.graph->resource(outputs.visibility);
    requireVisibility(slot.visibility->info);
    std::vector<Texture> kept{outputs.visibility};
    if (outputs.admissible) kept.push_back(*outputs.admissible);
    slot.graph->compile(kept);
    requireDeclared(*slot.entry, *slot.defences);
  }

  void setUpShading(SlotState& slot) {
    slot.shading = std::make_unique<Graph>("shading", setup.outputSize, frameworkShaders(), programsAlone);
    GraphBuilder& graph = slot.shading->builder();
    importGBuffer(graph);
    graph.provide("gShadingNormal", graph.import("gShadingNormal", shared.resource(passes.shadingNormal)));
    graph.provide("gAlbedo", graph.import("gAlbedo", shared.resource(passes.albedo)));
    slot.shaded = shadingPass(graph, graph.import("visibility", slot.visibility));
    slot.shading->compile(std::span(&slot.shaded, 1));
  }

  SlotState& at(Slot slot) { return *slots.at(slot.index); }

  /// Runs code of a plugin. Whatever it throws is copied into an Error that names it; what OpenGL said of it, and state that
  /// it left, end with it.
  template <class Work>
  decltype(auto) guarded(const std::string& technique, const Work& work) {
    struct Restored {
      ~Restored() { gl::restoreState(); }
    } const restored;
    std::string message;
    try {
      return work();
    } catch (const std::exception& error) {
      message = error.what();
    } catch (...) {
      message = "it threw something that is no std::exception";
    }
    messages.discard();
    throw Error(fmt::format("technique '{}': {}", technique, message));
  }

  std::unique_ptr<SlotState> makeSlot(const OpenTechnique& technique, const void* parameters) {
    auto slot = std::make_unique<SlotState>();
    slot->name = technique.registered->declaration.name;
    slot->entry = technique.entry;
    guarded(slot->name, [&] {
      slot->parameters = technique.entry->makeParameters();
      copyValues(*technique.entry->parameters, slot->parameters.get(), parameters);
      slot->technique = technique.entry->create(slot->parameters.get());
      if (plan.has(Rule::receivers)) {
        setUpTechnique(*slot, technique);
      } else {
        slot->visibility = fullyLit;  // nothing can be shadowed: nothing runs
      }
      if (slot->support.ok()) setUpShading(*slot);
      messages.throwIfError("set-up");
    });
    return slot;
  }

  std::unique_ptr<SlotState> makePicture(const std::shared_ptr<TextureResource>& visibility) {
    auto slot = std::make_unique<SlotState>();
    slot->name = visibility->name;
    slot->visibility = visibility;
    requireVisibility(visibility->info);
    setUpShading(*slot);
    messages.throwIfError("set-up of a picture");
    return slot;
  }

  /// Whether the slot can go on with these values: the technique is the same, and its structure.
  static bool serves(const SlotState& slot, const OpenTechnique& technique, const void* parameters) {
    if (slot.entry != technique.entry || slot.name != technique.registered->declaration.name) return false;
    return agree(slot, parameters, Binding::structure);
  }

  static bool agree(const SlotState& slot, const void* parameters, Binding binding) {
    const std::vector<Field>& fields = slot.entry->parameters->fields();
    return std::all_of(fields.begin(), fields.end(), [&](const Field& field) {
      return field.binding != binding || equalValue(field, slot.parameters.get(), parameters);
    });
  }

  /// Programs first: if one does not compile, all stays as it was.
  void writeParameters(SlotState& slot, const void* parameters) {
    const FieldTable& table = *slot.entry->parameters;
    const bool sameConstants = agree(slot, parameters, Binding::specialise);
    if (sameConstants && agree(slot, parameters, Binding::uniform)) return;
    if (slot.graph && !sameConstants) {
      guarded(slot.name, [&] { slot.graph->specialise(parameterConstants(table, parameters)); });
      slot.graph->touch(slot.block);  // cpu passes see constants through the parameters themselves
    }
    for (const Field& field : table.fields()) {
      if (field.binding != Binding::structure) copyValue(field, slot.parameters.get(), parameters);
    }
    if (!slot.graph) return;
    slot.graph->uniforms().write(slot.block, parameterBlockBytes(table, parameters));
    guarded(slot.name, [&] { slot.graph->refreshSharing(); });
  }
};

Session::Session(SessionSetup setup) : state_(std::make_unique<State>(std::move(setup))) {}
Session::~Session() = default;

const Scene& Session::scene() const {
  return state_->setup.scene;
}
const Light& Session::light() const {
  return state_->setup.light;
}
const Camera& Session::camera() const {
  return state_->setup.camera;
}
glm::ivec2 Session::outputSize() const {
  return state_->setup.outputSize;
}
const SceneSurvey& Session::survey() const {
  return state_->survey;
}
const EffectPlan& Session::plan() const {
  return state_->plan;
}

void Session::moveLight(const Light& light) {
  state_->setup.light = light;
  ++state_->revisions[Input::light];
}

void Session::moveCamera(const Camera& camera) {
  state_->setup.camera = camera;
  ++state_->revisions[Input::camera];
}

void Session::moveInstances(const std::vector<glm::dmat4>& worlds) {
  std::vector<Instance>& instances = state_->setup.scene.instances;
  if (worlds.size() != instances.size())
    throw Error(fmt::format("{} transforms for {} instances", worlds.size(), instances.size()));
  for (std::size_t i = 0; i < worlds.size(); ++i) {
    instances[i].world = worlds[i];
    state_->survey.instanceBounds[i] = worldBounds(state_->setup.scene, instances[i]);
  }
  ++state_->revisions[Input::geometry];
}

void Session::restrictReceivers(const Image& pixels) {
  Restriction& restriction = *state_->passes.restriction;
  const GLuint texture = restriction.pixels->object.name();
  const glm::ivec2 size = state_->setup.outputSize;
  if (pixels.data.empty()) {
    const float one = 1.0f;
    glClearTexImage(texture, 0, GL_RED, GL_FLOAT, &one);
    restriction.region = glm::ivec4(0, 0, size);
  } else if (pixels.width == size.x && pixels.height == size.y && pixels.channels == 1) {
    const glm::ivec2 rows = rowsWithAny(pixels);
    const int count = rows.y - rows.x;
    if (count > 0) {
      glTextureSubImage2D(texture, 0, 0, rows.x, size.x, count, GL_RED, GL_FLOAT, pixels.data.data() + pixels.index(0, rows.x));
    }
    restriction.region = {0, rows.x, size.x, count};
  } else {
    throw Error(
        fmt::format("receivers are restricted by {}x{} pixels of {} channels; it must be one channel of the output's "
                    "size, {}x{}",
                    pixels.width, pixels.height, pixels.channels, size.x, size.y));
  }
  ++restriction.pixels->revision;
}

Slot Session::addSlot(const OpenTechnique& technique, const std::shared_ptr<const void>& parameters) {
  state_->slots.push_back(state_->makeSlot(technique, parameters.get()));
  return {state_->slots.size() - 1};
}

void Session::replaceSlot(Slot slot, const OpenTechnique& technique, const std::shared_ptr<const void>& parameters) {
  state_->slots.at(slot.index) = state_->makeSlot(technique, parameters.get());
}

bool Session::setParameters(Slot slot, const OpenTechnique& technique, const std::shared_ptr<const void>& parameters) {
  if (!State::serves(state_->at(slot), technique, parameters.get())) {
    replaceSlot(slot, technique, parameters);
    return true;
  }
  state_->writeParameters(state_->at(slot), parameters.get());
  return false;
}

Slot Session::addPicture(const std::shared_ptr<TextureResource>& visibility) {
  state_->slots.push_back(state_->makePicture(visibility));
  return {state_->slots.size() - 1};
}

void Session::replacePicture(Slot slot, const std::shared_ptr<TextureResource>& visibility) {
  auto made = state_->makePicture(visibility);
  state_->slots.at(slot.index) = std::move(made);
}

void Session::removeSlots() {
  state_->slots.clear();
}

void Session::cut() {
  for (const auto& slot : state_->slots) {
    if (slot->graph) slot->graph->cut();
  }
}

const Support& Session::support(Slot slot) const {
  return state_->at(slot).support;
}
Facts Session::facts(Slot slot) const {
  return state_->at(slot).graph ? state_->at(slot).graph->facts() : Facts{};
}
std::set<std::string> Session::defences(Slot slot) const {
  return *state_->at(slot).defences;
}
std::size_t Session::memoryBytes(Slot slot) const {
  return state_->at(slot).graph ? state_->at(slot).graph->memoryBytes() : 0;
}
std::vector<std::string> Session::passNames(Slot slot) const {
  return state_->at(slot).graph ? state_->at(slot).graph->passNames() : std::vector<std::string>{};
}

bool Session::hasCpuPasses(Slot slot) const {
  return state_->at(slot).graph && state_->at(slot).graph->hasCpuPasses();
}

const GraphReport& Session::runShared(const GraphRun& options) {
  return state_->run(state_->shared, options);
}

const GraphReport& Session::runTechnique(Slot slot, const GraphRun& options) {
  SlotState& s = state_->at(slot);
  if (!s.graph) return kNothing;
  return state_->guarded(s.name, [&]() -> const GraphReport& {
    s.technique->update(state_->inputs(), s.graph->uniforms());
    return state_->run(*s.graph, options);
  });
}

const GraphReport& Session::runShading(Slot slot, const GraphRun& options) {
  return state_->run(*state_->at(slot).shading, options);
}

const FrameReport& Session::frame(Slot slot, const GraphRun& options) {
  FrameReport& report = state_->at(slot).report;
  report.shared = runShared(options);
  report.technique = runTechnique(slot, options);
  report.shading = runShading(slot, options);
  return report;
}

Image Session::visibility(Slot slot) const {
  return readTexture(*state_->at(slot).visibility);
}
Image Session::shaded(Slot slot) const {
  return state_->at(slot).shading->read(state_->at(slot).shaded);
}
const TextureResource& Session::visibilityTexture(Slot slot) const {
  return *state_->at(slot).visibility;
}
const TextureResource& Session::shadedTexture(Slot slot) const {
  const SlotState& s = state_->at(slot);
  return *s.shading->resource(s.shaded);
}
std::vector<std::shared_ptr<TextureResource>> Session::textures(Slot slot) const {
  std::vector<std::shared_ptr<TextureResource>> all = state_->shared.textures();
  if (const auto& graph = state_->at(slot).graph) {
    const auto own = graph->textures();
    all.insert(all.end(), own.begin(), own.end());
  }
  std::erase_if(all, [](const auto& texture) { return texture->info.format == Format::rg32ui || texture->info.layers > 0; });
  return all;
}
std::optional<std::size_t> Session::instanceAt(glm::ivec2 pixel) const {
  const glm::ivec2 size = outputSize();
  if (pixel.x < 0 || pixel.y < 0 || pixel.x >= size.x || pixel.y >= size.y) return std::nullopt;
  std::array<std::uint32_t, 2> ids{~0U, ~0U};
  glGetTextureSubImage(state_->shared.resource(state_->passes.gbuffer.ids)->object.name(), 0, pixel.x, pixel.y, 0, 1, 1, 1,
                       GL_RG_INTEGER, GL_UNSIGNED_INT, sizeof(ids), ids.data());
  return ids[0] < scene().instances.size() ? std::optional<std::size_t>(ids[0]) : std::nullopt;
}
Image Session::receiverMask() const {
  return state_->shared.read(state_->passes.gbuffer.mask);
}
Image Session::positions() const {
  return state_->shared.read(state_->passes.gbuffer.position);
}
Image Session::normals() const {
  return state_->shared.read(state_->passes.gbuffer.normal);
}

}  // namespace gnomon
