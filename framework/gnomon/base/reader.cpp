// The typed reader: a struct from JSON by its table, with every fault at once.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "gnomon/base/json.h"

namespace gnomon {
namespace {

template <class T>
T& as(void* value) {
  return *static_cast<T*>(value);
}

bool contains(const Range& range, double value) {
  return std::isfinite(value) && value <= range.max && (range.openMin ? value > range.min : value >= range.min);
}

std::optional<double> numberIn(const Json& json, const Range& range) {
  if (!json.is_number()) return std::nullopt;
  const double value = json.get<double>();
  return contains(range, value) ? std::optional(value) : std::nullopt;
}

std::optional<float> floatIn(const Json& json, const Range& range) {
  const std::optional<double> value = numberIn(json, range);
  if (!value || std::abs(*value) > static_cast<double>(std::numeric_limits<float>::max())) return std::nullopt;
  const auto narrowed = static_cast<float>(*value);
  // Rounding must not land on an excluded minimum: 1e-60 is above 0, its float is not.
  if (range.openMin && static_cast<double>(narrowed) <= range.min) return std::nullopt;
  return narrowed;
}

std::optional<int> integerIn(const Json& json, const Range& range) {
  const std::optional<double> value = numberIn(json, range);
  if (!value || !allowsInteger(range, *value)) return std::nullopt;
  if (*value < std::numeric_limits<int>::min() || *value > std::numeric_limits<int>::max()) return std::nullopt;
  return static_cast<int>(*value);
}

bool readInteger(const Json& json, const Range& range, int& to) {
  const std::optional<int> value = integerIn(json, range);
  if (value) to = *value;
  return value.has_value();
}

bool readSize(const Json& json, const Range& range, glm::ivec2& to) {
  if (!json.is_array()) {
    if (!readInteger(json, range, to.x)) return false;
    to.y = to.x;
    return true;
  }
  return json.size() == 2 && readInteger(json[0], range, to.x) && readInteger(json[1], range, to.y);
}

template <int N>
bool readVector(const Json& json, const Range& range, glm::vec<N, double>& to) {
  if (!json.is_array() || json.size() != N) return false;
  for (int i = 0; i < N; ++i) {
    const std::optional<double> value = numberIn(json[static_cast<std::size_t>(i)], range);
    if (!value) return false;
    to[i] = *value;
  }
  return true;
}

void readChoice(const Json& json, const Field& field, void* to, const Location& where, Problems& problems) {
  if (!json.is_string()) return reportWrong(json, allowedText(field), where, problems);
  const auto& name = json.get_ref<const std::string&>();
  for (std::size_t i = 0; i < field.choices.size(); ++i) {
    if (field.choices[i] != name) continue;
    const int index = static_cast<int>(i);
    std::memcpy(to, &index, sizeof index);
    return;
  }
  reportUnknown("choice", name, field.choices, where, problems);
}

void readText(const Json& json, const Field& field, std::string& to, const Location& where, Problems& problems) {
  if (!json.is_string()) return reportWrong(json, "text", where, problems);
  to = json.get<std::string>();
  const bool isNamed = std::find(field.choices.begin(), field.choices.end(), to) != field.choices.end();
  if (!field.choices.empty() && !isNamed) reportUnknown("name", to, field.choices, where, problems);
}

void readList(const Json& json, const Field& field, void* values, const Location& where, Problems& problems) {
  if (!json.is_array()) return reportWrong(json, allowedText(field), where, problems);
  field.clear(values);
  std::set<std::string> seen;
  for (std::size_t i = 0; i < json.size(); ++i) {
    void* element = field.append(values);
    if (field.nested) {
      readObject(json[i], *field.nested, element, where.child(i), problems);
      continue;
    }
    readText(json[i], field, as<std::string>(element), where.child(i), problems);
    if (!field.choices.empty() && json[i].is_string() && !seen.insert(json[i].get<std::string>()).second) {
      problems.add(where.file, where.child(i).pointer, fmt::format("{} is listed twice", shortText(json[i])));
    }
  }
}

/// Values whose message is just what is allowed.
bool readSimple(const Json& json, const Field& field, void* value) {
  switch (field.type) {
    case FieldType::boolean:
      if (json.is_boolean()) as<bool>(value) = json.get<bool>();
      return json.is_boolean();
    case FieldType::integer:
      return readInteger(json, field.range, as<int>(value));
    case FieldType::real32: {
      const std::optional<float> number = floatIn(json, field.range);
      if (number) as<float>(value) = *number;
      return number.has_value();
    }
    case FieldType::real64: {
      const std::optional<double> number = numberIn(json, field.range);
      if (number) as<double>(value) = *number;
      return number.has_value();
    }
    case FieldType::size:
      return readSize(json, field.range, as<glm::ivec2>(value));
    case FieldType::vector2:
      return readVector<2>(json, field.range, as<glm::dvec2>(value));
    case FieldType::vector3:
      return readVector<3>(json, field.range, as<glm::dvec3>(value));
    default:
      return false;
  }
}

}  // namespace

void reportWrong(const Json& found, const std::string& allowed, const Location& where, Problems& problems) {
  problems.add(where.file, where.pointer, fmt::format("found {}; allowed: {}", shortText(found), allowed));
}

void reportUnknown(const std::string& kind, const std::string& name, const std::vector<std::string>& allowed,
                   const Location& where, Problems& problems) {
  const std::string nearest = nearestName(name, allowed);
  problems.add(where.file, where.pointer,
               fmt::format("unknown {} {}; {}allowed: {}", kind, shortText(name),
                           nearest.empty() ? "" : fmt::format("did you mean \"{}\"? ", nearest),
                           allowed.empty() ? "none" : fmt::format("{}", fmt::join(allowed, ", "))));
}

void readValue(const Json& json, const Field& field, void* object, const Location& where, Problems& problems) {
  void* value = field.make(object);
  switch (field.type) {
    case FieldType::choice:
      return readChoice(json, field, value, where, problems);
    case FieldType::text:
      return readText(json, field, as<std::string>(value), where, problems);
    case FieldType::object:
      return readObject(json, *field.nested, value, where, problems);
    case FieldType::list:
      return readList(json, field, value, where, problems);
    case FieldType::custom:
      return field.custom->read(json, value, where, problems);
    default:
      if (!readSimple(json, field, value)) reportWrong(json, allowedText(field), where, problems);
  }
}

void readObject(const Json& json, const FieldTable& table, void* object, const Location& where, Problems& problems) {
  if (!json.is_object()) {
    return reportWrong(json, fmt::format("an object with keys among {}", fmt::join(table.names(), ", ")), where, problems);
  }
  const std::size_t faultsBefore = problems.list().size();
  for (const auto& [key, value] : json.items()) {
    if (key == "$schema" && where.pointer.empty()) {
      if (!value.is_string()) reportWrong(value, "text: where the schema lies", where.child(key), problems);
    } else if (const Field* field = table.find(key)) {
      readValue(value, *field, object, where.child(key), problems);
    } else {
      reportUnknown("key", key, table.names(), where.child(key), problems);
    }
  }
  for (const Field& field : table.fields()) {
    if (field.required && !json.contains(field.name)) {
      problems.add(where.file, where.pointer, fmt::format("the key \"{}\" is missing: {}", field.name, field.meaning));
    }
  }
  if (table.check() && problems.list().size() == faultsBefore) table.check()(object, where, problems);
}

}  // namespace gnomon
