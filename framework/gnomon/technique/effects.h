// The effect plan: what a scene calls for, decided from its survey, each with the sentence and the number that decided.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "gnomon/base/table.h"
#include "gnomon/scene/camera.h"
#include "gnomon/scene/light.h"
#include "gnomon/scene/survey.h"

namespace gnomon {

/// What a scene can call for.
enum class Effect : std::uint8_t {
  penumbra,
  varyingPenumbra,
  selfShadowing,
  alphaTestedCasters,
  translucentCasters,
  omnidirectionalLight,
  overlappingPenumbrae,
  largeDepthRange,
  wideView,
  motion
};

/// What the framework makes of the survey by itself, whatever the technique.
enum class Rule : std::uint8_t {
  receivers,     ///< some visible receiver faces the light; off: nothing runs and V is 1
  culling,       ///< casters that cannot reach a visible receiver are left out
  fitting,       ///< near and far of the light's views are fitted to the casters and receivers that matter
  skipping,      ///< a pass of which nothing changed is not run again
  idleReceivers  ///< some receivers cast nothing: maps that are averaged hold them where no caster is
};

inline constexpr std::size_t kEffects = 10;
inline constexpr std::size_t kRules = 5;

constexpr std::size_t planIndex(Effect effect) {
  return static_cast<std::size_t>(effect);
}
constexpr std::size_t planIndex(Rule rule) {
  return kEffects + static_cast<std::size_t>(rule);
}

/// "penumbra", "varying_penumbra", ..., then the rules: in planIndex order, as configs and results spell them.
const std::vector<std::string>& planNames();

enum class Toggle : int { automatic, on, off };  // "auto", "on", "off"

/// What a run config's "plan" says: each decision may be forced.
struct PlanOverrides {
  std::array<Toggle, kEffects + kRules> toggles{};
  std::vector<std::string> without = {};  ///< names of defences that are switched off: see technique/defences.h

  Toggle& operator[](Effect effect) { return toggles[planIndex(effect)]; }
  Toggle& operator[](Rule rule) { return toggles[planIndex(rule)]; }
  Toggle operator[](Effect effect) const { return toggles[planIndex(effect)]; }
  Toggle operator[](Rule rule) const { return toggles[planIndex(rule)]; }
};

std::shared_ptr<const FieldTable> planOverridesTable();

struct PlanDecision {
  std::string name;  ///< out of planNames(), or "defence NAME"
  bool on = false;
  std::string reason;
  double value = 0.0;  ///< the number that decided; NaN where nothing was measured, infinite where it has no bound
};

/// Writes and reads PlanDecision: keys effect, on, reason, value.
std::shared_ptr<const FieldTable> planDecisionTable();

struct EffectPlan {
  /// Effects, then rules, in planIndex order, then the defences that are off. Empty: nothing was decided, all effects and
  /// rules are off.
  std::vector<PlanDecision> decisions;

  bool has(Effect effect) const { return isOn(planIndex(effect)); }
  bool has(Rule rule) const { return isOn(planIndex(rule)); }
  /// Whether the defence is on, as all are unless somebody switched them off: GNOMON_DEFENCE(name) for code.
  bool defence(const std::string& name) const;
  std::set<std::string> defencesOff() const;

 private:
  bool isOn(std::size_t index) const { return index < decisions.size() && decisions[index].on; }
};

/// Decides from upper bounds: an effect is off only if the scene cannot show it. An override replaces the decision and keeps
/// the number; its reason says both.
EffectPlan planEffects(const SceneSurvey& survey, const Light& light, const Camera& camera,
                       const PlanOverrides& overrides = {});

}  // namespace gnomon
