#include "systems/setup/lattice.hpp"

#include "engine/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace minamo {

namespace {

/// Keeps, of the points that are tried one after the other, those inside a region; the many at a time that threads
/// share, for the nearest triangle of a mesh takes a microsecond or more.
template <int Dim>
class Inside {
 public:
  /// \param part  edge of what a point stands for [m]
  Inside(const ParticleScene& region, const Instant& start, PartsTaken taken, double part)
      : region_(region), start_(start), taken_(taken), reach_(0.5 * part * std::sqrt(static_cast<double>(Dim))) {
    tried_.reserve(batch);
  }

  void try_point(const Vec<Dim>& x) {
    tried_.push_back(x);
    if (tried_.size() == batch) sift();
  }
  std::vector<Vec<Dim>> found() {
    sift();
    return std::move(found_);
  }

 private:
  static constexpr std::size_t batch = 1 << 16;

  void sift() {
    std::vector<std::uint8_t> is_inside(tried_.size());
    if (const auto* shape = std::get_if<SharedShape<Dim>>(&region_.shape)) {
      for_each_row(tried_.size(), [&](std::size_t k) { is_inside[k] = is_in(**shape, tried_[k]); });
    } else {
      for (std::size_t k = 0; k < tried_.size(); ++k) is_inside[k] = is_where(tried_[k]);
    }
    for (std::size_t k = 0; k < tried_.size(); ++k) {
      if (is_inside[k] != 0) found_.push_back(tried_[k]);
    }
    tried_.clear();
  }
  bool is_in(const Shape<Dim>& shape, const Vec<Dim>& x) const {
    if (taken_ == PartsTaken::middle_inside) return shape.contains(x);
    return !shape.is_bounded_by_distance() || shape.distance(x) < reach_;
  }
  bool is_where(const Vec<Dim>& x) const {
    Arguments arguments(start_);
    const double value = std::get<Where>(region_.shape).inside(arguments.at<Dim>(x));
    return std::isfinite(value) && value != 0;
  }

  const ParticleScene& region_;
  const Instant& start_;
  PartsTaken taken_;
  double reach_;
  std::vector<Vec<Dim>> tried_;
  std::vector<Vec<Dim>> found_;
};

/// Parts that can lie in a shape, first and past the last per direction; all of them unless the shape has bounds.
template <int Dim>
using PartsToTry = std::array<std::array<int, 2>, static_cast<std::size_t>(Dim)>;
template <int Dim>
PartsToTry<Dim> parts_to_try(const ParticleScene& region, const Grid<Dim>& grid) {
  PartsToTry<Dim> range;
  const auto* shape = std::get_if<SharedShape<Dim>>(&region.shape);
  const Bounds<Dim> bounds = shape ? (*shape)->bounds() : Bounds<Dim>();
  for (std::size_t d = 0; d < Dim; ++d) {
    const auto axis = static_cast<Eigen::Index>(d);
    const int parts = grid.cells[d] * region.per_cell;
    const auto clip = [&](double x) {
      const double part = (x - grid.low[axis]) / grid.spacing * region.per_cell;
      return static_cast<int>(std::clamp(part, 0.0, static_cast<double>(parts)));
    };
    range[d] = {std::max(0, clip(bounds.low[axis]) - 1), std::min(parts, clip(bounds.high[axis]) + 2)};
  }
  return range;
}

/// The last axis narrowed to layers of cells. \return how many parts come before them
template <int Dim>
std::uint64_t narrow(PartsToTry<Dim>& range, const Layers& layers, const Grid<Dim>& grid, int per_cell) {
  auto& [first, last] = range[Dim - 1];
  const int before = first;
  first = std::clamp(std::min(layers[0], grid.cells[Dim - 1]) * per_cell, first, last);
  last = std::clamp(std::min(layers[1], grid.cells[Dim - 1]) * per_cell, first, last);
  auto parts = static_cast<std::uint64_t>(first - before);
  for (std::size_t d = 0; d + 1 < Dim; ++d) parts *= static_cast<std::uint64_t>(range[d][1] - range[d][0]);
  return parts;
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
Layers layers_of(const ParticleScene& region, const Grid<Dim>& grid) {
  const auto [first, last] = parts_to_try<Dim>(region, grid)[Dim - 1];
  return {first / region.per_cell, (last + region.per_cell - 1) / region.per_cell};
}

template <int Dim>
std::vector<Vec<Dim>> lattice(const ParticleScene& region, const Grid<Dim>& grid, const Instant& start,
                              PartsTaken taken, const Layers& layers) {
  auto range = parts_to_try<Dim>(region, grid);
  const std::uint64_t parts_before = narrow<Dim>(range, layers, grid, region.per_cell);
  const double part = grid.spacing / region.per_cell;
  std::mt19937_64 random(region.jitter.value_or(0));
  if (region.jitter) random.discard(Dim * parts_before);
  Inside<Dim> inside(region, start, taken, part);
  Index<Dim> at;
  for (std::size_t d = 0; d < Dim; ++d) at[d] = range[d][0];
  while (at[Dim - 1] < range[Dim - 1][1]) {
    Vec<Dim> x;
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      const double within = region.jitter ? uniform(random) : 0.5;
      x[axis] = grid.low[axis] + part * (at[d] + within);
    }
    inside.try_point(x);
    for (std::size_t d = 0; d < Dim; ++d) {
      if (++at[d] < range[d][1] || d + 1 == Dim) break;
      at[d] = range[d][0];
    }
  }
  return inside.found();
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

template Layers layers_of<2>(const ParticleScene&, const Grid<2>&);
template Layers layers_of<3>(const ParticleScene&, const Grid<3>&);
template Vec<2> exact_for_splines<2>(const Grid<2>&, int, Vec<2>);
template Vec<3> exact_for_splines<3>(const Grid<3>&, int, Vec<3>);
template Vec<2> nearer_to_walls<2>(const Grid<2>&, int, Vec<2>);
template Vec<3> nearer_to_walls<3>(const Grid<3>&, int, Vec<3>);
template std::vector<Vec<2>> lattice<2>(const ParticleScene&, const Grid<2>&, const Instant&, PartsTaken,
                                        const Layers&);
template std::vector<Vec<3>> lattice<3>(const ParticleScene&, const Grid<3>&, const Instant&, PartsTaken,
                                        const Layers&);

}  // namespace minamo
