#pragma once
/// \file
/// Points where the surface crosses the lines between sampled nodes, each once.

#include "engine/schedule/parallel.hpp"
#include "systems/shapes/marching.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace minamo {

/// The last place in [0, 1] where a function is not positive, to 2^-36: it is at 0 and is not at 1. By the ITP method
/// (I. F. D. Oliveira, R. H. C. Takahashi, ACM TOMS 47 (2020) 5), which takes a few steps where the function is smooth
/// and one more than halving at worst.
template <class Function>
double last_inside(const Function& function) {
  constexpr double tolerance = 0x1p-37;  // half of what is left in the end
  double in = 0;
  double out = 1;
  double f_in = function(in);
  double f_out = function(out);
  if (f_in >= 0) return in;
  if (f_out <= 0) return out;
  // As far from the middle as a step may be without costing more than one halving in all.
  for (double reach = 1; out - in > 2 * tolerance; reach /= 2) {
    const double half = 0.5 * (in + out);
    const double slack = reach - 0.5 * (out - in);
    const double straight = in + (out - in) * (f_in / (f_in - f_out));
    const double toward = half < straight ? -1 : 1;
    const double nudge = 0.2 * (out - in) * (out - in);
    const double nudged = nudge <= std::abs(half - straight) ? straight + toward * nudge : half;
    const double next = std::abs(nudged - half) <= slack ? nudged : half - toward * slack;
    const double f = function(next);
    (f <= 0 ? in : out) = next;
    (f <= 0 ? f_in : f_out) = f;
  }
  return in;
}

template <int Dim>
class Crossings {
 public:
  Crossings(const SampledShape<Dim>& shape, const SampleNodes<Dim>& nodes)
      : shape_(shape), nodes_(nodes), inside_(nodes.size()), place_(nodes.size(), none), way_(ways_in(nodes)) {
    for_each_row(inside_.size(), [&](std::size_t row) {
      inside_[row] = (shape_.inside ? shape_.inside(row) : shape_.distance(nodes_.at(row)) <= 0) ? 1 : 0;
    });
  }

  bool inside(std::size_t row) const { return inside_[row] != 0; }

  /// The number of the point between two nodes of a box of the lattice, one inside and one outside.
  std::uint32_t between(std::size_t a, std::size_t b) {
    if (!inside(a)) std::swap(a, b);
    std::uint32_t& number = number_of(std::min(a, b), std::max(a, b));
    if (number == none) {
      number = static_cast<std::uint32_t>(ends_.size());
      ends_.emplace_back(a, b);
    }
    return number;
  }

  std::vector<Vec<Dim>> points() const {
    std::vector<Vec<Dim>> points(ends_.size());
    for_each_row(points.size(), [&](std::size_t k) {
      const Vec<Dim> in = nodes_.at(ends_[k].first);
      const Vec<Dim> way = nodes_.at(ends_[k].second) - in;
      const auto distance = [&](double share) { return shape_.distance(in + share * way); };
      points[k] = in + (shape_.share ? shape_.share(ends_[k].first, ends_[k].second) : last_inside(distance)) * way;
    });
    return points;
  }

 private:
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  static constexpr std::size_t ways = (std::size_t{1} << static_cast<std::size_t>(Dim)) - 1;  // to nodes that follow
  using Numbers = std::array<std::uint32_t, ways>;

  /// Of the point on the line between a node and one of those that follow it along the axes.
  std::uint32_t& number_of(std::size_t low, std::size_t high) {
    std::uint32_t& place = place_[low];
    if (place == none) {
      place = static_cast<std::uint32_t>(numbers_.size());
      numbers_.emplace_back().fill(none);
    }
    const auto way = std::find(way_.begin(), way_.end(), high - low);
    return numbers_[place][static_cast<std::size_t>(way - way_.begin())];
  }

  /// From a node to those that follow it, in rows.
  static std::array<std::size_t, ways> ways_in(const SampleNodes<Dim>& nodes) {
    std::array<std::size_t, ways> rows{};
    for (std::size_t way = 1; way <= ways; ++way) {
      std::size_t stride = 1;
      for (std::size_t d = 0; d < Dim; ++d) {
        if ((way >> d & 1U) == 1) rows[way - 1] += stride;
        stride *= static_cast<std::size_t>(nodes.count[d]);
      }
    }
    return rows;
  }

  const SampledShape<Dim>& shape_;
  const SampleNodes<Dim>& nodes_;
  std::vector<std::uint8_t> inside_;
  std::vector<std::uint32_t> place_;  ///< in numbers_, of every node
  std::vector<Numbers> numbers_;      ///< of nodes that the surface passes by
  std::array<std::size_t, ways> way_;
  std::vector<std::pair<std::size_t, std::size_t>> ends_;  ///< inside, outside
};

}  // namespace minamo
