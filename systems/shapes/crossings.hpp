#pragma once
/// \file
/// Points where the surface crosses the lines between sampled nodes, each once.

#include "engine/parallel.hpp"
#include "systems/shapes/marching.hpp"

#include <unordered_map>

namespace minamo {

template <int Dim>
class Crossings {
 public:
  Crossings(const SampledShape<Dim>& shape, const SampleNodes<Dim>& nodes)
      : shape_(shape), nodes_(nodes), inside_(nodes.size()) {
    for_each_row(inside_.size(), [&](std::size_t row) { inside_[row] = shape_.distance(nodes_.at(row)) <= 0 ? 1 : 0; });
  }

  bool inside(std::size_t row) const { return inside_[row] != 0; }

  /// The number of the point between two nodes, one inside and one outside.
  std::uint32_t between(std::size_t a, std::size_t b) {
    if (!inside(a)) std::swap(a, b);
    const auto [found, is_new] = number_.try_emplace(Ends{a, b}, static_cast<std::uint32_t>(ends_.size()));
    if (is_new) ends_.emplace_back(a, b);
    return found->second;
  }

  /// The points, found by halving.
  std::vector<Vec<Dim>> points() const {
    constexpr int halvings = 36;
    std::vector<Vec<Dim>> points(ends_.size());
    for_each_row(points.size(), [&](std::size_t k) {
      Vec<Dim> in = nodes_.at(ends_[k].first);
      Vec<Dim> out = nodes_.at(ends_[k].second);
      for (int n = 0; n < halvings; ++n) {
        const Vec<Dim> middle = 0.5 * (in + out);
        (shape_.distance(middle) <= 0 ? in : out) = middle;
      }
      points[k] = in;
    });
    return points;
  }

 private:
  using Ends = std::pair<std::size_t, std::size_t>;
  struct Hash {
    std::size_t operator()(const Ends& ends) const { return 1'000'003 * ends.first + ends.second; }
  };

  const SampledShape<Dim>& shape_;
  const SampleNodes<Dim>& nodes_;
  std::vector<std::uint8_t> inside_;
  std::unordered_map<Ends, std::uint32_t, Hash> number_;
  std::vector<Ends> ends_;  ///< inside, outside
};

}  // namespace minamo
