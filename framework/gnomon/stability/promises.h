// What every picture of visibility promises, whatever made it.
#pragma once

#include <string>

#include "gnomon/base/image.h"

namespace gnomon {

/// Empty where V is of the mask's size, finite, in [0,1], and 1 outside the receiver mask; else the first pixel that is not so,
/// how many are wrong, and what to do.
std::string visibilityFault(const Image& visibility, const Image& mask);

/// Also tells apart -0 from 0, and NaNs from each other.
bool sameBits(const Image& a, const Image& b);

}  // namespace gnomon
