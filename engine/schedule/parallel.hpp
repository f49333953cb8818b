#pragma once
/// \file
/// Parallel loops and sums whose result does not depend on the number of threads.

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace minamo {

/// Rows handed to a thread at a time. Sums are added up in pieces of this size, whatever the number of threads.
inline constexpr std::size_t grain = 2048;

namespace detail {

/// The body of a loop without its type, so that TBB's tasks are compiled once, and the body once, not for every loop
/// twice. It is called for thousands of rows at a time.
struct RangeBody {
  const void* body;
  void (*call)(const void* body, std::size_t begin, std::size_t end);
};
void run_ranges(std::size_t rows, std::size_t rows_per_task, RangeBody body);

}  // namespace detail

/// body(begin, end) for ranges that cover all rows; it may write what belongs to their rows only.
template <class Body>
void for_each_range(std::size_t rows, const Body& body, std::size_t rows_per_task = grain) {
  detail::run_ranges(rows, rows_per_task, {&body, [](const void* typed, std::size_t begin, std::size_t end) {
                                             (*static_cast<const Body*>(typed))(begin, end);
                                           }});
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

/// The same where a row takes a microsecond and more, so that few of them are worth a task.
template <class Body>
void for_each_costly_row(std::size_t rows, const Body& body) {
  constexpr std::size_t tasks = 64;
  constexpr std::size_t least = 16;
  for_each_row(rows, body, std::clamp(rows / tasks, least, grain));
}

namespace detail {

/// What is summed up and how, without the types of both, for the same reason.
template <class T>
struct Summands {
  const void* summands;
  T (*add)(const void* summands, std::size_t begin, std::size_t end, T sum);
  T (*join)(const void* summands, const T& left, const T& right);
};

template <class T>
T reduce_pieces(std::size_t rows, const T& start, const Summands<T>& all) {
  if (rows <= grain) return all.add(all.summands, 0, rows, start);
  return tbb::parallel_deterministic_reduce(
      tbb::blocked_range<std::size_t>(0, rows, grain), start,
      [&](const auto& range, T sum) { return all.add(all.summands, range.begin(), range.end(), std::move(sum)); },
      [&](const T& left, const T& right) { return all.join(all.summands, left, right); });
}
extern template double reduce_pieces(std::size_t rows, const double& start, const Summands<double>& all);

}  // namespace detail

/// combine(... combine(start, value(0)) ..., value(rows - 1)) up to the order, which depends on `rows` alone.
template <class T, class Value, class Combine>
T reduce_rows(std::size_t rows, const T& start, const Value& value, const Combine& combine) {
  struct Both {
    const Value& value;
    const Combine& combine;
  };
  const Both both{value, combine};
  return detail::reduce_pieces<T>(rows, start,
                                  {&both,
                                   [](const void* summands, std::size_t begin, std::size_t end, T sum) {
                                     const Both& typed = *static_cast<const Both*>(summands);
                                     for (std::size_t row = begin; row != end; ++row)
                                       sum = typed.combine(sum, typed.value(row));
                                     return sum;
                                   },
                                   [](const void* summands, const T& left, const T& right) -> T {
                                     return static_cast<const Both*>(summands)->combine(left, right);
                                   }});
}

}  // namespace minamo
