#include "gnomon/gl/program_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace gnomon::gl {

namespace {

bool isWordCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

bool mentions(const std::string& text, const std::string& word) {
  for (std::size_t i = text.find(word); i != std::string::npos; i = text.find(word, i + 1)) {
    const std::size_t end = i + word.size();
    if ((i == 0 || !isWordCharacter(text[i - 1])) && (end == text.size() || !isWordCharacter(text[end]))) return true;
  }
  return false;
}

std::string expandAll(const ShaderSources& sources, const std::vector<ShaderStage>& stages) {
  std::string all;
  if (const auto& counting = sources.readCounting) {
    const glm::ivec2 pixels = counting->pixels.value_or(glm::ivec2(0));
    all += fmt::format("// counts reads, of {} x {} pixels, depth {}\n", pixels.x, pixels.y, counting->writesDepth);
  }
  for (const ShaderStage& stage : stages) {
    const ExpandedShader shader = expandShader(sources, stage.file, {});
    if (sources.defencesMet) sources.defencesMet->insert(shader.defences.begin(), shader.defences.end());
    // The numbers of #line stand for files: programs of other files have other
    // errors, and so another text.
    all += "// stage " + std::to_string(stage.type) + '\n' + shader.text;
    for (const std::string& file : shader.files) all += "// " + file + '\n';
  }
  return all;
}

std::string nameOf(GLuint program, GLenum interface, GLuint index) {
  std::array<char, 256> text{};
  glGetProgramResourceName(program, interface, index, static_cast<GLsizei>(text.size()), nullptr, text.data());
  return text.data();
}

GLuint countOf(GLuint program, GLenum interface) {
  GLint count = 0;
  glGetProgramInterfaceiv(program, interface, GL_ACTIVE_RESOURCES, &count);
  return static_cast<GLuint>(count);
}

/// Image types lie together, GL_IMAGE_1D to
/// GL_UNSIGNED_INT_IMAGE_2D_MULTISAMPLE_ARRAY.
bool isImage(GLint type) {
  return type >= GL_IMAGE_1D && type <= GL_UNSIGNED_INT_IMAGE_2D_MULTISAMPLE_ARRAY;
}

void bindUniforms(Program& program) {
  const GLuint name = program.object.name();
  for (GLuint i = 0; i < countOf(name, GL_UNIFORM); ++i) {
    const std::array<GLenum, 3> wanted{GL_TYPE, GL_LOCATION, GL_BLOCK_INDEX};
    std::array<GLint, 3> got{};
    glGetProgramResourceiv(name, GL_UNIFORM, i, 3, wanted.data(), 3, nullptr, got.data());
    if (got[2] != -1 || got[1] < 0) continue;
    std::vector<Program::Point>& points = isImage(got[0]) ? program.images : program.samplers;
    const auto at = static_cast<GLuint>(points.size());
    points.push_back({nameOf(name, GL_UNIFORM, i), at});
    glProgramUniform1i(name, got[1], static_cast<GLint>(at));
  }
}

/// A uniform block in a standard layout is active even if nothing of it is
/// used: ask who refers to it. (Not so for storage blocks: Mesa 22.3 says of
/// every one that nobody does.)
bool isReferenced(GLuint program, GLuint uniformBlock) {
  const std::array<GLenum, 4> users{GL_REFERENCED_BY_VERTEX_SHADER, GL_REFERENCED_BY_GEOMETRY_SHADER,
                                    GL_REFERENCED_BY_FRAGMENT_SHADER, GL_REFERENCED_BY_COMPUTE_SHADER};
  std::array<GLint, 4> used{};
  glGetProgramResourceiv(program, GL_UNIFORM_BLOCK, uniformBlock, 4, users.data(), 4, nullptr, used.data());
  return std::any_of(used.begin(), used.end(), [](GLint is) { return is != 0; });
}

void bindBlocks(Program& program) {
  const GLuint name = program.object.name();
  for (GLuint i = 0; i < countOf(name, GL_UNIFORM_BLOCK); ++i) {
    if (!isReferenced(name, i)) continue;
    program.uniforms.push_back({nameOf(name, GL_UNIFORM_BLOCK, i), i});
    glUniformBlockBinding(name, i, i);
  }
  for (GLuint i = 0; i < countOf(name, GL_SHADER_STORAGE_BLOCK); ++i) {
    program.storages.push_back({nameOf(name, GL_SHADER_STORAGE_BLOCK, i), i});
    glShaderStorageBlockBinding(name, i, i);
  }
}

}  // namespace

std::shared_ptr<const Program> ProgramCache::get(const ShaderSources& sources, const std::vector<ShaderStage>& stages,
                                                 const std::vector<Constant>& constants, const std::string& label) {
  std::string text = expandAll(sources, stages);
  std::vector<Constant> used;
  std::string declarations;
  for (const Constant& constant : constants) {
    if (!mentions(text, constant.name)) continue;
    used.push_back(constant);
    declarations += declaration(constant);
  }
  text = declarations + text;
  if (const auto known = find(text)) {
    keep(known);
    return known;
  }
  auto program = std::make_shared<Program>();
  program->object = makeProgram(sources, stages, used, label);
  program->text = std::move(text);
  if (sources.readCounting) program->readable = readableNames({program->text});
  bindUniforms(*program);
  bindBlocks(*program);
  std::erase_if(known_, [](const auto& each) { return each.expired(); });
  known_.push_back(program);
  keep(program);
  return program;
}

std::shared_ptr<const Program> ProgramCache::find(const std::string& text) const {
  for (const auto& each : known_) {
    if (auto program = each.lock(); program && program->text == text) return program;
  }
  return nullptr;
}

void ProgramCache::keep(const std::shared_ptr<const Program>& program) {
  recent_.remove(program);
  recent_.push_front(program);
  if (recent_.size() > limit_) recent_.pop_back();
}

}  // namespace gnomon::gl
