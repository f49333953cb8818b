#include "systems/setup/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace minamo {

namespace {

template <int Dim>
struct Contains {
  const Vec<Dim>& x;
  const Instant& start;

  bool operator()(const Box& box) const {
    for (int d = 0; d < Dim; ++d) {
      const auto axis = static_cast<std::size_t>(d);
      if (x[d] < box.low[axis] || x[d] > box.high[axis]) return false;
    }
    return true;
  }
  bool operator()(const Ball& ball) const {
    double squared = 0;
    for (int d = 0; d < Dim; ++d) squared += std::pow(x[d] - ball.center[static_cast<std::size_t>(d)], 2);
    return squared <= ball.radius * ball.radius;
  }
  bool operator()(const Where& where) const {
    Arguments arguments(start);
    const double value = where.inside(arguments.at<Dim>(x));
    return std::isfinite(value) && value != 0;
  }
};

/// Parts that can lie in a shape, first and past the last per direction; all of them unless the shape has bounds.
template <int Dim>
std::array<std::array<int, 2>, static_cast<std::size_t>(Dim)> parts_to_try(const ParticleScene& region,
                                                                           const Grid<Dim>& grid) {
  std::array<std::array<int, 2>, static_cast<std::size_t>(Dim)> range;
  for (std::size_t d = 0; d < Dim; ++d) {
    const int parts = grid.cells[d] * region.per_cell;
    const auto clip = [&](double x) {
      const double part = (x - grid.low[static_cast<Eigen::Index>(d)]) / grid.spacing * region.per_cell;
      return static_cast<int>(std::clamp(part, 0.0, static_cast<double>(parts)));
    };
    range[d] = {0, parts};
    if (const auto* box = std::get_if<Box>(&region.shape)) {
      range[d] = {std::max(0, clip(box->low[d]) - 1), std::min(parts, clip(box->high[d]) + 2)};
    } else if (const auto* ball = std::get_if<Ball>(&region.shape)) {
      range[d] = {std::max(0, clip(ball->center[d] - ball->radius) - 1),
                  std::min(parts, clip(ball->center[d] + ball->radius) + 2)};
    }
  }
  return range;
}

/// In [0, 1), the same on every machine.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

}  // namespace

template <int Dim>
Index<Dim> cell_of(const Grid<Dim>& grid, const Vec<Dim>& x) {
  Index<Dim> cell;
  for (std::size_t d = 0; d < Dim; ++d) {
    const auto axis = static_cast<Eigen::Index>(d);
    cell[d] = std::clamp(static_cast<int>((x[axis] - grid.low[axis]) / grid.spacing), 0, grid.cells[d] - 1);
  }
  return cell;
}

template <int Dim>
std::vector<Vec<Dim>> lattice(const ParticleScene& region, const Grid<Dim>& grid, const Instant& start) {
  const auto range = parts_to_try<Dim>(region, grid);
  const double part = grid.spacing / region.per_cell;
  std::mt19937_64 random(region.jitter.value_or(0));
  std::vector<Vec<Dim>> positions;
  Index<Dim> at;
  for (std::size_t d = 0; d < Dim; ++d) at[d] = range[d][0];
  while (at[Dim - 1] < range[Dim - 1][1]) {
    Vec<Dim> x;
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      const double within = region.jitter ? uniform(random) : 0.5;
      x[axis] = grid.low[axis] + part * (at[d] + within);
    }
    if (std::visit(Contains<Dim>{x, start}, region.shape)) positions.push_back(x);
    for (std::size_t d = 0; d < Dim; ++d) {
      if (++at[d] < range[d][1] || d + 1 == Dim) break;
      at[d] = range[d][0];
    }
  }
  return positions;
}

template <int Dim>
Vec<Dim> nearer_to_walls(const Grid<Dim>& grid, int per_cell, Vec<Dim> x) {
  const double part = grid.spacing / per_cell;
  for (int d = 0; d < Dim; ++d) {
    if (grid.periodic[static_cast<std::size_t>(d)]) continue;
    if (x[d] - grid.low[d] < part) x[d] -= part / 24;
    if (grid.high[d] - x[d] < part) x[d] += part / 24;
  }
  return x;
}

template Index<2> cell_of<2>(const Grid<2>&, const Vec<2>&);
template Index<3> cell_of<3>(const Grid<3>&, const Vec<3>&);
template <int Dim>
Vec<Dim> exact_for_splines(const Grid<Dim>& grid, int per_cell, Vec<Dim> x) {
  // The midpoint sums of the cells inside are off by r/2 of the second derivative, and the error of a spline adds up to
  // zero over its cells. So that it does at walls, the mean of the wall's cell moves to the wall by r/2, and the mean
  // square about the middle is 1/12 - r/2; a map a + b t of the places does both.
  const double r = 1.0 / (12.0 * per_cell * per_cell);
  const double spread = 1.0 / 12 - r;  // of the lattice
  const double shift = r / 2;
  const double stretch = spread > 0 ? std::sqrt((1.0 / 12 - r / 2 - shift * shift) / spread) : 1;
  for (int d = 0; d < Dim; ++d) {
    if (grid.periodic[static_cast<std::size_t>(d)]) continue;
    const auto moved = [&](double wall, double inward) {
      const double from_wall = (x[d] - wall) * inward / grid.spacing;
      if (from_wall < 1) x[d] = wall + inward * grid.spacing * (0.5 - shift + stretch * (from_wall - 0.5));
    };
    moved(grid.low[d], 1);
    moved(grid.high[d], -1);
  }
  return x;
}

template Vec<2> exact_for_splines<2>(const Grid<2>&, int, Vec<2>);
template Vec<3> exact_for_splines<3>(const Grid<3>&, int, Vec<3>);
template Vec<2> nearer_to_walls<2>(const Grid<2>&, int, Vec<2>);
template Vec<3> nearer_to_walls<3>(const Grid<3>&, int, Vec<3>);
template std::vector<Vec<2>> lattice<2>(const ParticleScene&, const Grid<2>&, const Instant&);
template std::vector<Vec<3>> lattice<3>(const ParticleScene&, const Grid<3>&, const Instant&);

}  // namespace minamo
