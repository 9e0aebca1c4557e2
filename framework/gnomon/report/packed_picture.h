// Pictures small enough to lie in a page.
#pragma once

#include <string>

#include "gnomon/base/image.h"

namespace gnomon {

/// Of one channel: its half floats, row by row from the top, all low bytes before all high bytes (which deflates better),
/// deflated (zlib), in base64.
std::string packedPicture(const Image& image);

/// RFC 4648, with padding.
std::string base64(const std::string& bytes);

}  // namespace gnomon
