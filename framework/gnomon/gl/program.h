// GLSL programs from files: #include, injected constants, generated blocks, and errors at file:line.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "gnomon/gl/instrument.h"
#include "gnomon/gl/objects.h"

namespace gnomon::gl {

/// A compile-time constant of a shader, written as `const TYPE NAME = value;` before its first line.
struct Constant {
  std::string name;
  std::variant<bool, int, float> value;
};

/// Where shader text comes from, and which of its defences are off.
struct ShaderSources {
  std::vector<std::filesystem::path> directories;  ///< searched in order for #include and for files named without a folder
  std::map<std::string, std::string> generated;    ///< includes that are not files, such as "parameters"
  std::set<std::string> defencesOff = {};          ///< names whose GNOMON_DEFENCE(name) is false
  std::shared_ptr<std::set<std::string>> defencesMet = {};  ///< where makeProgram notes the names it meets; null: nowhere
  std::optional<ReadCounting> readCounting = {};            ///< programs count the texels that they read
};

/// "const TYPE NAME = VALUE;" and a line break.
std::string declaration(const Constant& constant);

struct ShaderStage {
  GLenum type;       ///< GL_VERTEX_SHADER, ...
  std::string file;  ///< looked up in the directories
};

/// The whole text that the compiler sees, and the files that the source-string numbers of its #line directives mean.
struct ExpandedShader {
  std::string text;
  std::vector<std::string> files;
  std::set<std::string> defences = {};  ///< names of its GNOMON_DEFENCE(name)
};

/// GNOMON_DEFENCE(name), a named guard against a numerical hard case, becomes `true`, or `false` where its name is off: in the
/// text itself, so that no #include and no macro decides it. Outside comments the word stands for nothing else. Replaces
/// #include "x" (once each), looked up beside the including file, then in the directories, then among the generated ones.
/// Throws Error at file:line for a missing file, a path that leaves the folders (absolute or with ".."), or nesting deeper than
/// 32, or a GNOMON_DEFENCE without one name on its line.
ExpandedShader expandShader(const ShaderSources& sources, const std::string& file, const std::vector<Constant>& constants);

/// Compiles and links. Throws Error with the driver's messages, each at its file:line.
ProgramObject makeProgram(const ShaderSources& sources, const std::vector<ShaderStage>& stages,
                          const std::vector<Constant>& constants, const std::string& label);

}  // namespace gnomon::gl
