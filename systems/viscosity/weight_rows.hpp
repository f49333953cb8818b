#pragma once
/// \file
/// A sparse matrix that is made anew in every step, row by row: few weights in each.

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace minamo {

class WeightRows {
 public:
  struct Weight {
    std::uint32_t column;
    double value;
  };

  void clear() {
    begin_.assign(1, 0);
    weights_.clear();
  }
  void add(std::uint32_t column, double value) { weights_.push_back({column, value}); }
  void end_row() { begin_.push_back(weights_.size()); }

  std::size_t rows() const { return begin_.size() - 1; }
  std::span<const Weight> row(std::size_t k) const {
    return std::span(weights_).subspan(begin_[k], begin_[k + 1] - begin_[k]);
  }
  /// Becomes the transpose of another one, with as many rows as that has columns.
  void transpose(const WeightRows& other, std::size_t columns) {
    begin_.assign(columns + 1, 0);
    for (const Weight& weight : other.weights_) ++begin_[weight.column + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    next_.assign(begin_.begin(), begin_.end() - 1);
    weights_.resize(other.weights_.size());
    for (std::size_t k = 0; k < other.rows(); ++k) {
      for (const Weight& weight : other.row(k))
        weights_[next_[weight.column]++] = {static_cast<std::uint32_t>(k), weight.value};
    }
  }
  /// The sum of a row's weights times the values of its columns.
  template <class ValueAt>
  double sum(std::size_t k, const ValueAt& value_at) const {
    double sum = 0;
    for (const Weight& weight : row(k)) sum += weight.value * value_at(weight.column);
    return sum;
  }

 private:
  std::vector<std::size_t> begin_{0};
  std::vector<Weight> weights_;
  std::vector<std::size_t> next_;  ///< work space
};

}  // namespace minamo
