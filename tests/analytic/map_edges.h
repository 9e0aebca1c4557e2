// Set-ups in which what a depth map must say follows from geometry by hand: a straight edge seen from above, and lone planes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/trigonometric.hpp>
#include <string>
#include <vector>

#include "agreement.h"
#include "closed_forms.h"
#include "gnomon/base/error.h"
#include "gnomon/scene/builtin_dimensions.h"
#include "render.h"

namespace gnomon::test {

/// The axis that an edge crosses: 0 along X, 2 along Z.
enum class Across : int { x = 0, z = 2 };

/// half_plane under a light without extent that looks straight down from one metre behind the edge, so that the edge's shadow
/// is clear of the blocker, and seen from straight above by a camera whose rows cross it.
struct EdgeScene {
  Across across = Across::x;
  glm::ivec2 output{2048, 4};
  double viewWidth = 0.5;  ///< metres of floor in a row, with the shadow's edge in the middle

  static constexpr double kBlockerHeight = 1.0;
  static constexpr double kLightBehind = 1.0;
  static constexpr double kConeDegrees = 60.0;

  /// The edge's shadow on the floor.
  static double shadowEdge(double blockerEdge = dimensions::kHalfPlaneEdge) {
    const double magnification = dimensions::kSourceHeight / (dimensions::kSourceHeight - kBlockerHeight);
    return -kLightBehind + (blockerEdge + kLightBehind) * magnification;
  }
  /// Where the light's map has a point of lateral coordinate `x` at `depth` below the light, in texels from the map's border.
  static double texelOf(double x, double depth, int mapSize) {
    const double image = (x + kLightBehind) / (depth * std::tan(glm::radians(kConeDegrees)));
    return (0.5 * image + 0.5) * mapSize;
  }
  /// First texel whose centre's ray passes the blocker: the edge as the map holds it.
  static int snappedEdge(int mapSize, double blockerEdge = dimensions::kHalfPlaneEdge) {
    return static_cast<int>(std::ceil(texelOf(blockerEdge, dimensions::kSourceHeight - kBlockerHeight, mapSize) - 0.5));
  }

  SessionSetup setup() const {
    SessionSetup result = builtinSetup("half_plane", output);
    const glm::dvec3 along = across == Across::x ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 0.0, 1.0);
    if (across == Across::z) {
      const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), glm::radians(-90.0), {0.0, 1.0, 0.0});  // X to Z
      result.scene.instances.at(1).world = turn * result.scene.instances.at(1).world;
    }
    result.light.source = {};
    result.light.coneHalfAngleDegrees = kConeDegrees;
    result.light.target = -kLightBehind * along;
    result.light.position = result.light.target + glm::dvec3(0.0, dimensions::kSourceHeight, 0.0);
    result.camera.type = CameraType::orthographic;
    result.camera.target = shadowEdge() * along;
    result.camera.position = result.camera.target + glm::dvec3(0.0, 3.0, 0.0);
    result.camera.up = across == Across::x ? glm::dvec3(0.0, 0.0, -1.0) : glm::dvec3(1.0, 0.0, 0.0);
    result.camera.height = viewWidth * output.y / output.x;
    return result;
  }
};

/// One pixel of a row across the edge.
struct EdgePixel {
  double at;  ///< along the crossed axis, metres
  double visibility;
};

/// The picture's middle row, in the order of growing coordinate. Every pixel of it is a receiver.
inline std::vector<EdgePixel> acrossEdge(const Session& session, Slot slot, Across across) {
  const Image v = session.visibility(slot);
  std::vector<EdgePixel> row;
  for (const ReceiverPoint& p : receiverPoints(session)) {
    if (p.y == v.height / 2) row.push_back({p.position[static_cast<int>(across)], v.at(p.x, p.y)});
  }
  if (row.size() != static_cast<std::size_t>(v.width)) throw Error("the row across the edge leaves the receiver mask");
  std::sort(row.begin(), row.end(), [](const EdgePixel& a, const EdgePixel& b) { return a.at < b.at; });
  return row;
}

/// Where a hard row turns from dark to lit: half-way between two pixels. Throws Error unless it does so once.
inline double hardEdge(const std::vector<EdgePixel>& row) {
  const auto lit = std::find_if(row.begin(), row.end(), [](const EdgePixel& p) { return p.visibility > 0.0; });
  if (lit == row.begin() || lit == row.end()) throw Error("no edge in view");
  if (std::any_of(lit, row.end(), [](const EdgePixel& p) { return p.visibility < 1.0; })) throw Error("not one hard edge");
  return 0.5 * (std::prev(lit)->at + lit->at);
}

enum class Glancing { directional, spot };

/// A floor with nothing on it, that meets the light's axis at `elevationDegrees`; seen from above.
inline SessionSetup lonePlane(Glancing kind, double elevationDegrees) {
  SessionSetup setup = builtinSetup("half_plane", {200, 150});
  setup.scene.instances.resize(1);
  const double elevation = glm::radians(elevationDegrees);
  setup.light = {};
  setup.light.type = kind == Glancing::directional ? LightType::directional : LightType::spot;
  setup.light.position = 10.0 * glm::dvec3(0.8 * std::cos(elevation), std::sin(elevation), 0.6 * std::cos(elevation));
  setup.light.coneHalfAngleDegrees = kind == Glancing::spot ? 15.0 : setup.light.coneHalfAngleDegrees;
  setup.camera.position = {0.5, 4.0, 4.5};
  setup.camera.target = {0.0, 0.0, 0.0};
  return setup;
}

/// Share of receiver pixels whose visibility is below 1.
inline double shadowedShare(const Session& session, Slot slot) {
  const Image v = session.visibility(slot);
  const std::vector<ReceiverPoint> points = receiverPoints(session);
  if (points.empty()) throw Error("no receiver in view");
  const auto dark = std::count_if(points.begin(), points.end(), [&](const ReceiverPoint& p) { return v.at(p.x, p.y) < 1.0f; });
  return static_cast<double>(dark) / static_cast<double>(points.size());
}

/// The same of one technique on a set-up.
inline double shadowedShare(SessionSetup setup, const std::string& technique, const std::string& parameters) {
  ensureContext();
  Session session(std::move(setup));
  const Slot slot = addSlot(session, technique, parameters);
  session.frame(slot);
  return shadowedShare(session, slot);
}

/// Mean |a - b|.
inline double meanDifference(const Image& a, const Image& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.data.size(); ++i) sum += std::abs(static_cast<double>(a.data[i]) - b.data[i]);
  return sum / static_cast<double>(a.data.size());
}

/// The mean V where the source is wholly hidden, by 256 rays a pixel.
inline double leakInUmbra(const SessionSetup& setup, const std::string& technique, const std::string& parameters) {
  const Image truth = renderVisibility(setup, "ray_traced", R"({"samples": 256})");
  const Image v = renderVisibility(setup, technique, parameters);
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < v.data.size(); ++i) {
    if (truth.data[i] > 0.0f) continue;
    sum += static_cast<double>(v.data[i]);
    ++count;
  }
  if (count < 100.0) throw Error("no umbra in view");
  return sum / count;
}

}  // namespace gnomon::test
