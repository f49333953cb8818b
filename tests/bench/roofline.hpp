#pragma once
/// \file
/// How near a kernel comes to what the machine can do: bandwidth of a triad and peak of fused multiply-adds, measured
/// here, and a line of a table per kernel. What kernels must move and compute is in work.hpp.

#include "bench/work.hpp"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace minamo::roofline {

/// One, and two where the machine has them.
std::vector<int> thread_counts();

/// With `--benchmark-samples 1`: a look whether all of it works, on small boxes, whose figures mean nothing.
bool is_quick();

/// Median wall time of a call, over as many calls as `--benchmark-samples` says. [s]
double median_seconds(const std::function<void()>& body);

/// a_k = b_k + s c_k over arrays of so many bytes in all; 24 bytes per k, the best of several times. [B/s]
double triad_bandwidth(double bytes, int threads);

/// Multiply-adds of doubles in registers, two operations each. [1/s]
double multiply_add_peak(int threads);

/// A line of the table; the first one comes with the head.
struct Line {
  std::string kernel;
  int threads;
  std::size_t rows;  ///< particles or unknowns, by which the time is divided
  double seconds;
  Work work;
};
void print(const Line& line);

}  // namespace minamo::roofline
