#include "gnomon/measure/reference_cache.h"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <exception>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "gnomon/base/error.h"
#include "gnomon/base/files.h"
#include "gnomon/base/log.h"

namespace gnomon {
namespace {

// The file: magic, version, length of the key, key, rays and rays saved (64 bits each), width, height, number of pictures (2: A
// and B; 4: the standard error and V_cos too), the pictures (rows from the top), checksum of all before it. Other integers have
// 32 bits and numbers are 32-bit floats, all little-endian; the checksum is hashHex's 32 digits.
static_assert(std::endian::native == std::endian::little, "the cache's format is the memory's on little-endian machines");

constexpr std::string_view kMagic = "GNOMONRF";
constexpr std::uint32_t kVersion = 2;
constexpr std::size_t kChecksumDigits = 32;

template <class Integer>
void appendInteger(std::string& bytes, Integer value) {
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
  template <class Integer = std::uint32_t>
  Integer integer() {
    Integer value = 0;
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

KeptReference parse(std::string_view bytes, const std::string& key) {
  if (bytes.size() < kChecksumDigits) throw Error("it is cut short");
  const std::string_view content = bytes.substr(0, bytes.size() - kChecksumDigits);
  if (hashHex(content) != bytes.substr(content.size())) throw Error("its checksum does not match");
  Cursor cursor(content);
  if (cursor.take(kMagic.size()) != kMagic) throw Error("it is no reference file");
  const std::uint32_t version = cursor.integer();
  if (version != kVersion) throw Error(fmt::format("its format is version {}, must be {}", version, kVersion));
  if (cursor.take(cursor.integer()) != key) throw Error("it belongs to another key");
  KeptReference reference;
  reference.rays = cursor.integer<std::uint64_t>();
  reference.raysSaved = cursor.integer<std::uint64_t>();
  const std::uint32_t width = cursor.integer();
  const std::uint32_t height = cursor.integer();
  const std::uint32_t pictures = cursor.integer();
  if (pictures != 2 && pictures != 4) throw Error(fmt::format("it says that it holds {} pictures, must be 2 or 4", pictures));
  // Checked before anything is allocated; the products cannot overflow in 64 bits after the first division's bound.
  const std::size_t pixels = cursor.left() / (pictures * sizeof(float));
  const bool fits = width == 0 || height == 0 ? pixels == 0 : height <= pixels / width && std::size_t{width} * height == pixels;
  if (!fits || cursor.left() % (pictures * sizeof(float)) != 0) {
    throw Error(
        fmt::format("it holds {} bytes of pixels, which is not {} pictures of {}x{}", cursor.left(), pictures, width, height));
  }
  reference.halves.a = takeImage(cursor, width, height);
  reference.halves.b = takeImage(cursor, width, height);
  if (pictures == 4) {
    reference.standardError = takeImage(cursor, width, height);
    reference.cosineVisibility = takeImage(cursor, width, height);
  }
  return reference;
}

}  // namespace

std::filesystem::path referenceFile(const std::filesystem::path& directory, const std::string& key) {
  return directory / (hashHex(key) + ".reference");
}

std::optional<KeptReference> loadReference(const std::filesystem::path& directory, const std::string& key) {
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

void storeReference(const std::filesystem::path& directory, const std::string& key, const KeptReference& reference) {
  const Image& a = reference.halves.a;
  std::vector<const Image*> pictures{&a, &reference.halves.b};
  if (reference.standardError.pixels() > 0)
    pictures.insert(pictures.end(), {&reference.standardError, &reference.cosineVisibility});
  for (const Image* picture : pictures) {
    if (picture->width == a.width && picture->height == a.height && picture->channels == 1) continue;
    throw Error(fmt::format("reference cache: pictures of {}x{} and of {}x{} with {} channels; must be of one size with 1",
                            a.width, a.height, picture->width, picture->height, picture->channels));
  }
  std::string bytes(kMagic);
  appendInteger(bytes, kVersion);
  appendInteger(bytes, static_cast<std::uint32_t>(key.size()));
  bytes += key;
  appendInteger(bytes, reference.rays);
  appendInteger(bytes, reference.raysSaved);
  appendInteger(bytes, static_cast<std::uint32_t>(a.width));
  appendInteger(bytes, static_cast<std::uint32_t>(a.height));
  appendInteger(bytes, static_cast<std::uint32_t>(pictures.size()));
  for (const Image* picture : pictures) append(bytes, *picture);
  bytes += hashHex(bytes);
  writeFileAtomically(referenceFile(directory, key), bytes);
}

}  // namespace gnomon
