#include "gnomon/run/pictures.h"

#include <gtest/gtest.h>

namespace gnomon {
namespace {

/// Colour of one pixel inside the mask whose technique is off by `error` from a reference of 0.5.
Image pictureOfError(float error) {
  return signedErrorPicture(Image(1, 1, 1, 0.5f + error), {Image(1, 1, 1, 0.5f), Image(1, 1, 1, 0.5f)}, Image(1, 1, 1, 1.0f));
}

TEST(SignedErrorPicture, LeakingLightIsRed) {
  const Image picture = pictureOfError(0.4f);
  EXPECT_GT(picture.at(0, 0, 0), picture.at(0, 0, 2));
}

TEST(SignedErrorPicture, TooDarkIsBlue) {
  const Image picture = pictureOfError(-0.4f);
  EXPECT_GT(picture.at(0, 0, 2), picture.at(0, 0, 0));
}

TEST(SignedErrorPicture, NoErrorHasNoHue) {
  const Image picture = pictureOfError(0.0f);
  EXPECT_EQ(picture.at(0, 0, 0), picture.at(0, 0, 2));
}

}  // namespace
}  // namespace gnomon
