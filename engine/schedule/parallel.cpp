#include "engine/schedule/parallel.hpp"

#include <oneapi/tbb/parallel_for.h>

namespace minamo::detail {

void run_ranges(std::size_t rows, std::size_t rows_per_task, RangeBody body) {
  if (rows <= rows_per_task) {
    body.call(body.body, 0, rows);
    return;
  }
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, rows, rows_per_task),
      [&](const auto& range) { body.call(body.body, range.begin(), range.end()); }, tbb::simple_partitioner());
}

template double reduce_pieces(std::size_t rows, const double& start, const Summands<double>& all);

}  // namespace minamo::detail
