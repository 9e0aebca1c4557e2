// Counts what this process takes from operator new, in the test program, the framework and its plugins.
#pragma once

#include <cstddef>

namespace gnomon::test {

/// Calls of operator new on any thread since the program started. The driver's own malloc is not seen.
std::size_t allocations();

}  // namespace gnomon::test
