// Changing a technique's parameters by keys.
#pragma once

#include "gnomon/base/table.h"

namespace gnomon {

/// One step up (steps > 0) or down: integers to the next that is allowed, sizes by a factor of 2, reals by a tenth of
/// themselves (from 0, to a tenth) or, on a logarithmic scale, by a tenth of a decade, choices and booleans to the next. Stays
/// within what the field allows. Returns whether anything changed.
bool stepValue(const Field& field, void* parameters, int steps);

}  // namespace gnomon
