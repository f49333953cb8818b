#pragma once
/// \file
/// Parallel loops and sums whose result does not depend on the number of threads.

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <cstddef>
#include <utility>

namespace minamo {

/// Rows handed to a thread at a time. Sums are added up in pieces of this size, whatever the number of threads.
inline constexpr std::size_t grain = 2048;

/// body(begin, end) for ranges that cover all rows; it may write what belongs to their rows only.
template <class Body>
void for_each_range(std::size_t rows, const Body& body, std::size_t rows_per_task = grain) {
  if (rows <= rows_per_task) {
    body(std::size_t{0}, rows);
    return;
  }
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, rows, rows_per_task),
      [&](const auto& range) { body(range.begin(), range.end()); }, tbb::simple_partitioner());
}

/// body(row) for every row; it may write what belongs to that row only.
template <class Body>
void for_each_row(std::size_t rows, const Body& body, std::size_t rows_per_task = grain) {
  for_each_range(
      rows,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row != end; ++row) body(row);
      },
      rows_per_task);
}

/// combine(... combine(start, value(0)) ..., value(rows - 1)) up to the order, which depends on `rows` alone.
template <class T, class Value, class Combine>
T reduce_rows(std::size_t rows, const T& start, const Value& value, const Combine& combine) {
  const auto of_range = [&](std::size_t begin, std::size_t end, T sum) {
    for (std::size_t row = begin; row != end; ++row) sum = combine(sum, value(row));
    return sum;
  };
  if (rows <= grain) return of_range(0, rows, start);
  return tbb::parallel_deterministic_reduce(
      tbb::blocked_range<std::size_t>(0, rows, grain), start,
      [&](const auto& range, T sum) { return of_range(range.begin(), range.end(), std::move(sum)); }, combine);
}

}  // namespace minamo
