#include "gnomon/base/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
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

/// The same with the integers that are left out: "from 64 to 4096 texels, a multiple of 64".
std::string integerText(const Range& range) {
  return rangeText(range) + (range.step > 1 ? fmt::format(", a multiple of {}", range.step) : "") + (range.odd ? ", odd" : "");
}

std::string each(const std::string& text) {
  return text.empty() ? "" : ", each" + text;
}

template <class T>
bool same(const void* a, const void* b) {
  return *static_cast<const T*>(a) == *static_cast<const T*>(b);
}

bool sameLists(const Field& field, const void* a, const void* b) {
  const std::size_t count = field.count(a);
  if (field.count(b) != count) return false;
  for (std::size_t i = 0; i < count; ++i) {
    const void* first = field.element(a, i);
    const void* second = field.element(b, i);
    if (!(field.nested ? equalValues(*field.nested, first, second) : same<std::string>(first, second))) return false;
  }
  return true;
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

void copyValue(const Field& field, void* to, const void* from) {
  field.assign(to, from);
}

void copyValues(const FieldTable& table, void* to, const void* from) {
  for (const Field& field : table.fields()) copyValue(field, to, from);
}

bool equalValue(const Field& field, const void* a, const void* b) {
  const void* first = field.find(a);
  const void* second = field.find(b);
  if (first == nullptr || second == nullptr) return first == second;
  switch (field.type) {
    case FieldType::boolean:
      return same<bool>(first, second);
    case FieldType::integer:
    case FieldType::choice:
      return same<int>(first, second);
    case FieldType::real32:
      return same<float>(first, second);
    case FieldType::real64:
      return same<double>(first, second);
    case FieldType::text:
      return same<std::string>(first, second);
    case FieldType::size:
      return same<glm::ivec2>(first, second);
    case FieldType::vector2:
      return same<glm::dvec2>(first, second);
    case FieldType::vector3:
      return same<glm::dvec3>(first, second);
    case FieldType::object:
      return equalValues(*field.nested, first, second);
    case FieldType::list:
      return sameLists(field, first, second);
    case FieldType::custom:
      break;
  }
  return false;
}

bool equalValues(const FieldTable& table, const void* a, const void* b) {
  return std::all_of(table.fields().begin(), table.fields().end(), [&](const Field& field) { return equalValue(field, a, b); });
}

bool allowsInteger(const Range& range, double value) {
  const bool isInRange = range.openMin ? value > range.min : value >= range.min;
  if (!isInRange || !(value <= range.max) || std::trunc(value) != value) return false;
  const bool isStep = range.step <= 1 || std::fmod(value, range.step) == 0.0;
  return isStep && (!range.odd || std::fmod(value, 2.0) != 0.0);
}

int integerStep(const Range& range) {
  return std::max(range.step, 1) * (range.odd ? 2 : 1);
}

std::string allowedText(const Field& field) {
  switch (field.type) {
    case FieldType::boolean:
      return "true or false";
    case FieldType::integer:
      return "an integer" + integerText(field.range);
    case FieldType::real32:
    case FieldType::real64:
      return "a number" + rangeText(field.range);
    case FieldType::choice:
      return fmt::format("one of {}", fmt::join(field.choices, ", "));
    case FieldType::text:
      return "text";
    case FieldType::size:
      return "one integer (square) or two [width, height]" + each(integerText(field.range));
    case FieldType::vector2:
      return "two numbers [x, y]" + each(rangeText(field.range));
    case FieldType::vector3:
      return "three numbers [x, y, z]" + each(rangeText(field.range));
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
