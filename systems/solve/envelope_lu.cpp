#include "systems/solve/envelope_lu.hpp"

#include <Eigen/Dense>

#include <algorithm>

namespace minamo {

namespace {

/// term(first) + ... + term(first + Count - 1), the sums of halves first: independent of one another for longest.
template <std::size_t Count, class Term>
inline auto pairwise_sum(std::size_t first, const Term& term) {
  if constexpr (Count == 1) {
    return term(first).eval();
  } else {
    return (pairwise_sum<Count / 2>(first, term) + pairwise_sum<Count / 2>(first + Count / 2, term)).eval();
  }
}

}  // namespace

double envelope_cost(const std::vector<std::uint32_t>& first) {
  double sum = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const auto below = static_cast<double>(i - first[i]);
    sum += below * below;
  }
  return sum;
}

template <class Scalar>
void EnvelopeLu<Scalar>::start(const std::vector<std::uint32_t>& first) {
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

template <class Scalar>
inline auto EnvelopeLu<Scalar>::column_of(const Tile& tile, std::size_t j) -> Lanes {
  return Eigen::Map<const Lanes>(tile.data() + width * j);
}

/// c += a b
template <class Scalar>
inline void EnvelopeLu<Scalar>::add_product(const Tile& a, const Tile& b, Columns& c) {
  for (std::size_t k = 0; k < width; ++k) {
    const Lanes of_a = column_of(a, k);
    for (std::size_t j = 0; j < width; ++j) c[j] += of_a * b.data()[width * j + k];
  }
}

template <class Scalar>
inline auto EnvelopeLu<Scalar>::product(const Tile& a, const Lanes& x) -> Lanes {
  return pairwise_sum<width>(0,
                             [&](std::size_t k) -> Lanes { return column_of(a, k) * x[static_cast<Eigen::Index>(k)]; });
}

template <class Scalar>
inline auto EnvelopeLu<Scalar>::product(const Tile& a, const Tile& b) -> Tile {
  Columns sum;
  sum.fill(Lanes::Zero());
  add_product(a, b, sum);
  Tile out;
  for (std::size_t j = 0; j < width; ++j) out.col(static_cast<Eigen::Index>(j)) = sum[j].matrix();
  return out;
}

/// from - sum_k lower_k upper_k
template <class Scalar>
inline auto EnvelopeLu<Scalar>::eliminated(const Tile& from, const Tile* lower, const Tile* upper, std::size_t count)
    -> Tile {
  Columns sum;
  sum.fill(Lanes::Zero());
  for (std::size_t k = 0; k < count; ++k) add_product(lower[k], upper[k], sum);
  Tile out;
  for (std::size_t j = 0; j < width; ++j) {
    out.col(static_cast<Eigen::Index>(j)) = (column_of(from, j) - sum[j]).matrix();
  }
  return out;
}

template <class Scalar>
bool EnvelopeLu<Scalar>::invert_diagonal(std::size_t j, const std::array<Scalar, width>& least) {
  Tile& tile = upper_[start_[j] + j - first_[j]];
  constexpr auto size = static_cast<Eigen::Index>(width);
  for (Eigen::Index k = 0; k < size; ++k) {
    const Scalar pivot = tile(k, k);
    if (!(std::abs(pivot) > least[static_cast<std::size_t>(k)]) || !std::isfinite(pivot)) return false;
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
      Scalar sum = 0;
      for (Eigen::Index k = i + 1; k <= c; ++k) sum += tile(i, k) * upper(k, c);
      upper(i, c) = -sum / tile(i, i);
    }
  }
  inverse_lower_[j] = lower;
  inverse_upper_[j] = upper;
  return true;
}

template <class Scalar>
bool EnvelopeLu<Scalar>::factorize(double least) {
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
    std::array<Scalar, width> least_pivot;
    for (std::size_t k = 0; k < width; ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      least_pivot[k] = static_cast<Scalar>(least) * std::abs(diagonal(i, i));
    }
    diagonal = eliminated(diagonal, row_j, column_j, j - first_[j]);
    if (!invert_diagonal(j, least_pivot)) return false;
  }
  return true;
}

template <class Scalar>
void EnvelopeLu<Scalar>::solve(Values& b) {
  const std::size_t tiles = first_.size();
  x_.back().setZero();
  for (std::size_t i = 0; i < rows_; ++i)
    x_[i / width][static_cast<Eigen::Index>(i % width)] = static_cast<Scalar>(b[i]);
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

template class EnvelopeLu<float>;
template class EnvelopeLu<double>;

}  // namespace minamo
