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

std::shared_ptr<const FieldTable> declarationTable() {
  return ParameterTable<TechniqueDeclaration>{
      text("title", &TechniqueDeclaration::title, "what people call it").mandatory(),
      text("entry", &TechniqueDeclaration::entry, "the library's entry that makes it").mandatory(),
      choice("role", &TechniqueDeclaration::role, {"technique", "reference", "floor"}, Binding::structure,
             "reference: what others are compared with; floor: does no work"),
      custom("parameters", &TechniqueDeclaration::parametersJsonText, presetField(),
             "values that differ from the entry's defaults")}
      .table();
}

void checkName(const std::string& name, const Location& where, Problems& problems) {
  if (!isTechniqueName(name))
    problems.add(where.file, where.pointer, fmt::format("found {}; allowed: {}", shortText(name), kNameRule));
}

/// The names are keys, so this is no table of its own.
std::shared_ptr<const CustomField> techniquesField() {
  auto field = std::make_shared<CustomField>();
  field->read = [](const Json& json, void* value, const Location& where, Problems& problems) {
    auto& techniques = *static_cast<std::vector<TechniqueDeclaration>*>(value);
    if (!json.is_object() || json.empty())
      return reportWrong(json, "an object with a technique under each name", where, problems);
    for (const auto& [name, declaration] : json.items()) {
      TechniqueDeclaration& technique = techniques.emplace_back();
      technique.name = name;
      checkName(name, where.child(name), problems);
      readObject(declaration, *declarationTable(), &technique, where.child(name), problems);
    }
  };
  field->write = [](const void* value) {
    Json json = Json::object();
    for (const TechniqueDeclaration& technique : *static_cast<const std::vector<TechniqueDeclaration>*>(value)) {
      json[technique.name] = writeObject(*declarationTable(), &technique);
    }
    return json;
  };
  field->schema = [] {
    const TechniqueDeclaration blank;
    return Json{{"type", "object"},
                {"minProperties", 1},
                {"propertyNames", {{"pattern", kNamePattern}}},
                {"additionalProperties", objectSchema(*declarationTable(), &blank)}};
  };
  return field;
}

std::shared_ptr<const FieldTable> fileTable() {
  return ParameterTable<TechniqueFile>{
      text("library", &TechniqueFile::library, "the shared object beside this file, without lib and .so").mandatory(),
      custom("techniques", &TechniqueFile::techniques, techniquesField(), "the techniques by name").mandatory()}
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
    return {path, {}, {}};
  }
  return readTechniqueFileText(path, text, problems);
}

Json techniqueFileSchema() {
  const TechniqueFile blank;
  Json schema = schemaOf(*fileTable(), &blank);
  schema["title"] = "Gnomon technique file";
  schema["properties"]["library"]["pattern"] = kNamePattern;
  return schema;
}

}  // namespace gnomon
