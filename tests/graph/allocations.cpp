#include "allocations.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<std::size_t> count{0};
}

namespace gnomon::test {
std::size_t allocations() {
  return count.load(std::memory_order_relaxed);
}
}  // namespace gnomon::test

// The program's definitions replace the library's for every shared object too. Arrays and nothrow forms come through these;
// over-aligned types keep the library's own.
void* operator new(std::size_t size) {
  count.fetch_add(1, std::memory_order_relaxed);
  if (void* p = std::malloc(size == 0 ? 1 : size)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t /*size*/) noexcept {
  std::free(p);
}
