// The typed reader: JSON into structs through their tables, with every fault at once; and back, and the schema.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

/// Parses strictly: no comments, no repeated keys (each reported with its pointer), no trailing text, at most 64 levels deep.
/// Syntax errors are reported with line and column. Empty if it could not be parsed at all.
std::optional<Json> parseJson(const std::string& file, std::string_view text, Problems& problems);

/// Fills the struct behind `object` from `json`. Reports: not an object; unknown key (with the nearest right name and the
/// allowed ones), wrong type, out of range, not a choice, missing required key, non-finite number. Keys not named keep their
/// defaults. "$schema" is allowed at the top (pointer ""). Runs the table's check when its own fields had no fault.
void readObject(const Json& json, const FieldTable& table, void* object, const Location& where, Problems& problems);

/// One value by its field, as readObject does (for parameters set one by one: sweeps, viewer keys). `where` is the value's
/// own place. Integers may be written as 3.0 or 3e0, as JSON Schema allows; never as 3.5.
void readValue(const Json& json, const Field& field, void* object, const Location& where, Problems& problems);

/// Every value that is there (empty optionals left out), under its key, in table order.
Json writeObject(const FieldTable& table, const void* object);

/// One value as writeObject writes it; null for an empty optional and for a number that is not finite.
Json toJson(const Field& field, const void* object);

/// JSON Schema (draft 2020-12) of a document read by `table`; defaults come from `defaults` (a default-constructed object).
Json schemaOf(const FieldTable& table, const void* defaults);

/// The same for an object inside a document: without "$schema", neither as keyword nor as key.
Json objectSchema(const FieldTable& table, const void* defaults);

/// The value on one line, cut where it is long: what messages show as found.
std::string shortText(const Json& json);

/// Reports `found X; allowed: Y`.
void reportWrong(const Json& found, const std::string& allowed, const Location& where, Problems& problems);

/// Reports `unknown KIND "x"; did you mean "y"? allowed: a, b`.
void reportUnknown(const std::string& kind, const std::string& name, const std::vector<std::string>& allowed,
                   const Location& where, Problems& problems);

}  // namespace gnomon
