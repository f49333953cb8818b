#include "systems/solve/envelope_lu.hpp"

#include <Eigen/Dense>

#include <algorithm>

namespace minamo {

double EnvelopeLu::cost(const std::vector<std::uint32_t>& first) {
  double sum = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const auto below = static_cast<double>(i - first[i]);
    sum += below * below;
  }
  return sum;
}

void EnvelopeLu::start(const std::vector<std::uint32_t>& first) {
  rows_ = first.size();
  const std::size_t tiles = (rows_ + width - 1) / width;
  first_.resize(tiles);
  start_.resize(tiles);
  std::size_t size = 0;
  for (std::size_t j = 0; j < tiles; ++j) {
    const auto begin = first.begin() + static_cast<std::ptrdiff_t>(width * j);
    const auto end = first.begin() + static_cast<std::ptrdiff_t>(std::min(width * (j + 1), rows_));
    first_[j] = *std::min_element(begin, end) / static_cast<std::uint32_t>(width);
    start_[j] = size;
    size += j - first_[j] + 1;
  }
  lower_.assign(size, Tile::Zero());
  upper_.assign(size, Tile::Zero());
  inverse_lower_.resize(tiles);
  inverse_upper_.resize(tiles);
  x_.resize(tiles);
  for (std::size_t i = rows_; i < width * tiles; ++i) at(i, i) = 1;
}

EnvelopeLu::Columns EnvelopeLu::columns(const Tile& tile) {
  return {tile.col(0).array(), tile.col(1).array(), tile.col(2).array(), tile.col(3).array()};
}

/// c -= a b
inline void EnvelopeLu::subtract_product(const Tile& a, const Tile& b, Columns& c) {
  const Columns of_a = columns(a);
  for (std::size_t j = 0; j < width; ++j) {
    const double* of_b = b.data() + width * j;
    c[j] -= (of_a[0] * of_b[0] + of_a[1] * of_b[1]) + (of_a[2] * of_b[2] + of_a[3] * of_b[3]);
  }
}

inline EnvelopeLu::Lanes EnvelopeLu::product(const Tile& a, const Lanes& x) {
  const Columns of_a = columns(a);
  return (of_a[0] * x[0] + of_a[1] * x[1]) + (of_a[2] * x[2] + of_a[3] * x[3]);
}

inline EnvelopeLu::Tile EnvelopeLu::product(const Tile& a, const Columns& b) {
  Tile out;
  for (std::size_t j = 0; j < width; ++j) out.col(static_cast<Eigen::Index>(j)) = product(a, b[j]).matrix();
  return out;
}

inline EnvelopeLu::Tile EnvelopeLu::product(const Columns& a, const Tile& b) {
  Tile out;
  for (std::size_t j = 0; j < width; ++j) {
    const double* of_b = b.data() + width * j;
    out.col(static_cast<Eigen::Index>(j)) =
        ((a[0] * of_b[0] + a[1] * of_b[1]) + (a[2] * of_b[2] + a[3] * of_b[3])).matrix();
  }
  return out;
}

/// from - sum_k lower_k upper_k
inline EnvelopeLu::Columns EnvelopeLu::eliminated(const Tile& from, const Tile* lower, const Tile* upper,
                                                  std::size_t count) const {
  Columns sum = columns(from);
  for (std::size_t k = 0; k < count; ++k) subtract_product(lower[k], upper[k], sum);
  return sum;
}

bool EnvelopeLu::invert_diagonal(std::size_t j) {
  Tile& tile = upper_[start_[j] + j - first_[j]];
  constexpr auto size = static_cast<Eigen::Index>(width);
  for (Eigen::Index k = 0; k < size; ++k) {
    const double pivot = tile(k, k);
    if (!(std::abs(pivot) > 0) || !std::isfinite(pivot)) return false;
    for (Eigen::Index i = k + 1; i < size; ++i) {
      tile(i, k) /= pivot;
      for (Eigen::Index l = k + 1; l < size; ++l) tile(i, l) -= tile(i, k) * tile(k, l);
    }
  }
  // Column by column of L^-1 and U^-1.
  Tile lower = Tile::Identity();
  Tile upper = Tile::Zero();
  for (Eigen::Index c = 0; c < size; ++c) {
    for (Eigen::Index i = c + 1; i < size; ++i) {
      for (Eigen::Index k = c; k < i; ++k) lower(i, c) -= tile(i, k) * lower(k, c);
    }
    upper(c, c) = 1 / tile(c, c);
    for (Eigen::Index i = c; i-- > 0;) {
      double sum = 0;
      for (Eigen::Index k = i + 1; k <= c; ++k) sum += tile(i, k) * upper(k, c);
      upper(i, c) = -sum / tile(i, i);
    }
  }
  inverse_lower_[j] = lower;
  inverse_upper_[j] = upper;
  return true;
}

bool EnvelopeLu::factorize() {
  for (std::size_t j = 0; j < first_.size(); ++j) {
    Tile* row_j = lower_.data() + start_[j];
    Tile* column_j = upper_.data() + start_[j];
    for (std::size_t i = first_[j]; i < j; ++i) {
      const std::size_t common = std::max(first_[i], first_[j]);
      const Tile* row_i = lower_.data() + start_[i] + (common - first_[i]);
      const Tile* column_i = upper_.data() + start_[i] + (common - first_[i]);
      const std::size_t from = common - first_[j];
      const std::size_t at = i - first_[j];
      column_j[at] = product(inverse_lower_[i], eliminated(column_j[at], row_i, column_j + from, i - common));
      row_j[at] = product(eliminated(row_j[at], row_j + from, column_i, i - common), inverse_upper_[i]);
    }
    Tile& diagonal = column_j[j - first_[j]];
    const Columns rest = eliminated(diagonal, row_j, column_j, j - first_[j]);
    for (std::size_t c = 0; c < width; ++c) diagonal.col(static_cast<Eigen::Index>(c)) = rest[c].matrix();
    if (!invert_diagonal(j)) return false;
  }
  return true;
}

void EnvelopeLu::solve(Values& b) {
  const std::size_t tiles = first_.size();
  x_.back().setZero();
  for (std::size_t i = 0; i < rows_; ++i) x_[i / width][static_cast<Eigen::Index>(i % width)] = b[i];
  for (std::size_t j = 0; j < tiles; ++j) {
    const Tile* row = lower_.data() + start_[j];
    Lanes sum = x_[j];
    for (std::size_t i = first_[j]; i < j; ++i) sum -= product(row[i - first_[j]], x_[i]);
    x_[j] = product(inverse_lower_[j], sum);
  }
  for (std::size_t j = tiles; j-- > 0;) {
    const Tile* column = upper_.data() + start_[j];
    x_[j] = product(inverse_upper_[j], x_[j]);
    for (std::size_t i = first_[j]; i < j; ++i) x_[i] -= product(column[i - first_[j]], x_[j]);
  }
  for (std::size_t i = 0; i < rows_; ++i) b[i] = x_[i / width][static_cast<Eigen::Index>(i % width)];
}

}  // namespace minamo
