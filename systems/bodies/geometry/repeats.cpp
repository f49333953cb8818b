#include "systems/bodies/geometry/repeats.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <stdexcept>

namespace minamo {

namespace {

/// Whether a body lies farther than `reach` from both ends of an axis.
template <int Dim>
bool is_clear(const Bounds<Dim>& bounds, const Grid<Dim>& grid, Eigen::Index axis, double reach) {
  return bounds.low[axis] >= grid.low[axis] + reach && bounds.high[axis] <= grid.high[axis] - reach;
}

/// Whether distances agree around both ends of an axis, as far as they tell of a surface within reach.
template <int Dim, class Distance>
bool repeats(const Grid<Dim>& grid, std::size_t axis, double reach, const Distance& distance) {
  const auto e = static_cast<Eigen::Index>(axis);
  const double rounding = 1e-6 * grid.spacing;
  Index<Dim> nodes = grid.cells;
  for (int& along : nodes) ++along;
  nodes[axis] = 1;
  for (std::size_t i = 0; i < rows_in<Dim>(nodes); ++i) {
    const Vec<Dim> low = grid.position(index_in<Dim>(nodes, i));
    for (const double off : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
      const auto near = [&](double end) {
        Vec<Dim> x = low;
        x[e] = end + off * reach;
        return std::clamp(distance(x), -reach, reach);
      };
      if (std::abs(near(grid.low[e]) - near(grid.high[e])) > rounding) return false;
    }
  }
  return true;
}

}  // namespace

template <int Dim>
std::optional<std::size_t> axis_where_it_ends(const Shape<Dim>& shape, const Placement<Dim>& placement,
                                              const Grid<Dim>& grid, double reach) {
  for (std::size_t axis = 0; axis < Dim; ++axis) {
    if (!grid.periodic[axis]) continue;
    if (is_clear<Dim>(placement.bounds(shape.bounds()), grid, static_cast<Eigen::Index>(axis), reach)) continue;
    if (!repeats<Dim>(grid, axis, reach, [&](const Vec<Dim>& x) { return placement.distance(shape, x); })) return axis;
  }
  return {};
}

template <int Dim>
void RequireRepeats<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                     Uses<BodyPlacement<Dim>> placement) const {
  const double reach = reach_over_ends<Dim>(*grid, *splines);
  const double time = clock->time;
  for (std::size_t b = 0; b < placement.set->bodies.size(); ++b) {
    const auto& body = placement.set->bodies[b];
    if (!body.moves()) continue;
    const auto axis =
        axis_where_it_ends<Dim>(*body.shape, {body.pivot, placement.c_b[b], placement.R_b[b]}, *grid, reach);
    if (!axis) continue;
    throw std::runtime_error(
        fmt::format("body \"{}\" comes nearer than {:.4g} m to an end of the periodic axis {} at t = {:.6g} s, and is "
                    "not the same at the other end",
                    body.name, reach, "xyz"[*axis], time));
  }
}

template std::optional<std::size_t> axis_where_it_ends<2>(const Shape<2>&, const Placement<2>&, const Grid<2>&, double);
template std::optional<std::size_t> axis_where_it_ends<3>(const Shape<3>&, const Placement<3>&, const Grid<3>&, double);
template struct RequireRepeats<2>;
template struct RequireRepeats<3>;

}  // namespace minamo
