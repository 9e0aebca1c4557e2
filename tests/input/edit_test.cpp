// What the viewer's keys make of a parameter: always a value that a config might hold.
#include "edit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/vec2.hpp>

namespace gnomon::test {
namespace {

struct Values {
  int any = 5;
  int odd = 5;
  int tile = 64;
  int oddTile = 9;
  int narrow = 4;
  glm::ivec2 extent{512, 256};
  glm::ivec2 tiles{192, 64};
  float linear = 2.0f;
  double scale = 1e-3;
};

Field field(const std::string& name) {
  const ParameterTable<Values> table{
      integer("any", &Values::any, {.min = 1, .max = 31}, Binding::specialise, ""),
      integer("odd", &Values::odd, {.min = 2, .max = 10, .odd = true}, Binding::specialise, ""),
      integer("tile", &Values::tile, {.min = 1, .max = 200, .step = 64}, Binding::structure, ""),
      integer("odd_tile", &Values::oddTile, {.step = 3, .odd = true}, Binding::structure, ""),
      integer("narrow", &Values::narrow, {.min = 2, .max = 5, .step = 4}, Binding::structure, ""),
      size("extent", &Values::extent, {.min = 1, .max = 1024}, Binding::structure, ""),
      size("tiles", &Values::tiles, {.min = 64, .max = 1024, .step = 64}, Binding::structure, ""),
      real("linear", &Values::linear, {.min = 0.0, .max = 16.0}, Binding::uniform, ""),
      real("scale", &Values::scale, {.min = 1e-6, .max = 0.5, .logarithmic = true}, Binding::uniform, "")};
  return *table.table()->find(name);
}

/// The value after `steps`.
template <class T>
T stepped(const std::string& name, T Values::*member, int steps, Values values = {}) {
  stepValue(field(name), &values, steps);
  return values.*member;
}

TEST(Edit, IntegersStepByOneWithinTheirRange) {
  EXPECT_EQ(stepped("any", &Values::any, 1), 6);
  EXPECT_EQ(stepped("any", &Values::any, -2), 3);
  EXPECT_EQ(stepped("any", &Values::any, 100), 31);
  EXPECT_EQ(stepped("any", &Values::any, -100), 1);
}

TEST(Edit, OddIntegersStayOddToTheEnds) {
  EXPECT_EQ(stepped("odd", &Values::odd, 1), 7);
  EXPECT_EQ(stepped("odd", &Values::odd, 100), 9);
  EXPECT_EQ(stepped("odd", &Values::odd, -100), 3);
}

TEST(Edit, SteppedIntegersStayMultiplesToTheEnds) {
  EXPECT_EQ(stepped("tile", &Values::tile, 1), 128);
  EXPECT_EQ(stepped("tile", &Values::tile, 100), 192);
  EXPECT_EQ(stepped("tile", &Values::tile, -100), 64);
  EXPECT_EQ(stepped("odd_tile", &Values::oddTile, 1), 15);
  EXPECT_EQ(stepped("odd_tile", &Values::oddTile, -2), -3);
}

TEST(Edit, WhereOnlyOneIntegerIsAllowedNothingChanges) {
  Values values;
  EXPECT_FALSE(stepValue(field("narrow"), &values, 1));
  EXPECT_EQ(values.narrow, 4);
}

TEST(Edit, SizesDoubleAndStayMultiples) {
  EXPECT_EQ(stepped("extent", &Values::extent, 1), glm::ivec2(1024, 512));
  EXPECT_EQ(stepped("extent", &Values::extent, 2), glm::ivec2(1024, 1024));
  EXPECT_EQ(stepped("tiles", &Values::tiles, -1), glm::ivec2(64, 64));  // of 64 and 128, both as near to 96
}

TEST(Edit, RealsStepByATenthOfThemselves) {
  EXPECT_FLOAT_EQ(stepped("linear", &Values::linear, 1), 2.2f);
  EXPECT_FLOAT_EQ(stepped("linear", &Values::linear, -1), 1.8f);
}

TEST(Edit, TenLogarithmicStepsAreADecade) {
  EXPECT_DOUBLE_EQ(stepped("scale", &Values::scale, 10), 1e-2);
  EXPECT_DOUBLE_EQ(stepped("scale", &Values::scale, -10), 1e-4);
  EXPECT_DOUBLE_EQ(stepped("scale", &Values::scale, 1), 1e-3 * std::pow(10.0, 0.1));
  EXPECT_DOUBLE_EQ(stepped("scale", &Values::scale, 100), 0.5);
  EXPECT_DOUBLE_EQ(stepped("scale", &Values::scale, -100), 1e-6);
}

}  // namespace
}  // namespace gnomon::test
