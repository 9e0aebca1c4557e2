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

namespace {
void* take(std::size_t size) noexcept {
  count.fetch_add(1, std::memory_order_relaxed);
  return std::malloc(size == 0 ? 1 : size);
}
void* takeOrThrow(std::size_t size) {
  if (void* p = take(size)) return p;
  throw std::bad_alloc();
}
}  // namespace

// The program's definitions replace the library's for every shared object too. All forms, since a sanitizer's own would not
// come through these; over-aligned types keep the library's.
void* operator new(std::size_t size) {
  return takeOrThrow(size);
}
void* operator new[](std::size_t size) {
  return takeOrThrow(size);
}
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
  return take(size);
}
void* operator new[](std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
  return take(size);
}
void operator delete(void* p) noexcept {
  std::free(p);
}
void operator delete[](void* p) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t /*size*/) noexcept {
  std::free(p);
}
void operator delete[](void* p, std::size_t /*size*/) noexcept {
  std::free(p);
}
void operator delete(void* p, const std::nothrow_t& /*tag*/) noexcept {
  std::free(p);
}
void operator delete[](void* p, const std::nothrow_t& /*tag*/) noexcept {
  std::free(p);
}
