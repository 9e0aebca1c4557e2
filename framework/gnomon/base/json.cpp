// Parsing with places, and writing. The typed reader is in reader.cpp, schemas in schema.cpp.
#include "gnomon/base/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

/// Deeper nesting is no configuration; unbounded, it would end in a stack overflow of the recursive writer.
constexpr std::size_t kDeepest = 64;

/// Builds the document, and knows where it is: a repeated key is reported at its pointer. The last of repeated values stays.
class Builder final : public nlohmann::json_sax<Json> {
 public:
  Builder(const std::string& file, std::string_view text, Problems& problems) : file_(file), text_(text), problems_(problems) {}

  Json take() { return std::move(root_); }

  bool null() override { return put(nullptr); }
  bool boolean(bool value) override { return put(value); }
  bool number_integer(number_integer_t value) override { return put(value); }
  bool number_unsigned(number_unsigned_t value) override { return put(value); }
  bool number_float(number_float_t value, const string_t&) override { return put(value); }
  bool string(string_t& value) override { return put(std::move(value)); }
  bool binary(binary_t&) override { return false; }  // does not occur in text
  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    Level& level = levels_.back();
    const auto [place, isNew] = level.slots.try_emplace(name, level.slots.size());
    level.slot = place->second;
    level.where = level.base.child(name);
    if (isNew) {
      level.container->get_ref<Json::object_t&>().emplace_back(name, nullptr);
    } else {
      problems_.add(file_, level.where.pointer, "this key is given twice");
    }
    return true;
  }

  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& error) override {
    // The library's text is "[json.exception.ID] parse error at line L, column C: REASON" or "[json.exception.ID] REASON".
    std::string reason = error.what();
    reason.erase(0, reason.find("] ") + 2);
    if (reason.rfind("parse error", 0) == 0) reason.erase(0, reason.find(": ") + 2);
    const std::string_view before = text_.substr(0, position == 0 ? 0 : position - 1);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t lineStart = before.rfind('\n');
    const std::size_t column = before.size() - (lineStart == std::string_view::npos ? 0 : lineStart + 1) + 1;
    problems_.add(file_, next().pointer, fmt::format("line {}, column {}: {}", line, column, reason));
    return false;
  }

 private:
  struct Level {
    Json* container;
    Location base;                             ///< of the container
    Location where;                            ///< of the member after the last key
    std::map<std::string, std::size_t> slots;  ///< of an object: the library's own look-up would be linear
    std::size_t slot = 0;
  };

  /// Where the next value goes.
  Location next() const {
    if (levels_.empty()) return {file_, ""};
    const Level& level = levels_.back();
    return level.container->is_object() ? level.where : level.base.child(level.container->size());
  }

  Json& place(Json value) {
    if (levels_.empty()) return root_ = std::move(value);
    Level& level = levels_.back();
    if (level.container->is_array()) return level.container->emplace_back(std::move(value));
    const auto member = level.container->get_ref<Json::object_t&>().begin() + static_cast<std::ptrdiff_t>(level.slot);
    return member->second = std::move(value);
  }
  bool put(Json value) {
    place(std::move(value));
    return true;
  }
  bool open(Json container) {
    const Location where = next();
    if (levels_.size() == kDeepest) {
      problems_.add(file_, where.pointer, fmt::format("nested deeper than {} levels", kDeepest));
      return false;
    }
    // A container does not grow while one of its members is open, so the pointer stays good.
    Json& placed = place(std::move(container));
    levels_.push_back({&placed, where, where, {}, 0});
    return true;
  }
  bool close() {
    levels_.pop_back();
    return true;
  }

  const std::string& file_;
  std::string_view text_;
  Problems& problems_;
  Json root_;
  std::vector<Level> levels_;
};

template <class T>
const T& as(const void* value) {
  return *static_cast<const T*>(value);
}

/// The double that has the shortest decimal text of the float: 0.1f becomes 0.1, not 0.10000000149.
double shortestDouble(float value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  double result = 0.0;
  std::from_chars(text.data(), end, result);
  return result;
}

/// JSON has no infinity and no NaN: what is not a number is not there.
Json numberOrNull(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json listToJson(const Field& field, const void* values) {
  Json list = Json::array();
  for (std::size_t i = 0; i < field.count(values); ++i) {
    const void* element = field.element(values, i);
    list.push_back(field.nested ? writeObject(*field.nested, element) : Json(as<std::string>(element)));
  }
  return list;
}

}  // namespace

std::optional<Json> parseJson(const std::string& file, std::string_view text, Problems& problems) {
  Builder builder(file, text, problems);
  if (!Json::sax_parse(text, &builder)) return std::nullopt;
  return builder.take();
}

Json toJson(const Field& field, const void* object) {
  const void* value = field.find(object);
  if (value == nullptr) return nullptr;
  switch (field.type) {
    case FieldType::boolean:
      return as<bool>(value);
    case FieldType::integer:
      return as<int>(value);
    case FieldType::real32:
      return numberOrNull(shortestDouble(as<float>(value)));
    case FieldType::real64:
      return numberOrNull(as<double>(value));
    case FieldType::choice: {
      int index = 0;
      std::memcpy(&index, value, sizeof index);
      return field.choices.at(static_cast<std::size_t>(index));
    }
    case FieldType::text:
      return as<std::string>(value);
    case FieldType::size: {
      const auto& size = as<glm::ivec2>(value);
      return size.x == size.y ? Json(size.x) : Json{size.x, size.y};
    }
    case FieldType::vector2:
      return {as<glm::dvec2>(value).x, as<glm::dvec2>(value).y};
    case FieldType::vector3:
      return {as<glm::dvec3>(value).x, as<glm::dvec3>(value).y, as<glm::dvec3>(value).z};
    case FieldType::object:
      return writeObject(*field.nested, value);
    case FieldType::list:
      return listToJson(field, value);
    case FieldType::custom:
      return field.custom->write(value);
  }
  return nullptr;
}

Json writeObject(const FieldTable& table, const void* object) {
  Json json = Json::object();
  for (const Field& field : table.fields()) {
    if (field.find(object) != nullptr) json[field.name] = toJson(field, object);
  }
  return json;
}

std::string valueText(const Field& field, const void* object) {
  const Json value = toJson(field, object);
  if (value.is_null()) return "none";
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::string shortText(const Json& json) {
  constexpr std::size_t kLongest = 60;
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() <= kLongest) return text;
  std::size_t cut = kLongest - 3;
  while (cut > 0 && (static_cast<unsigned char>(text[cut]) & 0xC0U) == 0x80U) --cut;  // not inside a UTF-8 character
  return text.substr(0, cut) + "...";
}

}  // namespace gnomon
