#include "gnomon/gl/instrument.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <string_view>

#include "gnomon/base/error.h"

namespace gnomon::gl {

namespace {

enum class Kind : std::uint8_t { blank, directive, word, other };

/// Text that keeps its place: what is blank and what are comments too.
struct Token {
  Kind kind;
  std::string text;
};

bool isWordCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

std::size_t endOfDirective(const std::string& text, std::size_t i) {
  while (i < text.size() && (text[i] != '\n' || text[i - 1] == '\\')) ++i;
  return i;
}

std::vector<Token> tokensOf(const std::string& text) {
  std::vector<Token> tokens;
  bool atLineStart = true;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t begin = i;
    Kind kind = Kind::other;
    if (std::isspace(static_cast<unsigned char>(text[i])) != 0) {
      kind = Kind::blank;
      while (i < text.size() && std::isspace(static_cast<unsigned char>(text[i])) != 0) atLineStart |= text[i++] == '\n';
    } else if (text.compare(i, 2, "//") == 0) {
      kind = Kind::blank;
      i = std::min(text.find('\n', i), text.size());
    } else if (text.compare(i, 2, "/*") == 0) {
      kind = Kind::blank;
      const std::size_t end = text.find("*/", i + 2);
      i = end == std::string::npos ? text.size() : end + 2;
    } else if (text[i] == '#' && atLineStart) {
      kind = Kind::directive;
      i = endOfDirective(text, i);
    } else if (isWordCharacter(text[i])) {
      kind = Kind::word;
      while (i < text.size() && isWordCharacter(text[i])) ++i;
      atLineStart = false;
    } else {
      ++i;
      atLineStart = false;
    }
    tokens.push_back({kind, text.substr(begin, i - begin)});
  }
  return tokens;
}

bool isTextureType(std::string_view word) {
  if (word.starts_with("i") || word.starts_with("u")) {
    if (word.starts_with("isampler") || word.starts_with("usampler") || word.starts_with("iimage") ||
        word.starts_with("uimage"))
      word.remove_prefix(1);
  }
  const auto followedByDimension = [&](std::string_view kind) {
    if (!word.starts_with(kind) || word.size() == kind.size()) return false;
    const char next = word[kind.size()];
    return std::isdigit(static_cast<unsigned char>(next)) != 0 || next == 'C' || next == 'B';  // sampler2D, -Cube, -Buffer
  };
  return followedByDimension("sampler") || followedByDimension("image");
}

/// Texels that a call reads; none for functions that read no texture.
std::optional<int> texelsRead(std::string_view function) {
  static constexpr std::array<std::string_view, 15> kLookups{
      "texture",           "textureLod",       "textureGrad",    "textureOffset",        "textureLodOffset",
      "textureGradOffset", "textureProj",      "textureProjLod", "textureProjGrad",      "textureProjOffset",
      "texelFetch",        "texelFetchOffset", "imageLoad",      "textureProjLodOffset", "textureProjGradOffset"};
  if (function == "textureGather" || function == "textureGatherOffset" || function == "textureGatherOffsets") return 4;
  if (function.starts_with("imageAtomic")) return 1;
  if (std::find(kLookups.begin(), kLookups.end(), function) != kLookups.end()) return 1;
  return std::nullopt;
}

/// Functions of GLSL that take a texture and read none of its texels.
bool asksOnly(std::string_view function) {
  return function.starts_with("textureQuery") || function == "textureSize" || function == "textureSamples" ||
         function == "imageSize" || function == "imageSamples" || function == "imageStore";
}

bool mentionsRead(const std::string& directive) {
  for (const Token& token : tokensOf(directive.substr(1))) {
    if (token.kind == Kind::word && texelsRead(token.text)) return true;
  }
  return false;
}

/// Positions of what counts for the grammar: all but blanks and directives.
std::vector<std::size_t> meaningful(const std::vector<Token>& tokens) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    if (tokens[i].kind == Kind::word || tokens[i].kind == Kind::other) places.push_back(i);
  }
  return places;
}

/// Rewrites tokens in place, in one walk.
class Rewriter {
 public:
  Rewriter(std::vector<Token>& tokens, const std::vector<std::string>& names)
      : tokens_(tokens), places_(meaningful(tokens)), names_(names) {
    for (const std::size_t place : places_) written_.push_back(tokens_[place].text);
  }

  void rewrite() {
    for (const Token& token : tokens_) {
      if (token.kind == Kind::directive && mentionsRead(token.text))
        throw Error("reads of textures inside a macro cannot be counted: " + token.text);
    }
    for (at_ = 0; at_ < places_.size(); ++at_) step();
  }
  bool reads() const { return reads_; }
  bool discards() const { return discards_; }
  bool writesFragDepth() const { return writesFragDepth_; }

 private:
  struct Call {
    std::string function;
    bool counted = false;
  };

  void step() {
    Token& token = tokens_[places_[at_]];
    if (token.kind == Kind::word) {
      word(token);
      return;
    }
    if (token.text == "{") ++depth_;
    if (token.text == "}") --depth_;
    if (token.text == "(") {
      if (depth_ == 0 && calls_.empty()) parameters_.clear();  // of another function
      calls_.push_back({at_ > 0 ? textAt(at_ - 1) : "", nextIsCounted_});
      nextIsCounted_ = false;
    } else if (token.text == ")" && !calls_.empty()) {
      if (calls_.back().counted) token.text = "))";
      calls_.pop_back();
    }
  }

  void word(Token& token) {
    const std::string text = textAt(at_);
    if (at_ > 0 && textAt(at_ - 1) == ".") return;  // a member
    if (text == "uniform") {
      skipUniform();
    } else if (text == "main" && next() == "(" && depth_ == 0) {
      token.text = "gnomonMain";
    } else if (text == "discard") {
      discards_ = true;
      token.text = "{ gnomonFlush(); discard; }";
      if (next() == ";") tokens_[places_[at_ + 1]].text.clear();
    } else if (isTextureType(text)) {
      parameter(token);
    } else if (const std::optional<int> texels = next() == "(" ? texelsRead(text) : std::nullopt) {
      token.text = fmt::format("(gnomonRead({}, {}u), {}", numberAt(at_ + 2), *texels, text);
      nextIsCounted_ = true;
      reads_ = true;
    } else if (isTexture(text)) {
      use(token);
    } else {
      writesFragDepth_ |= text == "gl_FragDepth";
    }
  }

  /// A declaration at global scope ends at its semicolon; of a block, its members hold no texture.
  void skipUniform() {
    std::size_t end = at_;
    while (end < places_.size() && textAt(end) != ";" && textAt(end) != "{") ++end;
    if (end < places_.size() && textAt(end) == "{") return;
    bool ofTextures = false;
    for (std::size_t i = at_; i < end; ++i) {
      ofTextures |= isTextureType(textAt(i));
      if (ofTextures && textAt(i) == "[") throw Error("reads of an array of samplers cannot be counted");
    }
    at_ = end;
  }

  /// A texture in a function's list of parameters takes its number along.
  void parameter(Token& type) {
    if (next() == "," || next() == ")") {
      type.text += ", int";
      return;
    }
    ++at_;
    Token& name = tokens_[places_[at_]];
    if (depth_ == 0) parameters_.insert(name.text);
    name.text += fmt::format(", int gnomonOf_{}", name.text);
  }

  /// So does one that is handed on.
  void use(Token& token) {
    const std::string function = calls_.empty() ? "" : calls_.back().function;
    if (texelsRead(function) || asksOnly(function)) return;
    const bool isWhole = at_ > 0 && (textAt(at_ - 1) == "(" || textAt(at_ - 1) == ",") && (next() == "," || next() == ")");
    if (isWhole && !function.empty()) token.text += ", " + numberOf(token.text);
  }

  std::string numberAt(std::size_t place) const {
    const std::string name = place < places_.size() ? textAt(place) : "";
    const std::string after = place + 1 < places_.size() ? textAt(place + 1) : "";
    if (!isTexture(name) || (after != "," && after != ")"))
      throw Error(fmt::format("which texture '{}' reads cannot be told: \"{}{}\" is no name of one", textAt(at_), name, after));
    return numberOf(name);
  }

  /// A parameter hides a uniform of its name.
  std::string numberOf(const std::string& name) const {
    if (parameters_.contains(name)) return "gnomonOf_" + name;
    return std::to_string(std::find(names_.begin(), names_.end(), name) - names_.begin());
  }

  bool isTexture(const std::string& name) const {
    return parameters_.contains(name) || std::find(names_.begin(), names_.end(), name) != names_.end();
  }
  const std::string& textAt(std::size_t place) const { return written_[place]; }
  std::string next() const { return at_ + 1 < places_.size() ? textAt(at_ + 1) : ""; }

  std::vector<Token>& tokens_;
  std::vector<std::size_t> places_;
  std::vector<std::string> written_;  ///< at each place, before it was rewritten
  const std::vector<std::string>& names_;
  std::size_t at_ = 0;
  int depth_ = 0;
  std::vector<Call> calls_;
  std::set<std::string> parameters_;
  bool nextIsCounted_ = false;
  bool reads_ = false;
  bool discards_ = false;
  bool writesFragDepth_ = false;
};

std::string pixelCount(GLenum stage, std::size_t names, const ReadCounting& counting) {
  if (!counting.pixels || (stage != GL_FRAGMENT_SHADER && stage != GL_COMPUTE_SHADER)) return "";
  const char* pixel = stage == GL_FRAGMENT_SHADER ? "ivec2(gl_FragCoord.xy)" : "ivec2(gl_GlobalInvocationID.xy)";
  return fmt::format(
      "  ivec2 pixel = {};\n"
      "  if (all(lessThan(pixel, ivec2({}, {})))) atomicAdd(gnomonCounts[{} + pixel.y * {} + pixel.x], sum);\n",
      pixel, counting.pixels->x, counting.pixels->y, 2 * names, counting.pixels->x);
}

}  // namespace

std::vector<std::string> readableNames(const std::vector<std::string>& stages) {
  std::set<std::string> names;
  for (const std::string& text : stages) {
    const std::vector<Token> tokens = tokensOf(text);
    const std::vector<std::size_t> places = meaningful(tokens);
    const auto textAt = [&](std::size_t place) { return place < places.size() ? tokens[places[place]].text : ""; };
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (textAt(i) != "uniform") continue;
      bool ofTextures = false;
      for (++i; i < places.size() && textAt(i) != ";" && textAt(i) != "{"; ++i) {
        if (ofTextures && (textAt(i + 1) == ";" || textAt(i + 1) == ",")) names.insert(textAt(i));
        ofTextures |= isTextureType(textAt(i));
      }
    }
  }
  return {names.begin(), names.end()};
}

std::string instrumented(const std::string& text, GLenum stage, const std::vector<std::string>& names,
                         const ReadCounting& counting) {
  std::vector<Token> tokens = tokensOf(text);
  Rewriter rewriter(tokens, names);
  rewriter.rewrite();
  if (!rewriter.reads()) return text;

  const std::size_t count = std::max<std::size_t>(names.size(), 1);
  const bool early =
      stage == GL_FRAGMENT_SHADER && !rewriter.writesFragDepth() && (!rewriter.discards() || !counting.writesDepth);
  const std::string before = fmt::format(
      "{}layout(std430) buffer {} {{ uint gnomonCounts[]; }};\n"
      "uint gnomonReads[{}];\n"
      "bool gnomonRead(int which, uint texels) {{\n  gnomonReads[which] += texels;\n  return true;\n}}\n"
      "void gnomonFlush() {{\n"
      "  uint sum = 0u;\n"
      "  for (int i = 0; i < {}; ++i) {{\n"
      "    uint reads = gnomonReads[i];\n"
      "    if (reads == 0u) continue;\n"
      "    sum += reads;\n"
      "    uint low = atomicAdd(gnomonCounts[2 * i], reads);\n"
      "    if (low + reads < low) atomicAdd(gnomonCounts[2 * i + 1], 1u);\n"  // the sum of 32 bits went over
      "  }}\n{}}}\n",
      early ? "layout(early_fragment_tests) in;\n" : "", kReadsBlock, count, count, pixelCount(stage, names.size(), counting));
  const std::string after = fmt::format(
      "\nvoid main() {{\n  for (int i = 0; i < {}; ++i) gnomonReads[i] = 0u;\n  gnomonMain();\n  gnomonFlush();\n}}\n", count);

  std::string result;
  bool isBegun = false;
  for (const Token& token : tokens) {
    result += token.text;
    if (!isBegun && token.kind == Kind::directive && token.text.starts_with("#version")) {
      result += '\n' + before;
      isBegun = true;
    }
  }
  return result + after;
}

}  // namespace gnomon::gl
