#include "gnomon/measure/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "gnomon/base/error.h"

namespace gnomon {
namespace {

constexpr int kSize = 48;

Image filled(float r, float g, float b) {
  Image image(kSize, kSize, 3);
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    image.data[3 * i] = r;
    image.data[3 * i + 1] = g;
    image.data[3 * i + 2] = b;
  }
  return image;
}
Image grey(float v) {
  return filled(v, v, v);
}

/// Black left of the middle, white from it on.
Image step() {
  Image image = grey(0.0f);
  for (int y = 0; y < kSize; ++y) {
    for (int x = kSize / 2; x < kSize; ++x) {
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = 1.0f;
    }
  }
  return image;
}

Image checkers(float amplitude, int period = 1) {
  Image image = grey(0.0f);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = 0.5f + ((x / period + y / period) % 2 == 0 ? amplitude : -amplitude);
    }
  }
  return image;
}

double middle(const Image& flip) {
  return flip.at(kSize / 2, kSize / 2);
}

// By hand. L*a*b* of green is (87.735, -86.183, 83.179), of blue (32.297, 79.188, -107.860). Hunt: a* and b* times L*/100:
// (-75.612, 72.977) and (25.575, -34.836). HyAB = 55.438 + hypot(101.187, 107.813) = 203.299; to the power of 0.7: 41.276, the
// greatest difference. The break lies at 0.4 of it, 16.510.
constexpr double kGreatest = 41.276;
constexpr double kBreakAt = 0.4 * kGreatest;

TEST(Flip, OfGreenAndBlueIsOne) {
  EXPECT_NEAR(middle(ldrFlip(filled(0, 1, 0), filled(0, 0, 1))), 1.0, 1e-4);
}

TEST(Flip, OfBlackAndWhiteIsByHand) {  // L* 0 and 100: 100^0.7 = 25.119, above the break
  const double expected = 0.95 + 0.05 * (std::pow(100.0, 0.7) - kBreakAt) / (kGreatest - kBreakAt);
  EXPECT_NEAR(expected, 0.9674, 1e-4);
  EXPECT_NEAR(middle(ldrFlip(grey(0.0f), grey(1.0f))), expected, 1e-4);
}

TEST(Flip, OfBlackAndGreyIsByHand) {  // L* of 0.214 is 53.389: 16.185, just below the break
  const double expected = 0.95 * std::pow(53.389, 0.7) / kBreakAt;
  EXPECT_NEAR(expected, 0.9313, 2e-4);
  EXPECT_NEAR(middle(ldrFlip(grey(0.0f), grey(0.21404f))), expected, 2e-4);
}

TEST(Flip, OfTwoGreysIsByHand) {  // L* = 116 cbrt(Y) - 16: 51.837 and 57.075
  const double expected = 0.95 * std::pow(57.0754 - 51.8372, 0.7) / kBreakAt;
  EXPECT_NEAR(middle(ldrFlip(grey(0.2f), grey(0.25f))), expected, 1e-4);
}

TEST(Flip, OfAnEdgeAgainstBlackIsByHand) {
  // The first white pixel: of the luminance filter half, and half of its middle weight, lies on white; the edge filter sees a
  // step of 1, and the point filter less.
  double sum = 0.0;
  for (int x = -10; x <= 10; ++x) sum += std::exp(-std::pow(std::numbers::pi * x / 67.0, 2.0) / 0.0047);
  const double y = 0.5 + 0.5 / sum;
  const double colour = 0.95 + 0.05 * (std::pow(116.0 * std::cbrt(y) - 16.0, 0.7) - kBreakAt) / (kGreatest - kBreakAt);
  const double expected = std::pow(colour, 1.0 - std::sqrt(1.0 / std::numbers::sqrt2));
  EXPECT_NEAR(middle(ldrFlip(grey(0.0f), step())), expected, 1e-4);
}

TEST(Flip, OfEqualPicturesIsZero) {
  for (const float v : ldrFlip(step(), step()).data) ASSERT_EQ(v, 0.0f);
  for (const float v : HdrFlip(step())(step()).data) ASSERT_EQ(v, 0.0f);
}

TEST(Flip, IsSymmetric) {
  EXPECT_EQ(ldrFlip(step(), checkers(0.4f, 3)).data, ldrFlip(checkers(0.4f, 3), step()).data);
}

TEST(Flip, IsBounded) {
  const auto inside = [](const Image& flip) {
    return std::all_of(flip.data.begin(), flip.data.end(), [](float v) { return v >= 0.0f && v <= 1.0f; });
  };
  EXPECT_TRUE(inside(ldrFlip(step(), checkers(0.5f))));
  EXPECT_TRUE(inside(ldrFlip(filled(1, 0, 0), filled(0, 1, 1))));
  EXPECT_TRUE(inside(HdrFlip(filled(0, 1, 1000))(filled(900, 0, 0))));
}

TEST(Flip, RisesWithContrast) {
  double before = 0.0;
  for (const float amplitude : {0.01f, 0.05f, 0.2f, 0.5f}) {
    const double now = middle(ldrFlip(checkers(amplitude, 6), grey(0.5f)));
    EXPECT_GT(now, before);
    before = now;
  }
}

TEST(Flip, FadesWithDistanceWherePatternsAreFine) {
  const auto colour = [](double pixelsPerDegree) {  // far from any feature: the pattern's mean
    const Image flip = ldrFlip(checkers(0.3f), grey(0.5f), pixelsPerDegree);
    return middle(flip);
  };
  EXPECT_LT(colour(120.0), colour(20.0));
}

TEST(Flip, APixelThatIsNotFiniteIsOne) {
  Image broken = grey(0.5f);
  broken.at(kSize / 2, kSize / 2, 1) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(middle(ldrFlip(broken, grey(0.5f))), 1.0);
  EXPECT_EQ(middle(HdrFlip(grey(0.5f))(broken)), 1.0);
}

TEST(Flip, ExposuresRunFromTheBrightestToTheMedian) {
  Image image = grey(0.5f);
  for (int c = 0; c < 3; ++c) image.at(3, 3, c) = 8.0f;
  const FlipExposures exposures = flipExposures(image);
  EXPECT_NEAR(exposures.stop - exposures.start, 4.0, 1e-5);  // 8 is four stops above a half
  EXPECT_EQ(exposures.count, 4);
}

TEST(Flip, HdrSeesWhatOneExposureHides) {  // 40 and 60 are both white in a picture that is exposed for 1
  Image bright = grey(1.0f);
  Image brighter = grey(1.0f);
  for (int y = 8; y < 20; ++y) {
    for (int x = 8; x < 20; ++x) {
      for (int c = 0; c < 3; ++c) bright.at(x, y, c) = 40.0f, brighter.at(x, y, c) = 60.0f;
    }
  }
  EXPECT_EQ(ldrFlip(bright, brighter).at(14, 14), 0.0f);
  EXPECT_GT(HdrFlip(brighter)(bright).at(14, 14), 0.05f);
}

TEST(Flip, FiguresAreOfTheMask) {
  Image flip(4, 1);
  flip.data = {0.1f, 0.3f, 0.9f, 0.9f};
  Image mask(4, 1);
  mask.data = {1.0f, 1.0f, 0.0f, 0.0f};
  EXPECT_NEAR(*flipFigures(flip, mask).mean, 0.2, 1e-6);
  EXPECT_NEAR(*flipFigures(flip, mask).p99, 0.298, 1e-6);
  EXPECT_EQ(flipFigures(flip, Image(4, 1)), FlipFigures{});
}

TEST(Flip, ShapesMustAgree) {
  EXPECT_THROW(ldrFlip(grey(0.0f), Image(kSize, kSize, 1)), Error);
  EXPECT_THROW(HdrFlip(Image(kSize, kSize + 1, 3))(grey(0.0f)), Error);
}

}  // namespace
}  // namespace gnomon
