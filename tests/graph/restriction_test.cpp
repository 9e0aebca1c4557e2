// A session that looks for receivers in a part of the picture only, and slots that show what is made elsewhere.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "bench.h"

namespace gnomon::test {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr glm::ivec2 kSize{61, 45};  // odd: rows of bytes are not aligned

/// Rows 10 to 29, and of those only two columns of three.
Image someRows() {
  Image pixels(kSize.x, kSize.y);
  for (int y = 10; y < 30; ++y) {
    for (int x = 0; x < kSize.x; ++x) pixels.at(x, y) = x % 3 == 0 ? 0.0f : 1.0f;
  }
  return pixels;
}

class Restricted : public testing::TestWithParam<const char*> {
 protected:
  Restricted() : whole_(frame()) {}

  Image frame() {
    report_ = session_.frame(slot_);
    return session_.visibility(slot_);
  }

  Session session_{builtinSetup("pillars", kSize)};
  Slot slot_ = addSlot(session_, GetParam());
  FrameReport report_;
  Image whole_;
};

TEST_P(Restricted, IsTheSameInsideAndOneOutside) {
  session_.restrictReceivers(someRows());
  const Image part = frame();
  const Image inside = someRows();
  for (std::size_t i = 0; i < part.data.size(); ++i) {
    ASSERT_EQ(part.data[i], inside.data[i] > 0.5f ? whole_.data[i] : 1.0f) << "pixel " << i;
  }
}

TEST_P(Restricted, AnEmptyImageLiftsIt) {
  session_.restrictReceivers(someRows());
  frame();
  session_.restrictReceivers({});
  EXPECT_EQ(frame().data, whole_.data);
}

TEST_P(Restricted, NoPixelLeavesNoReceiver) {
  session_.restrictReceivers(Image(kSize.x, kSize.y));
  EXPECT_THAT(frame().data, Each(1.0f));
}

INSTANTIATE_TEST_SUITE_P(Techniques, Restricted, testing::Values("shadow_map", "pcf", "ray_traced"));

TEST(Restriction, IntersectsTheReceiverMask) {
  Session session(builtinSetup("pillars", kSize));
  session.runShared();
  Image expected = session.receiverMask();
  const Image inside = someRows();
  std::transform(expected.data.begin(), expected.data.end(), inside.data.begin(), expected.data.begin(), std::multiplies<>());
  session.restrictReceivers(inside);
  session.runShared();
  EXPECT_EQ(session.receiverMask().data, expected.data);
}

TEST(Restriction, RaysFallWithTheArea) {
  Session session(builtinSetup("half_plane", kSize));  // a floor below its source: no horizon cuts it
  const Slot slot = addSlot(session, "ray_traced", R"({"samples": 3})");
  session.restrictReceivers(someRows());
  const FrameReport report = session.frame(slot);
  const std::vector<float> mask = session.receiverMask().data;
  EXPECT_EQ(report.technique.counters.rays, 3U * static_cast<std::uint64_t>(std::count(mask.begin(), mask.end(), 1.0f)));
}

TEST(Restriction, RunsTheMaskAndNotTheGBuffer) {
  Session session(builtinSetup("pillars", kSize));
  session.runShared();
  session.restrictReceivers(someRows());
  EXPECT_THAT(ran(session.runShared()), testing::ElementsAre("receiver mask"));
}

TEST(Restriction, OfAnotherSizeIsRefused) {
  Session session(builtinSetup("pillars", kSize));
  EXPECT_THAT(errorOf([&] { session.restrictReceivers(Image(3, 2)); }), HasSubstr("61x45"));
}

// --- pictures ---

std::shared_ptr<TextureResource> texture(glm::ivec2 size, Format format, float value) {
  auto made = std::make_shared<TextureResource>();
  made->name = "elsewhere";
  made->info = {size, format};
  made->object = gl::makeTexture2D(formatFacts(format).internalFormat, size, "elsewhere");
  glClearTexImage(made->object.name(), 0, GL_RED, GL_FLOAT, &value);
  return made;
}

TEST(Picture, IsShadedAgainWhenItsRevisionRises) {
  Session session(builtinSetup("half_plane", kSize));
  const std::shared_ptr<TextureResource> visibility = texture(kSize, Format::r32f, 1.0f);
  const Slot slot = session.addPicture(visibility);
  session.frame(slot);
  const std::vector<float> lit = session.shaded(slot).data;
  const float dark = 0.0f;
  glClearTexImage(visibility->object.name(), 0, GL_RED, GL_FLOAT, &dark);
  ++visibility->revision;
  const FrameReport report = session.frame(slot);
  EXPECT_THAT(report.technique.passes, IsEmpty());
  EXPECT_NE(session.shaded(slot).data, lit);
  EXPECT_THAT(session.visibility(slot).data, Each(0.0f));
}

TEST(Picture, LooksAsATechniqueOfTheSameVisibility) {
  Session session(builtinSetup("half_plane", kSize));
  const Slot floor = addSlot(session, "unshadowed");
  session.frame(floor);
  const Slot picture = session.addPicture(texture(kSize, Format::r16f, 1.0f));
  session.frame(picture);
  EXPECT_EQ(session.shaded(picture).data, session.shaded(floor).data);
}

TEST(Picture, MakesRoomForATechnique) {
  Session session(builtinSetup("half_plane", kSize));
  const Slot slot = session.addPicture(texture(kSize, Format::r32f, 1.0f));
  EXPECT_TRUE(session.setParameters(slot, registry().open("shadow_map"), parametersOf("shadow_map", "{}")));
  EXPECT_FALSE(session.passNames(slot).empty());
}

TEST(Picture, OfAnotherSizeOrFormatIsRefused) {
  Session session(builtinSetup("half_plane", kSize));
  EXPECT_THAT(errorOf([&] { session.addPicture(texture({3, 2}, Format::r32f, 1.0f)); }), HasSubstr("3x2"));
  EXPECT_THAT(errorOf([&] { session.addPicture(texture(kSize, Format::r8, 1.0f)); }), HasSubstr("r16f or r32f"));
}

}  // namespace
}  // namespace gnomon::test
