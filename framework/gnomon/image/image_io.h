// Picture files. The library that writes them is loaded on first use: it costs 0.2 s and 130 MB at start-up.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "gnomon/base/image.h"

namespace gnomon {

/// One plane of a picture of many; `image` has one channel.
struct NamedChannel {
  std::string name;  ///< "visibility", "normal.x"
  Image image;
};

using Metadata = std::vector<std::pair<std::string, std::string>>;

/// All channels are of one size.
struct ExrPicture {
  std::vector<NamedChannel> channels;  ///< in the file's order, which is not the order of writing
  Metadata metadata;                   ///< its text attributes, the format's own among them

  bool has(const std::string& name) const;
  /// Throws Error that lists the names if there is none of that name.
  const Image& channel(const std::string& name) const;
  /// Empty if there is none.
  std::string metadataValue(const std::string& key) const;
};

/// 8 bits, sRGB-encoded from linear values; 1 channel (grey) or 3 (RGB). Below 0 and NaN become 0, above 1 becomes 255.
/// Replaces the file atomically, creating its folder. Throws Error.
void writePng(const std::filesystem::path& path, const Image& linear);

/// 32-bit floats, losslessly compressed: bit for bit what is read back, NaN and infinity included. The same channels and
/// metadata give the same bytes. Replaces the file atomically, creating its folder. Throws Error.
void writeExr(const std::filesystem::path& path, const std::vector<NamedChannel>& channels, const Metadata& metadata = {});

/// The first part of an OpenEXR file, as floats. Throws Error on one that is damaged or huge.
ExrPicture readExr(const std::filesystem::path& path);

/// The sRGB transfer function of a linear value (IEC 61966-2-1), clamped to [0,1]; NaN becomes 0.
float encodeSrgb(float linear);

}  // namespace gnomon
