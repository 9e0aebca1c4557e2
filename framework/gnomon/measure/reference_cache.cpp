#include "gnomon/measure/reference_cache.h"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <exception>
#include <string_view>
#include <system_error>
#include <utility>

#include "gnomon/base/error.h"
#include "gnomon/base/files.h"
#include "gnomon/base/log.h"

namespace gnomon {
namespace {

// The file: magic, version, length of the key, key, width, height, A, B (rows from the top), checksum of all before it.
// Integers are 32-bit and numbers 32-bit floats, both little-endian; the checksum is hashHex's 32 digits.
static_assert(std::endian::native == std::endian::little, "the cache's format is the memory's on little-endian machines");

constexpr std::string_view kMagic = "GNOMONRF";
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kChecksumDigits = 32;

void append(std::string& bytes, std::uint32_t value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void append(std::string& bytes, const Image& image) {
  bytes.append(reinterpret_cast<const char*>(image.data.data()), image.data.size() * sizeof(float));
}

/// Takes values off the front of a file that may be cut anywhere.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : rest_(bytes) {}

  std::string_view take(std::size_t count) {
    if (count > rest_.size()) throw Error("it is cut short");
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return taken;
  }
  std::uint32_t integer() {
    std::uint32_t value = 0;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  std::size_t left() const { return rest_.size(); }

 private:
  std::string_view rest_;
};

Image takeImage(Cursor& cursor, std::uint32_t width, std::uint32_t height) {
  Image image(static_cast<int>(width), static_cast<int>(height));
  const std::size_t bytes = image.data.size() * sizeof(float);
  const std::string_view taken = cursor.take(bytes);
  if (bytes > 0) std::memcpy(image.data.data(), taken.data(), bytes);  // an empty vector may have no address
  return image;
}

ReferencePair parse(std::string_view bytes, const std::string& key) {
  if (bytes.size() < kChecksumDigits) throw Error("it is cut short");
  const std::string_view content = bytes.substr(0, bytes.size() - kChecksumDigits);
  if (hashHex(content) != bytes.substr(content.size())) throw Error("its checksum does not match");
  Cursor cursor(content);
  if (cursor.take(kMagic.size()) != kMagic) throw Error("it is no reference file");
  const std::uint32_t version = cursor.integer();
  if (version != kVersion) throw Error(fmt::format("its format is version {}, must be {}", version, kVersion));
  if (cursor.take(cursor.integer()) != key) throw Error("it belongs to another key");
  const std::uint32_t width = cursor.integer();
  const std::uint32_t height = cursor.integer();
  // Checked before anything is allocated; the products cannot overflow in 64 bits after the first division's bound.
  const std::size_t pixels = cursor.left() / (2 * sizeof(float));
  const bool fits = width == 0 || height == 0 ? pixels == 0 : height <= pixels / width && std::size_t{width} * height == pixels;
  if (!fits || cursor.left() % (2 * sizeof(float)) != 0) {
    throw Error(fmt::format("it holds {} bytes of pixels, which is not two halves of {}x{}", cursor.left(), width, height));
  }
  Image a = takeImage(cursor, width, height);
  Image b = takeImage(cursor, width, height);
  return {std::move(a), std::move(b)};
}

}  // namespace

std::filesystem::path referenceFile(const std::filesystem::path& directory, const std::string& key) {
  return directory / (hashHex(key) + ".reference");
}

std::optional<ReferencePair> loadReference(const std::filesystem::path& directory, const std::string& key) {
  const std::filesystem::path file = referenceFile(directory, key);
  std::error_code ignored;  // a folder that cannot be looked into has no reference for us
  if (!std::filesystem::exists(file, ignored)) return std::nullopt;
  try {
    return parse(readFile(file), key);
  } catch (const std::exception& error) {
    log::warning(fmt::format("reference cache: {} is made again: {}", file.string(), error.what()));
    return std::nullopt;
  }
}

void storeReference(const std::filesystem::path& directory, const std::string& key, const ReferencePair& pair) {
  if (pair.a.width != pair.b.width || pair.a.height != pair.b.height || pair.a.channels != 1 || pair.b.channels != 1) {
    throw Error(fmt::format("reference cache: halves of {}x{} with {} channels and {}x{} with {}; must be of one size with 1",
                            pair.a.width, pair.a.height, pair.a.channels, pair.b.width, pair.b.height, pair.b.channels));
  }
  std::string bytes(kMagic);
  append(bytes, kVersion);
  append(bytes, static_cast<std::uint32_t>(key.size()));
  bytes += key;
  append(bytes, static_cast<std::uint32_t>(pair.a.width));
  append(bytes, static_cast<std::uint32_t>(pair.a.height));
  append(bytes, pair.a);
  append(bytes, pair.b);
  bytes += hashHex(bytes);
  writeFileAtomically(referenceFile(directory, key), bytes);
}

}  // namespace gnomon
