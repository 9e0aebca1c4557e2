#include "gnomon/base/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace gnomon {
namespace {

/// " from 1 to 31 texels", " above 0 metres", or nothing.
std::string rangeText(const Range& range) {
  const bool below = std::isfinite(range.max);
  std::string text;
  if (std::isfinite(range.min)) {
    text = fmt::format(" {} {}", range.openMin ? "above" : below ? "from" : "at least", range.min);
    if (below) text += fmt::format(" {} {}", range.openMin ? "up to" : "to", range.max);
  } else if (below) {
    text = fmt::format(" at most {}", range.max);
  }
  if (!range.unit.empty()) text += (text.empty() ? " in " : " ") + range.unit;
  return text;
}

std::string eachInRange(const Range& range) {
  const std::string text = rangeText(range);
  return text.empty() ? "" : ", each" + text;
}

}  // namespace

Location Location::child(const std::string& key) const {
  std::string escaped;
  for (const char c : keyPrefix + key) {
    if (c == '~')
      escaped += "~0";
    else if (c == '/')
      escaped += "~1";
    else
      escaped += c;
  }
  return {file, pointer + "/" + escaped};
}

const Field* FieldTable::find(const std::string& name) const {
  for (const Field& field : fields_) {
    if (field.name == name) return &field;
  }
  return nullptr;
}

std::vector<std::string> FieldTable::names() const {
  std::vector<std::string> names;
  for (const Field& field : fields_) names.push_back(field.name);
  return names;
}

std::string allowedText(const Field& field) {
  switch (field.type) {
    case FieldType::boolean:
      return "true or false";
    case FieldType::integer:
      return "an integer" + rangeText(field.range);
    case FieldType::real32:
    case FieldType::real64:
      return "a number" + rangeText(field.range);
    case FieldType::choice:
      return fmt::format("one of {}", fmt::join(field.choices, ", "));
    case FieldType::text:
      return "text";
    case FieldType::size:
      return "one integer (square) or two [width, height]" + eachInRange(field.range);
    case FieldType::vector2:
      return "two numbers [x, y]" + eachInRange(field.range);
    case FieldType::vector3:
      return "three numbers [x, y, z]" + eachInRange(field.range);
    case FieldType::object:
      return fmt::format("an object with keys among {}", fmt::join(field.nested->names(), ", "));
    case FieldType::list:
      if (field.nested) return "a list of objects";
      return field.choices.empty() ? "a list of text" : fmt::format("a list of some of {}", fmt::join(field.choices, ", "));
    case FieldType::custom:
      break;
  }
  return {};
}

}  // namespace gnomon
