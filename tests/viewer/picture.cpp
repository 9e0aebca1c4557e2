#include "picture.h"

#include <algorithm>
#include <cstdlib>

#include "gnomon/base/error.h"
#include "gnomon/base/files.h"

namespace gnomon::test {

namespace {

/// Unpacks what zlib has packed (RFC 1951): the framework writes pictures and never reads them.
class Inflater {
 public:
  explicit Inflater(const std::string& packed) : packed_(packed) {}

  std::vector<std::uint8_t> run() {
    for (bool last = false; !last;) {
      last = bits(1) == 1;
      const int kind = bits(2);
      if (kind == 0) {
        stored();
      } else if (kind == 1) {
        std::vector<int> lengths(288, 8);
        std::fill(lengths.begin() + 144, lengths.begin() + 256, 9);
        std::fill(lengths.begin() + 256, lengths.begin() + 280, 7);
        block(Code(lengths), Code(std::vector<int>(30, 5)));
      } else {
        dynamic();
      }
    }
    return std::move(out_);
  }

 private:
  /// A canonical Huffman code from the lengths of its words.
  struct Code {
    explicit Code(const std::vector<int>& lengths) : count(16, 0) {
      for (const int length : lengths) ++count[static_cast<std::size_t>(length)];
      count[0] = 0;
      std::vector<int> first(16, 0);
      for (std::size_t i = 1; i < 15; ++i) first[i + 1] = first[i] + count[i];
      symbols.resize(lengths.size());
      for (std::size_t i = 0; i < lengths.size(); ++i) {
        const auto length = static_cast<std::size_t>(lengths[i]);
        if (length > 0) symbols[static_cast<std::size_t>(first[length]++)] = static_cast<int>(i);
      }
    }
    std::vector<int> count;
    std::vector<int> symbols;
  };

  int bits(int wanted) {
    int value = 0;
    for (int i = 0; i < wanted; ++i, ++at_) {
      if (at_ / 8 >= packed_.size()) throw Error("the picture ends too soon");
      value |= ((static_cast<unsigned char>(packed_[at_ / 8]) >> (at_ % 8)) & 1) << i;
    }
    return value;
  }

  int symbol(const Code& code) {
    int word = 0;
    int first = 0;
    int index = 0;
    for (std::size_t length = 1; length < 16; ++length) {
      word |= bits(1);
      if (word - first < code.count[length]) return code.symbols[static_cast<std::size_t>(index + word - first)];
      index += code.count[length];
      first = (first + code.count[length]) << 1;
      word <<= 1;
    }
    throw Error("the picture holds no such word");
  }

  void stored() {
    at_ = (at_ + 7) / 8 * 8;
    const int length = bits(16);
    bits(16);
    for (int i = 0; i < length; ++i) out_.push_back(static_cast<std::uint8_t>(bits(8)));
  }

  void dynamic() {
    const int literals = bits(5) + 257;
    const int distances = bits(5) + 1;
    const int used = bits(4) + 4;
    constexpr std::array<std::size_t, 19> kOrder{16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15};
    std::vector<int> small(19, 0);
    for (int i = 0; i < used; ++i) small[kOrder[static_cast<std::size_t>(i)]] = bits(3);
    const Code code(small);
    std::vector<int> lengths;
    while (lengths.size() < static_cast<std::size_t>(literals + distances)) {
      const int next = symbol(code);
      if (next < 16) {
        lengths.push_back(next);
      } else {
        const int value = next == 16 ? lengths.back() : 0;
        const int times = next == 16 ? 3 + bits(2) : next == 17 ? 3 + bits(3) : 11 + bits(7);
        lengths.insert(lengths.end(), static_cast<std::size_t>(times), value);
      }
    }
    block(Code({lengths.begin(), lengths.begin() + literals}), Code({lengths.begin() + literals, lengths.end()}));
  }

  void block(const Code& literals, const Code& distances) {
    constexpr std::array<int, 29> kLength{3,  4,  5,  6,  7,  8,  9,  10, 11,  13,  15,  17,  19,  23, 27,
                                          31, 35, 43, 51, 59, 67, 83, 99, 115, 131, 163, 195, 227, 258};
    constexpr std::array<int, 29> kLengthBits{0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2,
                                              2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0};
    constexpr std::array<int, 30> kDistance{1,    2,    3,    4,    5,    7,    9,    13,    17,    25,
                                            33,   49,   65,   97,   129,  193,  257,  385,   513,   769,
                                            1025, 1537, 2049, 3073, 4097, 6145, 8193, 12289, 16385, 24577};
    for (int next = symbol(literals); next != 256; next = symbol(literals)) {
      if (next < 256) {
        out_.push_back(static_cast<std::uint8_t>(next));
        continue;
      }
      const auto k = static_cast<std::size_t>(next - 257);
      const int length = kLength.at(k) + bits(kLengthBits.at(k));
      const auto d = static_cast<std::size_t>(symbol(distances));
      const auto back = static_cast<std::size_t>(kDistance.at(d) + bits(d < 4 ? 0 : static_cast<int>(d) / 2 - 1));
      if (back > out_.size()) throw Error("the picture refers to before its beginning");
      for (int i = 0; i < length; ++i) out_.push_back(out_[out_.size() - back]);
    }
  }

  const std::string& packed_;
  std::size_t at_ = 16;  // bits: behind zlib's two bytes
  std::vector<std::uint8_t> out_;
};

std::uint32_t bigEndian(const std::string& file, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(file.at(at + i));
  return value;
}

int predicted(int filter, int left, int up, int corner) {
  if (filter == 0) return 0;
  if (filter == 1) return left;
  if (filter == 2) return up;
  if (filter == 3) return (left + up) / 2;
  const int guess = left + up - corner;
  const int a = std::abs(guess - left);
  const int b = std::abs(guess - up);
  const int c = std::abs(guess - corner);
  return a <= b && a <= c ? left : b <= c ? up : corner;
}

}  // namespace

Picture::Pixel Picture::at(int x, int y) const {
  const std::size_t i = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  return {bytes.at(i), bytes.at(i + 1), bytes.at(i + 2)};
}

int Picture::count(const std::function<bool(const Pixel&)>& wanted) const {
  int found = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) found += wanted(at(x, y)) ? 1 : 0;
  }
  return found;
}

Picture readPicture(const std::filesystem::path& png) {
  const std::string file = readFile(png);
  std::string packed;
  Picture picture;
  for (std::size_t at = 8; at + 8 <= file.size();) {
    const std::size_t length = bigEndian(file, at);
    const std::string kind = file.substr(at + 4, 4);
    if (kind == "IHDR") {
      picture.width = static_cast<int>(bigEndian(file, at + 8));
      picture.height = static_cast<int>(bigEndian(file, at + 12));
      if (file.at(at + 16) != 8 || file.at(at + 17) != 2 || file.at(at + 20) != 0) throw Error("no plain RGB picture");
    }
    if (kind == "IDAT") packed += file.substr(at + 8, length);
    at += length + 12;
  }
  const std::vector<std::uint8_t> rows = Inflater(packed).run();
  const std::size_t stride = 3 * static_cast<std::size_t>(picture.width);
  picture.bytes.assign(stride * static_cast<std::size_t>(picture.height), 0);
  if (rows.size() != (stride + 1) * static_cast<std::size_t>(picture.height)) throw Error("the picture's rows are too few");
  for (std::size_t y = 0; y < static_cast<std::size_t>(picture.height); ++y) {
    std::uint8_t* to = &picture.bytes[y * stride];
    const auto before = [&](std::size_t x, bool left, bool up) {
      return (left && x < 3) || (up && y == 0) ? 0 : static_cast<int>(*(to + x - (left ? 3 : 0) - (up ? stride : 0)));
    };
    for (std::size_t x = 0; x < stride; ++x) {
      const int guess =
          predicted(rows[y * (stride + 1)], before(x, true, false), before(x, false, true), before(x, true, true));
      to[x] = static_cast<std::uint8_t>(rows[y * (stride + 1) + 1 + x] + guess);
    }
  }
  return picture;
}

int differing(const Picture& a, const Picture& b, int left, int top, int right, int bottom) {
  if (a.width != b.width || a.height != b.height) throw Error("pictures of two sizes");
  int count = 0;
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) count += a.at(x, y) != b.at(x, y) ? 1 : 0;
  }
  return count;
}

int differing(const Picture& a, const Picture& b) {
  return differing(a, b, 0, 0, a.width, a.height);
}

}  // namespace gnomon::test
