// How far a technique's visibility is from the reference, unbiased by the reference's own noise.
#pragma once

#include <cstddef>
#include <optional>

#include "gnomon/base/image.h"

namespace gnomon {

/// Figures of one class of pixels. `share` is of the mask's pixels (empty mask: none). Without a finite pixel of the technique
/// there is no rmse and no bias. A class is decided by the same halves that judge it, so the noise of the reference cancels
/// exactly over the whole mask only; within lit and umbra it is zero, within penumbra of second order.
struct ClassFigures {
  std::optional<double> share;
  std::optional<double> rmse;
  std::optional<double> bias;

  bool operator==(const ClassFigures&) const = default;
};

/// With T the technique, A and B independent halves of the reference, R = (A+B)/2. Means are over the mask's pixels where T is
/// finite. None of the optional figures exists where there is no such pixel.
struct ErrorFigures {
  std::optional<double> mse;         ///< mean (T-A)(T-B): unbiased at any number of samples, may come out negative
  std::optional<double> mseSe;       ///< its standard error: jackknife over 16x16 tiles; none with fewer than two tiles
  std::optional<double> rmse;        ///< sqrt(max(0, mse))
  std::optional<double> rmseSe;      ///< what one standard error of the mse adds to the rmse: sqrt(max(0,mse)+mseSe) - rmse;
                                     ///< mseSe/(2 rmse) for large errors, and no false certainty at mse <= 0
  std::optional<double> rmseBand;    ///< over the band alone: does not depend on how much of the picture is plainly lit
  std::optional<double> mae;         ///< mean |T-R|: carries the reference's noise, as p99, max and over01 do
  std::optional<double> bias;        ///< mean (T-R): positive is light leaking, negative too dark
  std::optional<double> p99;         ///< 99th percentile of |T-R|
  std::optional<double> max;         ///< greatest |T-R|
  std::optional<double> over01;      ///< share of mask pixels with |T-R| > 0.1; a value that is not finite counts as over
  std::size_t nonFinite = 0;         ///< mask pixels where T is NaN or infinite: left out of all means, never hidden
  std::optional<double> noiseFloor;  ///< sqrt(mean (A-B)^2)/2, the noise of R; nothing is credited below it
  ClassFigures lit;
  ClassFigures umbra;
  ClassFigures penumbra;
  ClassFigures band;
  ClassFigures terminator;

  bool operator==(const ErrorFigures&) const = default;
};

/// All images have one channel and one size; `classes` from classifyPixels (0 is outside the mask).
/// Throws Error where shapes disagree, or where a reference half is not finite inside the mask.
ErrorFigures measureError(const Image& technique, const Image& a, const Image& b, const Image& classes);

}  // namespace gnomon
