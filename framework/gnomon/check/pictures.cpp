// Checks of what is rendered: the contract of V, at any size and parameter, the same bits again, and near the reference.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "gnomon/check/subject.h"
#include "gnomon/stability/check.h"

namespace gnomon::check {

namespace {

/// One frame of a slot against the contract, every target looked through for NaN and infinity.
std::string faultOf(Session& session, Slot slot) {
  session.frame(slot, {.checkFinite = true});
  return visibilityFault(session.visibility(slot), session.receiverMask());
}

// --- parameters ---

/// Few pixels: an end of a range may be a thousand times as dear as the default.
constexpr glm::ivec2 kFewPixels{24, 18};

/// The ends of a range; an end that is not allowed itself, or without bound, is left out.
std::vector<Json> endsOf(const Field& field) {
  std::vector<Json> ends;
  for (const double end : {field.range.min, field.range.max}) {
    if (!std::isfinite(end) || (end == field.range.min && field.range.openMin)) continue;
    if (field.type == FieldType::integer || field.type == FieldType::size) {
      ends.push_back(static_cast<std::int64_t>(end));
    } else {
      ends.push_back(end);
    }
  }
  return ends;
}

std::vector<Json> extremesOf(const Field& field) {
  switch (field.type) {
    case FieldType::boolean:
      return {false, true};
    case FieldType::choice:
      return {field.choices.begin(), field.choices.end()};
    case FieldType::integer:
    case FieldType::real32:
    case FieldType::real64:
    case FieldType::size:
      return endsOf(field);
    default:
      return {};
  }
}

enum class Met : std::uint8_t { kept, refused };

/// Throws Error that says how the contract is broken. Other parameters may forbid a value: that is a refusal too.
Met meet(const Subject& subject, Session& session, const Field& field, const Json& value) {
  std::shared_ptr<void> parameters;
  try {
    parameters = parametersOf(subject.registry, subject.technique, {{field.name, value}});
  } catch (const InputError&) {
    return Met::refused;
  }
  session.removeSlots();
  const Slot slot = session.addSlot(subject.technique, parameters);
  if (!session.support(slot).ok()) return Met::refused;
  const std::string broken = faultOf(session, slot);
  if (!broken.empty()) throw Error(broken);
  if (field.binding != Binding::uniform) return Met::kept;

  const Image fresh = session.visibility(slot);
  const Slot changed = session.addSlot(subject.technique, parametersOf(subject));
  session.frame(changed);
  session.setParameters(changed, subject.technique, parameters);
  session.frame(changed);
  if (sameBits(fresh, session.visibility(changed))) return Met::kept;
  throw Error(fmt::format("changed while it runs, {}; bind it as structure, or read it in each run, not at set-up",
                          difference(fresh, session.visibility(changed))));
}

// --- bits and inputs ---

/// `light` a little to its side, so that shadows move over many pixels; looking in the same direction.
Light movedLight(Light light) {
  const LightFrame axes = lightFrame(light);
  const double far = glm::length(light.target - light.position);
  // A directional light has no position: its direction turns.
  if (light.type != LightType::directional) light.target += 0.1 * far * axes.x;
  light.position += 0.1 * far * axes.x;
  return light;
}

Camera movedCamera(Camera camera) {
  const glm::dvec3 side = glm::dvec3(glm::transpose(cameraRotation(camera))[0]);
  camera.position += 0.1 * glm::length(camera.target - camera.position) * side;
  return camera;
}

/// The instances that cast, to the side and up by a metre's tenth.
std::vector<glm::dmat4> movedInstances(const Scene& scene) {
  std::vector<glm::dmat4> worlds;
  for (const Instance& instance : scene.instances) {
    worlds.push_back(instance.world);
    worlds.back()[3] += glm::dvec4(0.1, 0.1, 0.0, 0.0);
  }
  worlds.front() = scene.instances.front().world;  // the ground
  return worlds;
}

struct Move {
  const char* what;
  std::function<void(Session&)> move;
  std::function<void(SessionSetup&)> setUp;  ///< as if it had always been there
};

/// A plan that holds before and after, so that both have the same passes.
void requireSamePlan(const EffectPlan& a, const EffectPlan& b) {
  for (std::size_t i = 0; i < a.decisions.size(); ++i) {
    if (a.decisions[i].on != b.decisions[i].on)
      throw Error("the check's own scene calls for other effects after the move: " + a.decisions[i].name);
  }
}

}  // namespace

Finding checkContract(const Subject& subject) {
  Session session(subject.stage);
  const Slot slot = addSlot(session, subject);
  const std::string broken = faultOf(session, slot);
  if (!broken.empty()) return failed(broken);
  const Image v = session.visibility(slot);
  const Image mask = session.receiverMask();
  const auto [least, most] = std::minmax_element(v.data.begin(), v.data.end());
  return passed(fmt::format("{} passes, {}x{} pixels, {} receivers: V from {:.3g} to {:.3g}", session.passNames(slot).size(),
                            v.width, v.height, std::count(mask.data.begin(), mask.data.end(), 1.0f), *least, *most));
}

Finding checkParameters(const Subject& subject) {
  Session session(subject.stageOf(kFewPixels));
  int kept = 0;
  int refused = 0;
  for (const Field& field : subject.technique.entry->parameters->fields()) {
    for (const Json& value : extremesOf(field)) {
      try {
        ++(meet(subject, session, field, value) == Met::kept ? kept : refused);
      } catch (const std::exception& error) {
        return failed(fmt::format("{} = {}: {}", field.name, value.dump(), error.what()));
      }
    }
  }
  return passed(fmt::format("{} parameters at {} extremes, {} of them refused",
                            subject.technique.entry->parameters->fields().size(), kept + refused, refused));
}

Finding checkSizes(const Subject& subject) {
  std::string sizes;
  for (const glm::ivec2 size : {glm::ivec2(1, 1), {1, 97}, {97, 1}, {17, 33}, {127, 3}}) {
    const std::string name = fmt::format("{}x{}", size.x, size.y);
    try {
      Session session(subject.stageOf(size));
      const std::string broken = faultOf(session, addSlot(session, subject));
      if (!broken.empty()) return failed(fmt::format("output {}: {}", name, broken));
    } catch (const std::exception& error) {
      return failed(fmt::format("output {}: {}", name, error.what()));
    }
    sizes += (sizes.empty() ? "" : ", ") + name;
  }
  return passed(sizes);
}

Finding checkBits(const Subject& subject) {
  Session session(subject.stage);
  const Slot slot = addSlot(session, subject);
  const Image first = renderAgain(session, slot);
  const auto compare = [&](const Image& other, const char* when) {
    if (!sameBits(first, other))
      throw Error(
          fmt::format("{}: {}; look for what is kept between frames or sessions, for "
                      "uninitialised memory and for sums in changing order",
                      when, difference(first, other)));
  };
  compare(renderAgain(session, slot), "in the next frame");
  compare(renderFresh(subject, subject.stage), "in a fresh session");
  session.moveLight(movedLight(subject.stage.light));
  session.frame(slot);
  session.moveLight(subject.stage.light);
  session.frame(slot);
  compare(session.visibility(slot), "after the light came back");
  return passed("the same in the next frame, in a fresh session, and after the light came back");
}

Finding checkInputs(const Subject& subject) {
  const Light light = movedLight(subject.stage.light);
  const Camera camera = movedCamera(subject.stage.camera);
  const std::vector<glm::dmat4> worlds = movedInstances(subject.stage.scene);
  const std::vector<Move> moves{
      {"light", [&](Session& s) { s.moveLight(light); }, [&](SessionSetup& s) { s.light = light; }},
      {"camera", [&](Session& s) { s.moveCamera(camera); }, [&](SessionSetup& s) { s.camera = camera; }},
      {"geometry", [&](Session& s) { s.moveInstances(worlds); },
       [&](SessionSetup& s) {
         for (std::size_t i = 0; i < worlds.size(); ++i) s.scene.instances[i].world = worlds[i];
       }}};
  SessionSetup before = subject.stage;
  before.lightPoses = {before.light, light};
  for (const Move& move : moves) {
    Session moved(before);
    const Slot slot = addSlot(moved, subject);
    moved.frame(slot);
    move.move(moved);
    moved.frame(slot);

    SessionSetup after = before;
    move.setUp(after);
    Session fresh(after);
    requireSamePlan(moved.plan(), fresh.plan());
    const Slot freshSlot = addSlot(fresh, subject);
    fresh.frame(freshSlot);
    const Image expected = fresh.visibility(freshSlot);
    if (!sameBits(moved.visibility(slot), expected)) {
      return failed(
          fmt::format("{} moved, against a fresh set-up there: {}; a pass uses Input::{} and does not declare it, or "
                      "something of it was kept at set-up",
                      move.what, difference(moved.visibility(slot), expected), move.what));
    }
  }
  return passed("light, camera and geometry moved: the bits of a fresh set-up there");
}

Finding checkAccuracy(const Subject& subject) {
  if (subject.technique.registered->declaration.role == TechniqueRole::floor) return passed("not asked of the floor");
  const RegisteredTechnique* reference = subject.registry.withRole(TechniqueRole::reference);
  if (reference == nullptr) return {Outcome::refused, "no technique has the role of the reference: nothing to compare with"};
  const OpenTechnique open = subject.registry.open(reference->declaration.name);
  Session session(subject.stage);
  const auto half = [&](int seed) {
    Json overrides = Json::object();
    for (const auto& [key, value] : {std::pair("samples", 64), std::pair("seed", seed)}) {
      if (open.entry->parameters->find(key) != nullptr) overrides[key] = value;
    }
    return renderAgain(session, session.addSlot(open, parametersOf(subject.registry, open, overrides)));
  };
  const Image a = half(1);
  const Image b = half(2);
  const Image v = renderAgain(session, addSlot(session, subject));
  const Image mask = session.receiverMask();
  double error = 0.0;     // sum of (T-A)(T-B), whose mean is the squared error without the reference's noise
  double shadowless = 0;  // the same with T = 1
  std::size_t count = 0;
  for (std::size_t i = 0; i < mask.data.size(); ++i) {
    if (mask.data[i] == 0.0f) continue;
    const auto product = [&](double t) { return (t - static_cast<double>(a.data[i])) * (t - static_cast<double>(b.data[i])); };
    error += product(static_cast<double>(v.data[i]));
    shadowless += product(1.0);
    ++count;
  }
  const auto rms = [&](double sum) { return std::sqrt(std::max(0.0, sum) / static_cast<double>(count)); };
  const std::string figures = fmt::format("RMSE {:.4f}, of a picture without shadows {:.4f}", rms(error), rms(shadowless));
  if (error < shadowless) return passed(figures);
  return failed(figures + "; it does not get nearer to the reference than that: look at it with gnomon-view");
}

Finding checkStability(const Subject& subject) {
  std::vector<const stability::Case*> all;
  for (const stability::Case& c : stability::cases()) all.push_back(&c);
  const stability::StabilityReport report = stability::runStability(subject.registry, {{subject.name()}, all});
  std::string failures;
  for (const stability::CellReport& cell : report.cells) {
    if (cell.outcome != stability::Outcome::fail) continue;
    failures += fmt::format("{}{}", failures.empty() ? "" : ", ", cell.hardCase);
    if (failures.size() == cell.hardCase.size()) failures += fmt::format(" ({})", cell.reasons.at(0));
  }
  const std::string figures = fmt::format("{} hard cases, {} refused, {} failed", report.cells.size(),
                                          report.count(stability::Outcome::refused), report.count(stability::Outcome::fail));
  if (failures.empty()) return passed(figures);
  return failed(fmt::format("{}: {}; `gnomon stability {}` tells each", figures, failures, subject.name()));
}

}  // namespace gnomon::check
