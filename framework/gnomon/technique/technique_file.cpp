#include "gnomon/technique/technique_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "gnomon/base/files.h"

namespace gnomon {
namespace {

constexpr const char* kNamePattern = "^[a-z0-9_]+$";
constexpr const char* kNameRule = "a name of a-z, 0-9 and _";

std::shared_ptr<const CustomField> presetField() {
  auto field = std::make_shared<CustomField>();
  field->read = [](const Json& json, void* value, const Location& where, Problems& problems) {
    if (!json.is_object()) return reportWrong(json, "an object of parameter values", where, problems);
    *static_cast<std::string*>(value) = json.dump();
  };
  field->write = [](const void* value) { return Json::parse(*static_cast<const std::string*>(value)); };
  field->schema = [] { return Json{{"type", "object"}}; };
  return field;
}

std::shared_ptr<const FieldTable> compositionTable() {
  return ParameterTable<Composition>{text("projection", &Composition::projection, "where receivers lie in a map").mandatory(),
                                     text("representation", &Composition::representation, "what a texel stores").mandatory(),
                                     text("footprint", &Composition::footprint, "what is averaged").mandatory()}
      .table();
}

void checkMaker(const TechniqueDeclaration& technique, const Location& where, Problems& problems) {
  if (technique.entry.empty() == technique.compose.has_value()) return;
  problems.add(where.file, where.pointer,
               technique.compose ? "has both \"entry\" and \"compose\"; allowed: one of them"
                                 : "has neither \"entry\", a name out of the library, nor \"compose\", three components");
}

std::shared_ptr<const FieldTable> componentTable() {
  return ParameterTable<ComponentDeclaration>{
      text("title", &ComponentDeclaration::title, "what people call it").mandatory(),
      choice("axis", &ComponentDeclaration::axis, {"projection", "representation", "footprint"}, Binding::structure,
             "what it is of a composed technique")}
      .table();
}

std::shared_ptr<const FieldTable> declarationTable() {
  return ParameterTable<TechniqueDeclaration>{
      text("title", &TechniqueDeclaration::title, "what people call it").mandatory(),
      text("entry", &TechniqueDeclaration::entry, "the library's entry that makes it"),
      object("compose", &TechniqueDeclaration::compose, compositionTable(), "the components that make it, instead of an entry"),
      choice("role", &TechniqueDeclaration::role, {"technique", "reference", "floor"}, Binding::structure,
             "reference: what others are compared with; floor: does no work"),
      custom("parameters", &TechniqueDeclaration::parametersJsonText, presetField(),
             "values that differ from the entry's defaults")}
      .checked(checkMaker)
      .table();
}

void checkName(const std::string& name, const Location& where, Problems& problems) {
  if (!isTechniqueName(name))
    problems.add(where.file, where.pointer, fmt::format("found {}; allowed: {}", shortText(name), kNameRule));
}

/// An object of declarations under their names: the names are keys, so this is no table of its own.
template <class Declaration>
std::shared_ptr<const CustomField> namedField(std::shared_ptr<const FieldTable> table, const char* wanted) {
  auto field = std::make_shared<CustomField>();
  field->read = [table, wanted](const Json& json, void* value, const Location& where, Problems& problems) {
    auto& declarations = *static_cast<std::vector<Declaration>*>(value);
    if (!json.is_object() || json.empty()) return reportWrong(json, wanted, where, problems);
    for (const auto& [name, one] : json.items()) {
      Declaration& declaration = declarations.emplace_back();
      declaration.name = name;
      checkName(name, where.child(name), problems);
      readObject(one, *table, &declaration, where.child(name), problems);
    }
  };
  field->write = [table](const void* value) {
    Json json = Json::object();
    for (const Declaration& declaration : *static_cast<const std::vector<Declaration>*>(value))
      json[declaration.name] = writeObject(*table, &declaration);
    return json;
  };
  field->schema = [table] {
    const Declaration blank;
    return Json{{"type", "object"},
                {"minProperties", 1},
                {"propertyNames", {{"pattern", kNamePattern}}},
                {"additionalProperties", objectSchema(*table, &blank)}};
  };
  return field;
}

void checkLibrary(const TechniqueFile& file, const Location& where, Problems& problems) {
  if (file.techniques.empty() && file.components.empty())
    problems.add(where.file, where.pointer, "has neither \"techniques\" nor \"components\"; one of them is needed");
  const bool entries = std::any_of(file.techniques.begin(), file.techniques.end(), [](const auto& t) { return !t.compose; });
  if (file.library.empty() && (entries || !file.components.empty()))
    problems.add(where.file, where.pointer, "has no \"library\"; entries and components lie in one");
}

std::shared_ptr<const FieldTable> fileTable() {
  return ParameterTable<TechniqueFile>{
      text("library", &TechniqueFile::library,
           "the shared object beside this file, without lib and .so; needed for entries and components"),
      custom("components", &TechniqueFile::components,
             namedField<ComponentDeclaration>(componentTable(), "an object with a component under each name"),
             "the library's components by name"),
      custom("techniques", &TechniqueFile::techniques,
             namedField<TechniqueDeclaration>(declarationTable(), "an object with a technique under each name"),
             "the techniques by name")}
      .checked(checkLibrary)
      .table();
}

}  // namespace

bool isTechniqueName(std::string_view name) {
  const auto isAllowed = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  return !name.empty() && std::all_of(name.begin(), name.end(), isAllowed);
}

TechniqueFile readTechniqueFileText(const std::filesystem::path& path, std::string_view text, Problems& problems) {
  TechniqueFile file;
  file.path = path;
  const Location top{path.string(), ""};
  const std::optional<Json> json = parseJson(top.file, text, problems);
  if (!json) return file;
  readObject(*json, *fileTable(), &file, top, problems);
  if (json->is_object() && json->contains("library") && (*json)["library"].is_string()) {
    checkName(file.library, top.child("library"), problems);
  }
  return file;
}

TechniqueFile readTechniqueFile(const std::filesystem::path& path, Problems& problems) {
  std::string text;
  try {
    text = readFile(path);
  } catch (const Error& error) {
    problems.add("", "", error.what());
    return {path, {}, {}, {}};
  }
  return readTechniqueFileText(path, text, problems);
}

Json techniqueFileSchema() {
  const TechniqueFile blank;
  Json schema = schemaOf(*fileTable(), &blank);
  schema["title"] = "Gnomon technique file";
  Json& properties = schema["properties"];
  properties["library"]["pattern"] = kNamePattern;
  // As checkMaker and checkLibrary say.
  const auto has = [](const std::vector<std::string>& keys) {
    Json rule;
    rule["required"] = keys;
    return rule;
  };
  Json& technique = properties["techniques"]["additionalProperties"];
  technique["properties"]["entry"]["minLength"] = 1;
  technique["anyOf"] = Json::array({has({"entry"}), has({"compose"})});
  technique["not"] = has({"entry", "compose"});
  schema["anyOf"] = Json::array({has({"techniques"}), has({"components"})});
  Json composedAlone;
  composedAlone["not"] = has({"components"});
  composedAlone["properties"]["techniques"]["additionalProperties"]["not"] = has({"entry"});
  schema["if"]["not"] = composedAlone;
  schema["then"] = has({"library"});
  return schema;
}

}  // namespace gnomon
