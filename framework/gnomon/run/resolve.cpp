#include "gnomon/run/resolve.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "gnomon/scene/gltf.h"

namespace gnomon {

namespace {

/// Of the reference, both halves together, unless the config says otherwise: rays a pixel at most, and the standard error of V
/// at which a pixel needs no more of them.
constexpr int kReferenceSamples = 4096;
constexpr double kReferenceStandardError = 0.0025;

/// Reports, as InputError, a name that no node with a mesh bears.
void checkNode(const Scene& scene, const std::string& name, const Location& where) {
  const std::vector<Instance>& all = scene.instances;
  if (std::any_of(all.begin(), all.end(), [&](const Instance& instance) { return instance.name == name; })) return;
  std::vector<std::string> known;
  for (const Instance& instance : all) known.push_back(instance.name);
  const std::string nearest = nearestName(name, known);
  throw InputError({{where.file, where.pointer,
                     fmt::format("no node of the scene is named '{}'{}", name,
                                 nearest.empty() ? "" : "; did you mean '" + nearest + "'?")}});
}

/// Sets a flag of exactly the named nodes' instances; a name that no node bears is a fault.
void flagNamed(Scene& scene, const std::vector<std::string>& names, bool Instance::*flag, const Location& where) {
  for (const std::string& name : names) checkNode(scene, name, where);
  for (Instance& instance : scene.instances)
    instance.*flag = std::find(names.begin(), names.end(), instance.name) != names.end();
}

/// Poses what is animated as it is at `seconds`.
void poseScene(Scene& scene, double seconds, const Location& where) {
  if (!(duration(scene) > 0.0)) {
    throw InputError(
        {{where.file, where.pointer, fmt::format("found {}; nothing in the scene is animated: leave this key out", seconds)}});
  }
  setPose(scene, seconds);
}

/// Moves the instances of that name, now and in all poses.
void moveNamed(Scene& scene, const std::string& name, const glm::dvec3& by, const Location& where) {
  checkNode(scene, name, where);
  for (Instance& instance : scene.instances)
    if (instance.name == name) instance.world[3] += glm::dvec4(by, 0.0);
  for (Animation::Rider& rider : scene.animation.riders)
    if (scene.instances[rider.instance].name == name) rider.offset += by;
}

/// Opens a technique and checks its parameters, which stand at `parametersAt` in the entry at `where`; null entry when that
/// failed.
ResolvedTechnique resolveTechnique(Registry& registry, const std::string& name, const Json& parameters,
                                   const Location& parametersAt, const Location& where, Problems& problems) {
  ResolvedTechnique resolved;
  try {
    resolved.technique = registry.open(name);
    resolved.parameters = registry.parameters(resolved.technique, parameters, parametersAt, problems);
  } catch (const InputError& error) {
    for (const Problem& p : error.problems()) {
      problems.add(p.file.empty() ? where.file : p.file, p.file.empty() ? where.pointer + "/technique" : p.pointer, p.message);
    }
  } catch (const Error& error) {
    problems.add(where.file, where.pointer + "/technique", error.what());
  }
  return resolved;
}

Json objectOf(const std::shared_ptr<const Json>& json) {
  return json ? *json : Json::object();
}

}  // namespace

Json ResolvedTechnique::parametersJson() const {
  return writeObject(*technique.entry->parameters, parameters.get());
}

std::string ResolvedTechnique::parametersText() const {
  Problems saidAlready;
  const std::shared_ptr<void> defaults = presetOf(technique, saidAlready);
  std::string text;
  for (const Field& field : technique.entry->parameters->fields()) {
    const std::string value = valueText(field, parameters.get());
    if (value == valueText(field, defaults.get())) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", field.name, value);
  }
  return text;
}

Scene loadScene(const SceneChoice& choice, const Location& where) {
  Scene scene;
  if (!choice.builtin.empty()) {
    const BuiltinScene* builtin = findBuiltinScene(choice.builtin);
    if (builtin == nullptr)
      throw InputError({{where.file, where.pointer + "/builtin", "no built-in scene is named '" + choice.builtin + "'"}});
    scene = builtin->make(choice.parameters);
  } else {
    try {
      scene = loadGltf(choice.file);
    } catch (const InputError&) {
      throw;
    } catch (const Error& error) {
      throw InputError({{where.file, where.pointer + "/file", error.what()}});
    }
  }
  if (choice.cast) flagNamed(scene, *choice.cast, &Instance::casts, where.child("cast"));
  if (choice.receive) flagNamed(scene, *choice.receive, &Instance::receives, where.child("receive"));
  if (choice.time != 0.0) poseScene(scene, choice.time, where.child("time"));
  for (const auto& [name, by] : choice.moves) moveNamed(scene, name, by, where.child("move").child(name));
  return scene;
}

namespace {

ResolvedRun resolveScene(const RunConfig& config, std::size_t index, Registry& registry, Problems& problems) {
  ResolvedRun run;
  run.config = config;
  const std::string file = config.path.string();
  const SceneChoice& choice = config.scenes[index];
  const std::string scenePointer = config.scenes.size() == 1 ? "/scene" : fmt::format("/scene/{}", index);
  // A scene that cannot be had must not hide what is wrong with the techniques.
  bool loaded = false;
  try {
    loaded = !choice.builtin.empty() || !choice.file.empty();  // else said already
    if (loaded) run.scene = loadScene(choice, {file, scenePointer});
  } catch (const InputError& error) {
    loaded = false;
    for (const Problem& p : error.problems()) problems.add(p.file.empty() ? file : p.file, p.pointer, p.message);
  }
  run.time = choice.time;
  run.sceneName = choice.builtin.empty() ? choice.file.filename().string() : choice.builtin;
  run.lights = config.lights.value_or(run.scene.lights);
  if (loaded && !config.lights && run.lights.empty()) {
    problems.add(
        file, "/lights",
        fmt::format("the config names no light and {} has none; add \"lights\": [{{\"type\": \"spot\", ...}}]", run.sceneName));
  }
  run.camera = config.camera.value_or(run.scene.camera.value_or(Camera{}));

  const auto withRole = [&](TechniqueRole role, const std::optional<TechniqueChoice>& chosen, const std::string& key) {
    if (chosen)
      return resolveTechnique(registry, chosen->technique, objectOf(chosen->parameters), chosen->where.child("parameters"),
                              chosen->where, problems);
    if (const RegisteredTechnique* registered = registry.withRole(role)) {
      return resolveTechnique(registry, registered->declaration.name, Json::object(), {file, "/" + key + "/parameters"},
                              {file, "/" + key}, problems);
    }
    problems.add(file, "/" + key, fmt::format("no registered technique has the role of {}; name one", key));
    return ResolvedTechnique{};
  };
  run.reference = withRole(TechniqueRole::reference, config.reference, "reference");
  if (run.reference.technique.entry != nullptr) {
    int* samples = reservedParameter(run.reference, "samples");
    const auto isChosen = [&](const char* key) {
      return config.reference && config.reference->parameters && config.reference->parameters->contains(key);
    };
    if (!isChosen("samples")) {  // who asks for a number of samples gets them
      if (samples != nullptr) *samples = kReferenceSamples;
      double* target = reservedReal(run.reference, "standard_error");
      if (target != nullptr && !isChosen("standard_error")) *target = kReferenceStandardError;
    }
    if (samples != nullptr && *samples < 2) {
      problems.add(file, "/reference/parameters/samples",
                   "found 1; allowed: 2 or more, since the reference is rendered as two halves");
    }
  }
  run.baseline = withRole(TechniqueRole::floor, config.baseline, "baseline");

  for (const JobRequest& request : expandJobs(config, std::max<std::size_t>(run.lights.size(), 1))) {
    Problems found;
    ResolvedTechnique technique = resolveTechnique(registry, request.technique, *request.parameters, request.where,
                                                   config.techniques[request.entry].where, found);
    problems.append(atTheirPlaces(found, request));
    run.jobs.push_back({request.light, std::move(technique)});
  }
  for (std::size_t i = 0; i < config.plan.without.size(); ++i) {
    reportIfUndeclared(config.plan.without[i], entriesOf(run), Location{file, "/plan/without"}.child(i), problems);
  }
  return run;
}

/// The parameter's value; null when the technique has none of that name and type.
void* reserved(const ResolvedTechnique& technique, const std::string& name, FieldType type) {
  const Field* field = technique.technique.entry->parameters->find(name);
  return field != nullptr && field->type == type ? field->make(technique.parameters.get()) : nullptr;
}

}  // namespace

std::vector<const Entry*> entriesOf(const ResolvedRun& run) {
  std::vector<const Entry*> entries{run.reference.technique.entry, run.baseline.technique.entry};
  for (const ResolvedJob& job : run.jobs) entries.push_back(job.technique.technique.entry);
  return entries;
}

std::vector<ResolvedRun> resolveRuns(const std::filesystem::path& path, Registry& registry, Problems& problems) {
  Problems found;
  RunConfig config = readRunConfig(path, found);
  if (config.scenes.empty() && !found.empty())
    config.scenes.emplace_back();  // said already; techniques are checked all the same
  std::vector<ResolvedRun> runs;
  for (std::size_t i = 0; i < config.scenes.size(); ++i) runs.push_back(resolveScene(config, i, registry, found));
  problems.append(found.unique());  // a wrong parameter is found for every scene, light and value of a sweep
  return runs;
}

int* reservedParameter(const ResolvedTechnique& technique, const std::string& name) {
  return static_cast<int*>(reserved(technique, name, FieldType::integer));
}
double* reservedReal(const ResolvedTechnique& technique, const std::string& name) {
  return static_cast<double*>(reserved(technique, name, FieldType::real64));
}
bool* reservedFlag(const ResolvedTechnique& technique, const std::string& name) {
  return static_cast<bool*>(reserved(technique, name, FieldType::boolean));
}

ResolvedTechnique copyOf(const ResolvedTechnique& technique, Registry& registry) {
  ResolvedTechnique copy = technique;
  Problems none;
  copy.parameters = registry.parameters(technique.technique, technique.parametersJson(), {}, none);
  none.throwIfAny();
  return copy;
}

}  // namespace gnomon
