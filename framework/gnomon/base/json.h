// The typed reader: JSON into structs through their tables, with every fault at once; and back, and the schema.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "gnomon/base/error.h"
#include "gnomon/base/table.h"

namespace gnomon {

using Json = nlohmann::ordered_json;  // keys keep their order in files that we write

/// How a FieldType::custom value is read (reports into Problems), written and described as a schema.
struct CustomField {
  std::function<void(const Json&, void* value, const Location&, Problems&)> read;
  std::function<Json(const void* value)> write;
  std::function<Json()> schema;
};

/// Parses strictly: no comments, no repeated keys (each reported with its pointer), no trailing text.
/// Syntax errors are reported with line and column. Empty if it could not be parsed at all.
std::optional<Json> parseJson(const std::string& file, std::string_view text, Problems& problems);

/// Fills the struct behind `object` from `json`. Reports: not an object; unknown key (with the nearest right name and the
/// allowed ones), wrong type, out of range, not a choice, missing required key, non-finite number. Keys not named keep their
/// defaults. "$schema" is allowed at the top (pointer ""). Runs the table's check when its own fields had no fault.
void readObject(const Json& json, const FieldTable& table, void* object, const Location& where, Problems& problems);

/// One value by its field, as readObject does (for parameters set one by one: sweeps, viewer keys).
void readValue(const Json& json, const Field& field, void* object, const Location& where, Problems& problems);

/// Every value that is there (empty optionals left out), under its key, in table order.
Json writeObject(const FieldTable& table, const void* object);

/// JSON Schema (draft 2020-12) of an object read by `table`; defaults come from `defaults` (a default-constructed object).
Json schemaOf(const FieldTable& table, const void* defaults);

}  // namespace gnomon
