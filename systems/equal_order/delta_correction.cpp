#include "systems/equal_order/delta_correction.hpp"

#include "systems/grid/node_volume.hpp"
#include "systems/grid/point_locator.hpp"
#include "systems/volume/shift.hpp"

namespace minamo {

namespace {

/// g_p of (E52).
template <int Dim>
Vec<Dim> slope(const NodeStencil<Dim>& place, const Weights<Dim>& weights, std::span<const double> e_i) {
  Vec<Dim> g = Vec<Dim>::Zero();
  place.for_each_node([&](std::size_t i, const Index<Dim>& offset) { g += e_i[i] * weights.gradient(offset); });
  return g;
}

/// lambda of (E52); 0 if nothing responds.
double step_length(std::span<const double> e_i, std::span<const double> r_i) {
  double e_r = 0;
  double r_r = 0;
  for (std::size_t i = 0; i < e_i.size(); ++i) {
    if (e_i[i] == 0) continue;
    e_r += e_i[i] * r_i[i];
    r_r += r_i[i] * r_i[i];
  }
  return r_r > 0 ? e_r / r_r : 0;
}

}  // namespace

template <int Dim>
void ShiftByDelta<Dim>::operator()(Read<Grid<Dim>> grid, Read<particle::Volume> V_p, Read<AdvectedNodeIndex<Dim>> rows,
                                   Read<advected_node::Capacity> capacity, Read<advected_node::Volume> v_i,
                                   Write<advected_node::VolumeExcess> e_i, Write<advected_node::VolumeResponse> r_i,
                                   Update<particle::Position<Dim>> x_p) const {
  for_each_row(e_i.size(), [&](std::size_t i) {
    e_i[i] = std::max(0.0, v_i[i] - capacity[i]);
    r_i[i] = 0;
  });
  // One after the other: particles have left the cells that they are sorted by.
  PointLocator<Dim> places(*grid, *rows);
  for (std::size_t p = 0; p < x_p.size(); ++p) {
    places.visit(x_p[p], [&](const auto& place, const auto& weights) {
      const Vec<Dim> g = V_p[p] * slope<Dim>(place, weights, e_i.span());
      place.for_each_node([&](std::size_t i, const Index<Dim>& offset) { r_i[i] += weights.gradient(offset).dot(g); });
    });
  }
  const double lambda = step_length(e_i.span(), r_i.span());
  for_each_range(x_p.size(), [&](std::size_t begin, std::size_t end) {
    PointLocator<Dim> places_of_range(*grid, *rows);
    for (std::size_t p = begin; p < end; ++p) {
      places_of_range.visit(x_p[p], [&](const auto& place, const auto& weights) {
        x_p[p] = shifted<Dim>(*grid, x_p[p], Vec<Dim>(-lambda * slope<Dim>(place, weights, e_i.span())));
      });
    }
  });
}

template struct ShiftByDelta<2>;
template struct ShiftByDelta<3>;

}  // namespace minamo
