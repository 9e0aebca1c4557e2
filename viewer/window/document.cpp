#include "document.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "gnomon/base/json.h"
#include "gnomon/scene/gltf.h"

namespace gnomon {

namespace {

/// A light for a scene that brings none: above, to one side, and wide enough for all of it.
Light lightFor(const Scene& scene) {
  const Bounds bounds = worldBounds(scene);
  const double size = bounds.empty() ? 1.0 : std::max(bounds.diagonal(), 1e-9);
  Light light;
  light.target = bounds.empty() ? glm::dvec3(0.0) : bounds.centre();
  light.position = light.target + glm::dvec3(0.6, 1.2, 0.5) * size;
  light.coneHalfAngleDegrees = 30.0;
  light.source.shape = SourceShape::rectangle;
  light.source.size = glm::dvec2(0.1 * size);
  return light;
}

/// All registered techniques on a glTF file, as if a config had named them.
ResolvedRun runOfScene(const std::filesystem::path& file, Registry& registry) {
  ResolvedRun run;
  run.config.name = file.stem().string();
  run.config.scenes.push_back({});
  run.config.scenes.back().file = file;
  run.scene = loadGltf(file);
  run.sceneName = file.filename().string();
  run.lights = run.scene.lights;
  if (run.lights.empty()) run.lights.push_back(lightFor(run.scene));
  run.camera = run.scene.camera.value_or(Camera{});
  Problems problems;
  const auto open = [&](const std::string& name) {
    ResolvedTechnique resolved;
    resolved.technique = registry.open(name);
    resolved.parameters = registry.parameters(resolved.technique, Json::object(), {}, problems);
    return resolved;
  };
  for (const std::string& name : registry.names()) run.jobs.push_back({0, open(name)});
  if (const auto* reference = registry.withRole(TechniqueRole::reference)) run.reference = open(reference->declaration.name);
  if (const auto* floor = registry.withRole(TechniqueRole::floor)) run.baseline = open(floor->declaration.name);
  problems.throwIfAny();
  if (run.jobs.empty()) throw Error("no technique is registered; name their folder with --technique-dir");
  return run;
}

}  // namespace

std::vector<std::filesystem::path> Document::files() const {
  std::vector<std::filesystem::path> all{subject};
  const std::filesystem::path& file = run.config.scenes.at(scene).file;
  if (!file.empty() && file != subject) all.push_back(file);
  return all;
}

std::vector<const Field*> editableFields(const ResolvedTechnique& technique) {
  const bool isReference = technique.technique.registered->declaration.role == TechniqueRole::reference;
  std::vector<const Field*> fields;
  for (const Field& field : technique.technique.entry->parameters->fields()) {
    if (!isReference || field.name != "seed") fields.push_back(&field);
  }
  return fields;
}

Json asConfigEntry(const ResolvedTechnique& technique) {
  Problems saidAlready;
  const std::shared_ptr<void> own = presetOf(technique.technique, saidAlready);
  const Json all = technique.parametersJson();
  Json entry{{"technique", technique.name()}};
  for (const Field* field : editableFields(technique)) {
    if (!equalValue(*field, own.get(), technique.parameters.get())) entry["parameters"][field->name] = all.at(field->name);
  }
  return entry;
}

Document loadDocument(const std::filesystem::path& subject, std::size_t scene,
                      const std::vector<std::filesystem::path>& techniqueDirectories,
                      const std::shared_ptr<Libraries>& libraries) {
  Document document;
  document.subject = subject;
  document.scene = scene;
  document.registry = std::make_shared<Registry>(techniqueDirectories, libraries);
  if (subject.extension() == ".json") {
    Problems problems;
    std::vector<ResolvedRun> runs = resolveRuns(subject, *document.registry, problems);
    // A technique that is missing may be so because its own file is broken: that says more.
    if (!problems.empty()) problems.append(document.registry->problems());
    problems.throwIfAny();
    document.scenes = runs.size();
    if (scene >= runs.size())
      throw InputError({{subject.string(), "/scene", fmt::format("has {} scenes now, the one shown is gone", runs.size())}});
    document.run = std::move(runs[scene]);
  } else {
    document.run = runOfScene(subject, *document.registry);
  }
  for (const ResolvedJob& job : document.run.jobs) {
    if (job.light != 0) continue;  // each light has the same
    document.techniques.push_back({.technique = job.technique, .asWritten = copyOf(job.technique, *document.registry)});
  }
  document.cameras = document.run.scene.cameras;
  const auto isTheRuns = [&](const NamedCamera& named) {
    return writeObject(*cameraTable(), &named.camera) == writeObject(*cameraTable(), &document.run.camera);
  };
  // The first is what the picture begins with.
  const auto same = std::find_if(document.cameras.begin(), document.cameras.end(), isTheRuns);
  if (same != document.cameras.end()) {
    std::rotate(document.cameras.begin(), same, same + 1);
  } else {
    document.cameras.insert(document.cameras.begin(), {"the config's", document.run.camera});
  }
  document.sceneHash = contentHash(document.run.scene);
  return document;
}

void keepEdits(Document& fresh, const Document& old) {
  for (std::size_t i = 0; i < fresh.techniques.size(); ++i) {
    // Of several entries of one technique, the one at the same place.
    const auto same = [&](std::size_t k) {
      return k < old.techniques.size() && old.techniques[k].technique.name() == fresh.techniques[i].technique.name();
    };
    std::size_t k = i;
    for (std::size_t at = 0; !same(k) && at < old.techniques.size(); ++at) k = at;
    if (!same(k)) continue;
    const ViewerTechnique& before = old.techniques[k];
    const Json now = before.technique.parametersJson();
    const Json written = before.asWritten.parametersJson();
    Json edits = Json::object();
    for (const auto& [key, value] : now.items()) {
      if (!written.contains(key) || written[key] != value) edits[key] = value;
    }
    if (edits.empty()) continue;
    ViewerTechnique& after = fresh.techniques[i];
    Json all = after.asWritten.parametersJson();
    all.update(edits);
    Problems refused;  // the new table may lack the parameter or its value: then the files' values stand
    const std::shared_ptr<void> values = fresh.registry->parameters(after.technique.technique, all, {}, refused);
    if (refused.empty()) after.technique.parameters = values;
  }
}

}  // namespace gnomon
