#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "gnomon/stability/oracle.h"

namespace gnomon::stability {

namespace {

constexpr double kUlp = 1.1920929e-7;
constexpr double kRoundings = 4.0 * kUlp;  // as graph/types.cpp and depth_map.glsl state it
constexpr double kSmallestCosine = 2e-6;   // twice where depth_map.glsl stops to follow a receiver's plane
constexpr double kExactly = 1.0 + 1e-9;    // the bias may equal what is needed
constexpr double kSmallOffset = 0.1;       // of the depth: a normal offset below this moves a receiver as to first order
constexpr double kInFrontOfLight = 1e-12;  // of far

}  // namespace

/// Stored depth is z = a / d + b (perspective) or a d + b; over a plane it is linear in the map, so all comparisons are with
/// planes in space. Gradients and coordinates in the map are tangents (perspective) or metres.
struct MapOracle::Beam {
  glm::dvec3 receiver;       ///< x, y, depth
  glm::dvec2 point;          ///< the receiver in the map
  glm::dvec2 low, high;      ///< centres of the texels that may be read
  glm::dvec2 rounding{0.0};  ///< texels by which the receiver's place in the map may be off
  double widest = 0.0;       ///< a texel's larger extent at the receiver, metres
  double offset = 0.0;       ///< metres that the receiver may be moved along its normal
  double a = 0.0, b = 0.0;
  double z = 0.0;
  glm::dvec2 gradient{0.0};  ///< of the compared depth
  double lowest = 0.0;       ///< what a clamped correction may take from the compared depth
  double highest = 0.0;      ///< what it may add
  double leastBias = 0.0, mostBias = 0.0;
  double blur = 0.0;       ///< of other surfaces' depths against the receiver's, by rounding
  bool depthKnown = true;  ///< what is compared can be told
  bool ownPlaneHolds = false;
  bool tapsInside = false;
};

MapOracle::MapOracle(const SessionSetup& setup, const std::vector<Face>& faces, const Facts& facts)
    : world_(faces), facts_(facts) {
  std::vector<Bounds> bounds;
  for (const Instance& instance : setup.scene.instances) bounds.push_back(worldBounds(setup.scene, instance));
  plane_ =
      mapPlane({setup.scene, bounds, setup.light, setup.camera, static_cast<double>(setup.outputSize.x) / setup.outputSize.y});
  for (const Face& face : faces)
    faces_.push_back({inLight(face.a), inLight(face.b), inLight(face.c), {}, face.casts, face.receives});
}

glm::dvec3 MapOracle::inLight(const glm::dvec3& world) const {
  const glm::dvec3 v = world - plane_.axes.origin;
  return {glm::dot(plane_.axes.x, v), glm::dot(plane_.axes.y, v), -glm::dot(plane_.axes.z, v)};
}

Certainty MapOracle::judge(const ReceiverPoint& receiver) const {
  Beam beam;
  beam.receiver = inLight(receiver.position);
  const double d = beam.receiver.z;
  if (!(facts_.farDepth > facts_.nearDepth) || !(d > facts_.nearDepth) || !(d < facts_.farDepth)) return Certainty::open;
  beam.point = glm::dvec2(beam.receiver) / (facts_.perspective ? d : 1.0);
  placeSquare(receiver, beam);
  compare(receiver, beam);
  if (beam.low.x > beam.high.x || beam.low.y > beam.high.y || nothingNearer(receiver, beam)) return Certainty::lit;
  return allNearer(receiver, beam) ? Certainty::dark : Certainty::open;
}

/// Which texels may be read: within r of the receiver, and of the map.
void MapOracle::placeSquare(const ReceiverPoint& receiver, Beam& beam) const {
  const Facts& f = facts_;
  const double d = beam.receiver.z;
  const glm::dvec2 footprint = texelFootprint(f, d);
  beam.widest = std::max(footprint.x, footprint.y);
  const double narrowest = std::min(footprint.x, footprint.y);
  // Off its axis a perspective map sees a shift along the axis too.
  const glm::dvec2 oblique = f.perspective ? 1.0 + glm::abs(beam.point) : glm::dvec2(1.0);
  beam.offset = f.biasNormal * beam.widest;
  beam.rounding = oblique * (receiver.rounding + beam.offset) / narrowest + kRoundings * std::max(f.mapSize.x, f.mapSize.y);
  const glm::dvec2 half = f.texel * glm::dvec2(f.mapSize) * 0.5;
  const glm::dvec2 radius = (f.filterRadiusTexels + 0.5 + beam.rounding) * f.texel;
  const glm::dvec2 centres = half - (0.5 - beam.rounding) * f.texel;
  beam.low = glm::max(beam.point - radius, plane_.centre - centres);
  beam.high = glm::min(beam.point + radius, plane_.centre + centres);
  const glm::dvec2 reach = glm::abs(beam.point - plane_.centre) + (f.filterRadiusTexels + beam.rounding) * f.texel;
  beam.tapsInside = reach.x < half.x && reach.y < half.y;
  if (f.perspective && beam.offset > kSmallOffset * d) {  // the receiver may be moved anywhere, even behind the light
    beam.low = plane_.centre - half;
    beam.high = plane_.centre + half;
    beam.depthKnown = false;
  }
}

/// What is compared there, and by how much it is moved towards the light, as the facts state it.
void MapOracle::compare(const ReceiverPoint& receiver, Beam& beam) const {
  const Facts& f = facts_;
  const double d = beam.receiver.z;
  const double range = f.farDepth - f.nearDepth;
  beam.a = f.perspective ? f.nearDepth * f.farDepth / range : -1.0 / range;
  beam.b = f.perspective ? -f.nearDepth / range : f.farDepth / range;
  beam.z = f.perspective ? beam.a / d + beam.b : beam.a * d + beam.b;
  const double rate = f.perspective ? beam.a / (d * d) : -beam.a;

  // The receiver's plane n.q = c in light axes, q = (x, y, -d): its depth's gradient in the map.
  const glm::dvec3 n(glm::dot(plane_.axes.x, receiver.normal), glm::dot(plane_.axes.y, receiver.normal),
                     glm::dot(plane_.axes.z, receiver.normal));
  const glm::dvec3 q(beam.receiver.x, beam.receiver.y, -d);
  const double cosine = f.perspective ? -glm::dot(n, q) / glm::length(q) : n.z;
  if (!(cosine > kSmallestCosine)) beam.depthKnown = false;
  if (!beam.depthKnown) {
    // Seen edge-on, or moved anywhere: only where the map holds nothing but the receiver's own plane is the answer known.
    beam.ownPlaneHolds = true;
    return;
  }
  const glm::dvec2 gradient = beam.a * glm::dvec2(n) / (f.perspective ? glm::dot(n, q) : n.z);
  const glm::dvec2 slope = glm::abs(gradient * f.texel);  // a texel
  const double steepest = std::max(slope.x, slope.y);
  const double quantum = depthQuantum(f, d) * rate;
  const double limit = f.biasLimit * beam.widest * rate;
  const double needed = (slope.x + slope.y) * (f.filterRadiusTexels + 0.5);
  const double curvature = f.biasCurvature * f.filterRadiusTexels * beam.widest * rate;
  const double slopeBias = f.biasSlope * steepest;
  const double correction = slopeBias + (f.radiusVaries ? 0.0 : curvature);  // what is sure
  const double rounding = receiver.rounding * rate + (slope.x + slope.y) * std::max(beam.rounding.x, beam.rounding.y);
  beam.leastBias = f.biasConstant * quantum + std::min(correction, limit);
  beam.mostBias = f.biasConstant * quantum + std::min(slopeBias + curvature + 2.0 * rounding, limit);
  beam.blur = quantum + rounding + beam.offset * rate;
  const double across = needed + (slope.x + slope.y) * std::max(beam.rounding.x, beam.rounding.y);
  if (!f.receiverPlane) {
    beam.ownPlaneHolds = needed <= std::min(correction, limit) * kExactly;
  } else if (across <= limit) {
    beam.gradient = gradient;
    beam.ownPlaneHolds = true;
  } else {
    beam.lowest = -limit;
    beam.highest = limit;
    beam.ownPlaneHolds = across - limit <= std::min(correction, limit);
  }
}

namespace {

/// Where stored depth exceeds `z` + gradient.(m - point), m in the map: z_here - z - ... >= 0, times the depth if perspective.
HalfSpace nearerThan(bool perspective, double a, double b, double z, const glm::dvec2& gradient, const glm::dvec2& point) {
  if (perspective) return {{-gradient.x, -gradient.y, b - z + glm::dot(gradient, point)}, a};
  return {{-gradient.x, -gradient.y, a}, b - z + glm::dot(gradient, point)};
}

}  // namespace

std::array<HalfSpace, 6> MapOracle::beamAnd(const Beam& beam, const HalfSpace& nearer) const {
  const bool p = facts_.perspective;
  const auto side = [&](double x, double y, double bound) {
    return p ? HalfSpace{{x, y, -bound}, 0.0} : HalfSpace{{x, y, 0.0}, -bound};
  };
  return {side(1.0, 0.0, beam.low.x),
          side(-1.0, 0.0, -beam.high.x),
          side(0.0, 1.0, beam.low.y),
          side(0.0, -1.0, -beam.high.y),
          p ? HalfSpace{{0.0, 0.0, 1.0}, -kInFrontOfLight * facts_.farDepth} : HalfSpace{},
          nearer};
}

bool MapOracle::nothingNearer(const ReceiverPoint& receiver, const Beam& beam) const {
  const bool p = facts_.perspective;
  const double threshold = beam.z + beam.lowest + beam.leastBias - beam.blur;
  const std::array<HalfSpace, 6> within =
      beamAnd(beam, beam.depthKnown ? nearerThan(p, beam.a, beam.b, threshold, beam.gradient, beam.point) : HalfSpace{});
  const std::span<const HalfSpace> sides(within.data(), 5);
  const double contact = 4.0 * receiver.rounding;
  const auto height = [&](const glm::dvec3& world) { return std::abs(glm::dot(receiver.normal, world - receiver.position)); };
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const Face& face = faces_[i];
    if (!face.casts) continue;
    const Face& world = world_[i];
    const bool own = std::max({height(world.a), height(world.b), height(world.c)}) <= contact;
    if (own && beam.ownPlaneHolds) continue;
    if (!clippedTriangle(face.a, face.b, face.c, own ? sides : std::span<const HalfSpace>(within)).empty()) return false;
  }
  return true;
}

bool MapOracle::allNearer(const ReceiverPoint& receiver, const Beam& beam) const {
  if (!beam.tapsInside || !beam.depthKnown) return false;  // a tap outside the map is lit
  const double threshold = beam.z + beam.highest + beam.mostBias + beam.blur;
  // Depths nearer than near are stored as 1: nothing exceeds that.
  const glm::dvec2 rise = glm::abs(beam.gradient) * glm::max(beam.high - beam.point, beam.point - beam.low);
  if (!(threshold + rise.x + rise.y < 1.0)) return false;
  const bool p = facts_.perspective;
  const std::array<HalfSpace, 6> solid = beamAnd(beam, nearerThan(p, beam.a, beam.b, threshold, beam.gradient, beam.point));
  const double contact = 4.0 * receiver.rounding;
  const auto height = [&](const glm::dvec3& world) { return std::abs(glm::dot(receiver.normal, world - receiver.position)); };
  std::vector<Polygon> blockers;
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const Face& face = faces_[i];
    const Face& world = world_[i];
    if (!face.casts || std::max({height(world.a), height(world.b), height(world.c)}) <= contact) continue;
    Polygon blocker = clippedTriangle(face.a, face.b, face.c, solid);
    if (blocker.empty()) continue;
    for (glm::dvec3& v : blocker) v = p ? glm::dvec3(v.x / v.z, v.y / v.z, 0.0) : glm::dvec3(v.x, v.y, 0.0);
    blockers.push_back(std::move(blocker));
  }
  const Polygon square{{beam.low.x, beam.low.y, 0.0},
                       {beam.high.x, beam.low.y, 0.0},
                       {beam.high.x, beam.high.y, 0.0},
                       {beam.low.x, beam.high.y, 0.0}};
  return covers(blockers, square);
}

}  // namespace gnomon::stability
