#include "gnomon/run/resolve.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "gnomon/scene/gltf.h"

namespace gnomon {

namespace {

/// Sets a flag of exactly the named nodes' instances; a name that no node bears is a fault.
void flagNamed(Scene& scene, const std::vector<std::string>& names, bool Instance::*flag, const std::string& key, const std::string& file) {
  std::vector<std::string> known;
  for (Instance& instance : scene.instances) {
    instance.*flag = std::find(names.begin(), names.end(), instance.name) != names.end();
    known.push_back(instance.name);
  }
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const std::string nearest = nearestName(name, known);
    throw InputError({{file, "/scene/" + key, fmt::format("no node of the scene is named '{}'{}", name,
                                                          nearest.empty() ? "" : "; did you mean '" + nearest + "'?")}});
  }
}

/// Opens a technique and checks its parameters; null entry when that failed.
ResolvedTechnique resolveTechnique(Registry& registry, const std::string& name, const Json& parameters, const Location& where, Problems& problems) {
  ResolvedTechnique resolved;
  try {
    resolved.technique = registry.open(name);
    resolved.parameters = registry.parameters(resolved.technique, parameters, where.child("parameters"), problems);
  } catch (const InputError& error) {
    for (const Problem& p : error.problems()) {
      problems.add(p.file.empty() ? where.file : p.file, p.file.empty() ? where.pointer + "/technique" : p.pointer, p.message);
    }
  } catch (const Error& error) {
    problems.add(where.file, where.pointer + "/technique", error.what());
  }
  return resolved;
}

Json objectOf(const std::shared_ptr<const Json>& json) { return json ? *json : Json::object(); }

}  // namespace

Json ResolvedTechnique::parametersJson() const { return writeObject(*technique.entry->parameters, parameters.get()); }

std::string ResolvedTechnique::parametersText() const {
  const std::shared_ptr<void> defaults = technique.entry->makeParameters();
  std::string text;
  for (const Field& field : technique.entry->parameters->fields()) {
    const std::string value = valueText(field, parameters.get());
    if (value == valueText(field, defaults.get())) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", field.name, value);
  }
  return text;
}

Scene loadScene(const SceneChoice& choice) {
  Scene scene;
  if (!choice.builtin.empty()) {
    const BuiltinScene* builtin = findBuiltinScene(choice.builtin);
    if (builtin == nullptr) throw InputError({{"", "/scene/builtin", "no built-in scene is named '" + choice.builtin + "'"}});
    scene = builtin->make(choice.parameters);
  } else {
    scene = loadGltf(choice.file);
  }
  if (choice.cast) flagNamed(scene, *choice.cast, &Instance::casts, "cast", choice.file.string());
  if (choice.receive) flagNamed(scene, *choice.receive, &Instance::receives, "receive", choice.file.string());
  return scene;
}

ResolvedRun resolveRun(const std::filesystem::path& path, Registry& registry, Problems& problems) {
  ResolvedRun run;
  const std::string file = path.string();
  run.config = readRunConfig(path, problems);
  if (run.config.scene.builtin.empty() && run.config.scene.file.empty()) return run;  // said already

  try {
    run.scene = loadScene(run.config.scene);
  } catch (const InputError& error) {
    for (const Problem& p : error.problems()) problems.add(p.file.empty() ? file : p.file, p.pointer, p.message);
  }
  run.sceneName = run.config.scene.builtin.empty() ? run.config.scene.file.filename().string() : run.config.scene.builtin;
  run.lights = run.config.lights.value_or(run.scene.lights);
  if (run.lights.empty() && problems.empty()) {
    problems.add(file, "/lights", fmt::format("the config names no light and {} has none; add \"lights\": [{{\"type\": \"spot\", ...}}]", run.sceneName));
  }
  run.camera = run.config.camera.value_or(run.scene.camera.value_or(Camera{}));

  const auto withRole = [&](TechniqueRole role, const std::optional<TechniqueChoice>& chosen, const std::string& key) {
    const Location where{file, "/" + key};
    if (chosen) return resolveTechnique(registry, chosen->technique, objectOf(chosen->parameters), chosen->where, problems);
    const RegisteredTechnique* registered = registry.withRole(role);
    if (registered == nullptr) {
      problems.add(file, where.pointer, fmt::format("no registered technique has the role of {}; name one", key));
      return ResolvedTechnique{};
    }
    return resolveTechnique(registry, registered->declaration.name, Json::object(), where, problems);
  };
  run.reference = withRole(TechniqueRole::reference, run.config.reference, "reference");
  if (run.reference.technique.entry != nullptr && !run.config.reference) {
    if (int* samples = reservedParameter(run.reference, "samples")) *samples = 1024;  // 2 x 512, unless the config says otherwise
  }
  if (run.reference.technique.entry != nullptr) {
    if (int* samples = reservedParameter(run.reference, "samples"); samples != nullptr && *samples < 2) {
      problems.add(file, "/reference/parameters/samples", "the reference is rendered as two halves and needs at least 2 samples");
    }
  }
  run.baseline = withRole(TechniqueRole::floor, run.config.baseline, "baseline");

  for (const JobRequest& request : expandJobs(run.config, run.lights.size())) {
    Problems found;
    ResolvedTechnique technique;
    try {
      technique.technique = registry.open(request.technique);
      technique.parameters = registry.parameters(technique.technique, *request.parameters, request.where, found);
      problems.append(atTheirPlaces(found, request));
    } catch (const InputError& error) {
      if (request.light > 0) continue;
      const TechniqueChoice& choice = run.config.techniques[request.entry];
      for (const Problem& p : error.problems()) {
        problems.add(p.file.empty() ? file : p.file, p.file.empty() ? choice.where.pointer + "/technique" : p.pointer, p.message);
      }
    } catch (const Error& error) {
      problems.add(file, run.config.techniques[request.entry].where.pointer + "/technique", error.what());
    }
    run.jobs.push_back({request.light, std::move(technique)});
  }
  return run;
}

int* reservedParameter(const ResolvedTechnique& technique, const std::string& name) {
  const Field* field = technique.technique.entry->parameters->find(name);
  if (field == nullptr || field->type != FieldType::integer) return nullptr;
  return static_cast<int*>(field->make(technique.parameters.get()));
}

ResolvedTechnique copyOf(const ResolvedTechnique& technique, Registry& registry) {
  ResolvedTechnique copy = technique;
  Problems none;
  copy.parameters = registry.parameters(technique.technique, technique.parametersJson(), {}, none);
  none.throwIfAny();
  return copy;
}

}  // namespace gnomon
