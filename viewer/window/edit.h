// Changing a technique's parameters by keys.
#pragma once

#include "gnomon/base/table.h"

namespace gnomon {

/// One step up (steps > 0) or down: integers by 1, sizes by a factor of 2, reals by a tenth of themselves (from 0, to a tenth),
/// choices and booleans to the next. Stays in the field's range. Returns whether anything changed.
bool stepValue(const Field& field, void* parameters, int steps);

}  // namespace gnomon
