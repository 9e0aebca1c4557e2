#include "gnomon/measure/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "gnomon/base/error.h"
#include "gnomon/base/random.h"
#include "gnomon/base/statistics.h"
#include "gnomon/measure/classes.h"

namespace gnomon {
namespace {

constexpr int kSize = 96;
constexpr double kFamilyWise = 1e-3;

/// A smooth field of visibilities with lit and dark corners.
Image truth() {
  Image image(kSize, kSize);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) image.at(x, y) = 0.5f + 0.5f * std::sin(0.05f * static_cast<float>(x + 2 * y));
  }
  return image;
}

/// What `samples` independent rays a pixel would report.
Image sampled(const Image& visibility, int samples, std::uint64_t seed) {
  RandomStream random(seed);
  Image image(visibility.width, visibility.height);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    int lit = 0;
    for (int s = 0; s < samples; ++s) lit += random.uniform() < visibility.data[i] ? 1 : 0;
    image.data[i] = static_cast<float>(lit) / static_cast<float>(samples);
  }
  return image;
}

float codeOf(PixelClass pixelClass, bool band = false, bool terminator = false) {
  return ClassCode{pixelClass, band, terminator}.encode();
}

Image allPenumbra() {
  return {kSize, kSize, 1, codeOf(PixelClass::penumbra, true)};
}

TEST(MeasureError, ExactTruthHasNoErrorAgainstNoisyHalves) {
  const Image exact = truth();
  std::vector<double> pValues;
  for (const int samples : {4, 16, 1024}) {
    const auto seed = static_cast<std::uint64_t>(samples);
    const ErrorFigures figures =
        measureError(exact, sampled(exact, samples, seed), sampled(exact, samples, seed + 1), allPenumbra());
    EXPECT_LT(std::abs(*figures.mse), 0.1 * std::pow(*figures.noiseFloor, 2)) << "the noise of R shows through";
    pValues.push_back(normalPValue(*figures.mse / *figures.mseSe));
  }
  for (const bool rejected : holmRejections(pValues, kFamilyWise)) EXPECT_FALSE(rejected);
}

TEST(MeasureError, AnEstimatorsErrorIsItsVariance) {
  const Image exact = truth();
  double spread = 0.0;
  for (const float v : exact.data) spread += static_cast<double>(v) * (1.0 - v) / static_cast<double>(exact.data.size());
  std::vector<double> pValues;
  for (const int samples : {4, 16, 64}) {
    const auto seed = 100 + static_cast<std::uint64_t>(samples);
    const ErrorFigures figures =
        measureError(sampled(exact, samples, seed), sampled(exact, 16, seed + 1), sampled(exact, 16, seed + 2), allPenumbra());
    pValues.push_back(normalPValue((*figures.mse - spread / samples) / *figures.mseSe));
  }
  for (const bool rejected : holmRejections(pValues, kFamilyWise)) EXPECT_FALSE(rejected);
}

TEST(MeasureError, ATenthTooBrightIsExactlyThat) {
  const Image reference(kSize, kSize, 1, 0.5f);
  const ErrorFigures figures = measureError(Image(kSize, kSize, 1, 0.6f), reference, reference, allPenumbra());
  const double error = static_cast<double>(0.6f) - 0.5;
  EXPECT_NEAR(*figures.bias, error, 1e-12);
  EXPECT_NEAR(*figures.rmse, error, 1e-12);
  EXPECT_NEAR(*figures.rmseBand, error, 1e-12);
  EXPECT_NEAR(*figures.mae, error, 1e-12);
  EXPECT_NEAR(*figures.p99, error, 1e-12);
  EXPECT_NEAR(*figures.max, error, 1e-12);
  EXPECT_NEAR(*figures.rmseSe, 0.0, 1e-9);
  EXPECT_EQ(*figures.noiseFloor, 0.0);
}

TEST(MeasureError, TooDarkIsNegativeBias) {
  const Image reference(kSize, kSize, 1, 0.5f);
  EXPECT_DOUBLE_EQ(*measureError(Image(kSize, kSize, 1, 0.25f), reference, reference, allPenumbra()).bias, -0.25);
}

TEST(MeasureError, NoiseFloorIsTheNoiseOfTheMeanOfTheHalves) {
  const ErrorFigures figures = measureError(Image(4, 4, 1, 0.5f), Image(4, 4, 1, 0.75f), Image(4, 4, 1, 0.25f),
                                            Image(4, 4, 1, codeOf(PixelClass::penumbra)));
  EXPECT_DOUBLE_EQ(*figures.noiseFloor, 0.25);
  EXPECT_DOUBLE_EQ(*figures.mse, -0.0625);  // signed: it is not clamped
  EXPECT_EQ(*figures.rmse, 0.0);
}

TEST(MeasureError, TheStandardErrorIsNotZeroWhereTheErrorIs) {
  const Image exact = truth();
  const ErrorFigures figures = measureError(exact, sampled(exact, 4, 1), sampled(exact, 4, 2), allPenumbra());
  EXPECT_GE(*figures.rmse + *figures.rmseSe, std::sqrt(*figures.mseSe));
}

TEST(MeasureError, ClassesAreSplitAndShared) {
  Image classes(4, 1);
  classes.data = {codeOf(PixelClass::lit), codeOf(PixelClass::lit, true), codeOf(PixelClass::umbra, true, true),
                  codeOf(PixelClass::outside)};
  Image technique(4, 1);
  technique.data = {1.0f, 0.5f, 0.25f, 9.0f};
  Image reference(4, 1);
  reference.data = {1.0f, 1.0f, 0.0f, 1.0f};
  const ErrorFigures figures = measureError(technique, reference, reference, classes);
  EXPECT_DOUBLE_EQ(*figures.lit.share, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(*figures.lit.rmse, std::sqrt(0.25 / 2.0));
  EXPECT_DOUBLE_EQ(*figures.lit.bias, -0.25);
  EXPECT_DOUBLE_EQ(*figures.umbra.bias, 0.25);
  EXPECT_DOUBLE_EQ(*figures.band.share, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(*figures.rmseBand, std::sqrt((0.25 + 0.0625) / 2.0));
  EXPECT_DOUBLE_EQ(*figures.terminator.share, 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(*figures.max, 0.5);  // the pixel outside the mask does not count
}

TEST(MeasureError, AnEmptyClassHasNoFigures) {
  const ErrorFigures figures = measureError(Image(2, 2, 1, 0.5f), Image(2, 2, 1, 0.5f), Image(2, 2, 1, 0.5f),
                                            Image(2, 2, 1, codeOf(PixelClass::penumbra, true)));
  EXPECT_EQ(figures.umbra.share, 0.0);
  EXPECT_FALSE(figures.umbra.rmse.has_value());
  EXPECT_FALSE(figures.umbra.bias.has_value());
}

TEST(MeasureError, AnEmptyMaskHasNoFiguresAtAll) {
  EXPECT_EQ(measureError(Image(2, 2), Image(2, 2), Image(2, 2), Image(2, 2)), ErrorFigures{});
}

TEST(MeasureError, OneTileHasNoStandardError) {
  const Image flat(16, 16, 1, 0.5f);
  const ErrorFigures figures = measureError(flat, flat, flat, Image(16, 16, 1, codeOf(PixelClass::penumbra)));
  EXPECT_FALSE(figures.mseSe.has_value());
  EXPECT_FALSE(figures.rmseSe.has_value());
}

TEST(MeasureError, NotANumberIsCountedAndNeverCredited) {
  const Image reference(2, 2, 1, 1.0f);
  Image technique(2, 2, 1, 1.0f);
  technique.at(0, 0) = std::numeric_limits<float>::quiet_NaN();
  technique.at(1, 0) = std::numeric_limits<float>::infinity();
  const ErrorFigures figures = measureError(technique, reference, reference, Image(2, 2, 1, codeOf(PixelClass::lit)));
  EXPECT_EQ(figures.nonFinite, 2u);
  EXPECT_EQ(figures.rmse, 0.0);
  EXPECT_EQ(figures.over01, 0.5);
  EXPECT_EQ(figures.lit.share, 1.0);
}

TEST(MeasureError, NothingButNotANumberHasNoMeans) {
  const Image reference(2, 2, 1, 1.0f);
  const ErrorFigures figures = measureError(Image(2, 2, 1, std::numeric_limits<float>::quiet_NaN()), reference, reference,
                                            Image(2, 2, 1, codeOf(PixelClass::lit)));
  EXPECT_EQ(figures.nonFinite, 4u);
  EXPECT_FALSE(figures.mse.has_value());
  EXPECT_EQ(figures.over01, 1.0);
}

TEST(MeasureError, AReferenceThatIsNotFiniteIsAnError) {
  Image broken(2, 2, 1, 1.0f);
  broken.at(1, 1) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(measureError(Image(2, 2), Image(2, 2), broken, Image(2, 2, 1, codeOf(PixelClass::lit))), Error);
}

TEST(MeasureError, SizesMustAgree) {
  EXPECT_THROW(measureError(Image(2, 2), Image(2, 2), Image(2, 3), Image(2, 2)), Error);
}

}  // namespace
}  // namespace gnomon
