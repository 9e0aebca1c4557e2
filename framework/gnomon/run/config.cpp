#include "gnomon/run/config.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "gnomon/base/files.h"
#include "gnomon/run/regime.h"
#include "gnomon/run/scene_choice.h"

namespace gnomon {
namespace {

/// Seeds belong to the framework: it renders the reference twice with two of them, and shares none with techniques.
constexpr const char* kReserved = "seed";

void checkReserved(const Json& values, const Location& where, Problems& problems) {
  if (!values.contains(kReserved)) return;
  problems.add(where.file, where.child(kReserved).pointer, "\"seed\" is reserved: the framework chooses seeds itself");
}

Json writeJson(const void* value) {
  const auto& json = *static_cast<const std::shared_ptr<const Json>*>(value);
  return json ? *json : Json::object();
}

std::shared_ptr<const CustomField> parametersField() {
  auto field = std::make_shared<CustomField>();
  field->read = [](const Json& json, void* value, const Location& where, Problems& problems) {
    if (!json.is_object()) return reportWrong(json, "an object of parameter values", where, problems);
    checkReserved(json, where, problems);
    *static_cast<std::shared_ptr<const Json>*>(value) = std::make_shared<const Json>(json);
  };
  field->write = writeJson;
  field->schema = [] { return Json{{"type", "object"}, {"propertyNames", {{"not", {{"const", kReserved}}}}}}; };
  return field;
}

void checkSweepValues(const Json& values, const Location& where, Problems& problems) {
  if (!values.is_array() || values.empty()) return reportWrong(values, "a list of at least one value", where, problems);
  std::set<std::string> seen;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Json value = values[i].is_number() ? Json(values[i].get<double>()) : values[i];  // 3 and 3.0 are one value
    if (seen.insert(value.dump()).second) continue;
    problems.add(where.file, where.child(i).pointer, fmt::format("{} is listed twice", shortText(values[i])));
  }
}

std::shared_ptr<const CustomField> sweepField() {
  auto field = std::make_shared<CustomField>();
  field->read = [](const Json& json, void* value, const Location& where, Problems& problems) {
    if (!json.is_object()) return reportWrong(json, "an object with a list of values under each parameter", where, problems);
    checkReserved(json, where, problems);
    for (const auto& [name, values] : json.items()) checkSweepValues(values, where.child(name), problems);
    *static_cast<std::shared_ptr<const Json>*>(value) = std::make_shared<const Json>(json);
  };
  field->write = writeJson;
  field->schema = [] {
    return Json{{"type", "object"},
                {"propertyNames", {{"not", {{"const", kReserved}}}}},
                {"additionalProperties", {{"type", "array"}, {"minItems", 1}, {"uniqueItems", true}}}};
  };
  return field;
}

void checkSweep(const TechniqueChoice& choice, const Location& where, Problems& problems) {
  if (!choice.sweep) return;
  const Location sweep = where.child("sweep");
  std::size_t combinations = 1;
  for (const auto& [name, values] : choice.sweep->items()) {
    if (choice.parameters && choice.parameters->contains(name)) {
      problems.add(where.file, sweep.child(name).pointer,
                   fmt::format("\"{}\" is also set in parameters; allowed: one of both", name));
    }
    if (combinations <= kMostSweepCombinations) combinations *= values.size();
  }
  if (combinations > kMostSweepCombinations) {
    problems.add(where.file, sweep.pointer, fmt::format("the sweep has more than {} combinations", kMostSweepCombinations));
  }
}

Field techniqueField() {
  return text("technique", &TechniqueChoice::technique, "name of a registered technique").mandatory();
}
Field presetField() {
  return custom("parameters", &TechniqueChoice::parameters, parametersField(), "values that differ from defaults");
}

/// Reference and baseline.
std::shared_ptr<const FieldTable> singleTechniqueTable() {
  return ParameterTable<TechniqueChoice>{techniqueField(), presetField()}.table();
}

std::shared_ptr<const FieldTable> sweptTechniqueTable() {
  return ParameterTable<TechniqueChoice>{
      techniqueField(), presetField(),
      custom("sweep", &TechniqueChoice::sweep, sweepField(), "parameters with several values: a job for each combination")}
      .checked(checkSweep)
      .table();
}

std::shared_ptr<const FieldTable> outputTable() {
  return ParameterTable<OutputChoice>{
      size("size", &OutputChoice::size, {.min = 1, .max = 16384, .unit = "pixels"}, Binding::structure, "of the picture"),
      list("images", &OutputChoice::images, nullptr, "pictures to write")
          .among({"shaded", "visibility", "error", "work", "class", "reference"})}
      .table();
}

std::shared_ptr<const FieldTable> measureTable() {
  return ParameterTable<MeasureChoice>{
      list("regimes", &MeasureChoice::regimes, nullptr,
           "what changes from frame to frame: dynamic: the light turns; animated: it turns and casters move; camera: the "
           "camera turns; static: nothing")
          .among(RegimePath::names()),
      integer("frames", &MeasureChoice::frames, {.min = 1, .max = 100000}, Binding::structure, "timed frames of each regime"),
      integer("blocks", &MeasureChoice::blocks, {.min = 1, .max = 1000}, Binding::structure,
              "blocks of the order technique, baseline, baseline, technique that share the frames"),
      integer("shimmer_frames", &MeasureChoice::shimmerFrames, {.min = 0, .max = 1000}, Binding::structure,
              "frames of each path, the light's and the camera's, along which shimmer is measured; 0: it is not")}
      .table();
}

void checkConfig(const RunConfig& config, const Location& where, Problems& problems) {
  const auto report = [&](const char* key, const char* message) {
    problems.add(where.file, where.child(key).pointer, message);
  };
  if (config.name.empty()) report("name", "found \"\"; allowed: text of at least one letter");
  if (config.lights && config.lights->empty())
    report("lights", "found []; allowed: at least one light, or no such key for the scene's own");
  if (config.techniques.empty()) report("techniques", "found []; allowed: at least one technique");
}

std::shared_ptr<const FieldTable> configTable() {
  return ParameterTable<RunConfig>{
      text("name", &RunConfig::name, "what results call the config; without it, the file's name"),
      custom("scene", &RunConfig::scenes, sceneChoiceField(), "a built-in scene or a glTF file, or a list of them").mandatory(),
      object("plan", &RunConfig::plan, planOverridesTable(), "effects and rules to force on or off"),
      object("camera", &RunConfig::camera, cameraTable(), "without it, the scene's own"),
      list("lights", &RunConfig::lights, lightTable(), "without them, the scene's own"),
      object("output", &RunConfig::output, outputTable(), "the pictures"),
      object("reference", &RunConfig::reference, singleTechniqueTable(), "without it, the technique registered as reference"),
      object("baseline", &RunConfig::baseline, singleTechniqueTable(), "what times are compared with"),
      list("techniques", &RunConfig::techniques, sweptTechniqueTable(), "what is rendered, compared and measured").mandatory(),
      object("measure", &RunConfig::measure, measureTable(), "what is timed")}
      .checked(checkConfig)
      .table();
}

}  // namespace

RunConfig readRunConfigText(const std::filesystem::path& path, std::string_view text, Problems& problems) {
  RunConfig config;
  config.path = path;
  config.name = path.stem().string();
  const Location top{path.string(), ""};
  const std::optional<Json> json = parseJson(top.file, text, problems);
  if (!json) return config;
  readObject(*json, *configTable(), &config, top, problems);

  for (SceneChoice& scene : config.scenes) {
    if (!scene.file.empty()) scene.file = (path.parent_path() / scene.file).lexically_normal();
  }
  if (config.reference) config.reference->where = top.child("reference");
  if (config.baseline) config.baseline->where = top.child("baseline");
  for (std::size_t i = 0; i < config.techniques.size(); ++i) config.techniques[i].where = top.child("techniques").child(i);
  return config;
}

RunConfig readRunConfig(const std::filesystem::path& path, Problems& problems) {
  std::string text;
  try {
    text = readFile(path);
  } catch (const Error& error) {
    problems.add("", "", error.what());
    return {};
  }
  return readRunConfigText(path, text, problems);
}

namespace {

/// What a table's check refuses across keys, in the schema's words: unless `selector` is one of `values`, `key` is as
/// `otherwise` says; without that, what it is when nobody sets it.
void onlyWith(Json& object, const std::string& selector, const std::vector<std::string>& values, const std::string& key,
              Json otherwise = {}) {
  const Json& properties = object["properties"];
  if (otherwise.is_null()) otherwise["const"] = properties[key]["default"];
  Json other;
  other["properties"][selector]["not"]["enum"] = values;
  const auto unset = properties[selector].value("default", std::string());
  if (std::find(values.begin(), values.end(), unset) != values.end()) other["required"] = Json::array({selector});
  Json rule;
  rule["if"] = std::move(other);
  rule["then"]["properties"][key] = std::move(otherwise);
  object["allOf"].push_back(std::move(rule));
}

}  // namespace

Json runConfigSchema() {
  const RunConfig blank;
  Json schema = schemaOf(*configTable(), &blank);
  schema["title"] = "Gnomon run config";
  Json& properties = schema["properties"];
  properties["name"].erase("default");  // the file's name
  properties["name"]["minLength"] = 1;
  properties["lights"]["minItems"] = 1;
  properties["techniques"]["minItems"] = 1;
  Json& light = properties["lights"]["items"];
  onlyWith(light, "type", {"spot"}, "cone_half_angle_degrees");
  Json noSource;
  noSource["properties"]["shape"]["const"] = "none";
  onlyWith(light, "type", {"spot"}, "source", noSource);
  onlyWith(light, "type", {"point"}, "radius");
  onlyWith(light, "type", {"directional"}, "angular_diameter_degrees");
  Json& source = light["properties"]["source"];
  onlyWith(source, "shape", {"rectangle"}, "size");
  onlyWith(source, "shape", {"disc"}, "radius");
  onlyWith(source, "shape", {"rectangle", "disc"}, "roll_degrees");
  Json& camera = properties["camera"];
  onlyWith(camera, "type", {"perspective"}, "vertical_fov_degrees");
  onlyWith(camera, "type", {"orthographic"}, "height");
  camera["properties"]["vertical_fov_degrees"].erase("maximum");
  camera["properties"]["vertical_fov_degrees"]["exclusiveMaximum"] = 180;
  return schema;
}

}  // namespace gnomon
