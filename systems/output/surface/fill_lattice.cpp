#include "systems/output/surface/fill_lattice.hpp"

#include "systems/grid/quadratic_spline.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// Nodes of a lattice that is fixed to the box, as far as particles reach, so that the outermost are empty.
template <int Dim>
SampleNodes<Dim> nodes_around(const Bounds<Dim>& box, double spacing, double margin,
                              std::span<const Vec<Dim>> position) {
  SampleNodes<Dim> whole = SampleNodes<Dim>::around(box, spacing);
  if (position.empty()) return whole;
  Vec<Dim> low = position[0];
  Vec<Dim> high = position[0];
  for (const Vec<Dim>& x : position) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  for (std::size_t d = 0; d < Dim; ++d) {
    const auto axis = static_cast<Eigen::Index>(d);
    const double from = (low[axis] - margin - whole.low[axis]) / spacing;
    const double to = (high[axis] + margin - whole.low[axis]) / spacing;
    const int first = std::max(0, static_cast<int>(std::floor(from)));
    const int last = std::min(whole.count[d] - 1, static_cast<int>(std::ceil(to)));
    whole.low[axis] += first * spacing;
    whole.count[d] = last - first + 1;
  }
  return whole;
}

}  // namespace

template <int Dim>
FillLattice<Dim>::FillLattice(const Bounds<Dim>& box, double spacing, std::span<const Vec<Dim>> position)
    : nodes_(nodes_around<Dim>(box, spacing, (quadratic_spline_reach * width + 1) * spacing, position)),
      sums_(nodes_.size()) {}

template <int Dim>
void FillLattice<Dim>::add(const Vec<Dim>& x, const Vec<Dim>& v, double volume) {
  constexpr int most = 2 * static_cast<int>(quadratic_spline_reach * width) + 2;  // nodes along an axis
  std::array<std::array<double, most>, static_cast<std::size_t>(Dim)> weight{};
  Index<Dim> first;
  Index<Dim> count;
  for (std::size_t d = 0; d < Dim; ++d) {
    const auto axis = static_cast<Eigen::Index>(d);
    const double at = (x[axis] - nodes_.low[axis]) / nodes_.spacing;
    first[d] = std::max(0, static_cast<int>(std::ceil(at - quadratic_spline_reach * width)));
    const int last = std::min(nodes_.count[d] - 1, static_cast<int>(std::floor(at + quadratic_spline_reach * width)));
    count[d] = last - first[d] + 1;
    for (int k = 0; k < count[d]; ++k)
      weight[d][static_cast<std::size_t>(k)] = quadratic_spline((first[d] + k - at) / width);
  }
  const double amount = volume / std::pow(width * nodes_.spacing, Dim);
  std::array<float, 1 + static_cast<std::size_t>(Dim)> carried{1.0F};
  for (std::size_t d = 0; d < Dim; ++d) carried[1 + d] = static_cast<float>(v[static_cast<Eigen::Index>(d)]);
  const auto add_line = [&](std::size_t row, double share) {
    for (int i = 0; i < count[0]; ++i) {
      auto& sum = sums_[row + static_cast<std::size_t>(i)];
      const auto part = static_cast<float>(share * weight[0][static_cast<std::size_t>(i)]);
      for (std::size_t k = 0; k <= Dim; ++k) sum[k] += part * carried[k];
    }
  };
  const auto n0 = static_cast<std::size_t>(nodes_.count[0]);
  for (int j = 0; j < count[1]; ++j) {
    const double along_y = amount * weight[1][static_cast<std::size_t>(j)];
    const std::size_t row = static_cast<std::size_t>(first[0]) + n0 * static_cast<std::size_t>(first[1] + j);
    if constexpr (Dim == 2) {
      add_line(row, along_y);
    } else {
      const std::size_t slice = n0 * static_cast<std::size_t>(nodes_.count[1]);
      for (int k = 0; k < count[2]; ++k)
        add_line(row + slice * static_cast<std::size_t>(first[2] + k),
                 along_y * weight[2][static_cast<std::size_t>(k)]);
    }
  }
}

template <int Dim>
template <class Use>
void FillLattice<Dim>::for_each_corner(const Vec<Dim>& x, const Use& use) const {
  std::array<std::size_t, static_cast<std::size_t>(Dim)> low{};
  Vec<Dim> rest;
  for (std::size_t d = 0; d < Dim; ++d) {
    const auto axis = static_cast<Eigen::Index>(d);
    const double at = std::clamp((x[axis] - nodes_.low[axis]) / nodes_.spacing, 0.0, nodes_.count[d] - 1.0);
    const int node = std::min(static_cast<int>(at), nodes_.count[d] - 2);
    low[d] = static_cast<std::size_t>(node);
    rest[axis] = at - node;
  }
  for (std::size_t c = 0; c < corners; ++c) {
    double weight = 1;
    std::size_t row = 0;
    for (std::size_t d = Dim; d-- > 0;) {
      const std::size_t up = c >> d & 1U;
      const double along = rest[static_cast<Eigen::Index>(d)];
      weight *= up == 1 ? along : 1 - along;
      row = row * static_cast<std::size_t>(nodes_.count[d]) + low[d] + up;
    }
    use(row, weight);
  }
}

template <int Dim>
double FillLattice<Dim>::fill(const Vec<Dim>& x) const {
  double sum = 0;
  for_each_corner(x, [&](std::size_t row, double weight) { sum += weight * sums_[row][0]; });
  return sum;
}

template <int Dim>
Vec<Dim> FillLattice<Dim>::velocity(const Vec<Dim>& x) const {
  double filled = 0;
  Vec<Dim> sum = Vec<Dim>::Zero();
  for_each_corner(x, [&](std::size_t row, double weight) {
    filled += weight * sums_[row][0];
    for (std::size_t d = 0; d < Dim; ++d) sum[static_cast<Eigen::Index>(d)] += weight * sums_[row][1 + d];
  });
  if (filled <= 0) return Vec<Dim>::Zero();
  return sum / filled;
}

template class FillLattice<2>;
template class FillLattice<3>;

}  // namespace minamo
