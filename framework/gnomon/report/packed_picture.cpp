#include "gnomon/report/packed_picture.h"

#include <zlib.h>

#include <cstdint>
#include <glm/gtc/packing.hpp>

#include "gnomon/base/error.h"

namespace gnomon {

std::string base64(const std::string& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8U | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : kDigits[three >> (18U - 6U * static_cast<unsigned>(k)) & 63U];
  }
  return text;
}

std::string packedPicture(const Image& image) {
  const std::size_t count = image.pixels();
  std::string bytes(2 * count, '\0');
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint16_t half = glm::packHalf1x16(image.data[i]);
    bytes[i] = static_cast<char>(half & 0xffU);
    bytes[count + i] = static_cast<char>(half >> 8U);
  }
  uLongf length = compressBound(bytes.size());
  std::string deflated(length, '\0');
  const int status = compress2(reinterpret_cast<Bytef*>(deflated.data()), &length,  // NOLINT: zlib's bytes
                               reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), Z_BEST_SPEED + 5);
  if (status != Z_OK) throw Error("a picture cannot be compressed: memory is short");
  deflated.resize(length);
  return base64(deflated);
}

}  // namespace gnomon
