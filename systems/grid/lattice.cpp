#include "systems/grid/lattice.hpp"

#include "engine/schedule/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace minamo {

namespace {

/// Where a point lies, whatever rounding says of one on the surface.
enum class PlaceIn { outside, surface, inside };

/// \param start  what expressions see of time and ode variables
/// \param part   edge of what the point stands for [m]
template <int Dim>
PlaceIn place_in(const ParticleScene& region, const Instant& start, const Vec<Dim>& x, double part) {
  const double rounding = 1e-9 * part;
  const auto* shape = std::get_if<SharedShape<Dim>>(&region.shape);
  if (shape && (*shape)->is_bounded_by_distance()) {
    const double distance = (*shape)->distance(x);
    if (std::abs(distance) <= rounding) return PlaceIn::surface;
    return distance < 0 ? PlaceIn::inside : PlaceIn::outside;
  }
  const auto is_in = [&](const Vec<Dim>& at) {
    if (shape) return (*shape)->contains(at);
    Arguments arguments(start);
    const double value = std::get<Where>(region.shape).inside(arguments.at<Dim>(at));
    return std::isfinite(value) && value != 0;
  };
  const bool own = is_in(x);
  if (region.jitter) return own ? PlaceIn::inside : PlaceIn::outside;
  // A surface that passes through x has some of them inside, wherever it or its corner turns.
  constexpr std::size_t corners = power(2, Dim);
  std::size_t inside = 0;
  for (std::size_t c = 0; c < corners; ++c) {
    Vec<Dim> aside;
    for (int d = 0; d < Dim; ++d) {
      const double length = std::array{1.0, 0.7129, 0.3917}[static_cast<std::size_t>(d)];  // along no edge of a shape
      aside[d] = (c >> static_cast<std::size_t>(d) & 1U) == 0 ? -rounding * length : rounding * length;
    }
    if (is_in(x + aside)) ++inside;
  }
  if (own && inside == corners) return PlaceIn::inside;
  return own || inside > 0 ? PlaceIn::surface : PlaceIn::outside;
}

/// Keeps, of the points that are tried one after the other, those inside a region; the many at a time that threads
/// share, for the nearest triangle of a mesh takes a microsecond or more.
template <int Dim>
class Inside {
 public:
  /// \param earlier  regions that have points on a surface in common with this one
  /// \param part     edge of what a point stands for [m]
  Inside(const ParticleScene& region, std::span<const ParticleScene> earlier, const Instant& start, PartsTaken taken,
         double part)
      : region_(region),
        earlier_(earlier),
        start_(start),
        taken_(taken),
        part_(part),
        reach_(0.5 * part * std::sqrt(static_cast<double>(Dim))) {
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
    std::vector<PlaceIn> place(tried_.size());
    const auto* shape = std::get_if<SharedShape<Dim>>(&region_.shape);
    if (shape) {
      for_each_row(tried_.size(), [&](std::size_t k) { place[k] = place_of(**shape, tried_[k]); });
    } else {  // in turn: expressions are not for several threads
      for (std::size_t k = 0; k < tried_.size(); ++k) place[k] = place_in<Dim>(region_, start_, tried_[k], part_);
    }
    for (std::size_t k = 0; k < tried_.size(); ++k) {
      if (place[k] == PlaceIn::inside || (place[k] == PlaceIn::surface && !is_taken(tried_[k])))
        found_.push_back(tried_[k]);
    }
    tried_.clear();
  }
  PlaceIn place_of(const Shape<Dim>& shape, const Vec<Dim>& x) const {
    if (taken_ == PartsTaken::middle_inside) return place_in<Dim>(region_, start_, x, part_);
    return !shape.is_bounded_by_distance() || shape.distance(x) < reach_ ? PlaceIn::inside : PlaceIn::outside;
  }
  /// A point on the surface of two regions is the first one's.
  bool is_taken(const Vec<Dim>& x) const {
    return std::any_of(earlier_.begin(), earlier_.end(), [&](const ParticleScene& other) {
      return other.per_cell == region_.per_cell && !other.jitter &&
             place_in<Dim>(other, start_, x, part_) != PlaceIn::outside;
    });
  }

  const ParticleScene& region_;
  std::span<const ParticleScene> earlier_;
  const Instant& start_;
  PartsTaken taken_;
  double part_;
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
                              PartsTaken taken, const Layers& layers, std::span<const ParticleScene> earlier) {
  auto range = parts_to_try<Dim>(region, grid);
  const std::uint64_t parts_before = narrow<Dim>(range, layers, grid, region.per_cell);
  const double part = grid.spacing / region.per_cell;
  std::mt19937_64 random(region.jitter.value_or(0));
  if (region.jitter) random.discard(Dim * parts_before);
  Inside<Dim> inside(region, earlier, start, taken, part);
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
template std::vector<Vec<2>> lattice<2>(const ParticleScene&, const Grid<2>&, const Instant&, PartsTaken, const Layers&,
                                        std::span<const ParticleScene>);
template std::vector<Vec<3>> lattice<3>(const ParticleScene&, const Grid<3>&, const Instant&, PartsTaken, const Layers&,
                                        std::span<const ParticleScene>);

}  // namespace minamo
