#include "gnomon/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "gnomon/base/error.h"
#include "gnomon/session/state.h"

namespace gnomon {

namespace {

/// From the first row with a pixel above 0.5 to the one behind the last; 0 and 0 where there is none.
glm::ivec2 rowsWithAny(const Image& pixels) {
  const auto above = [](float v) { return v > 0.5f; };
  const auto first = std::find_if(pixels.data.begin(), pixels.data.end(), above);
  if (first == pixels.data.end()) return {0, 0};
  const auto last = std::find_if(pixels.data.rbegin(), pixels.data.rend(), above);
  return {static_cast<int>(first - pixels.data.begin()) / pixels.width,
          static_cast<int>(pixels.data.rend() - last - 1) / pixels.width + 1};
}

}  // namespace

Session::Session(SessionSetup setup) : state_(std::make_unique<State>(std::move(setup))) {}
Session::~Session() = default;

const Scene& Session::scene() const {
  return state_->scene;
}
std::size_t Session::lights() const {
  return state_->lights.size();
}
const Light& Session::light(std::size_t light) const {
  return state_->lightAt(light).light;
}
const Camera& Session::camera() const {
  return state_->camera;
}
glm::ivec2 Session::outputSize() const {
  return state_->outputSize;
}
const SceneSurvey& Session::survey(std::size_t light) const {
  return state_->lightAt(light).survey;
}
const EffectPlan& Session::plan(std::size_t light) const {
  return state_->lightAt(light).plan;
}

void Session::moveLight(const Light& pose, std::size_t light) {
  LightState& moved = state_->lightAt(light);
  moved.light = pose;
  ++moved.revision;
}

void Session::moveCamera(const Camera& camera) {
  state_->camera = camera;
  ++state_->revisions[Input::camera];
}

void Session::moveInstances(const std::vector<glm::dmat4>& worlds) {
  std::vector<Instance>& instances = state_->scene.instances;
  if (worlds.size() != instances.size())
    throw Error(fmt::format("{} transforms for {} instances", worlds.size(), instances.size()));
  for (std::size_t i = 0; i < worlds.size(); ++i) {
    instances[i].world = worlds[i];
    const Bounds box = worldBounds(state_->scene, instances[i]);
    for (const auto& light : state_->lights) light->survey.instanceBounds[i] = box;
  }
  ++state_->revisions[Input::geometry];
}

void Session::restrictReceivers(const Image& pixels) {
  Restriction& restriction = *state_->restriction;
  const GLuint texture = restriction.pixels->object.name();
  const glm::ivec2 size = state_->outputSize;
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

Slot Session::addSlot(const OpenTechnique& technique, const std::shared_ptr<const void>& parameters, std::size_t light) {
  state_->slots.push_back(state_->makeSlot(technique, parameters.get(), light));
  return {state_->slots.size() - 1};
}

void Session::replaceSlot(Slot slot, const OpenTechnique& technique, const std::shared_ptr<const void>& parameters) {
  const SlotState& before = state_->single(slot, "has no technique of its own; replace one of its slots");
  state_->replace(slot, state_->makeSlot(technique, parameters.get(), before.light));
}

bool Session::setParameters(Slot slot, const OpenTechnique& technique, const std::shared_ptr<const void>& parameters) {
  SlotState& s = state_->single(slot, "has no parameters of its own; set those of its slots");
  if (!State::serves(s, technique, parameters.get())) {
    replaceSlot(slot, technique, parameters);
    return true;
  }
  state_->writeParameters(s, parameters.get());
  return false;
}

Slot Session::addPicture(const std::shared_ptr<TextureResource>& visibility, std::size_t light) {
  state_->slots.push_back(state_->makePicture(visibility, light));
  return {state_->slots.size() - 1};
}

void Session::replacePicture(Slot slot, const std::shared_ptr<TextureResource>& visibility) {
  const SlotState& before = state_->single(slot, "shows no visibility of its own; replace one of its slots");
  state_->replace(slot, state_->makePicture(visibility, before.light));
}

Slot Session::addSum(std::span<const Slot> slots) {
  state_->slots.push_back(state_->makeSum(slots));
  return {state_->slots.size() - 1};
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
  const SlotState& s = state_->single(slot, "states no facts; ask for those of its slots");
  return s.graph ? s.graph->facts() : Facts{};
}
std::set<std::string> Session::defences(Slot slot) const {
  std::set<std::string> all;
  state_->forEach(state_->at(slot), [&](const SlotState& s) { all.insert(s.defences->begin(), s.defences->end()); });
  return all;
}
std::size_t Session::memoryBytes(Slot slot) const {
  std::size_t bytes = 0;
  state_->forEach(state_->at(slot), [&](const SlotState& s) { bytes += s.graph ? s.graph->memoryBytes() : 0; });
  return bytes;
}
std::vector<std::string> Session::passNames(Slot slot) const {
  std::vector<std::string> all;
  state_->forEach(state_->at(slot), [&](const SlotState& s) {
    if (!s.graph) return;
    const std::vector<std::string> own = s.graph->passNames();
    all.insert(all.end(), own.begin(), own.end());
  });
  return all;
}

bool Session::hasCpuPasses(Slot slot) const {
  bool any = false;
  state_->forEach(state_->at(slot), [&](const SlotState& s) { any = any || (s.graph && s.graph->hasCpuPasses()); });
  return any;
}

const GraphReport& Session::runShared(const GraphRun& options) {
  return state_->runShared(options);
}

const GraphReport& Session::runTechnique(Slot slot, const GraphRun& options) {
  return state_->runTechnique(state_->at(slot), options);
}

const GraphReport& Session::runShading(Slot slot, const GraphRun& options) {
  const SlotState& s = state_->at(slot);
  return state_->run(*s.shading.graph, *state_->lights[s.light], options);
}

const FrameReport& Session::frame(Slot slot, const GraphRun& options) {
  FrameReport& report = state_->at(slot).report;
  report.shared = runShared(options);
  report.technique = runTechnique(slot, options);
  report.shading = runShading(slot, options);
  return report;
}

Image Session::visibility(Slot slot) const {
  return readTexture(visibilityTexture(slot));
}
std::optional<Image> Session::statistics(Slot slot) const {
  const auto& statistics = state_->single(slot, "has no statistics; ask for those of one of its slots").statistics;
  return statistics ? std::optional(readTexture(*statistics)) : std::nullopt;
}
Image Session::shaded(Slot slot) const {
  return readTexture(shadedTexture(slot));
}
const TextureResource& Session::visibilityTexture(Slot slot) const {
  return *state_->single(slot, "has no visibility; ask for that of one of its slots").visibility;
}
const TextureResource& Session::shadedTexture(Slot slot) const {
  const Shading& shading = state_->at(slot).shading;
  return *shading.graph->resource(shading.shaded);
}
std::vector<std::shared_ptr<TextureResource>> Session::textures(Slot slot) const {
  std::vector<std::shared_ptr<TextureResource>> all = state_->shared.textures();
  const auto append = [&](const Graph& graph) {
    const auto own = graph.textures();
    all.insert(all.end(), own.begin(), own.end());
  };
  state_->forEach(state_->at(slot), [&](const SlotState& s) {
    append(*state_->lights[s.light]->graph);
    if (s.graph) append(*s.graph);
  });
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
Image Session::receiverMask(std::size_t light) const {
  const LightState& s = state_->lightAt(light);
  return s.graph->read(s.passes.mask);
}
Image Session::positions() const {
  return state_->shared.read(state_->passes.gbuffer.position);
}
Image Session::normals() const {
  return state_->shared.read(state_->passes.gbuffer.normal);
}

}  // namespace gnomon
