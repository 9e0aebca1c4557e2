// Classes of receiver pixels by the reference: lit, umbra, penumbra; and two flags beside them, band and terminator.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "gnomon/base/image.h"

namespace gnomon {

/// A partition of the picture. By R = (A+B)/2: lit (R >= 1), umbra (R <= 0), penumbra (between).
enum class PixelClass : std::uint8_t { outside = 0, lit = 1, umbra = 2, penumbra = 3 };

/// What a pixel of a class image holds: the class, +4 if in the band, +8 if at the terminator. 0 outside the receiver mask.
struct ClassCode {
  PixelClass pixelClass = PixelClass::outside;
  bool band = false;        ///< penumbra, or within kBandPixels of a lit/umbra change on one surface
  bool terminator = false;  ///< N.L < kTerminatorCosine

  static ClassCode decode(float code) {
    const int bits = static_cast<int>(code);
    return {static_cast<PixelClass>(bits & 3), (bits & kBandFlag) != 0, (bits & kTerminatorFlag) != 0};
  }
  float encode() const {
    return static_cast<float>(static_cast<int>(pixelClass) + (band ? kBandFlag : 0) + (terminator ? kTerminatorFlag : 0));
  }
  bool operator==(const ClassCode&) const = default;

 private:
  static constexpr int kBandFlag = 4;
  static constexpr int kTerminatorFlag = 8;
};

/// Chebyshev distance in pixels up to which a pixel belongs to a lit/umbra change.
inline constexpr int kBandPixels = 2;
/// Geometric N.L below which a pixel is at the terminator.
inline constexpr float kTerminatorCosine = 0.1f;
/// Least cosine between the normals of two neighbours on one surface (26 degrees).
inline constexpr double kSameSurfaceCosine = 0.9;
/// Slack of the depth test below, relative to the step between two pixels. Rounding of 32-bit positions makes about 1e-4 of
/// it; parallel surfaces one behind the other are told apart down to views 1.1 degrees above them (asin 0.02).
inline constexpr double kSameSurfaceSlack = 0.02;

/// Whether the step from p1 to p2, with unit normals n1 and n2, stays on one surface: see classifyPixels.
bool onOneSurface(glm::dvec3 p1, glm::dvec3 n1, glm::dvec3 p2, glm::dvec3 n2);

/// What the classes are made of; all of one size. Positions are camera-relative, in metres (or any one unit).
struct ClassInputs {
  const Image& mask;         ///< receiver mask: above 0.5 inside
  const Image& referenceA;   ///< visibility in [0,1]
  const Image& referenceB;   ///< an independent half of the same reference
  const Image& position;     ///< 3 channels
  const Image& normal;       ///< 3 channels, geometric, unit length
  const Image& normalLight;  ///< N.L towards the source's centre
};

/// Class codes, one channel. A band starts at pairs of 4-neighbours of which one is lit and one umbra *on one surface*, so
/// that silhouettes do not count. Two pixels p1, p2 are on one surface when their normals agree, n1.n2 > kSameSurfaceCosine,
/// and their step d = p2 - p1 follows both: (|n1.d| + |n2.d|)/2 <= (sin(theta/2) + kSameSurfaceSlack) |d| with theta the
/// angle between n1 and n2. On an arc of a circle the left side is exactly sin(theta/2) |d|, and across the edge of two facets
/// at most that; on a plane it is 0; across a silhouette it is the depth of the gap.
/// Throws Error where sizes or channels disagree, or where the reference is not finite inside the mask.
Image classifyPixels(const ClassInputs& inputs);

}  // namespace gnomon
