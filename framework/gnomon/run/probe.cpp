#include "gnomon/run/probe.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <set>

#include "gnomon/scene/builtin.h"
#include "gnomon/session.h"

namespace gnomon {

namespace {

/// It moves, has contacts, and casters of one another: it calls for most effects.
constexpr const char* kScene = "animated";
constexpr glm::ivec2 kSize{320, 240};

struct KindOfLight {
  std::string name;
  Light light;
};

/// Every kind, in the scene's own light's place and as large as it is far from its target by a twentieth.
std::vector<KindOfLight> kindsOfLight(const Light& at) {
  const double extent = glm::length(at.target - at.position) / 20.0;
  const auto kind = [&](const char* name, LightType type, const auto& change) {
    KindOfLight made{name, {}};
    made.light.type = type;
    made.light.position = at.position;
    made.light.target = at.target;
    change(made.light);
    return made;
  };
  return {kind("directional", LightType::directional, [](Light&) {}),
          kind("directional with an angle", LightType::directional, [](Light& l) { l.angularDiameterDegrees = 2.0; }),
          kind("point", LightType::point, [](Light&) {}),
          kind("point with a radius", LightType::point, [&](Light& l) { l.radius = extent; }),
          kind("spot", LightType::spot, [](Light&) {}),
          kind("spot with a rectangle", LightType::spot,
               [&](Light& l) {
                 l.source.shape = SourceShape::rectangle;
                 l.source.size = {extent, extent};
               }),
          kind("spot with a disc", LightType::spot, [&](Light& l) {
            l.source.shape = SourceShape::disc;
            l.source.radius = extent;
          })};
}

/// The slot's textures without those that every slot shares.
std::vector<TextureFacts> ownTextures(Session& session, Slot slot) {
  const auto all = session.textures(slot);
  const auto visibility = std::find_if(all.begin(), all.end(),
                                       [&](const auto& texture) { return texture.get() == &session.visibilityTexture(slot); });
  if (visibility == all.end()) return {};  // nothing faces the light, and nothing runs
  const auto shared = session.textures(session.addPicture(*visibility));
  std::vector<TextureFacts> own;
  for (const auto& texture : all) {
    if (std::find(shared.begin(), shared.end(), texture) != shared.end()) continue;
    own.push_back({texture->name, texture->info, bytesOf(texture->info)});
  }
  return own;
}

std::vector<Defence> defencesOf(const Entry& entry, const std::set<std::string>& inShaders) {
  std::vector<Defence> found;
  for (const Defence& defence : declaredDefences(entry)) {
    const std::vector<Defence>& own = entry.notes.defences;
    const bool isOwn = std::any_of(own.begin(), own.end(), [&](const Defence& d) { return d.name == defence.name; });
    if (isOwn || inShaders.contains(defence.name)) found.push_back(defence);
  }
  return found;
}

}  // namespace

Probe probeTechnique(const OpenTechnique& technique, const std::shared_ptr<const void>& parameters) {
  const BuiltinScene& builtin = *findBuiltinScene(kScene);
  const Scene scene = builtin.make(builtin.defaults);
  Probe probe;
  std::set<std::string> calledFor;
  std::set<std::string> ignored;
  std::set<std::string> defences;
  for (const KindOfLight& kind : kindsOfLight(scene.lights.at(0))) {
    Session session({scene, kind.light, scene.camera.value(), kSize, {}, {}});
    const Slot slot = session.addSlot(technique, parameters);
    const Support& support = session.support(slot);
    probe.lights.push_back({kind.name, support.refusal});
    if (!support.ok()) continue;
    for (std::size_t i = 0; i < kEffects; ++i) {
      if (session.plan().decisions[i].on) calledFor.insert(planNames()[i]);
    }
    for (const Effect effect : support.ignored) ignored.insert(planNames()[planIndex(effect)]);
    defences.merge(session.defences(slot));
    std::vector<std::string> passes = session.passNames(slot);
    if (!probe.setUp.empty() && passes.size() < probe.passes.size()) continue;
    probe.setUp = fmt::format("{} at {}x{}, {}", kScene, kSize.x, kSize.y, kind.name);
    probe.passes = std::move(passes);
    probe.memoryBytes = session.memoryBytes(slot);
    probe.textures = ownTextures(session, slot);
  }
  for (const std::string& effect : planNames()) {
    if (calledFor.contains(effect)) (ignored.contains(effect) ? probe.ignored : probe.reproduced).push_back(effect);
  }
  probe.defences = defencesOf(*technique.entry, defences);
  return probe;
}

}  // namespace gnomon
