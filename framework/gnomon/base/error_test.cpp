#include "gnomon/base/error.h"

#include <gtest/gtest.h>

namespace gnomon {
namespace {

TEST(NearestName, FindsOneSlip) {
  const std::vector<std::string> names = {"taps", "kernel", "map_size"};
  EXPECT_EQ(nearestName("tap", names), "taps");   // missing letter
  EXPECT_EQ(nearestName("tasp", names), "taps");  // swapped neighbours
  EXPECT_EQ(nearestName("map-size", names), "map_size");
  EXPECT_EQ(nearestName("Kernel", names), "kernel");
}

TEST(NearestName, SuggestsNothingThatIsFar) {
  EXPECT_EQ(nearestName("colour", {"taps", "kernel"}), "");
  EXPECT_EQ(nearestName("x", {}), "");
}

TEST(NearestName, PrefersTheNearer) {
  EXPECT_EQ(nearestName("spreads", {"spaced", "spread"}), "spread");
}

TEST(NearestName, IgnoresHugeNames) {
  EXPECT_EQ(nearestName(std::string(1000000, 'a'), {"a"}), "");
}

TEST(Problem, LineNamesFileAndPlace) {
  EXPECT_EQ((Problem{"a.json", "/x/0", "wrong"}).line(), "a.json: /x/0: wrong");
  EXPECT_EQ((Problem{"a.json", "", "wrong"}).line(), "a.json: wrong");
  EXPECT_EQ((Problem{"", "", "wrong"}).line(), "wrong");
}

TEST(Problems, ThrowsAllOfThem) {
  Problems problems;
  problems.throwIfAny();
  problems.add("a", "/1", "one");
  problems.add("a", "/2", "two");
  try {
    problems.throwIfAny();
    FAIL() << "nothing thrown";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().size(), 2U);
    EXPECT_STREQ(error.what(), "a: /1: one\na: /2: two");
  }
}

}  // namespace
}  // namespace gnomon
