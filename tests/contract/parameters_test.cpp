// Parameters are declared once: defaults, the uniform block, constants and the schema follow from one table and agree.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

#include "gnomon/base/json.h"
#include "gnomon/gl/objects.h"
#include "gnomon/gl/program.h"
#include "gnomon/technique/parameter_block.h"
#include "render.h"
#include "temporary_folder.h"

namespace gnomon::test {
namespace {

using ::testing::ElementsAre;

enum class Shape : int { box, gaussian };

struct Bias {
  float slope = 0.25f;
};

/// Members in an order that leaves gaps: after a scalar a vector of two must skip to 8, one of three to 16, and a scalar may
/// follow a vector of three at once (OpenGL 4.5 core, 7.6.2.2).
struct Everything {
  float first = 1.5f;
  glm::ivec2 mapSize{640, 480};
  bool flag = true;
  glm::dvec3 axis{0.25, -0.5, 4.0};
  float behindAxis = 7.0f;
  int count = -3;
  glm::dvec2 centre{0.125, 8.0};
  double wide = 0.375;
  Shape shape = Shape::gaussian;
  glm::dvec3 last{1.0, 2.0, 3.0};
  Bias bias;
  int taps = 5;                    // specialised
  bool fast = true;                // specialised
  float spread = 0.75f;            // specialised
  Shape kernel = Shape::gaussian;  // specialised
  int passes = 2;                  // structure
};

Field uniformVector(Field field) {
  field.binding = Binding::uniform;
  return field;
}

ParameterTable<Everything> everything() {
  const ParameterTable<Bias> bias{real("slope", &Bias::slope, {.min = 0.0, .max = 8.0}, Binding::uniform, "of the depth")};
  return {real("first", &Everything::first, {}, Binding::uniform, "m"),
          size("map_size", &Everything::mapSize, {.min = 1, .max = 4096}, Binding::uniform, "m"),
          boolean("flag", &Everything::flag, Binding::uniform, "m"),
          uniformVector(vector("axis", &Everything::axis, {}, "m")),
          real("behind_axis", &Everything::behindAxis, {}, Binding::uniform, "m"),
          integer("count", &Everything::count, {}, Binding::uniform, "m"),
          uniformVector(vector("centre", &Everything::centre, {}, "m")),
          real("wide", &Everything::wide, {}, Binding::uniform, "m"),
          choice("shape", &Everything::shape, {"box", "gaussian"}, Binding::uniform, "m"),
          uniformVector(vector("last", &Everything::last, {}, "m")),
          inlined(&Everything::bias, bias, "bias."),
          integer("taps", &Everything::taps, {.min = 1, .max = 31}, Binding::specialise, "m"),
          boolean("fast", &Everything::fast, Binding::specialise, "m"),
          real("spread", &Everything::spread, {}, Binding::specialise, "m"),
          choice("kernel", &Everything::kernel, {"box", "gaussian"}, Binding::specialise, "m"),
          integer("passes", &Everything::passes, {}, Binding::structure, "m")};
}

/// The generated block compiled by the driver, with every member in use.
class CompiledBlock {
 public:
  explicit CompiledBlock(const FieldTable& table, const std::string& use) {
    ensureContext();
    folder_.write("all.frag", "#include \"parameters\"\nout float result;\nvoid main() { result = " + use + "; }\n");
    const gl::ShaderSources sources{{folder_.path(), installationDirectory() / "shaders"},
                                    {{"parameters", parameterBlockText(table)}}};
    program_ =
        gl::makeProgram(sources, {{GL_VERTEX_SHADER, "gnomon/fullscreen.vert"}, {GL_FRAGMENT_SHADER, "all.frag"}}, {}, "block");
  }

  std::size_t bytes() const {
    const GLuint block = glGetProgramResourceIndex(program_.name(), GL_UNIFORM_BLOCK, "Parameters");
    return static_cast<std::size_t>(property(GL_UNIFORM_BLOCK, block, GL_BUFFER_DATA_SIZE));
  }
  std::size_t offset(const char* member) const {
    const GLuint uniform = glGetProgramResourceIndex(program_.name(), GL_UNIFORM, member);
    if (uniform == GL_INVALID_INDEX) throw Error(std::string("the block has no member ") + member);
    return static_cast<std::size_t>(property(GL_UNIFORM, uniform, GL_OFFSET));
  }

 private:
  GLint property(GLenum interface, GLuint index, GLenum what) const {
    GLint value = -1;
    glGetProgramResourceiv(program_.name(), interface, index, 1, &what, 1, nullptr, &value);
    return value;
  }
  TemporaryFolder folder_;
  gl::ProgramObject program_;
};

const char* const kUseAll =
    "first + float(map_size.x) + float(flag) + axis.x + behind_axis + float(count) + centre.x + wide + float(shape) + last.z + "
    "bias_slope";

template <class T>
T at(const std::vector<std::byte>& bytes, std::size_t offset) {
  T value{};
  if (offset + sizeof(T) > bytes.size()) throw Error("beyond the block's bytes");
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

TEST(ParameterBlock, EveryValueLiesWhereTheDriverLooksForIt) {
  const auto table = everything().table();
  const Everything values;
  const CompiledBlock block(*table, kUseAll);
  const std::vector<std::byte> bytes = parameterBlockBytes(*table, &values);
  EXPECT_EQ(at<float>(bytes, block.offset("first")), 1.5f);
  EXPECT_EQ(at<glm::ivec2>(bytes, block.offset("map_size")), glm::ivec2(640, 480));
  EXPECT_EQ(at<int>(bytes, block.offset("flag")), 1);
  EXPECT_EQ(at<glm::vec3>(bytes, block.offset("axis")), glm::vec3(0.25f, -0.5f, 4.0f));
  EXPECT_EQ(at<float>(bytes, block.offset("behind_axis")), 7.0f);
  EXPECT_EQ(at<int>(bytes, block.offset("count")), -3);
  EXPECT_EQ(at<glm::vec2>(bytes, block.offset("centre")), glm::vec2(0.125f, 8.0f));
  EXPECT_EQ(at<float>(bytes, block.offset("wide")), 0.375f);
  EXPECT_EQ(at<int>(bytes, block.offset("shape")), 1);
  EXPECT_EQ(at<glm::vec3>(bytes, block.offset("last")), glm::vec3(1.0f, 2.0f, 3.0f));
  EXPECT_EQ(at<float>(bytes, block.offset("bias_slope")), 0.25f);
}

TEST(ParameterBlock, IsAsLongAsTheDriverWants) {
  const auto table = everything().table();
  const Everything values;
  EXPECT_GE(parameterBlockBytes(*table, &values).size(), CompiledBlock(*table, kUseAll).bytes());
}

TEST(ParameterBlock, AScalarFollowsAVectorOfThreeAtOnce) {  // the gap that a layout by hand gets wrong
  const CompiledBlock block(*everything().table(), kUseAll);
  EXPECT_EQ(block.offset("behind_axis"), block.offset("axis") + 12);
}

TEST(ParameterBlock, HoldsOnlyUniforms) {
  const std::string text = parameterBlockText(*everything().table());
  for (const char* other : {"taps", "fast", "spread", "kernel", "passes"})
    EXPECT_EQ(text.find(other), std::string::npos) << other;
}

TEST(ParameterBlock, OfATableWithoutUniformsIsNoTextButABufferCanHoldIt) {
  const ParameterTable<Everything> table{integer("taps", &Everything::taps, {}, Binding::specialise, "m")};
  const Everything values;
  EXPECT_EQ(parameterBlockText(*table.table()), "");
  EXPECT_EQ(parameterBlockBytes(*table.table(), &values).size(), 16U);
}

TEST(ParameterBlock, TextCannotBeAUniform) {
  struct Named {
    std::string name;
  };
  Field field = text("name", &Named::name, "m");
  field.binding = Binding::uniform;
  EXPECT_THROW(parameterBlockText(FieldTable({field})), Error);
}

TEST(ParameterConstants, AreThoseThatAreSpecialisedInCapitals) {
  const Everything values;
  std::vector<std::string> shown;
  for (const Constant& c : parameterConstants(*everything().table(), &values)) {
    const std::string value = std::visit([](auto v) { return std::to_string(v); }, c.value);
    shown.push_back(c.name + " = " + value + " of kind " + std::to_string(c.value.index()));
  }
  EXPECT_THAT(shown,
              ElementsAre("TAPS = 5 of kind 1", "FAST = 1 of kind 0", "SPREAD = 0.750000 of kind 2", "KERNEL = 1 of kind 1"));
}

/// Block members and constants spell the same keys as JSON, dots apart.
TEST(Parameters, SchemaDefaultsAreTheStructsOwn) {
  const auto table = everything().table();
  const Everything values;
  const Json written = writeObject(*table, &values);
  const Json properties = schemaOf(*table, &values)["properties"];
  for (const Field& field : table->fields()) {
    ASSERT_TRUE(properties.contains(field.name)) << field.name;
    EXPECT_EQ(properties[field.name].value("default", Json()), written[field.name]) << field.name;
  }
}

TEST(Parameters, WhatIsWrittenIsReadBack) {
  const auto table = everything().table();
  Everything changed;
  changed.axis = {9.0, 8.0, 7.0};
  changed.bias.slope = 3.0f;
  changed.kernel = Shape::box;
  changed.mapSize = {32, 32};
  Everything read;
  Problems problems;
  readObject(writeObject(*table, &changed), *table, &read, {"test", ""}, problems);
  EXPECT_TRUE(problems.empty()) << (problems.empty() ? "" : problems.list()[0].line());
  EXPECT_EQ(writeObject(*table, &read), writeObject(*table, &changed));
  EXPECT_EQ(parameterBlockBytes(*table, &read), parameterBlockBytes(*table, &changed));
}

/// Every technique that is built: its table can be written, read back, and made into a block that the driver lays out alike.
TEST(Parameters, OfEveryBuiltTechniqueAgree) {
  for (const std::string& name : registry().names()) {
    const OpenTechnique technique = registry().open(name);
    const FieldTable& table = *technique.entry->parameters;
    const std::shared_ptr<void> defaults = technique.entry->makeParameters();
    const Json written = writeObject(table, defaults.get());
    const std::shared_ptr<void> read = technique.entry->makeParameters();
    Problems problems;
    readObject(written, table, read.get(), {name, ""}, problems);
    EXPECT_TRUE(problems.empty()) << (problems.empty() ? "" : problems.list()[0].line());
    EXPECT_EQ(writeObject(table, read.get()), written) << name;
    const std::vector<std::byte> bytes = parameterBlockBytes(table, defaults.get());
    std::string use;
    for (const Field& field : table.fields()) {
      std::string member = field.name;
      std::replace(member.begin(), member.end(), '.', '_');
      const bool isVector =
          field.type == FieldType::size || field.type == FieldType::vector2 || field.type == FieldType::vector3;
      if (field.binding == Binding::uniform) use += (use.empty() ? "" : " + ") + ("float(" + member) + (isVector ? ".x)" : ")");
    }
    if (use.empty()) continue;
    EXPECT_GE(bytes.size(), CompiledBlock(table, use).bytes()) << name;
  }
}

}  // namespace
}  // namespace gnomon::test
