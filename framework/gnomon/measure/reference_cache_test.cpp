#include "gnomon/measure/reference_cache.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "gnomon/base/error.h"
#include "gnomon/base/files.h"
#include "gnomon/base/log.h"

namespace gnomon {
namespace {

const std::string kKey = "ray_traced 512 samples, seeds 1 and 2, sphere_grid";

class ReferenceCache : public ::testing::Test {
 protected:
  void SetUp() override {
    log::setLevel(log::Level::off);  // damaged files are what is tested
    folder_ = std::filesystem::path(::testing::TempDir()) /
              ("gnomon_reference_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::remove_all(folder_);
  }
  void TearDown() override {
    std::filesystem::remove_all(folder_);
    log::setLevel(log::Level::info);
  }

  static KeptReference pair() {
    KeptReference result{{Image(5, 3), Image(5, 3)}, {}, {}, 70'000'000'000, 12};
    ReferencePair& halves = result.halves;
    for (std::size_t i = 0; i < halves.a.data.size(); ++i) {
      halves.a.data[i] = static_cast<float>(i) / 7.0f;
      halves.b.data[i] = 1.0f - halves.a.data[i];
    }
    return result;
  }
  static KeptReference withStatistics() {
    KeptReference result = pair();
    result.standardError = Image(5, 3, 1, 0.01f);
    result.cosineVisibility = Image(5, 3, 1, 0.3f);
    return result;
  }
  std::string storedBytes() const { return readFile(referenceFile(folder_, kKey)); }
  void replace(const std::string& bytes) const {
    std::ofstream(referenceFile(folder_, kKey), std::ios::binary | std::ios::trunc) << bytes;
  }

  std::filesystem::path folder_;
};

std::vector<std::uint32_t> bitsOf(const Image& image) {
  std::vector<std::uint32_t> bits;
  for (const float value : image.data) bits.push_back(std::bit_cast<std::uint32_t>(value));
  return bits;
}

TEST_F(ReferenceCache, GivesBackTheSameBits) {
  KeptReference kept = pair();
  kept.halves.a.at(2, 1) = -0.0f;
  kept.halves.b.at(2, 1) = std::numeric_limits<float>::quiet_NaN();
  storeReference(folder_, kKey, kept);
  const auto loaded = loadReference(folder_, kKey);
  ASSERT_TRUE(loaded.has_value());
  EXPECT_EQ(loaded->halves.a.width, 5);
  EXPECT_EQ(loaded->halves.a.height, 3);
  EXPECT_EQ(bitsOf(loaded->halves.a), bitsOf(kept.halves.a));
  EXPECT_EQ(bitsOf(loaded->halves.b), bitsOf(kept.halves.b));
  EXPECT_EQ(loaded->standardError.pixels(), 0U);
  EXPECT_EQ(loaded->rays, kept.rays);
  EXPECT_EQ(loaded->raysSaved, kept.raysSaved);
}

TEST_F(ReferenceCache, GivesBackWhatTheReferenceTellsOfItself) {
  storeReference(folder_, kKey, withStatistics());
  const auto loaded = loadReference(folder_, kKey);
  ASSERT_TRUE(loaded.has_value());
  EXPECT_EQ(bitsOf(loaded->standardError), bitsOf(withStatistics().standardError));
  EXPECT_EQ(bitsOf(loaded->cosineVisibility), bitsOf(withStatistics().cosineVisibility));
}

TEST_F(ReferenceCache, HasNothingBeforeAnythingIsStored) {
  EXPECT_FALSE(loadReference(folder_, kKey).has_value());
}

TEST_F(ReferenceCache, KeysHaveTheirOwnPairs) {
  storeReference(folder_, kKey, pair());
  EXPECT_FALSE(loadReference(folder_, kKey + "!").has_value());
}

TEST_F(ReferenceCache, AFileUnderAnotherKeysNameIsRefused) {  // as after a collision of hashes or a rename
  storeReference(folder_, "another key", pair());
  std::filesystem::copy_file(referenceFile(folder_, "another key"), referenceFile(folder_, kKey));
  EXPECT_FALSE(loadReference(folder_, kKey).has_value());
}

TEST_F(ReferenceCache, AFlippedBitIsNoticedWhereverItIs) {
  storeReference(folder_, kKey, pair());
  const std::string good = storedBytes();
  for (std::size_t i = 0; i < good.size(); i += 5) {  // into each field, and all eight bits
    std::string flipped = good;
    flipped[i] = static_cast<char>(flipped[i] ^ (1 << (i % 8)));
    replace(flipped);
    EXPECT_FALSE(loadReference(folder_, kKey).has_value()) << "byte " << i;
  }
}

TEST_F(ReferenceCache, ACutIsNoticedWhereverItIs) {
  storeReference(folder_, kKey, pair());
  const std::string good = storedBytes();
  for (std::size_t length = 0; length < good.size(); length += 11) {
    replace(good.substr(0, length));
    EXPECT_FALSE(loadReference(folder_, kKey).has_value()) << "cut at " << length;
  }
}

TEST_F(ReferenceCache, TrailingBytesAreNoticed) {
  storeReference(folder_, kKey, pair());
  replace(storedBytes() + "x");
  EXPECT_FALSE(loadReference(folder_, kKey).has_value());
}

/// The stored file with four bytes replaced by `value` and a checksum that is right again.
std::string forged(std::string bytes, std::size_t offset, std::uint32_t value) {
  bytes.resize(bytes.size() - 32);
  bytes.replace(offset, sizeof value, reinterpret_cast<const char*>(&value), sizeof value);
  return bytes + hashHex(bytes);
}

TEST_F(ReferenceCache, SizesThatDoNotFitAreRefusedBeforeAnythingIsAllocated) {
  storeReference(folder_, kKey, pair());
  const std::string good = storedBytes();
  const std::size_t widthOffset = 8 + 4 + 4 + kKey.size() + 2 * 8;
  for (const std::uint32_t width : {0u, 4u, 6u, 0x40000000u, 0xffffffffu}) {
    replace(forged(good, widthOffset, width));
    EXPECT_FALSE(loadReference(folder_, kKey).has_value()) << width;
  }
}

TEST_F(ReferenceCache, ANumberOfPicturesThatDoesNotFitIsRefused) {
  storeReference(folder_, kKey, pair());
  for (const std::uint32_t pictures : {0u, 1u, 3u, 4u, 0xffffffffu}) {
    replace(forged(storedBytes(), 8 + 4 + 4 + kKey.size() + 2 * 8 + 2 * 4, pictures));
    EXPECT_FALSE(loadReference(folder_, kKey).has_value()) << pictures;
    storeReference(folder_, kKey, pair());
  }
}

TEST_F(ReferenceCache, AKeyLengthBeyondTheFileIsRefused) {
  storeReference(folder_, kKey, pair());
  replace(forged(storedBytes(), 8 + 4, 0xffffffffu));
  EXPECT_FALSE(loadReference(folder_, kKey).has_value());
}

TEST_F(ReferenceCache, AnotherVersionIsRefused) {
  storeReference(folder_, kKey, pair());
  replace(forged(storedBytes(), 8, 1));
  EXPECT_FALSE(loadReference(folder_, kKey).has_value());
}

TEST_F(ReferenceCache, ADamagedFileIsReplacedByTheNextStore) {
  storeReference(folder_, kKey, pair());
  replace("rubbish");
  storeReference(folder_, kKey, pair());
  EXPECT_TRUE(loadReference(folder_, kKey).has_value());
}

TEST_F(ReferenceCache, HalvesOfTwoSizesAreAnError) {
  EXPECT_THROW(storeReference(folder_, kKey, {{Image(2, 2), Image(2, 3)}, {}, {}}), Error);
  EXPECT_THROW(storeReference(folder_, kKey, {{Image(2, 2), Image(2, 2)}, Image(2, 2), Image(2, 3)}), Error);
}

}  // namespace
}  // namespace gnomon
