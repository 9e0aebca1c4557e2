#include "gnomon/run/scene_choice.h"

#include <nlohmann/json.hpp>

#include "gnomon/run/config.h"

namespace gnomon {
namespace {

using Moves = std::vector<std::pair<std::string, glm::dvec3>>;

/// Beyond, a double no longer tells apart what lies a micrometre apart.
constexpr double kFarthestMove = 1e9;

struct Move {
  glm::dvec3 by{0.0};
};

Field moveField() {
  return vector("by", &Move::by, {-kFarthestMove, kFarthestMove, "m"}, "along the world's axes");
}

std::shared_ptr<const CustomField> movesField() {
  auto field = std::make_shared<CustomField>();
  field->read = [](const Json& json, void* value, const Location& where, Problems& problems) {
    auto& moves = *static_cast<Moves*>(value);
    moves.clear();
    if (!json.is_object())
      return reportWrong(json, "an object with [x, y, z] in metres under each node's name", where, problems);
    for (const auto& [name, by] : json.items()) {
      Move move;
      readValue(by, moveField(), &move, where.child(name), problems);
      moves.emplace_back(name, move.by);
    }
  };
  field->write = [](const void* value) {
    Json json = Json::object();
    for (const auto& [name, by] : *static_cast<const Moves*>(value)) {
      const Move move{by};
      json[name] = toJson(moveField(), &move);
    }
    return json;
  };
  field->schema = [] {
    const Move blank;
    Json by = objectSchema(FieldTable({moveField()}), &blank)["properties"]["by"];
    by.erase("default");
    return Json{{"type", "object"}, {"additionalProperties", std::move(by)}};
  };
  return field;
}

/// The keys that every scene has.
template <class T>
Fields poseFields() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return Fields({custom("move", &T::moves, movesField(), "by how many metres along the world's axes to move nodes, by name"),
                 real("time", &T::time, {0.0, infinity, "s"}, Binding::uniform, "the pose of what is animated in the scene")});
}

/// The form with a file, before paths are joined.
struct FileChoice {
  std::string file;
  std::optional<std::vector<std::string>> cast, receive;
  Moves moves;
  double time = 0.0;
};

std::shared_ptr<const FieldTable> fileTable() {
  return ParameterTable<FileChoice>{
      text("file", &FileChoice::file, "a .gltf or .glb file, relative to the config").mandatory(),
      list("cast", &FileChoice::cast, nullptr, "names of the nodes that cast; without it, all do"),
      list("receive", &FileChoice::receive, nullptr, "names of the nodes that receive; without it, all do"),
      poseFields<FileChoice>()}
      .checked([](const FileChoice& choice, const Location& where, Problems& problems) {
        if (choice.file.empty()) reportWrong(choice.file, "the path of a .gltf or .glb file", where.child("file"), problems);
      })
      .table();
}

/// A built-in scene's own keys, and those that every scene has.
std::shared_ptr<const FieldTable> builtinTable(const BuiltinScene& scene) {
  const ParameterTable<BuiltinParameters> own{Fields(scene.table->fields(), scene.table->check())};
  return ParameterTable<SceneChoice>{inlined(&SceneChoice::parameters, own), poseFields<SceneChoice>()}.table();
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
  readObject(keys, *builtinTable(*scene), &choice, where, problems);
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
  choice.moves = read.moves;
  choice.time = read.time;
}

/// One schema a scene, chosen by the name, so that editors complain about the key that is wrong and not about the whole.
Json sceneSchema() {
  Json branches = Json::array();
  for (const BuiltinScene& scene : builtinScenes()) {
    SceneChoice defaults;
    defaults.parameters = scene.defaults;
    Json keys = objectSchema(*builtinTable(scene), &defaults);
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

Json writeSceneChoice(const SceneChoice& choice) {
  Json json;
  if (choice.builtin.empty()) {
    const FileChoice file{choice.file.string(), choice.cast, choice.receive, choice.moves, choice.time};
    json = writeObject(*fileTable(), &file);
  } else {
    json["builtin"] = choice.builtin;
    if (const BuiltinScene* scene = findBuiltinScene(choice.builtin)) json.update(writeObject(*builtinTable(*scene), &choice));
  }
  if (choice.moves.empty()) json.erase("move");
  if (choice.time == 0.0) json.erase("time");
  return json;
}

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
    if (choices.size() == 1) return writeSceneChoice(choices[0]);
    Json json = Json::array();
    for (const SceneChoice& choice : choices) json.push_back(writeSceneChoice(choice));
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
