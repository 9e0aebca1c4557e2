#include "gnomon/measure/splits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>

#include "gnomon/base/error.h"
#include "gnomon/measure/classes.h"

namespace gnomon {
namespace {

constexpr int kSize = 128;

/// A floor at y = 0 seen from above, a pixel a centimetre, x to the right and z downwards; pixel (0,0) around (0.005, 0.005).
constexpr double kPixel = 0.01;

using Field = std::function<double(double x, double z)>;

/// The world's point in the middle of a pixel of the floor.
double coordinate(int pixel) {
  return (pixel + 0.5) * kPixel;
}

struct Scene {
  Image position{kSize, kSize, 4};
  Image normal{kSize, kSize, 4};
  Image reference{kSize, kSize};
  Light light;

  explicit Scene(const Field& visibility) {
    light.type = LightType::directional;
    light.position = {0.0, 10.0, 0.0};
    light.target = {0.0, 0.0, 0.0};
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        put(x, y, {coordinate(x), 0.0, coordinate(y)}, {0.0, 1.0, 0.0});
        reference.at(x, y) = static_cast<float>(visibility(coordinate(x), coordinate(y)));
      }
    }
  }

  void put(int x, int y, glm::dvec3 p, glm::dvec3 n) {
    for (int c = 0; c < 3; ++c) {
      position.at(x, y, c) = static_cast<float>(p[c]);
      normal.at(x, y, c) = static_cast<float>(n[c]);
    }
    position.at(x, y, 3) = 1.0f;
  }

  Image classes() const {
    Image codes(kSize, kSize);
    const LightFrame axes = lightFrame(light);
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const glm::dvec3 n(normal.at(x, y, 0), normal.at(x, y, 1), normal.at(x, y, 2));
        const double cosine = glm::dot(n, towardsCentre(light, axes, {}));
        if (cosine <= 0.0) continue;
        const float r = reference.at(x, y);
        ClassCode code;
        code.pixelClass = r >= 1.0f ? PixelClass::lit : r <= 0.0f ? PixelClass::umbra : PixelClass::penumbra;
        code.terminator = cosine < static_cast<double>(kTerminatorCosine);
        codes.at(x, y) = code.encode();
      }
    }
    return codes;
  }

  ErrorSplits splits(const Image& technique) const {
    return measureSplits({technique, reference, reference, classes(), position, normal, light, {0.0, 0.0, 0.0}});
  }
  ErrorSplits splits(const Field& visibility) const { return splits(imageOf(visibility)); }

  static Image imageOf(const Field& visibility) {
    Image image(kSize, kSize);
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) image.at(x, y) = static_cast<float>(visibility(coordinate(x), coordinate(y)));
    }
    return image;
  }
};

double ramp(double distance, double width) {
  return width > 0.0 ? std::clamp(distance / width + 0.5, 0.0, 1.0) : distance > 0.0 ? 1.0 : 0.0;
}

/// Shadow of a disc of 0.3 m in the middle; `width` of its penumbra.
Field disc(double width, double shiftX = 0.0, double shiftZ = 0.0) {
  return [=](double x, double z) { return ramp(std::hypot(x - 0.64 - shiftX, z - 0.64 - shiftZ) - 0.3, width); };
}

TEST(Splits, AreAllZeroForTheReferenceItself) {
  const Scene scene(disc(0.1));
  const ErrorSplits splits = scene.splits(disc(0.1));
  EXPECT_EQ(splits.acne, 0.0);
  EXPECT_EQ(splits.leak, 0.0);
  EXPECT_EQ(splits.penumbra, 0.0);
  EXPECT_EQ(splits.offset, 0.0);
  EXPECT_EQ(splits.detachment, std::nullopt);  // nothing stands on the floor
  EXPECT_EQ(splits.shimmer, std::nullopt);     // one picture does not show it
}

TEST(Splits, AcneIsDarkOnLitPixelsFarFromEdges) {
  const Scene scene(disc(0.1));
  const auto stripes = [](double x, double z) { return disc(0.1)(x, z) * (std::fmod(x, 0.02) < kPixel ? 0.4 : 1.0); };
  const ErrorSplits splits = scene.splits(stripes);
  EXPECT_NEAR(*splits.acne, 0.6 * std::sqrt(0.5), 0.01);  // every second column
  EXPECT_EQ(splits.leak, 0.0);
}

TEST(Splits, AcneDoesNotLookNearAnEdge) {
  const Scene scene(disc(0.1));
  const double nearPixels = farPixels(kSize) * kPixel;
  const auto wide = [=](double x, double z) { return std::hypot(x - 0.64, z - 0.64) < 0.35 + nearPixels - kPixel ? 0.0 : 1.0; };
  EXPECT_EQ(scene.splits(wide).acne, 0.0);
}

TEST(Splits, LeakIsLightInUmbraFarFromEdges) {
  const Scene scene(disc(0.1));
  const ErrorSplits splits = scene.splits([](double x, double z) { return std::max(0.25, disc(0.1)(x, z)); });
  EXPECT_NEAR(*splits.leak, 0.25, 1e-6);
  EXPECT_EQ(splits.acne, 0.0);
}

TEST(Splits, AbsentClassesHaveNoFigure) {
  const Scene lit([](double, double) { return 1.0; });
  EXPECT_TRUE(lit.splits(disc(0.1)).acne.has_value());
  EXPECT_EQ(lit.splits(disc(0.1)).leak, std::nullopt);
  EXPECT_EQ(lit.splits(disc(0.1)).penumbra, std::nullopt);
  EXPECT_EQ(lit.splits(disc(0.1)).offset, std::nullopt);
}

TEST(Splits, PenumbraIsTheRatioOfWidths) {
  const Scene scene(disc(0.1));
  for (const double factor : {0.5, 1.0 / 1.3, 1.3, 1.6}) {
    const double inPixels = 0.1 / kPixel;
    const double expected = std::abs(std::log2((factor * inPixels + 1.0) / (inPixels + 1.0)));
    const ErrorSplits splits = scene.splits(disc(factor * 0.1));
    EXPECT_NEAR(*splits.penumbra, expected, 0.05 * expected) << factor;
    EXPECT_LT(*splits.offset, 0.1 * kPixel) << factor;
  }
}

TEST(Splits, HardEdgesHaveAPenumbraOfNoWidth) {
  const Scene scene(disc(0.2));
  EXPECT_NEAR(*scene.splits(disc(0.0)).penumbra, std::log2(0.2 / kPixel + 1.0), 0.2);
  const Scene hard(disc(0.0));
  EXPECT_NEAR(*hard.splits(disc(0.2)).penumbra, std::log2(0.2 / kPixel + 1.0), 0.2);
}

TEST(Splits, OffsetIsTheDisplacementInMetres) {
  for (const double width : {0.0, 0.1}) {
    const Scene scene(disc(width));
    const ErrorSplits splits = scene.splits(disc(width, 0.03, 0.02));
    EXPECT_NEAR(*splits.offset, std::hypot(0.03, 0.02), 0.004) << width;
    EXPECT_LT(*splits.penumbra, 0.12) << width;
  }
}

TEST(Splits, OffsetOfASpotIsMeasuredInThePlaneOfItsTarget) {
  Scene scene(disc(0.1));
  scene.light.type = LightType::spot;
  scene.light.position = {0.64, 4.0, 0.64};
  scene.light.target = {0.64, 2.0, 0.64};  // half way: a shadow on the floor is twice as far from the axis
  scene.light.coneHalfAngleDegrees = 60.0;
  EXPECT_NEAR(*scene.splits(disc(0.1, 0.03)).offset, 0.015, 0.001);
}

TEST(Splits, OffsetNeedsEdgesInTwoDirections) {
  const auto wall = [](double shift) { return [=](double x, double) { return ramp(x - 0.64 - shift, 0.1); }; };
  EXPECT_EQ(Scene(wall(0.0)).splits(wall(0.05)).offset, std::nullopt);
}

TEST(Splits, PointLightsHaveNoPlaneForAnOffset) {
  Scene scene(disc(0.1));
  scene.light.type = LightType::point;
  EXPECT_EQ(scene.splits(disc(0.1, 0.03)).offset, std::nullopt);
  EXPECT_TRUE(scene.splits(disc(0.1, 0.03)).penumbra.has_value());
}

/// A wall at x < 0.4 that the light, from the left at 45 degrees, leaves dark: it stands 0.4 m high on the floor and shades it
/// up to x = 0.8. The wall's side that the camera would see is drawn as the pixels left of 0.4.
Scene wallScene() {
  Scene scene([](double x, double) { return x < 0.8 ? 0.0 : 1.0; });
  scene.light.position = {-10.0, 10.0, 0.0};
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < 40; ++x) scene.put(x, y, {0.4, (40 - x) * kPixel, coordinate(y)}, {1.0, 0.0, 0.0});
  }
  return scene;
}

Field wallShadow(double gap) {
  return [=](double x, double) { return x < 0.4 + gap || x > 0.8 ? 1.0 : 0.0; };
}

TEST(Splits, DetachmentIsTheLengthOfTheLitGap) {
  const Scene scene = wallScene();
  EXPECT_EQ(scene.splits(wallShadow(0.0)).detachment, 0.0);
  for (const double gap : {0.05, 0.2}) EXPECT_NEAR(*scene.splits(wallShadow(gap)).detachment, gap, kPixel) << gap;
}

TEST(Splits, DetachmentEndsWithTheShadow) {
  const ErrorSplits splits = wallScene().splits([](double, double) { return 1.0; });
  EXPECT_NEAR(*splits.detachment, 0.4, kPixel);
}

TEST(Splits, LightInTheGapIsNoLeak) {
  const double nearPixels = farPixels(kSize) * kPixel;
  EXPECT_EQ(wallScene().splits(wallShadow(nearPixels - kPixel)).leak, 0.0);
}

TEST(Splits, SilhouettesAreNoContacts) {
  Scene scene = wallScene();
  for (int y = 0; y < kSize; ++y) {  // the same wall, half a metre nearer to the camera
    for (int x = 0; x < 40; ++x) scene.position.at(x, y, 1) += 0.5f;
  }
  EXPECT_EQ(scene.splits(wallShadow(0.1)).detachment, std::nullopt);
}

TEST(Splits, PixelsThatAreNotFiniteAreLeftOut) {
  const Scene scene(disc(0.1));
  Image technique = Scene::imageOf(disc(0.1));
  technique.at(3, 3) = std::numeric_limits<float>::quiet_NaN();
  technique.at(64, 64) = std::numeric_limits<float>::infinity();
  const ErrorSplits splits = scene.splits(technique);
  EXPECT_EQ(splits.acne, 0.0);
  EXPECT_EQ(splits.leak, 0.0);
}

TEST(Splits, ShapesMustAgree) {
  const Scene scene(disc(0.1));
  EXPECT_THROW(scene.splits(Image(kSize, kSize + 1)), Error);
}

Image flat(float value) {
  return Image(8, 8, 1, value);
}

TEST(Shimmer, IsWhatChangesBeyondTheReference) {
  ShimmerSum sum;
  sum.add({flat(0.5f), flat(0.5f), flat(0.5f)}, {flat(0.8f), flat(0.6f), flat(0.6f)});  // 0.2 beyond
  sum.add({flat(0.8f), flat(0.6f), flat(0.6f)}, {flat(0.9f), flat(0.7f), flat(0.7f)});  // as the reference does
  EXPECT_NEAR(*sum.value(), 0.2 / std::sqrt(2.0), 1e-6);
}

TEST(Shimmer, StandingErrorIsNone) {
  ShimmerSum sum;
  sum.add({flat(0.9f), flat(0.2f), flat(0.2f)}, {flat(0.9f), flat(0.2f), flat(0.2f)});
  EXPECT_EQ(sum.value(), 0.0);
}

TEST(Shimmer, LooksAtReceiversOfBothFrames) {
  Image outside = flat(0.5f);
  for (float& v : outside.data) v = std::numeric_limits<float>::quiet_NaN();
  ShimmerSum sum;
  sum.add({flat(0.0f), outside, outside}, {flat(1.0f), flat(0.5f), flat(0.5f)});
  EXPECT_EQ(sum.value(), std::nullopt);
}

TEST(Shimmer, IsUnbiasedByTheNoiseOfTheReference) {
  // Halves that err apart, by 0.3 in turns: whoever squared T-R would see noise as shimmer.
  Image a(8, 8), b(8, 8), c(8, 8), d(8, 8);
  for (std::size_t i = 0; i < a.data.size(); ++i) {
    a.data[i] = 0.5f + (i & 1 ? 0.3f : -0.3f);
    b.data[i] = 0.5f + (i & 2 ? 0.3f : -0.3f);
    c.data[i] = 0.5f + (i & 4 ? 0.3f : -0.3f);
    d.data[i] = 0.5f + (i & 8 ? 0.3f : -0.3f);
  }
  ShimmerSum sum;
  sum.add({flat(0.5f), a, b}, {flat(0.5f), c, d});
  EXPECT_NEAR(*sum.value(), 0.0, 1e-3);
}

}  // namespace
}  // namespace gnomon
