#include "gnomon/check/subject.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "gnomon/scene/builtin.h"

namespace gnomon::check {

namespace {

/// Pillars and bars: contact, distance, umbra and penumbra in few triangles.
constexpr const char* kScene = "pillars";

/// The scene's own area light, then lights for techniques that take no such: without extent, directional, in all directions.
std::vector<Light> lightsFor(const Light& own) {
  std::vector<Light> lights(4, own);
  for (std::size_t i = 1; i < lights.size(); ++i) lights[i].source = {};
  lights[2].type = LightType::directional;
  lights[3].type = LightType::point;
  return lights;
}

/// What follows another technique, and is followed by it: the cheapest, else any.
OpenTechnique neighbourOf(Registry& registry, const OpenTechnique& technique) {
  const RegisteredTechnique* floor = registry.withRole(TechniqueRole::floor);
  if (floor != nullptr && floor != technique.registered) return registry.open(floor->declaration.name);
  for (const RegisteredTechnique& other : registry.techniques()) {
    if (&other != technique.registered && other.declaration.role == TechniqueRole::technique)
      return registry.open(other.declaration.name);
  }
  return technique;
}

}  // namespace

SessionSetup Subject::stageOf(glm::ivec2 size) const {
  SessionSetup setup = stage;
  setup.outputSize = size;
  return setup;
}

Subject makeSubject(Registry& registry, const std::string& name) {
  const OpenTechnique technique = registry.open(name);
  const BuiltinScene* builtin = findBuiltinScene(kScene);
  SessionSetup setup;
  setup.scene = builtin->make(builtin->defaults);
  setup.camera = setup.scene.camera.value();
  setup.outputSize = kOutput;
  std::string refusals;
  const std::shared_ptr<void> parameters = parametersOf(registry, technique, Json::object());
  for (const Light& light : lightsFor(setup.scene.lights.at(0))) {
    setup.light = light;
    Session session(setup);
    const std::string refusal = session.support(session.addSlot(technique, parameters)).refusal;
    if (refusal.empty()) return {registry, technique, neighbourOf(registry, technique), setup};
    refusals = refusal;
  }
  return {registry, technique, neighbourOf(registry, technique), setup, refusals};
}

std::shared_ptr<void> parametersOf(Registry& registry, const OpenTechnique& technique, const Json& overrides) {
  Problems problems;
  std::shared_ptr<void> values = registry.parameters(technique, overrides, {"", ""}, problems);
  problems.throwIfAny();
  return values;
}

std::shared_ptr<void> parametersOf(const Subject& subject) {
  return parametersOf(subject.registry, subject.technique, Json::object());
}

Slot addSlot(Session& session, const Subject& subject) {
  const Slot slot = session.addSlot(subject.technique, parametersOf(subject));
  if (!session.support(slot).ok()) throw Error("it refuses what it accepted before: " + session.support(slot).refusal);
  return slot;
}

Image renderAgain(Session& session, Slot slot) {
  session.frame(slot, {.skipUnchanged = false});
  return session.visibility(slot);
}

Image renderFresh(const Subject& subject, const SessionSetup& setup) {
  Session session(setup);
  return renderAgain(session, addSlot(session, subject));
}

std::string difference(const Image& a, const Image& b) {
  std::size_t count = 0;
  std::size_t first = 0;
  for (std::size_t i = a.data.size(); i-- > 0;) {
    if (std::memcmp(&a.data[i], &b.data[i], sizeof(float)) == 0) continue;
    ++count;
    first = i;
  }
  const auto width = static_cast<std::size_t>(a.width);
  return fmt::format("{} of {} pixels differ, the first at ({}, {}) by {:.3g}", count, a.data.size(), first % width,
                     first / width, static_cast<double>(a.data[first]) - static_cast<double>(b.data[first]));
}

Finding passed(std::string text) {
  return {Outcome::pass, std::move(text)};
}

Finding failed(std::string text) {
  return {Outcome::fail, std::move(text)};
}

}  // namespace gnomon::check
