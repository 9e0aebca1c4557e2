#include "render.h"

#include <nlohmann/json.hpp>

#include "gnomon/base/files.h"
#include "gnomon/gl/context.h"
#include "gnomon/scene/builtin.h"

namespace gnomon::test {

void ensureContext() {
  // Never destroyed: textures of other statics may outlive it, and leak checkers need the driver loaded.
  static const auto* context = new gl::HeadlessContext({.debug = true});
  static_cast<void>(context);
}

Registry& registry() {
  static Registry registry({installationDirectory() / "plugins"});
  return registry;
}

SessionSetup builtinSetup(const std::string& name, glm::ivec2 size, const std::string& parametersJson) {
  ensureContext();
  const BuiltinScene* builtin = findBuiltinScene(name);
  if (builtin == nullptr) throw Error("no built-in scene '" + name + "'");
  BuiltinParameters parameters = builtin->defaults;
  Problems problems;
  const std::optional<Json> json = parseJson("scene", parametersJson, problems);
  if (json) readObject(*json, *builtin->table, &parameters, {"scene", ""}, problems);
  problems.throwIfAny();
  SessionSetup setup;
  setup.scene = builtin->make(parameters);
  setup.light = setup.scene.lights.at(0);
  setup.camera = setup.scene.camera.value();
  setup.outputSize = size;
  return setup;
}

std::shared_ptr<void> parametersOf(const std::string& technique, const std::string& text) {
  Problems problems;
  const std::optional<Json> json = parseJson("parameters", text, problems);
  problems.throwIfAny();
  std::shared_ptr<void> values = registry().parameters(registry().open(technique), *json, {"parameters", ""}, problems);
  problems.throwIfAny();
  return values;
}

Slot addSlot(Session& session, const std::string& technique, const std::string& json) {
  return session.addSlot(registry().open(technique), parametersOf(technique, json));
}

Image renderVisibility(SessionSetup setup, const std::string& technique, const std::string& json) {
  ensureContext();
  Session session(std::move(setup));
  const Slot slot = addSlot(session, technique, json);
  if (!session.support(slot).ok()) throw Error(technique + " refuses: " + session.support(slot).refusal);
  session.frame(slot);
  return session.visibility(slot);
}

}  // namespace gnomon::test
