#include "gnomon/measure/classes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "gnomon/base/error.h"

namespace gnomon {
namespace {

/// A plane y = 0 seen at 1 m a pixel, all in the mask and lit, facing the light.
struct Plane {
  Image mask, a, b, position, normal, normalLight;

  Plane(int width, int height)
      : mask(width, height, 1, 1.0f),
        a(width, height, 1, 1.0f),
        b(width, height, 1, 1.0f),
        position(width, height, 3),
        normal(width, height, 3),
        normalLight(width, height, 1, 1.0f) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        position.at(x, y, 0) = static_cast<float>(x);
        position.at(x, y, 2) = static_cast<float>(y);
        normal.at(x, y, 1) = 1.0f;
      }
    }
  }
  void setReference(int x, int y, float valueA, float valueB) {
    a.at(x, y) = valueA;
    b.at(x, y) = valueB;
  }
  /// Columns from `column` on are umbra.
  void darkenFrom(int column) {
    for (int y = 0; y < mask.height; ++y) {
      for (int x = column; x < mask.width; ++x) setReference(x, y, 0.0f, 0.0f);
    }
  }
  ClassCode at(int x, int y) const {
    return ClassCode::decode(classifyPixels({mask, a, b, position, normal, normalLight}).at(x, y));
  }
  int bandPixels() const {
    const Image codes = classifyPixels({mask, a, b, position, normal, normalLight});
    int count = 0;
    for (const float code : codes.data) count += ClassCode::decode(code).band ? 1 : 0;
    return count;
  }
};

TEST(Classes, CodesAreThoseOfTheFiles) {
  EXPECT_EQ(ClassCode{}.encode(), 0.0f);
  EXPECT_EQ((ClassCode{PixelClass::lit, false, false}).encode(), 1.0f);
  EXPECT_EQ((ClassCode{PixelClass::umbra, true, false}).encode(), 6.0f);
  EXPECT_EQ((ClassCode{PixelClass::penumbra, true, true}).encode(), 15.0f);
  for (int code = 0; code < 16; ++code)
    EXPECT_EQ(ClassCode::decode(static_cast<float>(code)).encode(), static_cast<float>(code));
}

TEST(Classes, LitUmbraAndPenumbraAreAPartition) {
  Plane plane(3, 1);
  plane.setReference(1, 0, 0.0f, 0.0f);
  plane.setReference(2, 0, 0.0f, 1.0f / 512.0f);  // one sample of one half saw light
  EXPECT_EQ(plane.at(0, 0).pixelClass, PixelClass::lit);
  EXPECT_EQ(plane.at(1, 0).pixelClass, PixelClass::umbra);
  EXPECT_EQ(plane.at(2, 0).pixelClass, PixelClass::penumbra);
}

TEST(Classes, NothingCountsOutsideTheMask) {
  Plane plane(8, 1);
  plane.darkenFrom(4);
  plane.mask.at(5, 0) = 0.0f;
  plane.a.at(5, 0) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(plane.at(5, 0), ClassCode{});
}

TEST(Classes, PenumbraIsInTheBandWhereverItIs) {
  Plane plane(9, 9);
  plane.setReference(4, 4, 0.5f, 0.5f);
  EXPECT_TRUE(plane.at(4, 4).band);
  EXPECT_EQ(plane.bandPixels(), 1);  // lit beside penumbra is no lit/umbra change
}

TEST(Classes, BandReachesTwoPixelsOnBothSidesOfAHardEdge) {
  Plane plane(12, 1);
  plane.darkenFrom(6);
  for (int x = 0; x < 12; ++x) EXPECT_EQ(plane.at(x, 0).band, x >= 3 && x <= 8) << x;  // 5|6 is the change
}

TEST(Classes, BandIsChebyshev) {
  Plane plane(11, 11);
  plane.setReference(5, 5, 0.0f, 0.0f);
  EXPECT_TRUE(plane.at(3, 3).band);   // its distance to (5,5) is 2
  EXPECT_TRUE(plane.at(2, 3).band);   // 2 from (4,5), the lit pixel of a changing pair
  EXPECT_FALSE(plane.at(2, 2).band);  // 3 from every pixel of a changing pair
  EXPECT_FALSE(plane.at(1, 5).band);
}

TEST(Classes, ASilhouetteBeforeAParallelSurfaceIsNoChange) {
  Plane plane(12, 1);
  plane.darkenFrom(6);
  for (int x = 6; x < 12; ++x) plane.position.at(x, 0, 1) = -0.1f;  // a tenth of the pixel's step below: a gap
  EXPECT_EQ(plane.bandPixels(), 0);
}

TEST(Classes, RoundingOfPositionsIsNoSilhouette) {
  Plane plane(12, 1);
  plane.darkenFrom(6);
  for (int x = 6; x < 12; ++x) plane.position.at(x, 0, 1) = -1e-3f;
  EXPECT_EQ(plane.bandPixels(), 6);
}

TEST(Classes, ACornerIsNoChangeOnOneSurface) {
  Plane plane(12, 1);
  plane.darkenFrom(6);
  for (int x = 6; x < 12; ++x) {
    plane.normal.at(x, 0, 0) = 1.0f;
    plane.normal.at(x, 0, 1) = 0.0f;
  }
  EXPECT_EQ(plane.bandPixels(), 0);
}

/// Puts the pixels on a circle about the z axis, `radians` apart.
void bend(Plane& plane, double radians) {
  for (int x = 0; x < plane.mask.width; ++x) {
    const auto sine = static_cast<float>(std::sin(radians * x));
    const auto cosine = static_cast<float>(std::cos(radians * x));
    plane.position.at(x, 0, 0) = 3.0f * sine;
    plane.position.at(x, 0, 1) = 3.0f * cosine;
    plane.normal.at(x, 0, 0) = sine;
    plane.normal.at(x, 0, 1) = cosine;
  }
}

TEST(Classes, ACoarselySampledSphereIsOneSurface) {
  Plane plane(12, 1);
  plane.darkenFrom(6);
  bend(plane, 0.4);  // 23 degrees between neighbours
  EXPECT_EQ(plane.bandPixels(), 6);
}

TEST(Classes, CurvatureBeyondTheCosineIsTwoSurfaces) {
  Plane plane(12, 1);
  plane.darkenFrom(6);
  bend(plane, 0.5);  // 29 degrees
  EXPECT_EQ(plane.bandPixels(), 0);
}

TEST(Classes, TerminatorIsAFlagBesideTheClass) {
  Plane plane(2, 1);
  plane.normalLight.at(0, 0) = 0.099f;
  plane.normalLight.at(1, 0) = 0.1f;
  EXPECT_EQ(plane.at(0, 0), (ClassCode{PixelClass::lit, false, true}));
  EXPECT_EQ(plane.at(1, 0), (ClassCode{PixelClass::lit, false, false}));
}

TEST(Classes, AReferenceThatIsNotFiniteIsAnError) {
  Plane plane(2, 1);
  plane.b.at(1, 0) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(plane.at(0, 0), Error);
}

TEST(Classes, SizesMustAgree) {
  Plane plane(2, 1);
  plane.normal = Image(2, 2, 3);
  EXPECT_THROW(plane.at(0, 0), Error);
}

}  // namespace
}  // namespace gnomon
