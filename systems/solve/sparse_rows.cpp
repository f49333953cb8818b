#include "systems/solve/sparse_rows.hpp"

#include <algorithm>
#include <numeric>

namespace minamo {

void transpose(const SparseRows& matrix, SparseRows& out) {
  out.begin.assign(matrix.rows() + 1, 0);
  out.column.resize(matrix.column.size());
  out.value.resize(matrix.value.size());
  for (const std::uint32_t column : matrix.column) ++out.begin[column + 1];
  std::partial_sum(out.begin.begin(), out.begin.end(), out.begin.begin());
  for (std::size_t r = matrix.rows(); r-- > 0;) {
    for (std::uint32_t e = matrix.begin[r + 1]; e-- > matrix.begin[r];) {
      const std::uint32_t at = --out.begin[matrix.column[e] + 1];
      out.column[at] = static_cast<std::uint32_t>(r);
      out.value[at] = matrix.value[e];
    }
  }
  // What has been counted down are the beginnings, one place too late.
  std::rotate(out.begin.begin(), out.begin.begin() + 1, out.begin.end());
  out.begin.back() = static_cast<std::uint32_t>(matrix.column.size());
}

}  // namespace minamo
