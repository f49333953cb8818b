#include "systems/linear/envelope_cholesky.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace minamo {

double envelope_work(std::span<const std::uint32_t> first) {
  double sum = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const auto entries = static_cast<double>(i - first[i] + 1);
    sum += entries * entries;
  }
  return sum;
}

void EnvelopeCholesky::start(std::span<const std::uint32_t> first) {
  const std::size_t count = (first.size() + width - 1) / width;
  first_.assign(count, std::numeric_limits<std::uint32_t>::max());
  start_.resize(count);
  place_tiles(first);
  for (std::size_t i = first.size(); i < width * count; ++i) at(i, i) = 1;  // fills up the last tile
}

void EnvelopeCholesky::place_tiles(std::span<const std::uint32_t> first) {
  for (std::size_t i = 0; i < first.size(); ++i) {
    first_[i / width] = std::min(first_[i / width], first[i] / static_cast<std::uint32_t>(width));
  }
  std::size_t size = 0;
  for (std::size_t i = 0; i < first_.size(); ++i) {
    start_[i] = size;
    size += i - first_[i] + 1;
  }
  tiles_.assign(size, Tile{});
}

inline void EnvelopeCholesky::subtract_products(const Tile* a, const Tile* b, std::size_t count, Tile& c) {
  std::array<Row, width> even{};  // two sums each, so that one product need not wait for the one before
  std::array<Row, width> odd{};
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t m = 0; m < width; m += 2) {
      for (std::size_t j = 0; j < width; ++j) {
        even[j].lane += a[k].column(m) * b[k](j, m);
        odd[j].lane += a[k].column(m + 1) * b[k](j, m + 1);
      }
    }
  }
  for (std::size_t j = 0; j < width; ++j) c.set_column(j, c.column(j) - (even[j].lane + odd[j].lane));
}

/// a lower^T, in place
inline void EnvelopeCholesky::times_transposed(Tile& a, const Tile& lower) {
  const Tile before = a;
  for (std::size_t j = 0; j < width; ++j) {
    Four sum = before.column(0) * lower(j, 0);
    for (std::size_t k = 1; k <= j; ++k) sum += before.column(k) * lower(j, k);
    a.set_column(j, sum);
  }
}

/// From a symmetric tile the inverse of its Cholesky factor.
inline bool EnvelopeCholesky::invert_factor(Tile& a) {
  bool is_positive = true;
  for (std::size_t k = 0; k < width; ++k) {
    is_positive = is_positive && a(k, k) > 0 && std::isfinite(a(k, k));
    const double per_pivot = 1 / std::sqrt(a(k, k));
    for (std::size_t i = k + 1; i < width; ++i) a(i, k) *= per_pivot;
    for (std::size_t j = k + 1; j < width; ++j) {
      for (std::size_t i = j; i < width; ++i) a(i, j) -= a(i, k) * a(j, k);
    }
    a(k, k) = per_pivot;
  }
  for (std::size_t j = 0; j < width; ++j) {
    for (std::size_t i = 0; i < j; ++i) a(i, j) = 0;
    for (std::size_t i = j + 1; i < width; ++i) {
      double sum = 0;
      for (std::size_t k = j; k < i; ++k) sum += a(i, k) * a(k, j);
      a(i, j) = -sum * a(i, i);
    }
  }
  return is_positive;
}

bool EnvelopeCholesky::factorize() {
  for (std::size_t i = 0; i < first_.size(); ++i) {
    Tile* const row_i = tiles_.data() + start_[i];
    for (std::size_t j = first_[i]; j <= i; ++j) {
      const std::size_t common = std::max(first_[i], first_[j]);
      const Tile* const row_j = tiles_.data() + start_[j] + (common - first_[j]);
      Tile& tile = row_i[j - first_[i]];
      subtract_products(row_i + (common - first_[i]), row_j, j - common, tile);
      if (j < i) times_transposed(tile, tiles_[start_[j] + j - first_[j]]);
    }
    if (!invert_factor(row_i[i - first_[i]])) return false;
  }
  return true;
}

/// L^-1 x
void EnvelopeCholesky::eliminate(std::span<Row> x) const {
  for (std::size_t i = 0; i < first_.size(); ++i) {
    const Tile* tile = tiles_.data() + start_[i];
    Row* const x_i = x.data() + width * i;
    std::array<Row, width> sum{};
    std::copy_n(x_i, width, sum.data());
    for (std::size_t j = first_[i]; j < i; ++j, ++tile) {
      const Row* const x_j = x.data() + width * j;
      for (std::size_t k = 0; k < width; ++k) {
        for (std::size_t r = 0; r < width; ++r) sum[r].lane -= x_j[k].lane * (*tile)(r, k);
      }
    }
    for (std::size_t r = 0; r < width; ++r) {
      x_i[r].lane = sum[0].lane * (*tile)(r, 0);
      for (std::size_t k = 1; k <= r; ++k) x_i[r].lane += sum[k].lane * (*tile)(r, k);
    }
  }
}

/// L^-T x
void EnvelopeCholesky::substitute(std::span<Row> x) const {
  for (std::size_t i = first_.size(); i-- > 0;) {
    const Tile* tile = tiles_.data() + start_[i] + (i - first_[i]);
    Row* const x_i = x.data() + width * i;
    std::array<Row, width> sum{};
    for (std::size_t k = 0; k < width; ++k) {
      sum[k].lane = x_i[k].lane * (*tile)(k, k);
      for (std::size_t r = k + 1; r < width; ++r) sum[k].lane += x_i[r].lane * (*tile)(r, k);
    }
    std::copy_n(sum.data(), width, x_i);
    for (std::size_t j = i; j-- > first_[i];) {
      Row* const x_j = x.data() + width * j;
      --tile;
      for (std::size_t r = 0; r < width; ++r) {
        for (std::size_t k = 0; k < width; ++k) x_j[k].lane -= sum[r].lane * (*tile)(r, k);
      }
    }
  }
}

void EnvelopeCholesky::solve(std::span<Row> x) const {
  eliminate(x);
  substitute(x);
}

}  // namespace minamo
