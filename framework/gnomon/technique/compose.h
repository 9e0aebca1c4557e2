// The composer: a technique out of a projection, a representation and a footprint (design section 5.3).
#pragma once

#include <array>
#include <string>

#include "gnomon/technique/entry.h"

namespace gnomon {

/// "projection", "representation", "footprint".
const char* axisName(Axis axis);

/// The three, in the order of Axis.
using Components = std::array<const Component*, 3>;

/// An entry whose parameters are those of the three, in that order. Throws Error: components that make no sense together,
/// two that name a parameter alike.
Entry composedEntry(const std::string& name, const Components& components);

}  // namespace gnomon
