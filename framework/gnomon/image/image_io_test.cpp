#include "gnomon/image/image_io.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "gnomon/base/error.h"
#include "gnomon/base/files.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

class ImageIo : public testing::Test {
 protected:
  ImageIo() {
    std::string name = (fs::temp_directory_path() / "gnomon-image-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~ImageIo() override { fs::remove_all(folder_); }
  fs::path folder_;
};

Image ramp(int width, int height, float start) {
  Image image(width, height);
  for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = start + 0.37f * static_cast<float>(i);
  return image;
}

bool sameBits(const Image& a, const Image& b) {
  return a.width == b.width && a.height == b.height &&
         std::memcmp(a.data.data(), b.data.data(), a.data.size() * sizeof(float)) == 0;
}

TEST_F(ImageIo, ExrComesBackBitForBitByName) {
  Image special = ramp(5, 3, 0.0f);
  special.at(1, 0) = std::numeric_limits<float>::quiet_NaN();
  special.at(2, 0) = -std::numeric_limits<float>::infinity();
  special.at(3, 0) = 1e-42f;  // subnormal
  special.at(4, 0) = -0.0f;
  // Written in an order that the file format does not keep.
  const std::vector<NamedChannel> channels = {
      {"visibility", special}, {"reference_a", ramp(5, 3, 1.0f)}, {"position.x", ramp(5, 3, 2.0f)}, {"R", ramp(5, 3, 3.0f)}};
  writeExr(folder_ / "a.exr", channels, {{"gnomon:light", R"({"type": "spot"})"}});
  const ExrPicture picture = readExr(folder_ / "a.exr");
  EXPECT_EQ(picture.channels.size(), channels.size());
  for (const NamedChannel& channel : channels)
    EXPECT_TRUE(sameBits(picture.channel(channel.name), channel.image)) << channel.name;
  EXPECT_EQ(picture.metadataValue("gnomon:light"), R"({"type": "spot"})");
  EXPECT_EQ(picture.metadataValue("nothing"), "");
}

TEST_F(ImageIo, ExrBytesRepeat) {
  const std::vector<NamedChannel> channels = {{"v", ramp(64, 64, 0.5f)}};
  writeExr(folder_ / "a.exr", channels);
  ::usleep(1100000);  // files bear times in seconds
  writeExr(folder_ / "b.exr", channels);
  EXPECT_EQ(hashHex(readFile(folder_ / "a.exr")), hashHex(readFile(folder_ / "b.exr")));
}

TEST_F(ImageIo, MissingChannelListsTheOthers) {
  writeExr(folder_ / "a.exr", {{"one", ramp(2, 2, 0.0f)}, {"two", ramp(2, 2, 0.0f)}});
  const ExrPicture picture = readExr(folder_ / "a.exr");
  EXPECT_FALSE(picture.has("three"));
  try {
    picture.channel("three");
    FAIL() << "nothing thrown";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "the picture has no channel \"three\"; it has one, two");
  }
}

TEST_F(ImageIo, UnequalChannelsAreRefused) {
  EXPECT_THROW(writeExr(folder_ / "a.exr", {{"a", Image(2, 2)}, {"b", Image(2, 3)}}), Error);
  EXPECT_THROW(writeExr(folder_ / "a.exr", {{"a", Image(2, 2, 3)}}), Error);
  EXPECT_THROW(writeExr(folder_ / "a.exr", {{"a", Image(2, 2)}, {"a", Image(2, 2)}}), Error);
  EXPECT_THROW(writeExr(folder_ / "a.exr", {}), Error);
  EXPECT_FALSE(fs::exists(folder_ / "a.exr"));
}

TEST_F(ImageIo, DamagedFilesAreErrors) {
  writeExr(folder_ / "whole.exr", {{"v", ramp(64, 64, 0.5f)}});
  const std::string bytes = readFile(folder_ / "whole.exr");
  writeFileAtomically(folder_ / "cut.exr", bytes.substr(0, bytes.size() / 2));
  EXPECT_THROW(readExr(folder_ / "cut.exr"), Error);
  writeFileAtomically(folder_ / "text.exr", "no picture");
  EXPECT_THROW(readExr(folder_ / "text.exr"), Error);
  EXPECT_THROW(readExr(folder_ / "none.exr"), Error);
}

TEST_F(ImageIo, WritingLeavesNothingElse) {
  writePng(folder_ / "new" / "a.png", Image(2, 2));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "new"), {}), 1);
  EXPECT_EQ(readFile(folder_ / "new" / "a.png").substr(1, 3), "PNG");
}

TEST_F(ImageIo, UnwritableFolderIsAnError) {
  writeFileAtomically(folder_ / "file", "");
  EXPECT_THROW(writePng(folder_ / "file" / "a.png", Image(2, 2)), Error);
}

TEST_F(ImageIo, PngTakesGreyAndRgb) {
  writePng(folder_ / "grey.png", Image(2, 2, 1, 0.5f));
  writePng(folder_ / "rgb.png", Image(2, 2, 3, 0.5f));
  EXPECT_EQ(readFile(folder_ / "grey.png")[25], 0);  // colour type in the header: grey
  EXPECT_EQ(readFile(folder_ / "rgb.png")[25], 2);   // RGB
  EXPECT_THROW(writePng(folder_ / "two.png", Image(2, 2, 2)), Error);
}

TEST_F(ImageIo, ExtensionMustFit) {
  EXPECT_THROW(writePng(folder_ / "a.exr", Image(1, 1)), Error);
  EXPECT_THROW(writeExr(folder_ / "a.png", {{"v", Image(1, 1)}}), Error);
  EXPECT_THROW(readExr(folder_ / "a.png"), Error);
}

TEST(EncodeSrgb, MatchesTheStandard) {
  EXPECT_EQ(encodeSrgb(0.0f), 0.0f);
  EXPECT_NEAR(encodeSrgb(1.0f), 1.0f, 1e-6f);
  EXPECT_NEAR(encodeSrgb(0.002f), 0.02584f, 1e-6f);                 // the linear piece
  EXPECT_NEAR(encodeSrgb(0.21404114f), 0.5f, 1e-6f);                // half grey
  EXPECT_NEAR(encodeSrgb(0.0031309f), 12.92f * 0.0031309f, 1e-5f);  // both pieces meet
}

TEST(EncodeSrgb, ClampsWhatIsNoColour) {
  EXPECT_EQ(encodeSrgb(-1.0f), 0.0f);
  EXPECT_EQ(encodeSrgb(7.0f), encodeSrgb(1.0f));
  EXPECT_EQ(encodeSrgb(std::numeric_limits<float>::quiet_NaN()), 0.0f);
}

}  // namespace
}  // namespace gnomon
