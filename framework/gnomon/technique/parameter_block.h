// The uniform block that shaders #include as "parameters": generated from a technique's table.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "gnomon/base/table.h"
#include "gnomon/graph/passes.h"

namespace gnomon {

/// Text of the block `Parameters` (std140) with one member for each field bound as uniform; dots in names become underscores.
std::string parameterBlockText(const FieldTable& table);
/// Its contents. Never empty, so that a buffer can hold it.
std::vector<std::byte> parameterBlockBytes(const FieldTable& table, const void* parameters);
/// A constant for each field bound as specialise: NAME in capitals; a choice is its index.
std::vector<Constant> parameterConstants(const FieldTable& table, const void* parameters);

}  // namespace gnomon
