#pragma once
/// \file
/// The machine that a run happens on: threads, clocks, memory.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

namespace minamo {

/// Address space that OpenBLAS works in, 128 MiB, and what goes with it. [byte]
constexpr std::size_t blas_work_space = 160 << 20;

/// One thread in BLAS, since a second pool of threads next to ours only costs; and the work space that OpenBLAS
/// takes at its first call, now: where it does not get it, it tries again for ever, and no signal ends that. \return
/// whether it got it; what it took is no longer in available_memory().
bool prepare_blas();

/// Settles the number of threads of the program (0: one per processor) and keeps the allocator from working against it:
/// freed memory is kept, since a sparse solver maps and unmaps its work arrays at every call.
int prepare_threads(int wanted);

std::string cpu_model();

/// Largest resident memory of the process so far. [byte]
std::int64_t peak_memory();

/// Processor time of the process so far, all threads. [s]
double process_seconds();

/// Wall and processor time since its construction.
class Stopwatch {
 public:
  double wall_seconds() const;
  double cpu_seconds() const;  ///< of the process, all threads

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  double cpu_begin_ = process_seconds();
};

}  // namespace minamo
