#include "allocation/counting.hpp"

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <new>

namespace {

// There is nobody to hand them to operator new. NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables)
std::atomic<std::int64_t> by_new{0};
std::atomic<std::int64_t> by_malloc{0};
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

}  // namespace

// The functions of glibc behind malloc() and its relatives, which a program may define anew.
extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier)
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* memory);
// NOLINTEND(bugprone-reserved-identifier)

void* malloc(std::size_t size) {
  ++by_malloc;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++by_malloc;
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) {
  ++by_malloc;
  return __libc_realloc(memory, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  ++by_malloc;
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++by_malloc;
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  ++by_malloc;
  *memory = __libc_memalign(alignment, size);
  return *memory == nullptr ? ENOMEM : 0;
}
}

// The forms for arrays and those that do not throw end here.
void* operator new(std::size_t size) {
  ++by_new;
  void* memory = __libc_malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  ++by_new;
  void* memory = __libc_memalign(static_cast<std::size_t>(alignment), size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void operator delete(void* memory) noexcept { __libc_free(memory); }
void operator delete(void* memory, std::size_t) noexcept { __libc_free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { __libc_free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { __libc_free(memory); }

namespace minamo::allocation {

Count count() { return {by_new, by_malloc}; }

}  // namespace minamo::allocation
