#include "systems/linear/incomplete_lu.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// Of the largest entry of a row: smaller pivots have lost their digits.
constexpr double least_pivot = 1e-3;

}  // namespace

/// Subtracts multiples of the rows before it from a row.
void IncompleteLu::eliminate(std::size_t r) {
  auto& [begin, column, value] = factors_;
  for (std::uint32_t e = begin[r]; e < begin[r + 1]; ++e) place_[column[e]] = e + 1;
  double largest = 0;
  for (std::uint32_t e = begin[r]; e < begin[r + 1]; ++e) largest = std::max(largest, std::abs(value[e]));
  for (std::uint32_t e = begin[r]; e < diagonal_[r]; ++e) {
    const std::uint32_t k = column[e];
    value[e] *= per_pivot_[k];
    for (std::uint32_t f = diagonal_[k] + 1; f < begin[k + 1]; ++f) {
      if (place_[column[f]] > 0) value[place_[column[f]] - 1] -= value[e] * value[f];
    }
  }
  for (std::uint32_t e = begin[r]; e < begin[r + 1]; ++e) place_[column[e]] = 0;
  const double pivot = value[diagonal_[r]];
  per_pivot_[r] = 1 / (std::abs(pivot) > least_pivot * largest ? pivot : largest);
}

void IncompleteLu::factorize(const SparseRows& matrix) {
  factors_ = matrix;
  diagonal_.resize(matrix.rows());
  per_pivot_.resize(matrix.rows());
  place_.assign(matrix.rows(), 0);
  const auto& column = matrix.column;
  for (std::uint32_t r = 0; r < matrix.rows(); ++r) {
    const auto own = std::lower_bound(column.begin() + matrix.begin[r], column.begin() + matrix.begin[r + 1], r);
    diagonal_[r] = static_cast<std::uint32_t>(own - column.begin());
    eliminate(r);
  }
}

void IncompleteLu::solve(Values& b) const {
  const auto& [begin, column, value] = factors_;
  for (std::size_t r = 0; r < b.size(); ++r) {
    for (std::uint32_t e = begin[r]; e < diagonal_[r]; ++e) b[r] -= value[e] * b[column[e]];
  }
  for (std::size_t r = b.size(); r-- > 0;) {
    for (std::uint32_t e = diagonal_[r] + 1; e < begin[r + 1]; ++e) b[r] -= value[e] * b[column[e]];
    b[r] *= per_pivot_[r];
  }
}

}  // namespace minamo
