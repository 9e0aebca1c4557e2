#include "gnomon/technique/parameter_block.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "gnomon/base/error.h"

namespace gnomon {

namespace {

std::string shaderName(const std::string& key) {
  std::string name = key;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

struct Layout {
  const char* type;
  std::size_t alignment, bytes;
};

/// std140 (OpenGL 4.5 core, 7.6.2.2).
Layout layoutOf(const Field& field) {
  switch (field.type) {
    case FieldType::boolean:
      return {"bool", 4, 4};
    case FieldType::integer:
    case FieldType::choice:
      return {"int", 4, 4};
    case FieldType::real32:
    case FieldType::real64:
      return {"float", 4, 4};
    case FieldType::size:
      return {"ivec2", 8, 8};
    case FieldType::vector2:
      return {"vec2", 8, 8};
    case FieldType::vector3:
      return {"vec3", 16, 12};
    default:
      throw Error(fmt::format("parameter '{}': its type cannot be a uniform", field.name));
  }
}

template <class T>
void put(std::byte* to, const T& value) {
  std::memcpy(to, &value, sizeof(T));
}

void putValue(std::byte* to, const Field& field, const void* value) {
  switch (field.type) {
    case FieldType::boolean:
      put(to, static_cast<int>(*static_cast<const bool*>(value)));
      break;
    case FieldType::integer:
    case FieldType::choice:
      put(to, *static_cast<const int*>(value));
      break;
    case FieldType::real32:
      put(to, *static_cast<const float*>(value));
      break;
    case FieldType::real64:
      put(to, static_cast<float>(*static_cast<const double*>(value)));
      break;
    case FieldType::size:
      put(to, *static_cast<const glm::ivec2*>(value));
      break;
    case FieldType::vector2:
      put(to, glm::vec2(*static_cast<const glm::dvec2*>(value)));
      break;
    case FieldType::vector3:
      put(to, glm::vec3(*static_cast<const glm::dvec3*>(value)));
      break;
    default:
      break;
  }
}

}  // namespace

std::string parameterBlockText(const FieldTable& table) {
  std::string members;
  for (const Field& field : table.fields()) {
    if (field.binding == Binding::uniform)
      members += fmt::format("  {} {};  // {}\n", layoutOf(field).type, shaderName(field.name), field.meaning);
  }
  if (members.empty()) return "";
  return "layout(std140) uniform Parameters {\n" + members + "};\n";
}

std::vector<std::byte> parameterBlockBytes(const FieldTable& table, const void* parameters) {
  std::vector<std::byte> bytes;
  for (const Field& field : table.fields()) {
    if (field.binding != Binding::uniform) continue;
    const Layout layout = layoutOf(field);
    const std::size_t at = (bytes.size() + layout.alignment - 1) / layout.alignment * layout.alignment;
    bytes.resize(at + layout.bytes, std::byte{0});
    if (const void* value = field.find(parameters)) putValue(bytes.data() + at, field, value);
  }
  bytes.resize(std::max<std::size_t>((bytes.size() + 15) / 16 * 16, 16), std::byte{0});
  return bytes;
}

std::vector<Constant> parameterConstants(const FieldTable& table, const void* parameters) {
  std::vector<Constant> constants;
  for (const Field& field : table.fields()) {
    if (field.binding != Binding::specialise) continue;
    std::string name = shaderName(field.name);
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    const void* value = field.find(parameters);
    if (value == nullptr) continue;
    switch (field.type) {
      case FieldType::boolean:
        constants.push_back({name, *static_cast<const bool*>(value)});
        break;
      case FieldType::integer:
      case FieldType::choice:
        constants.push_back({name, *static_cast<const int*>(value)});
        break;
      case FieldType::real32:
        constants.push_back({name, *static_cast<const float*>(value)});
        break;
      default:
        throw Error(fmt::format("parameter '{}': its type cannot be a shader constant", field.name));
    }
  }
  return constants;
}

}  // namespace gnomon
