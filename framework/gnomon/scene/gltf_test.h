// What tests of the glTF import share: small files, written to a folder of the test's own.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gnomon/base/error.h"
#include "gnomon/scene/gltf.h"

namespace gnomon::gltf_test {

namespace fs = std::filesystem;
using Json = nlohmann::json;

template <class T>
std::string bytesOf(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// A folder of its own for each test.
class GltfTest : public testing::Test {
 protected:
  GltfTest() {
    const testing::TestInfo* const test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / ("gnomon_gltf_" + std::string(test->name()) + std::to_string(::getpid()));
    fs::create_directories(folder_ / "inner");
  }
  ~GltfTest() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }

  /// A unit right triangle in z = 0 with 16-bit indices: accessor 0 positions, 1 indices; buffer in data.bin.
  Json triangle(const std::string& buffer = "data.bin") const {
    const std::string bytes = bytesOf<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}) + bytesOf<std::uint16_t>({0, 1, 2, 0});
    write("data.bin", bytes);
    return Json{
        {"asset", {{"version", "2.0"}}},
        {"scene", 0},
        {"scenes", {{{"nodes", {0}}}}},
        {"nodes", {{{"mesh", 0}, {"name", "thing"}}}},
        {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}},
        {"accessors",
         {{{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}},
          {{"bufferView", 1}, {"componentType", 5123}, {"count", 3}, {"type", "SCALAR"}}}},
        {"bufferViews",
         {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 36}}, {{"buffer", 0}, {"byteOffset", 36}, {"byteLength", 6}}}},
        {"buffers", {{{"uri", buffer}, {"byteLength", 44}}}}};
  }

  /// The triangle with other bytes of positions and indices (of this component type).
  Json withData(const std::string& positions, const std::string& indices, int componentType, int indexCount) const {
    Json json = triangle();
    write("data.bin", positions + indices);
    json["buffers"][0]["byteLength"] = positions.size() + indices.size();
    json["bufferViews"][0]["byteLength"] = positions.size();
    json["bufferViews"][1] = {{"buffer", 0}, {"byteOffset", positions.size()}, {"byteLength", indices.size()}};
    json["accessors"][0]["count"] = positions.size() / 12;
    json["accessors"][1]["componentType"] = componentType;
    json["accessors"][1]["count"] = indexCount;
    return json;
  }

  Scene load(const Json& json) const { return loadGltf(write("test.gltf", json.dump())); }

  /// The pointer of the InputError that loading ends in; "none" if it does not.
  std::string faultOf(const Json& json) const { return faultOf(write("test.gltf", json.dump())); }
  static std::string faultOf(const fs::path& path) {
    try {
      loadGltf(path);
    } catch (const InputError& error) {
      EXPECT_EQ(error.problems().at(0).file, path.string());
      return error.problems().at(0).pointer;
    }
    return "none";
  }

  fs::path folder_;
};

}  // namespace gnomon::gltf_test
