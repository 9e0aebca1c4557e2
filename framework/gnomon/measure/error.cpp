#include "gnomon/measure/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "gnomon/base/error.h"
#include "gnomon/base/statistics.h"
#include "gnomon/measure/classes.h"

namespace gnomon {
namespace {

constexpr int kTilePixels = 16;      // errors of neighbouring pixels are alike: a tile is one witness
constexpr double kLargeError = 0.1;  // the "0_1" of over_0_1

void requireShape(const Image& image, const Image& technique, const char* name) {
  if (image.width != technique.width || image.height != technique.height || image.channels != 1 || technique.channels != 1) {
    throw Error(
        fmt::format("error: {} is {}x{} with {} channels, the technique's visibility {}x{} with {}; must be alike with 1", name,
                    image.width, image.height, image.channels, technique.width, technique.height, technique.channels));
  }
}

/// Sums over a set of pixels.
struct Sums {
  double pixels = 0.0;  ///< all, finite or not
  double finite = 0.0;
  double product = 0.0;  ///< of (T-A)(T-B)
  double signedError = 0.0;

  void add(double pixelProduct, double pixelError) {
    finite += 1.0;
    product += pixelProduct;
    signedError += pixelError;
  }
  std::optional<double> rmse() const {
    if (finite == 0.0) return std::nullopt;
    return std::sqrt(std::max(0.0, product / finite));
  }
  ClassFigures figures(double maskPixels) const {
    ClassFigures result;
    if (maskPixels > 0.0) result.share = pixels / maskPixels;
    result.rmse = rmse();
    if (finite > 0.0) result.bias = signedError / finite;
    return result;
  }
};

struct AllSums {
  Sums mask, lit, umbra, penumbra, band, terminator;

  /// Visits the sums to which a pixel belongs.
  template <typename Visit>
  void each(const ClassCode& code, const Visit& visit) {
    visit(mask);
    visit(code.pixelClass == PixelClass::lit ? lit : code.pixelClass == PixelClass::umbra ? umbra : penumbra);
    if (code.band) visit(band);
    if (code.terminator) visit(terminator);
  }
};

}  // namespace

ErrorFigures measureError(const Image& technique, const Image& a, const Image& b, const Image& classes) {
  requireShape(a, technique, "reference A");
  requireShape(b, technique, "reference B");
  requireShape(classes, technique, "the class image");

  AllSums sums;
  const int tilesX = (technique.width + kTilePixels - 1) / kTilePixels;
  const int tilesY = (technique.height + kTilePixels - 1) / kTilePixels;
  std::vector<GroupSum> tiles(static_cast<std::size_t>(tilesX) * static_cast<std::size_t>(tilesY));
  std::vector<double> absoluteErrors;
  double halvesSquared = 0.0;
  ErrorFigures figures;
  for (int y = 0; y < technique.height; ++y) {
    for (int x = 0; x < technique.width; ++x) {
      const ClassCode code = ClassCode::decode(classes.at(x, y));
      if (code.pixelClass == PixelClass::outside) continue;
      const double valueA = a.at(x, y);
      const double valueB = b.at(x, y);
      if (!std::isfinite(valueA) || !std::isfinite(valueB)) {
        throw Error(fmt::format("error: the reference is not finite at pixel ({}, {})", x, y));
      }
      halvesSquared += (valueA - valueB) * (valueA - valueB);
      sums.each(code, [](Sums& sum) { sum.pixels += 1.0; });
      const double value = technique.at(x, y);
      if (!std::isfinite(value)) {
        ++figures.nonFinite;
        continue;
      }
      const double product = (value - valueA) * (value - valueB);
      const double signedError = value - 0.5 * (valueA + valueB);
      sums.each(code, [&](Sums& sum) { sum.add(product, signedError); });
      GroupSum& tile = tiles[static_cast<std::size_t>(y / kTilePixels) * static_cast<std::size_t>(tilesX) +
                             static_cast<std::size_t>(x / kTilePixels)];
      tile.sum += product;
      tile.count += 1.0;
      absoluteErrors.push_back(std::abs(signedError));
    }
  }

  const double maskPixels = sums.mask.pixels;
  figures.lit = sums.lit.figures(maskPixels);
  figures.umbra = sums.umbra.figures(maskPixels);
  figures.penumbra = sums.penumbra.figures(maskPixels);
  figures.band = sums.band.figures(maskPixels);
  figures.terminator = sums.terminator.figures(maskPixels);
  figures.rmseBand = figures.band.rmse;
  if (maskPixels == 0.0) return figures;
  figures.noiseFloor = 0.5 * std::sqrt(halvesSquared / maskPixels);
  const auto large = std::count_if(absoluteErrors.begin(), absoluteErrors.end(), [](double e) { return e > kLargeError; });
  figures.over01 = (static_cast<double>(large) + static_cast<double>(figures.nonFinite)) / maskPixels;
  if (absoluteErrors.empty()) return figures;
  figures.mse = sums.mask.product / sums.mask.finite;
  figures.rmse = sums.mask.rmse();
  figures.mseSe = jackknifeErrorOfMean(tiles);
  if (figures.mseSe) figures.rmseSe = std::sqrt(std::max(0.0, *figures.mse) + *figures.mseSe) - *figures.rmse;
  figures.mae = mean(absoluteErrors);
  figures.bias = sums.mask.signedError / sums.mask.finite;
  figures.p99 = percentile(absoluteErrors, 99.0);
  figures.max = *std::max_element(absoluteErrors.begin(), absoluteErrors.end());
  return figures;
}

}  // namespace gnomon
