// FLIP: how visible the difference of two pictures is when they are flipped between.
#pragma once

#include <memory>
#include <optional>

#include "gnomon/base/image.h"

namespace gnomon {

/// HDR-FLIP of the shaded picture with white albedo, 67 pixels per degree, over the receiver mask. In [0,1]: 0 equal, 1 most
/// visible.
struct FlipFigures {
  std::optional<double> mean;
  std::optional<double> p99;

  bool operator==(const FlipFigures&) const = default;
};

/// 0.7 m before a screen of 0.7 m width with 3840 pixels: the distance of the paper.
inline constexpr double kFlipPixelsPerDegree = 67.0;

/// LDR-FLIP (Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild: FLIP: A Difference Evaluator for Alternating
/// Images, HPG 2020) of two pictures of three channels, linear RGB with the primaries of sRGB, clamped to [0,1]: one channel in
/// [0,1]. Symmetric. A pixel that is not finite in either is 1, and black to its neighbours. Throws Error where shapes
/// disagree.
Image ldrFlip(const Image& a, const Image& b, double pixelsPerDegree = kFlipPixelsPerDegree);

/// What HDR-FLIP looks at a picture with: stops of exposure from `start` to `stop`, evenly.
struct FlipExposures {
  double start = 0.0;
  double stop = 0.0;
  int count = 2;
};
/// From the reference's brightest pixel shown at 0.85 to its median shown so (Andersson, Nilsson, Shirley, Akenine-Moller:
/// Visualizing Errors in Rendered High Dynamic Range Images, Eurographics 2021, section 4).
FlipExposures flipExposures(const Image& reference);

/// HDR-FLIP: the greatest LDR-FLIP of the pictures' tone-mapped exposures (ACES), pixel by pixel. One reference for many
/// techniques is looked at once: it keeps 20 bytes a pixel and exposure.
class HdrFlip {
 public:
  /// Throws Error where the reference has not three channels.
  explicit HdrFlip(const Image& reference, double pixelsPerDegree = kFlipPixelsPerDegree);
  HdrFlip(HdrFlip&&) noexcept;
  HdrFlip& operator=(HdrFlip&&) noexcept;
  ~HdrFlip();
  Image operator()(const Image& technique) const;

 private:
  struct State;
  std::unique_ptr<const State> state_;
};

/// Over the mask's pixels. Empty without any.
FlipFigures flipFigures(const Image& flip, const Image& mask);

}  // namespace gnomon
