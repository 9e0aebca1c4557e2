#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>

#include "gnomon/base/parallel.h"
#include "gnomon/scene/look_at.h"
#include "gnomon/stability/oracle.h"

namespace gnomon::stability {

namespace {

constexpr double kUlp = 1.1920929e-7;  // of a float at 1
/// Positions come to a technique through a chain of float sums: a few units in the last place of the largest term.
constexpr double kRoundings = 4.0 * kUlp;
/// Blockers nearer to the receiver's plane than this many roundings cannot be told from it.
constexpr double kContact = 4.0;
constexpr double kSnap = 1.0 / 64.0;  // of a pixel: OpenGL asks for 1/16 at least, everybody has 1/256; seen at an angle, more
constexpr double kPad = 1e-2;         // tangent: most that rounding may widen the beam where darkness is decided
constexpr double kDoubleRounding = 1e-15;  // of tangents

/// The light's source as a receiver sees it: a rectangle across an axis, or the square around a disc or sphere.
struct SourceView {
  Axes axes;               ///< z points at the source
  double distance = 0.0;   ///< along z; infinite for directional lights
  glm::dvec2 centre{0.0};  ///< tangents
  glm::dvec2 half{0.0};    ///< tangents
  bool inside = false;     ///< the receiver is in the source
};

SourceView sourceView(const Light& light, const glm::dvec3& receiver) {
  const LightFrame frame = lightFrame(light);
  SourceView view;
  view.axes = {frame.x, frame.y, frame.z};
  if (light.type == LightType::directional) {
    view.distance = std::numeric_limits<double>::infinity();
    view.half = glm::dvec2(std::tan(glm::radians(light.angularDiameterDegrees) * 0.5));
    return view;
  }
  const glm::dvec3 towards = light.position - receiver;
  if (light.type == LightType::point) {
    view.distance = glm::length(towards);
    view.inside = view.distance <= light.radius;
    if (view.inside) return view;
    view.axes = axesAround(towards / view.distance);
    view.half = glm::dvec2(light.radius / std::sqrt((view.distance - light.radius) * (view.distance + light.radius)));
    return view;
  }
  view.distance = glm::dot(frame.z, towards);
  view.centre = glm::dvec2(glm::dot(frame.x, towards), glm::dot(frame.y, towards)) / view.distance;
  const Source& source = light.source;
  const glm::dvec2 half = source.shape == SourceShape::rectangle ? source.size * 0.5
                          : source.shape == SourceShape::disc    ? glm::dvec2(source.radius)
                                                                 : glm::dvec2(0.0);
  view.half = half / view.distance;
  return view;
}

Polygon rectangle(const glm::dvec2& low, const glm::dvec2& high) {
  return {{low.x, low.y, 0.0}, {high.x, low.y, 0.0}, {high.x, high.y, 0.0}, {low.x, high.y, 0.0}};
}

/// Whether the whole source is seen, or none of it. The receiver may lie `rounding` elsewhere; the source is exact, so that the
/// beam between them is the hull of the two.
Certainty judgeSource(const std::vector<Face>& faces, const Light& light, const ReceiverPoint& r) {
  const SourceView view = sourceView(light, r.position);
  if (view.inside || !(view.distance > 0.0)) return Certainty::open;
  const Axes& axes = view.axes;
  const auto inBeam = [&](const glm::dvec3& v) {
    return glm::dvec3(glm::dot(axes.x, v), glm::dot(axes.y, v), glm::dot(axes.z, v));
  };
  const glm::dvec3 normal = inBeam(r.normal);
  const double contact = kContact * r.rounding;
  const glm::dvec2 low = view.centre - view.half;
  const glm::dvec2 high = view.centre + view.half;

  // Sides of the beam: at depth z from low z - contact (1 - z/D) to high z + contact (1 - z/D).
  const double narrowing = std::isinf(view.distance) ? 0.0 : contact / view.distance;
  const std::array<HalfSpace, 7> beam{
      {{{1.0, 0.0, -low.x - narrowing}, contact},
       {{-1.0, 0.0, high.x - narrowing}, contact},
       {{0.0, 1.0, -low.y - narrowing}, contact},
       {{0.0, -1.0, high.y - narrowing}, contact},
       {{0.0, 0.0, 1.0}, 0.0},
       {{0.0, 0.0, std::isinf(view.distance) ? 0.0 : -1.0}, std::isinf(view.distance) ? 0.0 : view.distance},
       {normal, contact}}};
  // What surely blocks: clear of the receiver's plane, and short of the source by more than double precision's own rounding.
  constexpr double kShort = 1.0 - 1e-12;
  const double nearest = std::isinf(view.distance) ? contact : std::min(contact, view.distance * 1e-6);
  // Wider than the beam by what rounding may add, no wider: images of faces beside the receiver would reach to infinity.
  const glm::dvec2 pad = view.half + kPad;
  const std::array<HalfSpace, 7> solid{
      {{{1.0, 0.0, pad.x - low.x}, 0.0},
       {{-1.0, 0.0, pad.x + high.x}, 0.0},
       {{0.0, 1.0, pad.y - low.y}, 0.0},
       {{0.0, -1.0, pad.y + high.y}, 0.0},
       {{0.0, 0.0, 1.0}, -nearest},
       {{0.0, 0.0, std::isinf(view.distance) ? 0.0 : -1.0},
        std::isinf(view.distance) ? 0.0 : (view.distance - (light.type == LightType::point ? light.radius : 0.0)) * kShort},
       {normal, -contact}}};
  bool free = true;
  double nearestBlocker = std::numeric_limits<double>::infinity();
  std::vector<Polygon> blockers;
  for (const Face& face : faces) {
    if (!face.casts) continue;
    const glm::dvec3 a = inBeam(face.a - r.position);
    const glm::dvec3 b = inBeam(face.b - r.position);
    const glm::dvec3 c = inBeam(face.c - r.position);
    // The receiver's own plane never blocks it.
    if (std::max({std::abs(glm::dot(normal, a)), std::abs(glm::dot(normal, b)), std::abs(glm::dot(normal, c))}) <= contact)
      continue;
    if (clippedTriangle(a, b, c, beam).empty()) continue;
    free = false;
    Polygon blocker = clippedTriangle(a, b, c, solid);
    for (glm::dvec3& p : blocker) {
      nearestBlocker = std::min(nearestBlocker, p.z);
      p = {p.x / p.z, p.y / p.z, 0.0};
    }
    blockers.push_back(std::move(blocker));
  }
  if (free) return Certainty::lit;
  // Dark: every segment from where the receiver may be to the part of the source above its horizon is blocked.
  const double blur =
      contact * (1.0 / nearestBlocker - (std::isinf(view.distance) ? 0.0 : 1.0 / view.distance)) + kDoubleRounding;
  if (!std::isfinite(nearestBlocker) || blur > kPad) return Certainty::open;
  Polygon region = rectangle(low - blur, high + blur);
  clip(region, {{normal.x, normal.y, 0.0}, normal.z});
  return !region.empty() && covers(blockers, region) ? Certainty::dark : Certainty::open;
}

enum class Expected : std::uint8_t { either, inside, outside };

/// Whether the receiver mask must hold the point; either way where rounding decides.
Expected expectedInMask(const Light& light, const Face& face, const ReceiverPoint& r) {
  if (!face.receives) return Expected::outside;
  const LightFrame frame = lightFrame(light);
  const glm::dvec3 towards = light.type == LightType::directional ? frame.z : light.position - r.position;
  const double distance = glm::length(towards);
  if (!(distance > 0.0)) return Expected::either;
  const double slack = 2.0 * kRoundings + (light.type == LightType::directional ? 0.0 : kContact * r.rounding / distance);
  const double facing = glm::dot(r.normal, towards) / distance;
  double reach = 1.0;
  if (light.type == LightType::spot) {
    const double along = glm::dot(frame.z, towards) / distance;
    reach = std::min(along, along - std::cos(glm::radians(std::min(light.coneHalfAngleDegrees, 90.0))));
  }
  const double least = std::min(facing, reach);
  return least > slack ? Expected::inside : least < -slack ? Expected::outside : Expected::either;
}

}  // namespace

GroundTruth::GroundTruth(const SessionSetup& setup, const Image& positions, const Image& normals, const Image& mask)
    : faces_(worldFaces(setup.scene)) {
  Bounds bounds = worldBounds(setup.scene);
  const double extent = bounds.empty() ? 0.0 : 0.5 * bounds.diagonal();
  const double toLight =
      setup.light.type == LightType::directional ? 0.0 : glm::length(setup.light.position - setup.camera.position);

  struct Row {
    std::vector<ReceiverPoint> receivers;
    std::vector<std::string> faults;
  };
  std::vector<Row> rows(static_cast<std::size_t>(mask.height));
  parallelFor(rows.size(), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < mask.width; ++x) {
      const bool inMask = mask.at(x, y) > 0.5f;
      if (positions.at(x, y, 3) == 0.0f) {
        if (inMask)
          rows[row].faults.push_back(fmt::format("the receiver mask holds pixel ({}, {}), where there is no geometry", x, y));
        continue;
      }
      const glm::dvec3 relative(positions.at(x, y, 0), positions.at(x, y, 1), positions.at(x, y, 2));
      const glm::dvec3 seenNormal(normals.at(x, y, 0), normals.at(x, y, 1), normals.at(x, y, 2));
      const glm::dvec3 seen = setup.camera.position + relative;
      const NearestFace nearest = nearestFace(faces_, seen, seenNormal);
      const Face& face = faces_[nearest.face];
      const double height = glm::dot(face.normal, seen - nearest.point);
      ReceiverPoint r{x,
                      y,
                      seen - face.normal * height,
                      glm::dot(face.normal, seenNormal) < 0.0 ? -face.normal : face.normal,
                      nearest.face,
                      glm::length(relative)};
      r.rounding = kRoundings * (r.toCamera + extent + toLight);
      // Off its plane by rounding, beside its triangle by the fraction of a pixel to which rasterisers snap corners.
      const glm::dvec3 beside = seen - nearest.point;
      const double across = glm::length(beside - relative * (glm::dot(beside, relative) / glm::dot(relative, relative)));
      const double snap = kSnap * pixelFootprint(setup.camera, mask.height, r.toCamera);
      if (std::abs(height) > kContact * r.rounding || across > kContact * r.rounding + snap) {
        rows[row].faults.push_back(
            fmt::format("the G-buffer's position at pixel ({}, {}) lies {:.3g} m off every surface", x, y, nearest.distance));
      }
      const Expected expected = expectedInMask(setup.light, face, r);
      if ((expected == Expected::inside && !inMask) || (expected == Expected::outside && inMask)) {
        rows[row].faults.push_back(
            fmt::format("the receiver mask is {} at pixel ({}, {}), geometry says {}", inMask ? 1 : 0, x, y, inMask ? 0 : 1));
      }
      if (!inMask) continue;
      r.truth = judgeSource(faces_, setup.light, r);
      rows[row].receivers.push_back(r);
    }
  });
  for (Row& row : rows) {
    receivers_.insert(receivers_.end(), row.receivers.begin(), row.receivers.end());
    faults_.insert(faults_.end(), row.faults.begin(), row.faults.end());
  }
}

}  // namespace gnomon::stability
