#include "systems/solve/envelope_lu.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <limits>

namespace minamo {

double envelope_cost(std::span<const std::uint32_t> first) {
  double sum = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const auto below = static_cast<double>(i - first[i]);
    sum += below * below;
  }
  return sum;
}

void EnvelopeLu::start(std::span<const std::uint32_t> first) {
  rows_ = first.size();
  const std::size_t tiles = (rows_ + width - 1) / width;
  first_.resize(tiles);
  start_.resize(tiles);
  place_tiles(first);
  inverse_lower_.resize(tiles);
  inverse_upper_.resize(tiles);
  x_.assign(tiles, Lanes::Zero());
  for (std::size_t i = rows_; i < width * tiles; ++i) at(i, i) = 1;  // fills up the last tile
}

void EnvelopeLu::place_tiles(std::span<const std::uint32_t> first) {
  std::fill(first_.begin(), first_.end(), std::numeric_limits<std::uint32_t>::max());
  for (std::size_t i = 0; i < rows_; ++i) {
    std::uint32_t& of_tile = first_[place(i).tile];
    of_tile = std::min(of_tile, first[i]);
  }
  for (std::uint32_t& of_tile : first_) of_tile = static_cast<std::uint32_t>(place(of_tile).tile);
  std::size_t size = 0;
  for (std::size_t j = 0; j < first_.size(); ++j) {
    start_[j] = size;
    size += j - first_[j] + 1;
  }
  lower_.assign(size, Tile::Zero());
  upper_.assign(size, Tile::Zero());
}

inline auto EnvelopeLu::column_of(const Tile& tile, std::size_t j) -> Lanes {
  return Eigen::Map<const Lanes>(tile.data() + width * j);
}

/// c += a b
inline void EnvelopeLu::add_product(const Tile& a, const Tile& b, Columns& c) {
  for (std::size_t k = 0; k < width; ++k) {
    const Lanes of_a = column_of(a, k);
    for (std::size_t j = 0; j < width; ++j) c[j] += of_a * b.data()[width * j + k];
  }
}

inline auto EnvelopeLu::product(const Tile& a, const Lanes& x) -> Lanes {
  return (column_of(a, 0) * x[0] + column_of(a, 1) * x[1]) + (column_of(a, 2) * x[2] + column_of(a, 3) * x[3]);
}

inline auto EnvelopeLu::product(const Tile& a, const Tile& b) -> Tile {
  Columns sum;
  sum.fill(Lanes::Zero());
  add_product(a, b, sum);
  Tile out;
  for (std::size_t j = 0; j < width; ++j) out.col(static_cast<Eigen::Index>(j)) = sum[j].matrix();
  return out;
}

/// from -= sum_k lower_k upper_k
inline void EnvelopeLu::subtract_products(const Tile* lower, const Tile* upper, std::size_t count, Tile& from) {
  Columns sum;
  sum.fill(Lanes::Zero());
  for (std::size_t k = 0; k < count; ++k) add_product(lower[k], upper[k], sum);
  for (std::size_t j = 0; j < width; ++j) from.col(static_cast<Eigen::Index>(j)).array() -= sum[j];
}

bool EnvelopeLu::invert_diagonal(std::size_t j) {
  Tile& tile = upper_[start_[j] + j - first_[j]];
  constexpr auto size = static_cast<Eigen::Index>(width);
  for (Eigen::Index k = 0; k < size; ++k) {
    const double pivot = tile(k, k);
    if (pivot == 0 || !std::isfinite(pivot)) return false;
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

/// What the columns and rows before tile j of the diagonal leave of its row and column.
void EnvelopeLu::eliminate_from(std::size_t j) {
  Tile* row_j = lower_.data() + start_[j];
  Tile* column_j = upper_.data() + start_[j];
  for (std::size_t i = first_[j]; i <= j; ++i) {
    const std::size_t common = std::max(first_[i], first_[j]);
    const std::size_t count = i - common;
    const Tile* row_i = lower_.data() + start_[i] + (common - first_[i]);
    const Tile* column_i = upper_.data() + start_[i] + (common - first_[i]);
    const std::size_t from = common - first_[j];
    const std::size_t at = i - first_[j];
    subtract_products(row_i, column_j + from, count, column_j[at]);
    if (i == j) return;
    subtract_products(row_j + from, column_i, count, row_j[at]);
    column_j[at] = product(inverse_lower_[i], column_j[at]);
    row_j[at] = product(row_j[at], inverse_upper_[i]);
  }
}

bool EnvelopeLu::factorize() {
  for (std::size_t j = 0; j < first_.size(); ++j) {
    eliminate_from(j);
    if (!invert_diagonal(j)) return false;
  }
  return true;
}

/// L^-1 x
void EnvelopeLu::eliminate() {
  for (std::size_t j = 0; j < first_.size(); ++j) {
    const Tile* row = lower_.data() + start_[j];
    Lanes sum = x_[j];
    for (std::size_t i = first_[j]; i < j; ++i) sum -= product(row[i - first_[j]], x_[i]);
    x_[j] = product(inverse_lower_[j], sum);
  }
}

/// U^-1 x
void EnvelopeLu::substitute() {
  for (std::size_t j = first_.size(); j-- > 0;) {
    const Tile* column = upper_.data() + start_[j];
    x_[j] = product(inverse_upper_[j], x_[j]);
    const Lanes x = x_[j];
    for (std::size_t i = j; i-- > first_[j];) x_[i] -= product(column[i - first_[j]], x);
  }
}

void EnvelopeLu::solve(Values& b) {
  for (std::size_t i = 0; i < rows_; ++i) x_[i / width][place(i).within] = b[i];
  eliminate();
  substitute();
  for (std::size_t i = 0; i < rows_; ++i) b[i] = x_[i / width][place(i).within];
}

}  // namespace minamo
