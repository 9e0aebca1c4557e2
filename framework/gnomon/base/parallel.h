// Work over all cores.
#pragma once

#include <cstddef>
#include <functional>

namespace gnomon {

/// Calls `body(i)` once for each i in [0, count) from as many threads as there are cores; returns when all are done.
/// The first exception of a body is thrown again here; the others' remaining work is dropped.
void parallelFor(std::size_t count, const std::function<void(std::size_t)>& body);

}  // namespace gnomon
