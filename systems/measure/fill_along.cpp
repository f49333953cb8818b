#include "systems/measure/fill_along.hpp"

#include "systems/bodies/geometry/cut.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

constexpr double surface = 0.5;  // of the fill

/// Place where the fill passes that of the surface between a sample and the next one.
double crossing(const FillSample& a, const FillSample& b) {
  return a.at + (a.fill - surface) / (a.fill - b.fill) * (b.at - a.at);
}

/// The sample at zero; the last one of a line that ends just below.
auto start_of(std::span<const FillSample> line) {
  const auto zero = std::find_if(line.begin(), line.end(), [](const FillSample& sample) { return sample.at >= 0; });
  return zero == line.end() ? std::prev(zero) : zero;
}

/// Where the surface is, about: the first one above a point in the liquid, or the first one below a point in the air.
/// None if the line ends before.
std::optional<double> find_surface(std::span<const FillSample> line) {
  const auto is_wet = [](const FillSample& sample) { return sample.fill >= surface; };
  const auto zero = start_of(line);
  if (is_wet(*zero)) {
    const auto above = std::find_if_not(zero, line.end(), is_wet);
    if (above == line.end()) return {};
    return crossing(*std::prev(above), *above);
  }
  for (auto above = zero; above != line.begin(); --above) {
    if (is_wet(*std::prev(above))) return crossing(*std::prev(above), *above);
  }
  return {};
}

/// Integral of the fill between two places, the second of which is where the liquid ends: nothing is there, or it is
/// the least before other liquid.
double liquid_between(std::span<const FillSample> line, double from, double middle, double to) {
  double sum = 0;
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const FillSample& a = line[k];
    const FillSample& b = line[k + 1];
    if (b.at <= from || a.at >= to) continue;
    if (a.at >= middle && b.fill > a.fill) break;
    const auto fill = [&](double at) { return a.fill + (at - a.at) / (b.at - a.at) * (b.fill - a.fill); };
    const double low = std::max(a.at, from);
    const double high = std::min(b.at, to);
    sum += 0.5 * (fill(low) + fill(high)) * (high - low);
  }
  return sum;
}

}  // namespace

double height_of_surface(std::span<const FillSample> line, double reach) {
  const std::optional<double> found = find_surface(line);
  if (!found && start_of(line)->fill >= surface) return line.back().at;
  // On a line without a surface there is a film at its low end, or nothing.
  const double middle = found.value_or(line.front().at);
  const double from = std::max(line.front().at, middle - reach);
  // Of a layer that is thinner than that nobody knows where its volume begins.
  const auto is_gap = [&](const FillSample& sample) {
    return sample.at >= from && sample.at < middle && sample.fill < surface;
  };
  if (std::any_of(line.begin(), line.end(), is_gap)) return middle;
  return from + liquid_between(line, from, middle, middle + reach);
}

template <int Dim>
FillOfHats<Dim>::FillOfHats(const Grid<Dim>& grid, const Vec<Dim>& from, const Vec<Dim>& to,
                            const DistanceToBodies<Dim>& distance)
    : grid_(grid) {
  for (int d = 0; d < Dim; ++d) {
    const auto axis = static_cast<std::size_t>(d);
    const auto cell = [&](double x) {
      return std::clamp(static_cast<int>(std::floor((x - grid.low[d]) / grid.spacing)), 0, grid.cells[axis] - 1);
    };
    first_[axis] = cell(std::min(from[d], to[d]));
    count_[axis] = std::min(cell(std::max(from[d], to[d])) + 2 - first_[axis], grid.nodes(d));
    if (grid.periodic[axis]) continue;
    reach_.low[d] = grid.low[d] + (first_[axis] - 1) * grid.spacing;
    reach_.high[d] = grid.low[d] + (first_[axis] + count_[axis]) * grid.spacing;
  }
  const std::size_t nodes = rows_in<Dim>(count_);
  volume_.assign(nodes, 0);
  share_.assign(nodes, 1);
  integral_.assign(nodes, std::pow(grid.spacing, Dim));
  for (std::size_t row = 0; row < nodes; ++row) {
    Index<Dim> node = index_in<Dim>(count_, row);
    for (std::size_t d = 0; d < Dim; ++d) {
      node[d] += first_[d];
      if (!grid.periodic[d] && (node[d] == 0 || node[d] == grid.cells[d])) integral_[row] /= 2;
    }
    if (distance) share_[row] = open_share(grid.position(node), distance);
  }
}

template <int Dim>
template <class Use>
void FillOfHats<Dim>::for_each_corner(const Vec<Dim>& x, const Use& use) const {
  std::array<std::array<std::ptrdiff_t, 2>, static_cast<std::size_t>(Dim)> place;
  std::array<std::array<double, 2>, static_cast<std::size_t>(Dim)> weight;
  for (int d = 0; d < Dim; ++d) {
    const auto axis = static_cast<std::size_t>(d);
    const double scaled = (x[d] - grid_.low[d]) / grid_.spacing;
    const int cell = std::clamp(static_cast<int>(std::floor(scaled)), 0, grid_.cells[axis] - 1);
    const double t = std::clamp(scaled - cell, 0.0, 1.0);
    weight[axis] = {1 - t, t};
    for (const int up : {0, 1}) {
      int steps = cell + up - first_[axis];
      if (grid_.periodic[axis]) steps = (steps % grid_.cells[axis] + grid_.cells[axis]) % grid_.cells[axis];
      place[axis][static_cast<std::size_t>(up)] = steps;
    }
  }
  for (std::size_t corner = 0; corner < corners; ++corner) {
    std::ptrdiff_t row = 0;
    double product = 1;
    bool is_in_box = true;
    for (std::size_t d = Dim; d-- > 0;) {
      const std::size_t up = corner >> d & 1U;
      is_in_box = is_in_box && place[d][up] >= 0 && place[d][up] < count_[d];
      row = row * count_[d] + place[d][up];
      product *= weight[d][up];
    }
    if (is_in_box) use(static_cast<std::size_t>(row), product);
  }
}

template <int Dim>
void FillOfHats<Dim>::add(const Vec<Dim>& x_p, double V_p) {
  if ((x_p.array() < reach_.low.array()).any() || (x_p.array() > reach_.high.array()).any()) return;
  for_each_corner(x_p, [&](std::size_t row, double weight) { volume_[row] += weight * V_p; });
}

template <int Dim>
double FillOfHats<Dim>::at(const Vec<Dim>& x) const {
  double liquid = 0;
  double room = 0;
  for_each_corner(x, [&](std::size_t row, double weight) {
    liquid += weight * volume_[row] / integral_[row];
    room += weight * share_[row];
  });
  constexpr double least = 1e-3;  // less is rounding of a_i
  return room > least ? liquid / room : 0;
}

template <int Dim>
double FillOfHats<Dim>::open_share(const Vec<Dim>& node, const DistanceToBodies<Dim>& distance) const {
  const double h = grid_.spacing;
  const double at_node = distance(node);
  if (std::abs(at_node) > h * std::sqrt(static_cast<double>(Dim))) return at_node > 0 ? 1 : 0;
  // Midpoints of pieces, a side of which cuts a piece as if it were across it.
  constexpr int pieces = 8;
  const double piece = 2 * h / pieces;
  double open = 0;
  double all = 0;
  for (std::size_t k = 0; k < power(pieces, Dim); ++k) {
    Vec<Dim> x = node;
    double weight = 1;
    std::size_t rest = k;
    for (int d = 0; d < Dim; ++d, rest /= pieces) {
      const double offset = (static_cast<double>(rest % pieces) + 0.5) * piece - h;
      x[d] += offset;
      weight *= 1 - std::abs(offset) / h;
      const bool is_outside = x[d] < grid_.low[d] || x[d] > grid_.high[d];
      if (is_outside && !grid_.periodic[static_cast<std::size_t>(d)]) weight = 0;
    }
    if (weight == 0) continue;
    all += weight;
    open += weight * std::clamp(0.5 + distance(x) / piece, 0.0, 1.0);
  }
  return open / all;
}

template class FillOfHats<2>;
template class FillOfHats<3>;

}  // namespace minamo
