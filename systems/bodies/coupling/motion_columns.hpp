#pragma once
/// \file
/// (E92) What a unit of every motion of free bodies does to the divergence around every unknown.

#include "components/staggered.hpp"
#include "systems/ranks/site_exchange.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace minamo {

/// Columns over the unknowns, one for each motion of free bodies, three to an array as the solver takes them.
class MotionColumns {
 public:
  MotionColumns(Eigen::Index count, std::size_t rows)
      : count_(count), blocks_(static_cast<std::size_t>((count + width - 1) / width), Block(rows, Sources{})) {}

  using Block = std::vector<Sources>;
  Eigen::Index count() const { return count_; }
  std::size_t blocks() const { return blocks_.size(); }
  Block& block(std::size_t k) { return blocks_[k]; }
  const Block& block(std::size_t k) const { return blocks_[k]; }
  double& at(Eigen::Index k, std::size_t row) {
    return blocks_[static_cast<std::size_t>(k / width)][row][static_cast<std::size_t>(k % width)];
  }
  double at(Eigen::Index k, std::size_t row) const {
    return blocks_[static_cast<std::size_t>(k / width)][row][static_cast<std::size_t>(k % width)];
  }

 private:
  static constexpr Eigen::Index width = most_sources;
  Eigen::Index count_;
  std::vector<Block> blocks_;
};

template <class Matrix>
std::span<double> entries_of(Matrix& of) {
  return {of.data(), static_cast<std::size_t>(of.size())};
}

/// U = B C: what a unit of every motion adds to the divergence around an unknown.
struct Fluxes {
  MotionColumns columns;
  std::vector<std::size_t> touched;  ///< unknowns near free bodies that this rank owns
  const SiteExchange* shared = nullptr;

  /// U^T x, with x by unknown.
  template <class At>
  Eigen::VectorXd transposed_times(const At& x) const {
    Eigen::VectorXd product = Eigen::VectorXd::Zero(columns.count());
    for (const std::size_t l : touched) {
      for (Eigen::Index k = 0; k < columns.count(); ++k) product[k] += columns.at(k, l) * x(l);
    }
    add_up_on_all(shared, entries_of(product));
    return product;
  }
};

}  // namespace minamo
