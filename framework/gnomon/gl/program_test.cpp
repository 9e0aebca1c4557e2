#include "gnomon/gl/program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "gnomon/base/error.h"
#include "gnomon/base/files.h"

namespace gnomon::gl {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// expandShader() needs no context.
class ExpandShader : public testing::Test {
 protected:
  ExpandShader() {
    fs::remove_all(root_);
    sources_.directories = {root_ / "first", root_ / "second"};
    file("first/main.frag", "void main() {}\n");
  }
  ~ExpandShader() override { fs::remove_all(root_); }

  void file(const std::string& name, const std::string& text) { writeFileAtomically(root_ / name, text); }
  std::string path(const std::string& name) const { return (root_ / name).string(); }
  ExpandedShader expand(const std::vector<Constant>& constants = {}) const {
    return expandShader(sources_, "main.frag", constants);
  }
  std::string text(const std::vector<Constant>& constants = {}) const { return expand(constants).text; }
  std::string error() const {
    try {
      expand();
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  }

  const fs::path root_ = fs::temp_directory_path() /
                         ("gnomon_expand_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
  ShaderSources sources_;
};

TEST_F(ExpandShader, BeginsWithVersionThenConstantsThenTheFileFromItsFirstLine) {
  EXPECT_EQ(text({{"B", true}, {"I", -3}}),
            "#version 450 core\nconst bool B = true;\nconst int I = -3;\n#line 1 0\nvoid main() {}\n");
}

TEST_F(ExpandShader, FloatConstantsKeepAllTheirDigits) {  // nine give back every float
  EXPECT_THAT(text({{"F", 0.1f}}), HasSubstr("const float F = 1.000000015e-01;\n"));
}

// --- defences ---

TEST_F(ExpandShader, ADefenceIsOnUnlessItsNameIsOff) {
  file("first/main.frag", "if (GNOMON_DEFENCE(clamp) && GNOMON_DEFENCE( bias )) d = 0.0;\n");
  EXPECT_THAT(error(), HasSubstr("main.frag:1"));  // one name, and nothing else
  file("first/main.frag", "if (GNOMON_DEFENCE(clamp) && GNOMON_DEFENCE(bias)) d = 0.0;\n");
  EXPECT_THAT(text(), HasSubstr("if ((true) && (true)) d = 0.0;\n"));
  sources_.defencesOff = {"bias"};
  EXPECT_THAT(text(), HasSubstr("if ((true) && (false)) d = 0.0;\n"));
}

TEST_F(ExpandShader, NamesOfDefencesAreThoseOfItsIncludesToo) {
  file("first/main.frag", "#include \"b.glsl\"\nbool a = GNOMON_DEFENCE(outer);\n");
  file("first/b.glsl", "bool b = GNOMON_DEFENCE(inner);\n");
  EXPECT_THAT(expand().defences, ElementsAre("inner", "outer"));
}

TEST_F(ExpandShader, ADefenceInACommentIsNone) {
  file("first/main.frag", "// GNOMON_DEFENCE(a)\n/* GNOMON_DEFENCE(b)\n GNOMON_DEFENCE */ bool c = GNOMON_DEFENCE(c);\n");
  const ExpandedShader shader = expand();
  EXPECT_THAT(shader.defences, ElementsAre("c"));
  EXPECT_THAT(shader.text, HasSubstr("// GNOMON_DEFENCE(a)\n/* GNOMON_DEFENCE(b)\n GNOMON_DEFENCE */ bool c = (true);\n"));
}

TEST_F(ExpandShader, LongerWordsAreNoDefence) {
  file("first/main.frag", "bool a = MY_GNOMON_DEFENCE(x), b = GNOMON_DEFENCES(y);\n");
  EXPECT_THAT(text(), HasSubstr("bool a = MY_GNOMON_DEFENCE(x), b = GNOMON_DEFENCES(y);\n"));
}

TEST_F(ExpandShader, NoMacroDecidesADefence) {
  for (const char* line : {"#define GNOMON_DEFENCE(name) true", "#undef GNOMON_DEFENCE", "#if GNOMON_DEFENCE(clamp)",
                           "GNOMON_DEFENCE", "GNOMON_DEFENCE()", "GNOMON_DEFENCE(a b)", "GNOMON_DEFENCE(a"}) {
    file("first/main.frag", "\n" + std::string(line) + "\n");
    EXPECT_THAT(error(), AllOf(HasSubstr(path("first/main.frag") + ":2: "), HasSubstr("GNOMON_DEFENCE needs one name")))
        << line;
  }
}

TEST_F(ExpandShader, AnIncludeIsReplacedAndLinesCountOnBehindIt) {
  file("first/main.frag", "a\n#include \"b.glsl\"\nc\n");
  file("first/b.glsl", "b\n");
  const ExpandedShader shader = expand();
  EXPECT_EQ(shader.text, "#version 450 core\n#line 1 0\na\n#line 1 1\nb\n#line 3 0\nc\n");
  EXPECT_THAT(shader.files, ElementsAre(path("first/main.frag"), path("first/b.glsl")));
}

TEST_F(ExpandShader, EachFileComesOnce) {
  file("first/main.frag", "#include \"b.glsl\"\n#include \"c.glsl\"\n");
  file("first/b.glsl", "#include \"c.glsl\"\n");
  file("first/c.glsl", "c\n");
  const std::string all = text();
  EXPECT_EQ(all.find("c\n"), all.rfind("c\n"));
}

TEST_F(ExpandShader, AFileThatIncludesItselfEnds) {
  file("first/main.frag", "#include \"main.frag\"\nvoid main() {}\n");
  EXPECT_THAT(text(), HasSubstr("void main() {}"));
}

TEST_F(ExpandShader, LooksBesideTheIncludingFileFirst) {
  file("first/main.frag", "#include \"sub/b.glsl\"\n");
  file("first/sub/b.glsl", "#include \"c.glsl\"\n");
  file("first/sub/c.glsl", "beside\n");
  file("first/c.glsl", "elsewhere\n");
  EXPECT_THAT(text(), AllOf(HasSubstr("beside"), testing::Not(HasSubstr("elsewhere"))));
}

TEST_F(ExpandShader, LooksInTheDirectoriesInOrder) {
  file("first/main.frag", "#include \"b.glsl\"\n#include \"c.glsl\"\n");
  file("first/b.glsl", "first b\n");
  file("second/b.glsl", "second b\n");
  file("second/c.glsl", "second c\n");
  EXPECT_THAT(text(), AllOf(HasSubstr("first b"), HasSubstr("second c"), testing::Not(HasSubstr("second b"))));
}

TEST_F(ExpandShader, AGeneratedTextCanBeIncluded) {
  file("first/main.frag", "#include \"parameters\"\n");
  sources_.generated["parameters"] = "uniform int taps;\n";
  EXPECT_THAT(expand().files, ElementsAre(path("first/main.frag"), "parameters"));
  EXPECT_THAT(text(), HasSubstr("uniform int taps;"));
}

TEST_F(ExpandShader, AFileWithoutANewlineAtItsEndDoesNotSwallowTheNextLine) {
  file("first/main.frag", "#include \"b.glsl\"\nafter\n");
  file("first/b.glsl", "b");
  EXPECT_THAT(text(), HasSubstr("b\n#line 2 0\nafter\n"));
}

TEST_F(ExpandShader, AnIndentedIncludeCounts) {
  file("first/main.frag", "  #include \"b.glsl\"\n");
  file("first/b.glsl", "b\n");
  EXPECT_THAT(text(), HasSubstr("b\n"));
}

TEST_F(ExpandShader, ACommentedIncludeDoesNot) {
  file("first/main.frag", "// #include \"b.glsl\"\n");
  EXPECT_THAT(text(), HasSubstr("// #include"));
}

TEST_F(ExpandShader, AMissingFileIsNamedWhereItIsIncluded) {
  file("first/main.frag", "a\n#include \"nowhere.glsl\"\n");
  EXPECT_THAT(error(), AllOf(HasSubstr(path("first/main.frag") + ":2"), HasSubstr("nowhere.glsl"), HasSubstr(path("second"))));
}

TEST_F(ExpandShader, AnIncludeWithoutANameIsNamedWhereItIs) {
  file("first/main.frag", "#include <b.glsl>\n");
  EXPECT_THAT(error(), AllOf(HasSubstr(path("first/main.frag") + ":1"), HasSubstr("\"file\"")));
}

TEST_F(ExpandShader, PathsThatLeaveTheFoldersAreRefused) {
  file("secret.glsl", "secret\n");
  file("first/main.frag", "#include \"../secret.glsl\"\n");
  EXPECT_THAT(error(), AllOf(HasSubstr(":1"), HasSubstr("leaves the shader folders")));
  file("first/main.frag", "#include \"" + path("secret.glsl") + "\"\n");
  EXPECT_THAT(error(), HasSubstr("leaves the shader folders"));
}

TEST_F(ExpandShader, NestingIsBounded) {
  for (int i = 0; i < 40; ++i)
    file("first/n" + std::to_string(i) + ".glsl", "#include \"n" + std::to_string(i + 1) + ".glsl\"\n");
  file("first/main.frag", "#include \"n0.glsl\"\n");
  EXPECT_THAT(error(), HasSubstr("deeper than 32"));
}

}  // namespace
}  // namespace gnomon::gl
