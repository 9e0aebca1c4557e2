// JSON Schemas from tables, for editors; the tests hold the reader against them.
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "gnomon/base/json.h"

namespace gnomon {
namespace {

/// 1 and not 1.0, where the number is whole.
Json plainNumber(double value) {
  const bool isWhole = std::trunc(value) == value && std::abs(value) < 1e15;
  return isWhole ? Json(static_cast<std::int64_t>(value)) : Json(value);
}

Json bounded(Json schema, const Range& range) {
  if (std::isfinite(range.min)) schema[range.openMin ? "exclusiveMinimum" : "minimum"] = plainNumber(range.min);
  if (std::isfinite(range.max)) schema["maximum"] = plainNumber(range.max);
  return schema;
}

/// Within the range, and within what an int holds.
Json integerSchema(Json type, Range range) {
  if (!std::isfinite(range.min)) range.min = std::numeric_limits<int>::min();
  if (!std::isfinite(range.max)) range.max = std::numeric_limits<int>::max();
  Json schema = bounded({{"type", std::move(type)}}, range);
  if (range.step > 1) schema["multipleOf"] = range.step;
  if (range.odd) schema["not"] = {{"type", "integer"}, {"multipleOf", 2}};
  return schema;
}

Json arrayOf(Json items, std::size_t count) {
  return {{"type", "array"}, {"items", std::move(items)}, {"minItems", count}, {"maxItems", count}};
}

Json listSchema(const Field& field) {
  Json schema = {{"type", "array"}};
  schema["items"] = field.nested ? objectSchema(*field.nested, field.blank.get()) : Json{{"type", "string"}};
  if (!field.choices.empty()) {
    schema["items"]["enum"] = field.choices;
    schema["uniqueItems"] = true;
  }
  return schema;
}

Json typeSchema(const Field& field, const void* defaults) {
  switch (field.type) {
    case FieldType::boolean:
      return {{"type", "boolean"}};
    case FieldType::integer:
      return integerSchema("integer", field.range);
    case FieldType::real32:
    case FieldType::real64:
      return bounded({{"type", "number"}}, field.range);
    case FieldType::choice:
      return {{"type", "string"}, {"enum", field.choices}};
    case FieldType::text:
      return {{"type", "string"}};
    case FieldType::size: {
      // Bounds speak of numbers only, "items" and its like of arrays only, so both forms fit in one schema.
      Json schema = integerSchema({"integer", "array"}, field.range);
      Json pair = arrayOf(integerSchema("integer", field.range), 2);
      pair.erase("type");
      schema.update(pair);
      return schema;
    }
    case FieldType::vector2:
      return arrayOf(bounded({{"type", "number"}}, field.range), 2);
    case FieldType::vector3:
      return arrayOf(bounded({{"type", "number"}}, field.range), 3);
    case FieldType::object: {
      const void* inner = field.find(defaults);
      return objectSchema(*field.nested, inner != nullptr ? inner : field.blank.get());
    }
    case FieldType::list:
      return listSchema(field);
    case FieldType::custom:
      return field.custom->schema();
  }
  return Json::object();
}

Json fieldSchema(const Field& field, const void* defaults) {
  Json schema = typeSchema(field, defaults);
  const std::string scale = field.range.logarithmic ? "logarithmic scale" : "";
  const std::string facts = field.range.unit + (field.range.unit.empty() || scale.empty() ? "" : ", ") + scale;
  schema["description"] = facts.empty() ? field.meaning : fmt::format("{} ({})", field.meaning, facts);
  // The members of an object show their own defaults; a key that must be given has none.
  const bool showsDefault = !field.required && field.type != FieldType::object && field.type != FieldType::custom;
  if (showsDefault && field.find(defaults) != nullptr) schema["default"] = toJson(field, defaults);
  return schema;
}

}  // namespace

Json objectSchema(const FieldTable& table, const void* defaults) {
  Json properties = Json::object();
  Json required = Json::array();
  for (const Field& field : table.fields()) {
    properties[field.name] = fieldSchema(field, defaults);
    if (field.required) required.push_back(field.name);
  }
  Json schema = {{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
  if (!required.empty()) schema["required"] = std::move(required);
  return schema;
}

Json schemaOf(const FieldTable& table, const void* defaults) {
  Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}};
  schema.update(objectSchema(table, defaults));
  schema["properties"]["$schema"] = {{"type", "string"}, {"description", "where this schema lies, for editors"}};
  return schema;
}

}  // namespace gnomon
