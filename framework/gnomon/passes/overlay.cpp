#include "gnomon/passes/overlay.h"

#include <stb/stb_truetype.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "gnomon/base/error.h"
#include "gnomon/base/files.h"
#include "gnomon/gl/program.h"

// The font is part of the library: text needs no file at run time.
__asm__(
    ".section .rodata\n"
    ".global gnomon_font_begin\n"
    "gnomon_font_begin:\n"
    ".incbin \"" GNOMON_FONT_FILE
    "\"\n"
    ".byte 0\n"
    ".previous\n");
extern "C" const unsigned char gnomon_font_begin[];

namespace gnomon {

namespace {

/// Printable Latin-1, and what reports use beside it.
constexpr int kFirst = 32;
constexpr int kCount = 224;
constexpr std::array<int, 12> kSymbols{0x2013, 0x2014, 0x2022, 0x2026, 0x2190, 0x2191,
                                       0x2192, 0x2193, 0x2212, 0x2264, 0x2265, 0x25cf};

/// The next code point of UTF-8 text; malformed bytes are '?'.
int nextCodePoint(std::string_view text, std::size_t& i) {
  const auto first = static_cast<unsigned char>(text[i++]);
  const int extra = first < 0x80 ? 0 : first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : first >= 0xc0 ? 1 : -1;
  if (extra < 0 || i + static_cast<std::size_t>(extra) > text.size()) return '?';
  int code = extra == 0 ? first : first & (0x3f >> extra);
  for (int k = 0; k < extra; ++k) {
    const auto next = static_cast<unsigned char>(text[i]);
    if ((next & 0xc0U) != 0x80U) return '?';
    code = code << 6 | (next & 0x3f);
    ++i;
  }
  return code;
}

}  // namespace

struct Overlay::Font {
  float pixels = 0.0f;
  int atlasSize = 0;
  gl::TextureObject atlas;
  std::vector<stbtt_packedchar> latin, symbols;
  float ascent = 0.0f;
  float lineHeight = 0.0f;
  float advance = 0.0f;  // one for all: the face is monospaced

  explicit Font(float height) : pixels(height), latin(kCount), symbols(kSymbols.size()) {
    stbtt_fontinfo info;
    if (stbtt_InitFont(&info, gnomon_font_begin, 0) == 0) throw Error("the embedded font is damaged");
    int up = 0;
    int down = 0;
    int gap = 0;
    stbtt_GetFontVMetrics(&info, &up, &down, &gap);
    const float scale = stbtt_ScaleForPixelHeight(&info, pixels);
    ascent = std::round(static_cast<float>(up) * scale);
    lineHeight = std::ceil(static_cast<float>(up - down + gap) * scale * 1.15f);
    int advanceUnits = 0;
    stbtt_GetCodepointHMetrics(&info, 'M', &advanceUnits, nullptr);
    advance = std::round(static_cast<float>(advanceUnits) * scale);

    auto codes = kSymbols;
    std::array<stbtt_pack_range, 2> ranges{};
    ranges[0] = {pixels, kFirst, nullptr, kCount, latin.data(), 0, 0};
    ranges[1] = {pixels, 0, codes.data(), static_cast<int>(codes.size()), symbols.data(), 0, 0};
    std::vector<unsigned char> bitmap;
    for (atlasSize = 256; atlasSize <= 4096; atlasSize *= 2) {
      bitmap.assign(static_cast<std::size_t>(atlasSize) * static_cast<std::size_t>(atlasSize), 0);
      stbtt_pack_context context;
      stbtt_PackBegin(&context, bitmap.data(), atlasSize, atlasSize, 0, 1, nullptr);
      const int all = stbtt_PackFontRanges(&context, gnomon_font_begin, 0, ranges.data(), static_cast<int>(ranges.size()));
      stbtt_PackEnd(&context);
      if (all != 0) break;
    }
    atlas = gl::makeTexture2D(GL_R8, {atlasSize, atlasSize}, "font atlas");
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(atlas.name(), 0, 0, 0, atlasSize, atlasSize, GL_RED, GL_UNSIGNED_BYTE, bitmap.data());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  }

  const stbtt_packedchar& glyph(int code) const {
    if (code >= kFirst && code < kFirst + kCount) return latin[static_cast<std::size_t>(code - kFirst)];
    const auto symbol = std::find(kSymbols.begin(), kSymbols.end(), code);
    if (symbol != kSymbols.end()) return symbols[static_cast<std::size_t>(symbol - kSymbols.begin())];
    return latin['?' - kFirst];
  }
};

Overlay::Overlay(float fontPixels)
    : font_(std::make_unique<Font>(fontPixels)),
      program_(gl::makeProgram({{installationDirectory() / "shaders"}, {}},
                               {{GL_VERTEX_SHADER, "gnomon/overlay.vert"}, {GL_FRAGMENT_SHADER, "gnomon/overlay.frag"}}, {},
                               "overlay")),
      vertexArray_(gl::makeVertexArray("overlay")) {
  const GLuint vao = vertexArray_.name();
  glVertexArrayAttribFormat(vao, 0, 2, GL_FLOAT, GL_FALSE, offsetof(Vertex, position));
  glVertexArrayAttribFormat(vao, 1, 2, GL_FLOAT, GL_FALSE, offsetof(Vertex, atlas));
  glVertexArrayAttribFormat(vao, 2, 4, GL_FLOAT, GL_FALSE, offsetof(Vertex, colour));
  for (GLuint i = 0; i < 3; ++i) {
    glEnableVertexArrayAttrib(vao, i);
    glVertexArrayAttribBinding(vao, i, 0);
  }
}

Overlay::~Overlay() = default;

void Overlay::setFontPixels(float pixels) {
  if (font_->pixels != pixels) font_ = std::make_unique<Font>(pixels);
}

void Overlay::quad(glm::vec2 min, glm::vec2 max, glm::vec2 atlasMin, glm::vec2 atlasMax, glm::vec4 colour) {
  const Vertex a{min, atlasMin, colour};
  const Vertex b{{max.x, min.y}, {atlasMax.x, atlasMin.y}, colour};
  const Vertex c{{min.x, max.y}, {atlasMin.x, atlasMax.y}, colour};
  const Vertex d{max, atlasMax, colour};
  vertices_.insert(vertices_.end(), {a, b, c, c, b, d});
}

void Overlay::rectangle(glm::vec2 min, glm::vec2 max, glm::vec4 colour) {
  quad(min, max, glm::vec2(-1.0f), glm::vec2(-1.0f), colour);
}

void Overlay::line(glm::vec2 from, glm::vec2 to, float width, glm::vec4 colour) {
  const glm::vec2 along = to - from;
  const float length = glm::length(along);
  if (!(length > 0.0f)) return;
  const glm::vec2 side = glm::vec2(-along.y, along.x) * (0.5f * width / length);
  const glm::vec2 none(-1.0f);
  const Vertex a{from - side, none, colour};
  const Vertex b{to - side, none, colour};
  const Vertex c{from + side, none, colour};
  const Vertex d{to + side, none, colour};
  vertices_.insert(vertices_.end(), {a, b, c, c, b, d});
}

void Overlay::text(glm::vec2 at, std::string_view utf8, glm::vec4 colour) {
  // Whole pixels: letters are rasterised for them.
  glm::vec2 pen(std::round(at.x), std::round(at.y) + font_->ascent);
  const float left = pen.x;
  const float atlas = static_cast<float>(font_->atlasSize);
  for (std::size_t i = 0; i < utf8.size();) {
    const int code = nextCodePoint(utf8, i);
    if (code == '\n') {
      pen = {left, pen.y + font_->lineHeight};
      continue;
    }
    const stbtt_packedchar& g = font_->glyph(code);
    const glm::vec2 min(pen.x + std::round(g.xoff), pen.y + std::round(g.yoff));
    const glm::vec2 extent(g.x1 - g.x0, g.y1 - g.y0);
    quad(min, min + extent, glm::vec2(g.x0, g.y0) / atlas, glm::vec2(g.x1, g.y1) / atlas, colour);
    pen.x += font_->advance;
  }
}

float Overlay::textWidth(std::string_view utf8) const {
  float widest = 0.0f;
  float width = 0.0f;
  for (std::size_t i = 0; i < utf8.size();) {
    width = nextCodePoint(utf8, i) == '\n' ? 0.0f : width + font_->advance;
    widest = std::max(widest, width);
  }
  return widest;
}

std::string Overlay::wrapped(std::string_view utf8, float pixels) const {
  const auto room = static_cast<std::size_t>(std::max(1.0f, pixels / font_->advance));
  std::string out;
  std::string word;
  std::size_t column = 0;      // letters on the line, spaces too
  std::size_t wordLength = 0;  // letters, not bytes
  const auto breakLine = [&] {
    while (!out.empty() && out.back() == ' ') out.pop_back();
    out += '\n';
    column = 0;
  };
  const auto endWord = [&] {
    if (column > 0 && column + wordLength > room) breakLine();
    out += word;
    column += wordLength;
    word.clear();
    wordLength = 0;
  };
  for (std::size_t i = 0; i < utf8.size();) {
    const std::size_t start = i;
    const int code = nextCodePoint(utf8, i);
    if (code == '\n') {
      endWord();
      breakLine();
    } else if (code == ' ') {
      endWord();
      if (column >= room) {
        breakLine();
      } else if (column > 0) {
        out += ' ';
        ++column;
      }
    } else {
      if (wordLength == room) endWord();
      word += utf8.substr(start, i - start);
      ++wordLength;
    }
  }
  endWord();
  return out;
}

float Overlay::lineHeight() const {
  return font_->lineHeight;
}

void Overlay::draw(glm::ivec2 size) {
  if (vertices_.empty()) return;
  const std::size_t bytes = vertices_.size() * sizeof(Vertex);
  if (bytes > capacity_) {
    capacity_ = 2 * bytes;
    buffer_ = gl::makeBuffer(capacity_, nullptr, "overlay");
    glVertexArrayVertexBuffer(vertexArray_.name(), 0, buffer_.name(), 0, sizeof(Vertex));
  }
  glNamedBufferSubData(buffer_.name(), 0, static_cast<GLsizeiptr>(bytes), vertices_.data());
  glViewport(0, 0, size.x, size.y);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glUseProgram(program_.name());
  glProgramUniform2f(program_.name(), glGetUniformLocation(program_.name(), "size"), static_cast<float>(size.x),
                     static_cast<float>(size.y));
  glBindTextureUnit(0, font_->atlas.name());
  glBindSampler(0, 0);
  glBindVertexArray(vertexArray_.name());
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices_.size()));
  glDisable(GL_BLEND);
  vertices_.clear();
}

}  // namespace gnomon
