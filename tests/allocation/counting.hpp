#pragma once
/// \file
/// Counts what a program asks of the heap: in C++ by operator new, and in C by malloc() and its relatives, as
/// SuiteSparse, Eigen's dynamic matrices and TBB do. In counting.cpp both are replaced for the whole program.

#include <cstdint>
#include <ostream>

namespace minamo::allocation {

struct Count {
  std::int64_t by_new = 0;
  std::int64_t by_malloc = 0;
  friend bool operator==(const Count&, const Count&) = default;
  friend Count operator-(const Count& x, const Count& y) { return {x.by_new - y.by_new, x.by_malloc - y.by_malloc}; }
  Count& operator+=(const Count& other) {
    by_new += other.by_new;
    by_malloc += other.by_malloc;
    return *this;
  }
  friend std::ostream& operator<<(std::ostream& out, const Count& count) {
    return out << count.by_new << " by new, " << count.by_malloc << " by malloc";
  }
};

/// Since the program began, in all threads.
Count count();

}  // namespace minamo::allocation
