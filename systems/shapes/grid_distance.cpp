#include "systems/shapes/grid_distance.hpp"

#include "engine/schedule/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

constexpr int block = 4;  // nodes per direction that share a look at the distance of their middle

/// A grid of the same nodes without periodic axes.
template <int Dim>
Grid<Dim> closed(const Grid<Dim>& grid) {
  Grid<Dim> closed;
  closed.low = grid.low;
  closed.spacing = grid.spacing;
  closed.cells = grid.cells;
  closed.high = closed.position(grid.cells);
  return closed;
}

/// Of blocks of nodes.
template <int Dim>
Grid<Dim> blocks_of(const Grid<Dim>& grid) {
  Grid<Dim> blocks;
  for (std::size_t d = 0; d < Dim; ++d) blocks.cells[d] = grid.cells[d] / block;
  return blocks;
}

/// Calls f with every node of a block.
template <int Dim, class F>
void for_each_node(const Grid<Dim>& grid, const Index<Dim>& of_block, const F& f) {
  for (std::size_t k = 0; k < power(block, Dim); ++k) {
    Index<Dim> node;
    std::size_t rest = k;
    bool is_there = true;
    for (std::size_t d = 0; d < Dim; ++d) {
      node[d] = of_block[d] * block + static_cast<int>(rest % block);
      rest /= block;
      is_there = is_there && node[d] <= grid.cells[d];
    }
    if (is_there) f(node);
  }
}

/// The cell of a point, and where in it the point lies, 0 to 1 per direction.
template <int Dim>
struct InCell {
  Index<Dim> cell;
  Vec<Dim> share;

  InCell(const Grid<Dim>& grid, const Vec<Dim>& x) {
    for (int d = 0; d < Dim; ++d) {
      const auto axis = static_cast<std::size_t>(d);
      const double at = (x[d] - grid.low[d]) / grid.spacing;
      cell[axis] = static_cast<int>(std::clamp(std::floor(at), 0.0, grid.cells[axis] - 1.0));
      share[d] = at - cell[axis];
    }
  }
};

/// Sum over the corners of a cell of their values times products of 1 - s or s, or of the slopes -1 or 1 along `slope`.
template <int Dim>
double interpolated(const Grid<Dim>& grid, const std::vector<double>& values, const InCell<Dim>& at, int slope = -1) {
  double sum = 0;
  for (unsigned corner = 0; corner < 1U << Dim; ++corner) {
    Index<Dim> node = at.cell;
    double weight = 1;
    for (int d = 0; d < Dim; ++d) {
      const bool is_high = (corner >> d & 1U) != 0;
      node[static_cast<std::size_t>(d)] += is_high;
      weight *= d == slope ? (is_high ? 1 : -1) : is_high ? at.share[d] : 1 - at.share[d];
    }
    sum += weight * values[grid.row(node)];
  }
  return sum;
}

}  // namespace

template <int Dim>
GridDistance<Dim>::GridDistance(const Shape<Dim>& shape, const Grid<Dim>& grid, double band)
    : grid_(closed<Dim>(grid)), bounds_(shape.bounds()), values_(grid_.node_count()) {
  // The interpolation may round the surface outward within a cell.
  bounds_.low -= Vec<Dim>::Constant(grid.spacing);
  bounds_.high += Vec<Dim>::Constant(grid.spacing);
  fill(shape, shape.is_bounded_by_distance() ? band : std::numeric_limits<double>::infinity());
}

template <int Dim>
void GridDistance<Dim>::fill(const Shape<Dim>& shape, double band) {
  const Grid<Dim> blocks = blocks_of<Dim>(grid_);
  const double reach = grid_.spacing * (block - 1) / 2 * std::sqrt(Dim);
  for_each_row(
      blocks.node_count(),
      [&](std::size_t row) {
        const Index<Dim> of_block = blocks.index(row);
        Index<Dim> first;
        for (std::size_t d = 0; d < Dim; ++d) first[d] = of_block[d] * block;
        const Vec<Dim> middle = grid_.position(first) + Vec<Dim>::Constant(grid_.spacing * (block - 1) / 2);
        const double at_middle = std::isinf(band) ? 0 : shape.distance(middle);
        const bool is_far = std::abs(at_middle) > reach + band;
        for_each_node<Dim>(grid_, of_block, [&](const Index<Dim>& node) {
          const Vec<Dim> x = grid_.position(node);
          const double bound = std::abs(at_middle) - (x - middle).norm();
          values_[grid_.row(node)] = is_far ? std::copysign(bound, at_middle) : shape.distance(x);
        });
      },
      16);
}

template <int Dim>
double GridDistance<Dim>::distance(const Vec<Dim>& x) const {
  const Vec<Dim> inside = x.cwiseMax(grid_.low).cwiseMin(grid_.high);
  return interpolated<Dim>(grid_, values_, InCell<Dim>(grid_, inside)) + (x - inside).norm();
}

template <int Dim>
Vec<Dim> GridDistance<Dim>::gradient(const Vec<Dim>& x) const {
  if (x != x.cwiseMax(grid_.low).cwiseMin(grid_.high)) return Shape<Dim>::gradient(x);
  const InCell<Dim> at(grid_, x);
  Vec<Dim> gradient;
  for (int d = 0; d < Dim; ++d) gradient[d] = interpolated<Dim>(grid_, values_, at, d) / grid_.spacing;
  return gradient;
}

template class GridDistance<2>;
template class GridDistance<3>;

}  // namespace minamo
