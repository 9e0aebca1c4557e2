// Error split by what people see. Each figure answers to one fault and to little else.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>

#include "gnomon/base/image.h"
#include "gnomon/scene/light.h"

namespace gnomon {

/// With T the technique and R the reference. None of the figures exists where the picture has nothing to measure it on.
struct ErrorSplits {
  std::optional<double> acne;        ///< root mean square of min(T-R, 0) over lit pixels far from every edge of a shadow
  std::optional<double> leak;        ///< root mean square of T over umbra far from every edge of a shadow and every contact
  std::optional<double> detachment;  ///< mean length of the lit gap between a caster and its shadow at contacts, metres
  std::optional<double> penumbra;  ///< mean |log2((width + 1) / (the reference's width + 1))| over edges of shadows, in pixels
  std::optional<double> offset;    ///< how far the whole shadow is displaced in the light's plane through its target, metres
  std::optional<double> shimmer;   ///< root mean square of what T changes from frame to frame beyond what R does

  bool operator==(const ErrorSplits&) const = default;
};

/// Chebyshev distance in pixels from which on a pixel is far from another: 2 % of the picture's height, at least 8.
int farPixels(int height);

/// All images of one size, rows from the top.
struct SplitInputs {
  const Image& technique;   ///< V; pixels where it is not finite are left out
  const Image& referenceA;  ///< V in [0,1]
  const Image& referenceB;  ///< an independent half of the same reference
  const Image& classes;     ///< codes of classifyPixels
  const Image& position;    ///< 4 channels: metres from the camera, world axes; w above 0 where there is geometry
  const Image& normal;      ///< 4 channels: geometric, unit, turned to the camera
  const Light& light;
  glm::dvec3 camera;  ///< its position, metres, world
};

/// All but the shimmer, which one picture does not show.
/// - penumbra: over an edge of length L along which V falls evenly in a width w the sum of V(1-V) is L w / 6. Widths follow
/// from
///   that by tiles of 16x16 pixels, each with its eight neighbours, weighted by L. Of widths above 32 pixels a part falls
///   beyond the neighbours.
/// - offset: the displacement d for which -d . gradient(R) is nearest to T-R, in least squares over the tiles' sums, beside an
///   even darkening of what is lit and an even lighting of what is dark. Needs edges in two directions, and a light with a
///   plane: none for point lights.
/// - detachment: a contact is a pixel in the shadow that touches a pixel of another surface which faces away from the light.
///   From there on the way follows the light along the receiver while R < 0.5 <= T, for at most 64 pixels.
/// Throws Error where sizes or channels disagree.
ErrorSplits measureSplits(const SplitInputs& inputs);

/// Sums what changes from one frame to the next.
class ShimmerSum {
 public:
  /// One frame: the technique's V, and both halves of the reference, NaN outside the receiver mask.
  struct Frame {
    const Image& technique;
    const Image& referenceA;
    const Image& referenceB;
  };

  /// Over the pixels that are receivers in both frames.
  void add(const Frame& before, const Frame& after);
  /// sqrt(max(0, mean of (dT-dA)(dT-dB))), d the change of a pixel: unbiased before the root, as the mean square error is.
  std::optional<double> value() const;

 private:
  double sum_ = 0.0;
  std::size_t pixels_ = 0;
};

}  // namespace gnomon
