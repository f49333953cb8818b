#include "systems/linear/envelope_lu.hpp"

#include <Eigen/Dense>

#include <algorithm>

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
  const std::size_t tiles = (first.size() + width - 1) / width;
  first_.resize(tiles);
  start_.resize(tiles);
  x_.assign(tiles, Part::Zero());
  std::size_t size = 0;
  for (std::size_t j = 0; j < tiles; ++j) {
    const auto of_tile = first.subspan(width * j, std::min(width, first.size() - width * j));
    first_[j] = *std::min_element(of_tile.begin(), of_tile.end()) / width;
    start_[j] = size - first_[j];
    size += j - first_[j] + 1;
  }
  lower_.assign(size, Tile::Zero());
  upper_.assign(size, Tile::Zero());
  for (std::size_t i = first.size(); i < width * tiles; ++i) at(i, i) = 1;  // fills up the last tile
}

bool EnvelopeLu::factorize() {
  for (std::size_t j = 0; j < first_.size(); ++j) {
    for (std::size_t i = first_[j]; i <= j; ++i) {
      Tile above = Tile::Zero();
      Tile sum = Tile::Zero();
      for (std::size_t k = std::max(first_[i], first_[j]); k < i; ++k) {
        above.noalias() += lower_[start_[i] + k].lazyProduct(upper_[start_[j] + k]);
        sum.noalias() += lower_[start_[j] + k].lazyProduct(upper_[start_[i] + k]);
      }
      upper_[start_[j] + i] -= above;
      Tile& tile = lower_[start_[j] + i];
      tile = ((tile - sum) * upper_[start_[i] + i]).eval();
    }
    Tile& diagonal = upper_[start_[j] + j];
    diagonal = diagonal.partialPivLu().inverse().eval();
    if (!diagonal.allFinite()) return false;
  }
  return true;
}

void EnvelopeLu::solve(Values& b) {
  std::copy(b.begin(), b.end(), x_.data()->data());
  for (std::size_t j = 0; j < first_.size(); ++j) {
    for (std::size_t i = first_[j]; i < j; ++i) x_[j] -= lower_[start_[j] + i].lazyProduct(x_[i]);
  }
  for (std::size_t j = first_.size(); j-- > 0;) {
    x_[j] = (upper_[start_[j] + j] * x_[j]).eval();
    for (std::size_t i = first_[j]; i < j; ++i) x_[i] -= upper_[start_[j] + i].lazyProduct(x_[j]);
  }
  std::copy_n(x_.data()->data(), b.size(), b.begin());
}

}  // namespace minamo
