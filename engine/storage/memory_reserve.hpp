#pragma once
/// \file
/// Memory set aside for the moment when there is no more: what a run that fails for want of it needs to leave a
/// checkpoint.

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

namespace minamo {

/// What writing a file by HDF5 takes at most, by far. HDF5 1.10 crashes where memory ends, so that it is asked for
/// before.
inline constexpr std::size_t memory_for_a_file = std::size_t{16} << 20;

/// \throws std::bad_alloc if there is not that much.
inline void require_memory(std::size_t bytes) {
  void* const probe = std::malloc(bytes);
  if (probe == nullptr) throw std::bad_alloc();
  // Through a volatile, or the compiler sees that nothing is done with it.
  *static_cast<volatile char*>(probe) = 0;
  std::free(probe);
}

class MemoryReserve {
 public:
  /// Twice what a file takes, so that there is room for it wherever the heap has been cut into pieces.
  MemoryReserve() { take(); }
  void release() { held_.reset(); }
  /// As far as there is memory.
  void take() { held_.reset(new (std::nothrow) std::byte[2 * memory_for_a_file]); }

 private:
  std::unique_ptr<std::byte[]> held_;
};

}  // namespace minamo
