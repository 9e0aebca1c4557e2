// Slots: how they are set up, replaced and summed.
#include <algorithm>

#include "gnomon/session/state.h"
#include "gnomon/technique/parameter_block.h"

namespace gnomon {

namespace {

bool agree(const SlotState& slot, const void* parameters, Binding binding) {
  const std::vector<Field>& fields = slot.entry->parameters->fields();
  return std::all_of(fields.begin(), fields.end(), [&](const Field& field) {
    return field.binding != binding || equalValue(field, slot.parameters.get(), parameters);
  });
}

}  // namespace

// --- what slots are given ---

GBuffer Session::State::importGBuffer(GraphBuilder& graph) const {
  const auto bring = [&](const char* name, Texture texture) {
    const Texture imported = graph.import(name, shared.resource(texture));
    graph.provide(name, imported);
    return imported;
  };
  const GBuffer& g = passes.gbuffer;
  graph.provide("View", graph.import("View", shared.resource(passes.view)));
  return {bring("gPosition", g.position), bring("gNormal", g.normal), bring("gIds", g.ids), bring("gDepth", g.depth), {}};
}

LightPasses Session::State::importLight(GraphBuilder& graph, const LightState& light) const {
  return {graph.import("gMask", light.graph->resource(light.passes.mask)),
          graph.import("LightView", light.graph->resource(light.passes.lightView))};
}

/// Whether a texture can be shown as visibility.
void Session::State::requireVisibility(const TextureInfo& info) const {
  if (info.size == outputSize && (info.format == Format::r16f || info.format == Format::r32f)) return;
  throw Error(fmt::format("its visibility is {}x{} {}; it must be r16f or r32f of the output's size, {}x{}", info.size.x,
                          info.size.y, formatFacts(info.format).name, outputSize.x, outputSize.y));
}

// --- set-up ---

void Session::State::setUpTechnique(SlotState& slot, const OpenTechnique& technique) {
  const LightState& light = *lights[slot.light];
  gl::ShaderSources sources = frameworkShaders();
  sources.directories.insert(sources.directories.begin(), technique.directories.begin(), technique.directories.end());
  sources.defencesOff = light.plan.defencesOff();
  sources.defencesMet = slot.defences;
  slot.graph = std::make_unique<Graph>(slot.name, outputSize, std::move(sources), light.shares);
  GraphBuilder& graph = slot.graph->builder();
  const FieldTable& table = *technique.entry->parameters;
  const std::vector<std::byte> block = parameterBlockBytes(table, slot.parameters.get());
  slot.block = graph.buffer("Parameters", block.size());
  slot.graph->uniforms().write(slot.block, block);
  graph.provide("Parameters", slot.block);
  graph.include("parameters", parameterBlockText(table));
  slot.graph->specialise(parameterConstants(table, slot.parameters.get()));

  Frame frame{outputSize, light.light, importGBuffer(graph), 0, slot.block};
  const LightPasses own = importLight(graph, light);
  graph.provide("gMask", own.mask);
  graph.provide("LightView", own.lightView);
  frame.gbuffer.mask = own.mask;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &frame.maxTextureSize);
  slot.support = slot.technique->support(light.survey, light.light, frame);
  if (!slot.support.ok()) {
    slot.graph.reset();
    return;
  }
  const Outputs outputs = slot.technique->setup(graph, frame, light.plan);
  if (!outputs.visibility) throw Error("setup gave no visibility texture");
  slot.visibility = slot.graph->resource(outputs.visibility);
  requireVisibility(slot.visibility->info);
  std::vector<Texture> kept{outputs.visibility};
  if (outputs.admissible) kept.push_back(*outputs.admissible);
  if (outputs.statistics) {
    slot.statistics = slot.graph->resource(*outputs.statistics);
    kept.push_back(*outputs.statistics);
  }
  slot.graph->compile(kept);
  requireDeclared(*slot.entry, *slot.defences);
}

Shading Session::State::makeShading(std::span<const SlotState* const> shown) const {
  if (shown.empty()) return {};
  Shading made{std::make_unique<Graph>("shading", outputSize, frameworkShaders(), alone), {}};
  GraphBuilder& graph = made.graph->builder();
  importGBuffer(graph);
  graph.provide("gShadingNormal", graph.import("gShadingNormal", shared.resource(passes.shadingNormal)));
  graph.provide("gAlbedo", graph.import("gAlbedo", shared.resource(passes.albedo)));
  std::vector<ShownLight> all;
  for (const SlotState* slot : shown) {
    all.push_back({graph.import("visibility", slot->visibility), importLight(graph, *lights[slot->light])});
  }
  made.shaded = shadingPasses(graph, all);
  made.graph->compile(std::span(&made.shaded, 1));
  return made;
}

Shading Session::State::makeShading(const SlotState& slot) const {
  const SlotState* const shown = &slot;
  return makeShading(std::span(&shown, slot.support.ok() ? 1 : 0));
}

std::unique_ptr<SlotState> Session::State::makeSlot(const OpenTechnique& technique, const void* parameters, std::size_t light) {
  const EffectPlan& plan = lightAt(light).plan;
  auto slot = std::make_unique<SlotState>();
  slot->name = technique.registered->declaration.name;
  slot->light = light;
  slot->entry = technique.entry;
  guarded(slot->name, [&] {
    slot->parameters = technique.entry->makeParameters();
    copyValues(*technique.entry->parameters, slot->parameters.get(), parameters);
    slot->technique = technique.entry->create(slot->parameters.get());
    if (!slot->technique) throw Error(fmt::format("its entry '{}' made no technique", technique.entry->name));
    if (plan.has(Rule::receivers)) {
      setUpTechnique(*slot, technique);
    } else {
      slot->visibility = fullyLit;  // nothing can be shadowed: nothing runs
    }
    slot->shading = makeShading(*slot);
    messages.throwIfError("set-up");
  });
  return slot;
}

std::unique_ptr<SlotState> Session::State::makePicture(const std::shared_ptr<TextureResource>& visibility, std::size_t light) {
  auto slot = std::make_unique<SlotState>();
  slot->name = visibility->name;
  slot->light = light;
  slot->visibility = visibility;
  lightAt(light);
  requireVisibility(visibility->info);
  slot->shading = makeShading(*slot);
  messages.throwIfError("set-up of a picture");
  return slot;
}

// --- sums ---

std::unique_ptr<SlotState> Session::State::makeSum(std::span<const Slot> of) {
  if (of.empty()) throw Error("a sum of no slots; give it at least one");
  auto sum = std::make_unique<SlotState>();
  sum->name = "sum";
  for (const Slot slot : of) {
    single(slot, "is none to sum; give the slots it is of");
    sum->summed.push_back(slot.index);
  }
  sum->light = slots[sum->summed.front()]->light;
  SumPicture picture = pictureOf(*sum);
  sum->support = std::move(picture.support);
  sum->shading = std::move(picture.shading);
  messages.throwIfError("set-up of a sum");
  return sum;
}

SumPicture Session::State::pictureOf(const SlotState& sum) const {
  std::vector<const SlotState*> shown;
  forEach(sum, [&](const SlotState& slot) {
    if (slot.support.ok()) shown.push_back(&slot);
  });
  return {shown.empty() ? slots[sum.summed.front()]->support : Support{}, makeShading(shown)};
}

void Session::State::replace(Slot slot, std::unique_ptr<SlotState> made) {
  std::swap(slots[slot.index], made);
  try {
    std::vector<std::pair<SlotState*, SumPicture>> pictures;
    for (const auto& other : slots) {
      if (std::find(other->summed.begin(), other->summed.end(), slot.index) == other->summed.end()) continue;
      pictures.emplace_back(other.get(), pictureOf(*other));
    }
    for (auto& [sum, picture] : pictures) {
      sum->support = std::move(picture.support);
      sum->shading = std::move(picture.shading);
    }
  } catch (...) {
    std::swap(slots[slot.index], made);
    throw;
  }
}

SlotState& Session::State::single(Slot slot, const char* what) const {
  SlotState& state = at(slot);
  if (state.isSum()) throw Error(fmt::format("slot {}: a sum of lights {}", slot.index, what));
  return state;
}

// --- parameters ---

bool Session::State::serves(const SlotState& slot, const OpenTechnique& technique, const void* parameters) {
  if (slot.entry != technique.entry || slot.name != technique.registered->declaration.name) return false;
  return agree(slot, parameters, Binding::structure);
}

/// Programs first: if one does not compile, all stays as it was.
void Session::State::writeParameters(SlotState& slot, const void* parameters) {
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

}  // namespace gnomon
