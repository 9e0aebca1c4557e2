// Copying and comparing values of every type through their table.
#include "gnomon/base/table.h"

#include <gtest/gtest.h>

namespace gnomon {
namespace {

enum class Kind : int { box, gaussian };

struct Inner {
  float width = 1.0f;
};

struct Values {
  bool flag = false;
  int count = 1;
  float ratio = 0.5f;
  double exact = 0.25;
  Kind kind = Kind::box;
  std::string name = "a";
  glm::ivec2 extent{4, 4};
  glm::dvec2 at{0.0, 0.0};
  glm::dvec3 place{0.0, 0.0, 0.0};
  Inner inner;
  Inner flat;
  std::vector<std::string> words{"x"};
  std::vector<Inner> several{{}};
  std::optional<int> maybe;
};

const FieldTable& table() {
  static const ParameterTable<Inner> inner{real("width", &Inner::width, {}, Binding::uniform, "")};
  static const std::shared_ptr<const FieldTable> nested = inner.table();
  static const std::shared_ptr<const FieldTable> all =
      ParameterTable<Values>{boolean("flag", &Values::flag, Binding::structure, ""),
                             integer("count", &Values::count, {}, Binding::structure, ""),
                             real("ratio", &Values::ratio, {}, Binding::structure, ""),
                             real("exact", &Values::exact, {}, Binding::structure, ""),
                             choice("kind", &Values::kind, {"box", "gaussian"}, Binding::structure, ""),
                             text("name", &Values::name, ""),
                             size("extent", &Values::extent, {}, Binding::structure, ""),
                             vector("at", &Values::at, {}, ""),
                             vector("place", &Values::place, {}, ""),
                             object("inner", &Values::inner, nested, ""),
                             inlined(&Values::flat, inner, "flat."),
                             list("words", &Values::words, nullptr, ""),
                             list("several", &Values::several, nested, ""),
                             integer("maybe", &Values::maybe, {}, Binding::structure, "")}
          .table();
  return *all;
}

Values others() {
  return {true,   2,          0.75f,    0.125, Kind::gaussian, "b", {4, 8}, {0.0, 1.0}, {0.0, 0.0, 1.0}, {2.0f},
          {3.0f}, {"x", "y"}, {{4.0f}}, 5};
}

class EachField : public testing::TestWithParam<std::size_t> {
 protected:
  const Field& field_ = table().fields().at(GetParam());
  Values mine_;
  Values theirs_ = others();
};

TEST_P(EachField, DiffersWhereItsValuesDo) {
  EXPECT_FALSE(equalValue(field_, &mine_, &theirs_));
  EXPECT_FALSE(equalValue(field_, &theirs_, &mine_));
}

TEST_P(EachField, IsEqualOnceItWasCopied) {
  copyValue(field_, &mine_, &theirs_);
  EXPECT_TRUE(equalValue(field_, &mine_, &theirs_));
}

TEST_P(EachField, IsCopiedAlone) {
  copyValue(field_, &mine_, &theirs_);
  const Values untouched;
  for (const Field& other : table().fields()) {
    EXPECT_EQ(equalValue(other, &mine_, &untouched), other.name != field_.name) << other.name;
  }
}

INSTANTIATE_TEST_SUITE_P(TableValues, EachField, testing::Range<std::size_t>(0, 14), [](const auto& each) {
  std::string name = table().fields().at(each.param).name;
  std::erase(name, '.');
  return name;
});

TEST(TableValues, AllAreCopied) {
  Values mine;
  const Values theirs = others();
  copyValues(table(), &mine, &theirs);
  EXPECT_TRUE(equalValues(table(), &mine, &theirs));
}

TEST(TableValues, AnEmptyOptionalIsCopiedAsEmpty) {
  Values mine = others();
  const Values theirs;
  copyValues(table(), &mine, &theirs);
  EXPECT_FALSE(mine.maybe.has_value());
}

TEST(Integers, AreMultiplesOfTheStep) {
  const Range range{.min = 1, .max = 20, .step = 4};
  for (const int allowed : {4, 8, 12, 16, 20}) EXPECT_TRUE(allowsInteger(range, allowed)) << allowed;
  for (const double refused : {0.0, 1.0, 5.0, 10.0, 21.0, 24.0, 4.5}) EXPECT_FALSE(allowsInteger(range, refused)) << refused;
}

TEST(Integers, AreOddWhereTheyMustBe) {
  const Range range{.min = -3, .max = 5, .odd = true};
  for (const int allowed : {-3, -1, 1, 5}) EXPECT_TRUE(allowsInteger(range, allowed)) << allowed;
  for (const int refused : {-5, -2, 0, 4, 7}) EXPECT_FALSE(allowsInteger(range, refused)) << refused;
}

TEST(Integers, OfBothRulesObeyBoth) {
  const Range range{.step = 3, .odd = true};
  EXPECT_TRUE(allowsInteger(range, 9.0));
  EXPECT_FALSE(allowsInteger(range, 6.0));
  EXPECT_EQ(integerStep(range), 6);
  EXPECT_TRUE(allowsInteger(range, 9.0 + integerStep(range)));
}

TEST(TableValues, OneDifferenceIsEnough) {
  Values mine;
  const Values theirs;
  ASSERT_TRUE(equalValues(table(), &mine, &theirs));
  mine.several[0].width = 7.0f;
  EXPECT_FALSE(equalValues(table(), &mine, &theirs));
}

}  // namespace
}  // namespace gnomon
