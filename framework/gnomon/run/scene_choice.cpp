#include "gnomon/run/scene_choice.h"

#include <nlohmann/json.hpp>

#include "gnomon/run/config.h"

namespace gnomon {
namespace {

/// The form with a file, before paths are joined.
struct FileChoice {
  std::string file;
  std::optional<std::vector<std::string>> cast, receive;
};

std::shared_ptr<const FieldTable> fileTable() {
  return ParameterTable<FileChoice>{
      text("file", &FileChoice::file, "a .gltf or .glb file, relative to the config").mandatory(),
      list("cast", &FileChoice::cast, nullptr, "names of the nodes that cast; without it, all do"),
      list("receive", &FileChoice::receive, nullptr, "names of the nodes that receive; without it, all do")}
      .checked([](const FileChoice& choice, const Location& where, Problems& problems) {
        if (choice.file.empty()) reportWrong(choice.file, "the path of a .gltf or .glb file", where.child("file"), problems);
      })
      .table();
}

std::vector<std::string> builtinNames() {
  std::vector<std::string> names;
  for (const BuiltinScene& scene : builtinScenes()) names.push_back(scene.name);
  return names;
}

void readBuiltin(const Json& json, SceneChoice& choice, const Location& where, Problems& problems) {
  const Location nameAt = where.child("builtin");
  const Json& name = json["builtin"];
  if (!name.is_string()) return reportWrong(name, "the name of a built-in scene", nameAt, problems);
  if (json.contains("file"))
    return problems.add(where.file, where.pointer, "found both \"builtin\" and \"file\"; allowed: one of both");
  const BuiltinScene* scene = findBuiltinScene(name.get<std::string>());
  if (scene == nullptr) return reportUnknown("built-in scene", name.get<std::string>(), builtinNames(), nameAt, problems);
  choice.builtin = scene->name;
  choice.parameters = scene->defaults;
  Json keys = json;
  keys.erase("builtin");
  readObject(keys, *scene->table, &choice.parameters, where, problems);
}

void readScene(const Json& json, SceneChoice& choice, const Location& where, Problems& problems) {
  if (json.is_object() && json.contains("builtin")) return readBuiltin(json, choice, where, problems);
  if (!json.is_object() || !json.contains("file")) {
    return reportWrong(json, R"({"builtin": NAME, ...} or {"file": PATH, ...})", where, problems);
  }
  FileChoice read;
  readObject(json, *fileTable(), &read, where, problems);
  choice.file = read.file;
  choice.cast = read.cast;
  choice.receive = read.receive;
}

Json writeScene(const SceneChoice& choice) {
  if (choice.builtin.empty()) {
    const FileChoice file{choice.file.string(), choice.cast, choice.receive};
    return writeObject(*fileTable(), &file);
  }
  Json json = {{"builtin", choice.builtin}};
  if (const BuiltinScene* scene = findBuiltinScene(choice.builtin)) json.update(writeObject(*scene->table, &choice.parameters));
  return json;
}

/// One schema a scene, chosen by the name, so that editors complain about the key that is wrong and not about the whole.
Json sceneSchema() {
  Json branches = Json::array();
  for (const BuiltinScene& scene : builtinScenes()) {
    Json keys = objectSchema(*scene.table, &scene.defaults);
    keys["properties"]["builtin"] = {{"const", scene.name}, {"description", scene.purpose}};
    branches.push_back({{"if", {{"properties", {{"builtin", {{"const", scene.name}}}}}}}, {"then", std::move(keys)}});
  }
  const FileChoice blank;
  Json schema = {{"type", "object"}};
  schema["if"] = {{"required", Json::array({"builtin"})}};
  schema["then"] = {{"properties", {{"builtin", {{"enum", builtinNames()}}}}}, {"allOf", std::move(branches)}};
  schema["else"] = objectSchema(*fileTable(), &blank);
  schema["else"]["properties"]["file"]["minLength"] = 1;
  return schema;
}

}  // namespace

std::shared_ptr<const CustomField> sceneChoiceField() {
  auto field = std::make_shared<CustomField>();
  field->read = [](const Json& json, void* value, const Location& where, Problems& problems) {
    auto& choices = *static_cast<std::vector<SceneChoice>*>(value);
    choices.clear();
    if (!json.is_array()) return readScene(json, choices.emplace_back(), where, problems);
    if (json.empty()) reportWrong(json, "at least one scene", where, problems);
    for (std::size_t i = 0; i < json.size(); ++i) readScene(json[i], choices.emplace_back(), where.child(i), problems);
  };
  field->write = [](const void* value) {
    const auto& choices = *static_cast<const std::vector<SceneChoice>*>(value);
    if (choices.size() == 1) return writeScene(choices[0]);
    Json json = Json::array();
    for (const SceneChoice& choice : choices) json.push_back(writeScene(choice));
    return json;
  };
  field->schema = [] {
    Json schema;
    schema["if"] = {{"type", "array"}};
    schema["then"] = {{"items", sceneSchema()}, {"minItems", 1}};
    schema["else"] = sceneSchema();
    return schema;
  };
  return field;
}

}  // namespace gnomon
