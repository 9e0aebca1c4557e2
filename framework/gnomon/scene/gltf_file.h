// Reading of a glTF file into tinygltf's model, guarded. Internal to scene/.
#pragma once

#include <tiny_gltf.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "gnomon/scene/scene.h"

namespace gnomon::gltf {

/// The parsed file, with the name that messages give it.
struct File {
  std::string name;
  tinygltf::Model model;
  std::string remarks;  ///< what the parser found wrong and could read past, on one line

  /// Throws InputError at that JSON pointer.
  [[noreturn]] void fail(const std::string& pointer, const std::string& message) const;
};

/// "/accessors/3"
std::string pointerTo(const std::string& list, int index);

/// Parses a .gltf or .glb (told apart by its first bytes). Reads no other file than those in its own folder and below, and
/// decodes no image. Throws InputError on what is not glTF 2.0, Error on a file that cannot be read.
File openFile(const std::filesystem::path& path);

/// A primitive's triangles, all indices in range; corners that are not finite are still there.
struct RawTriangles {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;  ///< as many as positions, or none
  std::vector<std::uint32_t> indices;
};

/// Why an accessor's data cannot be had though the file may be valid ("is sparse"); empty if it can.
std::string unsupportedData(const File& file, int accessor);

/// What an animation's accessor holds: times, translations or scales (floats only), or rotations (floats or normalised
/// integers).
enum class NumberKind { scalar, vector, quaternion };

/// The numbers of an accessor whose data is supported, one after the other; not checked to be finite. Throws InputError.
std::vector<double> readNumbers(const File& file, int accessor, const std::string& pointer, NumberKind kind);

/// Reads a primitive of triangles whose accessors are supported. Every access is checked against accessor, bufferView and
/// buffer first. Throws InputError that names the one at fault.
RawTriangles readTriangles(const File& file, const tinygltf::Primitive& primitive, const std::string& pointer);

}  // namespace gnomon::gltf
