// Random triangles between the built-in scenes' floor and their source, under a light of every kind.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>

#include "gnomon/base/random.h"
#include "gnomon/scene/builtin_dimensions.h"
#include "render.h"

namespace gnomon::test {

/// Kinds of source, each with extent.
inline constexpr std::array kSourceKinds{"rectangle", "disc", "sphere", "directions"};

/// Aslant, so that no axis is special; large, so that most of the floor is penumbra.
inline Light soupLight(const std::string& kind) {
  Light light;
  light.position = {0.4, dimensions::kSourceHeight, -0.3};
  light.target = {0.1, 0.0, 0.2};
  light.coneHalfAngleDegrees = 80.0;
  if (kind == "rectangle") light.source = {SourceShape::rectangle, {1.1, 0.6}, 0.0, 20.0};
  if (kind == "disc") light.source = {SourceShape::disc, {}, 0.5, 0.0};
  if (kind == "sphere") {
    light.type = LightType::point;
    light.radius = 0.5;
  }
  if (kind == "directions") {
    light.type = LightType::directional;
    light.angularDiameterDegrees = 14.0;
  }
  return light;
}

/// half_plane's floor and camera under `triangles` random ones of some `size` metres, which receive nothing. A quarter of them
/// reaches through the floor, whose far side must not shadow it, or to beside and above a source at dimensions::kSourceHeight.
inline SessionSetup soupSetup(const std::string& kind, std::uint64_t seed, int triangles = 40, double size = 0.6,
                              glm::ivec2 output = {48, 36}) {
  SessionSetup setup = builtinSetup("half_plane", output);
  setup.light = soupLight(kind);
  RandomStream random(seed);
  const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
  Mesh mesh;
  mesh.name = "soup";
  for (int t = 0; t < triangles; ++t) {
    const bool reachesFar = t % 4 == 3;
    const double height = reachesFar ? between(-0.2, dimensions::kSourceHeight + 0.5) : between(0.5, 3.2);
    const glm::dvec3 middle(between(-1.5, 1.5), height, between(-1.5, 1.5));
    for (int k = 0; k < 3; ++k) {
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.emplace_back(middle + glm::dvec3(between(-size, size), between(-size, size), between(-size, size)));
      mesh.normals.emplace_back(0.0f, 1.0f, 0.0f);
    }
  }
  Instance soup = setup.scene.instances.at(1);
  soup.name = "soup";
  soup.mesh = static_cast<std::uint32_t>(setup.scene.meshes.size());
  soup.world = glm::dmat4(1.0);
  soup.receives = false;
  setup.scene.meshes.push_back(std::move(mesh));
  setup.scene.instances[1] = soup;
  return setup;
}

}  // namespace gnomon::test
