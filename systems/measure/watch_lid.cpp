#include "systems/measure/watch_lid.hpp"

#include "components/contact.hpp"
#include "components/vector_text.hpp"
#include "systems/openings/opening_set.hpp"
#include "systems/ranks/gathered.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace minamo {

namespace {

template <int Dim>
using Lid = typename Lids<Dim>::Lid;

template <int Dim>
double distance(const Lid<Dim>& lid, const Vec<Dim>& x) {
  return std::abs(lid.at - x[static_cast<Eigen::Index>(lid.axis)]);
}

template <int Dim>
bool holds_liquid(std::size_t axis, bool is_high, World& world) {
  if (world.resource<Grid<Dim>>().periodic[axis]) return false;
  if (world.has<SeparatingSides<Dim>>() && world.resource<SeparatingSides<Dim>>().side[axis][is_high ? 1 : 0])
    return false;
  return !world.has<OpeningSet<Dim>>() || !world.resource<OpeningSet<Dim>>().opens(2 * axis + (is_high ? 1 : 0));
}

/// Whether a cell lies at a lid, or next to it.
template <int Dim>
bool is_at(const Lid<Dim>& lid, const Grid<Dim>& grid, const Index<Dim>& node) {
  return lid.is_high ? node[lid.axis] >= grid.cells[lid.axis] - 1 : node[lid.axis] <= 1;
}

/// The first particle at a lid. \return its place, if there is one
template <int Dim>
std::optional<Vec<Dim>> touching(const Lid<Dim>& lid, const Grid<Dim>& grid, const OccupiedCells<Dim>& cells,
                                 std::span<const Vec<Dim>> x_p) {
  const double near = (0.25 + 1e-6) * grid.spacing;
  for (const auto& cell : cells.cells) {
    if (!is_at<Dim>(lid, grid, cell.node)) continue;
    for (std::size_t p = cell.begin; p < cell.end; ++p) {
      if (distance<Dim>(lid, x_p[p]) < near) return x_p[p];
    }
  }
  return {};
}

constexpr std::string_view lid_is_wet = "lid";

}  // namespace

template <int Dim>
Lids<Dim> lids_of(const Vec<Dim>& body_force, World& world) {
  const Grid<Dim>& grid = world.resource<Grid<Dim>>();
  Lids<Dim> lids;
  for (std::size_t axis = 0; axis < Dim; ++axis) {
    const double along = body_force[static_cast<Eigen::Index>(axis)];
    if (std::abs(along) <= 0.5 * body_force.norm()) continue;
    const bool is_high = along < 0;
    const auto d = static_cast<Eigen::Index>(axis);
    const Lid<Dim> lid{axis, is_high, is_high ? grid.high[d] : grid.low[d]};
    const auto& x_p = world.column<particle::Position<Dim>>();
    const bool is_meant =
        std::any_of(x_p.begin(), x_p.end(), [&](const Vec<Dim>& x) { return distance<Dim>(lid, x) < grid.spacing; });
    if (largest_over_ranks(is_meant ? 1 : 0) == 0 && holds_liquid<Dim>(axis, is_high, world)) lids.lids.push_back(lid);
  }
  return lids;
}

template <int Dim>
void WatchLid<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Lids<Dim>> lids,
                               Optional<Read<OccupiedCells<Dim>>> dual_cells, Optional<Read<GridCells<Dim>>> cells,
                               Read<particle::Position<Dim>> x_p, Optional<Read<Ranks>> ranks,
                               Update<Warnings> warnings) const {
  if (warnings->has(lid_is_wet)) return;
  const OccupiedCells<Dim>& occupied = cells ? static_cast<const OccupiedCells<Dim>&>(*cells) : *dual_cells;
  for (const Lid<Dim>& lid : lids->lids) {
    auto place = touching<Dim>(lid, *grid, occupied, x_p.span());
    if (ranks) place = of_lowest_rank(*ranks->all, place);
    if (!place) continue;
    warnings->add(lid_is_wet,
                  fmt::format("liquid touches the lid, the {} side of {}, at {}, t = {:.6g} s: the box is closed, "
                              "and its walls hold what touches them; for an open tank make this side "
                              "\"separating\", give it an opening, or make the box higher",
                              lid.is_high ? "high" : "low", "xyz"[lid.axis], place_text<Dim>(*place), clock -> time));
    return;
  }
}

template Lids<2> lids_of<2>(const Vec<2>&, World&);
template Lids<3> lids_of<3>(const Vec<3>&, World&);
template struct WatchLid<2>;
template struct WatchLid<3>;

}  // namespace minamo
