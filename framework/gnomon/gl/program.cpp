#include "gnomon/gl/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <sstream>

#include "gnomon/base/error.h"
#include "gnomon/base/files.h"
#include "gnomon/gl/context.h"

namespace gnomon::gl {

namespace {

constexpr int kMaxIncludeDepth = 32;

/// The name between the quotes of an #include line, empty if it has none; nullopt when the line is no such line.
std::optional<std::string> includedName(const std::string& line) {
  const std::size_t i = line.find_first_not_of(" \t");
  if (i == std::string::npos || line.compare(i, 8, "#include") != 0) return std::nullopt;
  const std::size_t open = line.find('"', i + 8);
  const std::size_t close = open == std::string::npos ? open : line.find('"', open + 1);
  return close == std::string::npos ? std::string() : line.substr(open + 1, close - open - 1);
}

bool isWordCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Decides the defences of a text, line by line.
class DefenceSwitch {
 public:
  explicit DefenceSwitch(const std::set<std::string>& off) : off_(off) {}

  /// The line with `(true)` or `(false)` for each GNOMON_DEFENCE(name) outside comments, whose names it adds to `met`.
  std::string decided(const std::string& line, const std::string& where, std::set<std::string>& met) {
    const bool isPlain = line.find("GNOMON_DEFENCE") == std::string::npos && line.find("/*") == std::string::npos;
    if (isPlain && !inComment_) return line;
    std::string result;
    for (std::size_t i = 0; i < line.size();) {
      if (inComment_) {
        const std::size_t end = line.find("*/", i);
        inComment_ = end == std::string::npos;
        const std::size_t after = inComment_ ? line.size() : end + 2;
        result.append(line, i, after - i);
        i = after;
      } else if (line.compare(i, 2, "//") == 0) {
        result.append(line, i);
        break;
      } else if (line.compare(i, 2, "/*") == 0) {
        inComment_ = true;
        result += "/*";
        i += 2;
      } else if (isWordCharacter(line[i])) {
        std::size_t end = i;
        while (end < line.size() && isWordCharacter(line[end])) ++end;
        const std::string word = line.substr(i, end - i);
        i = end;
        result += word == "GNOMON_DEFENCE" ? valueOf(line, i, where, met) : word;
      } else {
        result += line[i++];
      }
    }
    return result;
  }

 private:
  /// Of the name in brackets at `i`, which then stands behind them.
  std::string valueOf(const std::string& line, std::size_t& i, const std::string& where, std::set<std::string>& met) const {
    const std::size_t open = line.find_first_not_of(" \t", i);
    const std::size_t close = open != std::string::npos && line[open] == '(' ? line.find(')', open) : std::string::npos;
    const std::string name = close == std::string::npos ? "" : line.substr(open + 1, close - open - 1);
    const bool isDefined = line.find_first_not_of(" \t") != std::string::npos && line[line.find_first_not_of(" \t")] == '#';
    if (name.empty() || isDefined || !std::all_of(name.begin(), name.end(), isWordCharacter)) {
      throw Error(where + ": GNOMON_DEFENCE needs one name in brackets, outside directives; the framework gives its value");
    }
    met.insert(name);
    i = close + 1;
    return off_.contains(name) ? "(false)" : "(true)";
  }

  const std::set<std::string>& off_;
  bool inComment_ = false;
};

class Expander {
 public:
  explicit Expander(const ShaderSources& sources) : sources_(sources), defences_(sources.defencesOff) {}

  void expand(const std::string& name, const std::filesystem::path& besides, const std::string& from, int depth) {
    if (name.empty()) throw Error(from + ": #include needs \"file\" in quotes");
    if (depth > kMaxIncludeDepth) throw Error(from + ": #include nested deeper than 32");
    const std::filesystem::path relative(name);
    if (relative.is_absolute() ||
        std::any_of(relative.begin(), relative.end(), [](const auto& part) { return part == ".."; })) {
      throw Error(fmt::format("{}: \"{}\" leaves the shader folders; give a path below them", from, name));
    }
    std::string text;
    std::filesystem::path path;
    if (const auto generated = sources_.generated.find(name); generated != sources_.generated.end()) {
      text = generated->second;
      path = name;
    } else {
      path = locate(relative, besides, from);
      text = readFile(path);
    }
    if (!seen_.insert(path.string()).second) return;
    appendFile(text, path, depth);
  }

  ExpandedShader result;

 private:
  std::filesystem::path locate(const std::filesystem::path& relative, const std::filesystem::path& besides,
                               const std::string& from) {
    if (!besides.empty() && std::filesystem::is_regular_file(besides / relative)) return besides / relative;
    std::string searched;
    for (const auto& directory : sources_.directories) {
      if (std::filesystem::is_regular_file(directory / relative)) return directory / relative;
      searched += " " + directory.string();
    }
    throw Error(fmt::format("{}: no shader file \"{}\" in{}", from, relative.string(), searched));
  }

  void appendFile(const std::string& text, const std::filesystem::path& path, int depth) {
    const int number = static_cast<int>(result.files.size());
    result.files.push_back(path.string());
    result.text += fmt::format("#line 1 {}\n", number);
    std::istringstream lines(text);
    std::string line;
    for (int at = 1; std::getline(lines, line); ++at) {
      const std::optional<std::string> name = includedName(line);
      const std::string where = fmt::format("{}:{}", path.string(), at);
      if (!name) {
        result.text += defences_.decided(line, where, result.defences) + '\n';
      } else {
        expand(*name, path.parent_path(), where, depth + 1);
        result.text += fmt::format("#line {} {}\n", at + 1, number);
      }
    }
  }

  const ShaderSources& sources_;
  DefenceSwitch defences_;
  std::set<std::string> seen_;
};

/// Rewrites "0:12(5): error" (Mesa), "0(12) : error" (NVIDIA) and "ERROR: 0:12:" (others) into "file:12: ...".
std::string withFileNames(const std::string& log, const std::vector<std::string>& files) {
  std::istringstream lines(log);
  std::string result;
  std::string line;
  while (std::getline(lines, line)) {
    std::size_t i = 0;
    while (i < line.size() && std::isdigit(static_cast<unsigned char>(line[i])) == 0) ++i;
    std::size_t j = i;
    while (j < line.size() && std::isdigit(static_cast<unsigned char>(line[j])) != 0) ++j;
    std::size_t k = j + 1;
    while (k < line.size() && std::isdigit(static_cast<unsigned char>(line[k])) != 0) ++k;
    const bool located = j > i && j < line.size() && (line[j] == ':' || line[j] == '(') && k > j + 1 && j - i < 4;
    if (located) {
      const std::size_t file = std::stoul(line.substr(i, j - i));
      if (file < files.size()) line = fmt::format("{}:{}: {}", files[file], line.substr(j + 1, k - j - 1), line.substr(k));
    }
    if (!line.empty()) result += "\n  " + line;
  }
  return result;
}

void countReads(std::vector<ExpandedShader>& shaders, const std::vector<ShaderStage>& stages, const ReadCounting& counting) {
  std::vector<std::string> texts;
  for (const ExpandedShader& shader : shaders) texts.push_back(shader.text);
  const std::vector<std::string> names = readableNames(texts);
  for (std::size_t i = 0; i < shaders.size(); ++i) {
    try {
      shaders[i].text = instrumented(shaders[i].text, stages[i].type, names, counting);
    } catch (const Error& error) {
      throw Error(fmt::format("{}: {}", stages[i].file, error.what()));
    }
  }
}

}  // namespace

std::string declaration(const Constant& constant) {
  if (const bool* b = std::get_if<bool>(&constant.value)) return fmt::format("const bool {} = {};\n", constant.name, *b);
  if (const int* i = std::get_if<int>(&constant.value)) return fmt::format("const int {} = {};\n", constant.name, *i);
  return fmt::format("const float {} = {:.9e};\n", constant.name, std::get<float>(constant.value));
}

ExpandedShader expandShader(const ShaderSources& sources, const std::string& file, const std::vector<Constant>& constants) {
  Expander expander(sources);
  expander.result.text = "#version 450 core\n";
  for (const Constant& constant : constants) expander.result.text += declaration(constant);
  expander.expand(file, {}, file, 0);
  return std::move(expander.result);
}

ProgramObject makeProgram(const ShaderSources& sources, const std::vector<ShaderStage>& stages,
                          const std::vector<Constant>& constants, const std::string& label) {
  ProgramObject program(glCreateProgram());
  setLabel(GL_PROGRAM, program.name(), label);
  std::vector<ExpandedShader> expanded;
  for (const ShaderStage& stage : stages) expanded.push_back(expandShader(sources, stage.file, constants));
  if (sources.readCounting) countReads(expanded, stages, *sources.readCounting);
  std::vector<ShaderObject> shaders;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const ShaderStage& stage = stages[i];
    const ExpandedShader& source = expanded[i];
    if (sources.defencesMet) sources.defencesMet->insert(source.defences.begin(), source.defences.end());
    const ShaderObject& shader = shaders.emplace_back(glCreateShader(stage.type));
    const char* text = source.text.c_str();
    glShaderSource(shader.name(), 1, &text, nullptr);
    glCompileShader(shader.name());
    GLint ok = 0;
    glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &ok);
    if (ok == 0) {
      GLint length = 0;
      glGetShaderiv(shader.name(), GL_INFO_LOG_LENGTH, &length);
      std::string message(static_cast<std::size_t>(std::max(length, 1)), '\0');
      glGetShaderInfoLog(shader.name(), length, nullptr, message.data());
      message.resize(std::min(message.size(), message.find('\0')));
      discardMessages();  // said here, with file and line
      throw Error(fmt::format("shader {} does not compile:{}", stage.file, withFileNames(message, source.files)));
    }
    glAttachShader(program.name(), shader.name());
  }
  glLinkProgram(program.name());
  GLint ok = 0;
  glGetProgramiv(program.name(), GL_LINK_STATUS, &ok);
  if (ok == 0) {
    GLint length = 0;
    glGetProgramiv(program.name(), GL_INFO_LOG_LENGTH, &length);
    std::string message(static_cast<std::size_t>(std::max(length, 1)), '\0');
    glGetProgramInfoLog(program.name(), length, nullptr, message.data());
    message.resize(std::min(message.size(), message.find('\0')));
    discardMessages();
    throw Error(fmt::format("program {} does not link: {}", label, message));
  }
  for (const ShaderObject& shader : shaders) glDetachShader(program.name(), shader.name());
  return program;
}

}  // namespace gnomon::gl
