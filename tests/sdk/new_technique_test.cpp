// `gnomon new-technique`: what it refuses, and that a refusal leaves nothing behind.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "program.h"

namespace gnomon::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Outcome newTechnique(const TemporaryFolder& in, const std::string& name) {
  return gnomonProgram({"new-technique", "--in", in.path().string(), "--", name});
}

TEST(NewTechnique, WritesAFolderWithoutTheTemplatesName) {
  const TemporaryFolder in;
  const Outcome outcome = newTechnique(in, "soft_map_2");
  ASSERT_EQ(outcome.exitCode, 0) << outcome.all();
  EXPECT_THAT(namesIn(in.path()), ElementsAre("soft_map_2"));
  EXPECT_THAT(namesIn(in / "soft_map_2"),
              ElementsAre("CMakeLists.txt", "soft_map_2.cpp", "soft_map_2.frag", "soft_map_2.json"));
  std::string all;
  for (const std::string& file : namesIn(in / "soft_map_2")) all += readFile(in / "soft_map_2" / file);
  for (const char* const left : {"new_technique", "NewTechnique", "New technique"})
    EXPECT_EQ(all.find(left), std::string::npos) << left;
  EXPECT_THAT(all, HasSubstr("class SoftMap2Technique final : public Technique"));
  EXPECT_THAT(all, HasSubstr(R"("title": "Soft map 2")"));
}

TEST(NewTechnique, MakesTheFolderThatItWritesInto) {
  const TemporaryFolder in;
  ASSERT_EQ(gnomonProgram({"new-technique", "mine", "--in", (in / "some/where").string()}).exitCode, 0);
  EXPECT_TRUE(std::filesystem::exists(in / "some/where/mine/mine.cpp"));
}

struct Refusal {
  std::string test, name, words;

  friend void PrintTo(const Refusal& r, std::ostream* out) { *out << r.name; }
};

class Refusals : public ::testing::TestWithParam<Refusal> {};

TEST_P(Refusals, AreOneLineAndLeaveNothing) {
  const TemporaryFolder in;
  const Outcome outcome = newTechnique(in, GetParam().name);
  EXPECT_EQ(outcome.exitCode, 2) << outcome.all();
  EXPECT_THAT(outcome.lines("error"), ElementsAre(HasSubstr(GetParam().words)));
  EXPECT_THAT(namesIn(in.path()), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(NewTechnique, Refusals,
                         ::testing::Values(Refusal{"Capitals", "Mine", "'Mine' is no name for a technique"},
                                           Refusal{"Path", "../mine", "allowed are a-z, 0-9 and _"},
                                           Refusal{"Digit", "2nd", "a letter first"},
                                           Refusal{"Reserved", "test", "take another"},
                                           Refusal{"Registered", "shadow_map", "'shadow_map' is registered already, by "}),
                         [](const auto& each) { return each.param.test; });

TEST(NewTechnique, LeavesAFolderThatIsThereAsItWas) {
  const TemporaryFolder in;
  in.write("mine/notes.txt", "three years of work");
  const Outcome outcome = newTechnique(in, "mine");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.lines("error"), ElementsAre(HasSubstr("is there already; nothing was written")));
  EXPECT_THAT(namesIn(in / "mine"), ElementsAre("notes.txt"));
}

}  // namespace
}  // namespace gnomon::test
