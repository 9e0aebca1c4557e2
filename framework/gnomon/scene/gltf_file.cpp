#include "gnomon/scene/gltf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <string_view>

#include "gnomon/base/error.h"
#include "gnomon/base/files.h"

namespace gnomon::gltf {
namespace {

namespace fs = std::filesystem;

// tinygltf walks extras and extensions recursively; real files nest less than 20 deep.
constexpr int kMaxNesting = 200;

[[noreturn]] void failIn(const std::string& file, const std::string& pointer, const std::string& message) {
  throw InputError({{file, pointer, message}});
}

// --- Which files may be read

/// Whether `path` is a regular file in `folder` or below, symbolic links followed.
bool liesWithin(const fs::path& folder, const std::string& path) {
  std::error_code ignored;
  const fs::path file = fs::canonical(path, ignored);
  if (ignored || !fs::is_regular_file(file, ignored)) return false;
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

bool fileExists(const std::string& path, void* folder) {
  return liesWithin(*static_cast<const fs::path*>(folder), path);
}

std::string samePath(const std::string& path, void*) {
  return path;
}

bool readWholeFile(std::vector<unsigned char>* out, std::string* error, const std::string& path, void* folder) {
  if (!fileExists(path, folder)) return false;
  try {
    const std::string bytes = readFile(path);
    out->assign(bytes.begin(), bytes.end());
    return true;
  } catch (const Error& e) {
    *error += e.what();
    return false;
  }
}

bool writeNothing(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
  return false;
}

bool ignoreImage(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int, void*) {
  return true;
}

// --- Checks before tinygltf sees the bytes

std::uint32_t word(std::string_view bytes, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])); };
  return byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24;
}

/// The JSON chunk of a binary file whose chunks lie within it. (tinygltf 2.7 lets the second one end 8 bytes behind it.)
std::string_view jsonChunk(const std::string& name, std::string_view bytes) {
  constexpr std::size_t header = 12;
  constexpr std::size_t chunkHeader = 8;
  if (bytes.size() < header + chunkHeader) failIn(name, "", "is cut off: a binary glTF has at least 20 bytes");
  const std::size_t length = word(bytes, 8);
  if (length > bytes.size())
    failIn(name, "", fmt::format("is cut off: its header says {} bytes, the file has {}", length, bytes.size()));
  std::string_view json;
  for (std::size_t at = header; at < length;) {
    if (length - at < chunkHeader) failIn(name, "", fmt::format("has a chunk at byte {} that is cut off", at));
    const std::size_t size = word(bytes, at);
    if (size > length - at - chunkHeader)
      failIn(name, "", fmt::format("has a chunk at byte {} of {} bytes that goes beyond the end", at, size));
    if (at == header) json = bytes.substr(at + chunkHeader, size);
    at += chunkHeader + size;
  }
  return json;
}

void checkNesting(const std::string& name, std::string_view json) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (quoted) {
      if (c == '\\') ++i;
      if (c == '"') quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kMaxNesting) failIn(name, "", fmt::format("nests JSON deeper than {} levels (byte {})", kMaxNesting, i));
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
}

std::string oneLine(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

// --- Accessors

/// The bytes of an accessor's elements, checked to lie in bufferView and buffer.
struct Elements {
  const unsigned char* data = nullptr;
  std::size_t count = 0;
  std::size_t stride = 0;
  int componentType = 0;
};

const tinygltf::Accessor& accessorAt(const File& file, int index, const std::string& pointer) {
  if (index < 0 || static_cast<std::size_t>(index) >= file.model.accessors.size())
    file.fail(pointer, fmt::format("names accessor {}; the file has {}", index, file.model.accessors.size()));
  return file.model.accessors[static_cast<std::size_t>(index)];
}

Elements elementsOf(const File& file, int index, const std::string& pointer) {
  const tinygltf::Model& model = file.model;
  const tinygltf::Accessor& accessor = accessorAt(file, index, pointer);
  const std::string where = pointerTo("accessors", index);
  if (accessor.bufferView < 0 || static_cast<std::size_t>(accessor.bufferView) >= model.bufferViews.size())
    file.fail(where + "/bufferView", fmt::format("is {}; the file has {}", accessor.bufferView, model.bufferViews.size()));
  const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
  const std::string viewWhere = pointerTo("bufferViews", accessor.bufferView);
  if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model.buffers.size())
    file.fail(viewWhere + "/buffer", fmt::format("is {}; the file has {}", view.buffer, model.buffers.size()));
  const std::vector<unsigned char>& bytes = model.buffers[static_cast<std::size_t>(view.buffer)].data;
  if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset)
    file.fail(viewWhere,
              fmt::format("covers {} bytes from {}; its buffer has {}", view.byteLength, view.byteOffset, bytes.size()));

  const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
  const int componentSize = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType));
  if (components <= 0 || componentSize <= 0) file.fail(where, "has a type or componentType that is not glTF's");
  const auto size = static_cast<std::size_t>(components * componentSize);
  const std::size_t stride = view.byteStride == 0 ? size : view.byteStride;
  if (stride < size) file.fail(viewWhere + "/byteStride", fmt::format("is {}; an element has {} bytes", stride, size));
  if (accessor.count == 0) file.fail(where + "/count", "is 0; at least 1 is needed");
  // offset + (count - 1) * stride + size <= length, written so that nothing overflows.
  const bool fits = accessor.byteOffset <= view.byteLength && size <= view.byteLength - accessor.byteOffset &&
                    accessor.count - 1 <= (view.byteLength - accessor.byteOffset - size) / stride;
  if (!fits)
    file.fail(where, fmt::format("reads {} elements of {} bytes, {} apart, from byte {}; its bufferView has {} bytes",
                                 accessor.count, size, stride, accessor.byteOffset, view.byteLength));
  return {bytes.data() + view.byteOffset + accessor.byteOffset, accessor.count, stride, accessor.componentType};
}

std::vector<glm::vec3> readVectors(const File& file, int index, const std::string& pointer) {
  const tinygltf::Accessor& accessor = accessorAt(file, index, pointer);
  if (accessor.type != TINYGLTF_TYPE_VEC3 || accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
    file.fail(pointerTo("accessors", index), "holds positions or normals; only VEC3 of FLOAT (5126) is supported");
  const Elements elements = elementsOf(file, index, pointer);
  std::vector<glm::vec3> vectors(elements.count);
  for (std::size_t i = 0; i < elements.count; ++i)
    std::memcpy(&vectors[i], elements.data + i * elements.stride, sizeof(glm::vec3));
  return vectors;
}

std::vector<std::uint32_t> readIndices(const File& file, int index, const std::string& pointer, std::size_t vertices) {
  const Elements elements = elementsOf(file, index, pointer);
  const std::string where = pointerTo("accessors", index);
  const bool isByte = elements.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
  const bool isShort = elements.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
  const bool isInt = elements.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  if (accessorAt(file, index, pointer).type != TINYGLTF_TYPE_SCALAR || !(isByte || isShort || isInt))
    file.fail(where, "holds indices; SCALAR of UNSIGNED_BYTE (5121), UNSIGNED_SHORT (5123) or UNSIGNED_INT (5125) is allowed");
  std::vector<std::uint32_t> indices(elements.count);
  for (std::size_t i = 0; i < elements.count; ++i) {
    const unsigned char* at = elements.data + i * elements.stride;
    std::uint32_t value = at[0];
    if (!isByte) value |= static_cast<std::uint32_t>(at[1]) << 8;
    if (isInt) value |= static_cast<std::uint32_t>(at[2]) << 16 | static_cast<std::uint32_t>(at[3]) << 24;
    if (value >= vertices)
      file.fail(where, fmt::format("has index {} at element {}; the primitive has {} vertices", value, i, vertices));
    indices[i] = value;
  }
  return indices;
}

bool isSmallInteger(int componentType) {
  return componentType == TINYGLTF_COMPONENT_TYPE_BYTE || componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         componentType == TINYGLTF_COMPONENT_TYPE_SHORT || componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
}

template <class T>
T componentAt(const unsigned char* element, std::size_t component) {
  T value{};
  std::memcpy(&value, element + component * sizeof(T), sizeof(T));
  return value;
}

/// A float, or a small integer that stands for -1 to 1 or 0 to 1 (glTF 2.0, 3.11).
double numberAt(const unsigned char* element, std::size_t component, int componentType) {
  switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return std::max(componentAt<std::int8_t>(element, component) / 127.0, -1.0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return componentAt<std::uint8_t>(element, component) / 255.0;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return std::max(componentAt<std::int16_t>(element, component) / 32767.0, -1.0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return componentAt<std::uint16_t>(element, component) / 65535.0;
    default:
      return static_cast<double>(componentAt<float>(element, component));
  }
}

}  // namespace

void File::fail(const std::string& pointer, const std::string& message) const {
  failIn(name, pointer, message);
}

std::string pointerTo(const std::string& list, int index) {
  return "/" + list + "/" + std::to_string(index);
}

File openFile(const fs::path& path) {
  File file;
  file.name = path.string();
  const std::string bytes = readFile(path);
  if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) file.fail("", "is larger than 2 GiB");
  const bool binary = bytes.starts_with("glTF");
  checkNesting(file.name, binary ? jsonChunk(file.name, bytes) : std::string_view(bytes));

  fs::path folder = fs::canonical(path).parent_path();
  tinygltf::TinyGLTF parser;
  parser.SetFsCallbacks({fileExists, samePath, readWholeFile, writeNothing, &folder});
  parser.SetImageLoader(ignoreImage, nullptr);
  std::string errors;
  std::string warnings;  // of images that are not read anyway
  bool parsed = false;
  const auto length = static_cast<unsigned int>(bytes.size());
  try {
    parsed = binary ? parser.LoadBinaryFromMemory(&file.model, &errors, &warnings,
                                                  reinterpret_cast<const unsigned char*>(bytes.data()), length, folder.string())
                    : parser.LoadASCIIFromString(&file.model, &errors, &warnings, bytes.data(), length, folder.string());
  } catch (const std::exception& e) {  // tinygltf indexes empty data with at(), json converts with get()
    errors += e.what();
  }
  file.remarks = oneLine(errors);
  if (!parsed) {
    std::string message = "is not valid glTF 2.0: " + file.remarks;
    if (errors.find("File not found") != std::string::npos) message += " (only files in the glTF's own folder are read)";
    for (const std::string& extension : file.model.extensionsRequired) message += "; it requires " + extension;
    file.fail("", message);
  }
  if (!file.model.asset.version.starts_with("2."))
    file.fail("/asset/version", "is \"" + file.model.asset.version + "\"; only 2.x is supported");
  return file;
}

std::string unsupportedData(const File& file, int index) {
  if (index < 0 || static_cast<std::size_t>(index) >= file.model.accessors.size()) return {};  // an error, not unsupported
  const tinygltf::Accessor& accessor = file.model.accessors[static_cast<std::size_t>(index)];
  if (accessor.sparse.isSparse) return "sparse accessors";
  if (accessor.bufferView < 0) return "accessors without a bufferView";
  return {};
}

std::vector<double> readNumbers(const File& file, int index, const std::string& pointer, NumberKind kind) {
  struct Form {
    int type;
    std::size_t components;
    const char* allowed;
  };
  constexpr Form forms[] = {{TINYGLTF_TYPE_SCALAR, 1, "times; SCALAR of FLOAT (5126) is needed"},
                            {TINYGLTF_TYPE_VEC3, 3, "translations or scales; VEC3 of FLOAT (5126) is needed"},
                            {TINYGLTF_TYPE_VEC4, 4, "rotations; VEC4 of FLOAT (5126) or of normalised integers is needed"}};
  const Form& form = forms[static_cast<std::size_t>(kind)];
  const tinygltf::Accessor& accessor = accessorAt(file, index, pointer);
  const bool asFloat = accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT;
  const bool asInteger = kind == NumberKind::quaternion && accessor.normalized && isSmallInteger(accessor.componentType);
  if (accessor.type != form.type || !(asFloat || asInteger))
    file.fail(pointerTo("accessors", index), std::string("holds ") + form.allowed);
  const Elements elements = elementsOf(file, index, pointer);
  std::vector<double> numbers;
  numbers.reserve(elements.count * form.components);
  for (std::size_t i = 0; i < elements.count; ++i)
    for (std::size_t c = 0; c < form.components; ++c)
      numbers.push_back(numberAt(elements.data + i * elements.stride, c, elements.componentType));
  return numbers;
}

RawTriangles readTriangles(const File& file, const tinygltf::Primitive& primitive, const std::string& pointer) {
  RawTriangles raw;
  const std::string attributes = pointer + "/attributes/";
  raw.positions = readVectors(file, primitive.attributes.at("POSITION"), attributes + "POSITION");
  if (const auto normal = primitive.attributes.find("NORMAL"); normal != primitive.attributes.end()) {
    raw.normals = readVectors(file, normal->second, attributes + "NORMAL");
    if (raw.normals.size() != raw.positions.size())
      file.fail(attributes + "NORMAL",
                fmt::format("has {} normals for {} positions", raw.normals.size(), raw.positions.size()));
  }
  if (primitive.indices >= 0) {
    raw.indices = readIndices(file, primitive.indices, pointer + "/indices", raw.positions.size());
  } else {
    raw.indices.resize(raw.positions.size());
    for (std::size_t i = 0; i < raw.indices.size(); ++i) raw.indices[i] = static_cast<std::uint32_t>(i);
  }
  return raw;
}

}  // namespace gnomon::gltf
