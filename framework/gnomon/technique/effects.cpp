#include "gnomon/technique/effects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gnomon {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Before the name of a defence, in the decisions of a plan.
const std::string kDefence = "defence ";

/// A decision before its name is known.
struct Finding {
  bool on;
  double value;
  std::string reason;
};

/// A penumbra narrower than this lies within one pixel's step from lit to umbra: sampled at pixel centres, it is not seen.
constexpr double kNarrowestPenumbraPixels = 0.5;

Finding penumbra(const SceneSurvey& survey) {
  if (!survey.sourceHasExtent) return {false, 0.0, "the source has no extent: shadows are hard, and one ray decides V"};
  const double widest = survey.widestPenumbraPixels;
  if (std::isinf(widest)) return {true, widest, "a caster may touch the source: the penumbra's width has no bound"};
  if (widest < kNarrowestPenumbraPixels) {
    return {false, widest,
            fmt::format("the widest possible penumbra is {:.4g} pixels, under {}: nobody searches for it", widest,
                        kNarrowestPenumbraPixels)};
  }
  return {true, widest, fmt::format("the widest possible penumbra is {:.4g} pixels", widest)};
}

Finding varyingPenumbra(const Finding& penumbra) {
  if (!penumbra.on) return {false, 0.0, "there is no penumbra that could vary"};
  return {true, penumbra.value,
          std::isinf(penumbra.value) ? "penumbrae may widen from 0 at contacts without bound"
                                     : fmt::format("penumbrae may widen from 0 at contacts to {:.4g} pixels", penumbra.value)};
}

Finding selfShadowing(const SceneSurvey& survey) {
  const auto both = std::min(survey.casterTriangles, survey.receiverTriangles);
  if (both == 0) return {false, 0.0, "no triangle both casts and receives"};
  return {true, static_cast<double>(both), fmt::format("up to {} triangles both cast and receive", both)};
}

Finding omnidirectionalLight(const Light& light) {
  switch (light.type) {
    case LightType::point:
      return {true, 360.0, "a point light shines all around: 360 degrees"};
    case LightType::directional:
      return {false, 0.0, "a directional light shines one way: 0 degrees"};
    case LightType::spot:
      break;
  }
  const double opening = 2.0 * light.coneHalfAngleDegrees;
  return {false, opening, fmt::format("the spot's cone opens {:.4g} degrees", opening)};
}

Finding overlappingPenumbrae(const SceneSurvey& survey, const Finding& penumbra) {
  const auto casters = static_cast<double>(survey.casterTriangles);
  if (!penumbra.on) return {false, casters, "there is no penumbra that could overlap another"};
  if (survey.casterTriangles < 2) return {false, casters, fmt::format("{} caster triangles: none to overlap", casters)};
  return {true, casters, fmt::format("any of {} caster triangles may overlap in their penumbrae", casters)};
}

/// A 16-bit map of linear depth has 65536 steps: beyond this ratio one step is more than 1/256 of the distance to the nearest
/// caster, and bias has to grow with it.
constexpr double kLargeDepthRatio = 256.0;

Finding largeDepthRange(const SceneSurvey& survey, const Light& light) {
  if (light.type == LightType::directional)
    return {false, 0.0, "a directional light has no distances: depth is fitted to the scene"};
  if (survey.casterTriangles == 0 || survey.facingTriangles == 0) return {false, 0.0, "no depth is compared"};
  const double near = survey.nearestCasterDistance;
  const double ratio = near > 0.0 ? survey.farthestReceiverDistance / near : std::numeric_limits<double>::infinity();
  const bool isLarge = !(ratio <= kLargeDepthRatio);
  return {isLarge, ratio,
          fmt::format("from the nearest caster at {:.3g} m to the farthest receiver at {:.3g} m: a ratio of {:.3g}, {} {}",
                      near, survey.farthestReceiverDistance, ratio, isLarge ? "above" : "at most", kLargeDepthRatio)};
}

Finding wideView(const Camera& camera) {
  if (camera.type == CameraType::orthographic)
    return {false, 1.0, "an orthographic camera's pixels are all of one size: ratio 1"};
  return {false, kUnknown, "the spread of pixel sizes over visible receivers is not surveyed yet"};
}

Finding receivers(const SceneSurvey& survey) {
  const auto facing = static_cast<double>(survey.facingTriangles);
  if (survey.facingTriangles == 0) return {false, facing, "no visible receiver faces the light: nothing runs and V is 1"};
  return {true, facing, fmt::format("{} receiver triangles in view face the light", survey.facingTriangles)};
}

Finding culling(const SceneSurvey& survey) {
  const auto casters = static_cast<double>(survey.casterTriangles);
  if (survey.casterTriangles == 0) return {false, casters, "0 caster triangles: nothing to cull"};
  return {
      true, casters,
      fmt::format("of {} caster triangles, those that cannot reach a visible receiver are left out", survey.casterTriangles)};
}

Finding fitting(const SceneSurvey& survey) {
  const double range = survey.farthestReceiverDistance - survey.nearestCasterDistance;
  if (survey.casterTriangles == 0 || survey.facingTriangles == 0) return {false, 0.0, "no caster and receiver to fit to"};
  return {true, range,
          fmt::format("near and far are fitted to what matters: within {:.3g} to {:.3g} m of the light",
                      survey.nearestCasterDistance, survey.farthestReceiverDistance)};
}

Finding idleReceivers(const SceneSurvey& survey) {
  const std::size_t idle = survey.idleReceiverTriangles;
  return {idle > 0, static_cast<double>(idle),
          idle == 0 ? "0 triangles receive without casting: a map of casters holds every receiver"
                    : fmt::format("{} triangles receive and do not cast: averaged maps hold them where no caster is", idle)};
}

Finding motion(const SceneSurvey& survey) {
  return {survey.movingInstances > 0, static_cast<double>(survey.movingInstances),
          fmt::format("{} instances ride on an animation of the scene", survey.movingInstances)};
}

std::vector<Finding> findings(const SceneSurvey& survey, const Light& light, const Camera& camera) {
  const Finding soft = penumbra(survey);
  return {soft,
          varyingPenumbra(soft),
          selfShadowing(survey),
          {false, 0.0, "0 alpha-tested casters: materials of a scene hold no alpha"},
          {false, 0.0, "0 translucent casters: materials of a scene hold no transmission"},
          omnidirectionalLight(light),
          overlappingPenumbrae(survey, soft),
          largeDepthRange(survey, light),
          wideView(camera),
          motion(survey),
          receivers(survey),
          culling(survey),
          fitting(survey),
          {true, 0.0, "a pass with 0 changed inputs is skipped"},
          idleReceivers(survey)};
}

}  // namespace

const std::vector<std::string>& planNames() {
  static const std::vector<std::string> names = {"penumbra",
                                                 "varying_penumbra",
                                                 "self_shadowing",
                                                 "alpha_tested_casters",
                                                 "translucent_casters",
                                                 "omnidirectional_light",
                                                 "overlapping_penumbrae",
                                                 "large_depth_range",
                                                 "wide_view",
                                                 "motion",
                                                 "receivers",
                                                 "culling",
                                                 "fitting",
                                                 "skipping",
                                                 "idle_receivers"};
  return names;
}

std::shared_ptr<const FieldTable> planOverridesTable() {
  std::vector<Field> fields;
  for (std::size_t i = 0; i < planNames().size(); ++i) {
    Field field;
    field.name = planNames()[i];
    field.type = FieldType::choice;
    field.meaning = "auto: decided from the survey";
    field.choices = {"auto", "on", "off"};
    field.find = [i](const void* object) -> const void* { return &static_cast<const PlanOverrides*>(object)->toggles[i]; };
    field.make = [i](void* object) -> void* { return &static_cast<PlanOverrides*>(object)->toggles[i]; };
    fields.push_back(std::move(field));
  }
  fields.push_back(list("without", &PlanOverrides::without, nullptr,
                        "defences to switch off, to see what each is for: `gnomon describe` names a technique's"));
  return std::make_shared<const FieldTable>(std::move(fields));
}

std::shared_ptr<const FieldTable> planDecisionTable() {
  return ParameterTable<PlanDecision>{
      text("effect", &PlanDecision::name, "the effect or rule"),
      boolean("on", &PlanDecision::on, Binding::structure, "whether it is simulated"),
      text("reason", &PlanDecision::reason, "what decided"),
      real("value", &PlanDecision::value, {}, Binding::structure, "the number that decided; null where none was measured")}
      .table();
}

EffectPlan planEffects(const SceneSurvey& survey, const Light& light, const Camera& camera, const PlanOverrides& overrides) {
  EffectPlan plan;
  for (Finding& finding : findings(survey, light, camera)) {
    const std::size_t index = plan.decisions.size();
    const Toggle toggle = overrides.toggles[index];
    PlanDecision decision{planNames()[index], finding.on, std::move(finding.reason), finding.value};
    if (toggle != Toggle::automatic) {
      decision.on = toggle == Toggle::on;
      decision.reason = fmt::format("set {} by the config; the survey says: {}", decision.on ? "on" : "off", decision.reason);
    }
    plan.decisions.push_back(std::move(decision));
  }
  for (const std::string& name : overrides.without) {
    if (!plan.defence(name)) continue;  // named twice
    plan.decisions.push_back({kDefence + name, false, "switched off by hand: shows what the defence is for", kUnknown});
  }
  return plan;
}

bool EffectPlan::defence(const std::string& name) const {
  return std::none_of(decisions.begin(), decisions.end(), [&](const PlanDecision& d) { return d.name == kDefence + name; });
}

std::set<std::string> EffectPlan::defencesOff() const {
  std::set<std::string> off;
  for (const PlanDecision& d : decisions) {
    if (d.name.starts_with(kDefence)) off.insert(d.name.substr(kDefence.size()));
  }
  return off;
}

}  // namespace gnomon
