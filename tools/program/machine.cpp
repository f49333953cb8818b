#include "tools/program/machine.hpp"

#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <fstream>
#include <thread>

#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>

// There in the program only if its BLAS is OpenBLAS.
extern "C" void openblas_set_num_threads(int) __attribute__((weak));
extern "C" void dtrsv_(const char*, const char*, const char*, const int*, const double*, const int*, double*,
                       const int*);

namespace minamo {

bool prepare_blas() {
  if (!openblas_set_num_threads) return true;
  openblas_set_num_threads(1);
  void* const probe = mmap(nullptr, blas_work_space, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (probe == MAP_FAILED) return false;
  munmap(probe, blas_work_space);
  const int one = 1;
  const double factor = 1;
  double solution = 0;
  // A product of small matrices takes no work space on some processors; a triangular solve does on all.
  dtrsv_("L", "N", "N", &one, &factor, &one, &solution, &one);
  return true;
}

int prepare_threads(int wanted) {
  constexpr int gigabyte = 1 << 30;
  mallopt(M_MMAP_THRESHOLD, gigabyte);
  mallopt(M_TRIM_THRESHOLD, gigabyte);
  mallopt(M_TOP_PAD, 64 << 20);
  const int threads = wanted > 0 ? wanted : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  // Never lifted: at the end of a run that has run out of memory TBB would start a thread, could not, and would abort.
  static tbb::global_control* limit = nullptr;
  delete limit;
  limit = new tbb::global_control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  return threads;
}

std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::int64_t peak_memory() {
  // What getrusage() tells begins with the size of the process that started this one.
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::int64_t kibibytes = 0;
    if (word == "VmHWM:" && status >> kibibytes) return 1024 * kibibytes;
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{1024} * usage.ru_maxrss;
}

double process_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double Stopwatch::wall_seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

double Stopwatch::cpu_seconds() const { return process_seconds() - cpu_begin_; }

}  // namespace minamo
