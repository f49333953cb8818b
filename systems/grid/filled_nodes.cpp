#include "systems/grid/filled_nodes.hpp"

#include "systems/grid/node_support.hpp"

namespace minamo {

namespace {

/// Particles of a flow fill nodes to some hundredths more or less; at a surface a node is half full, its neighbour to
/// 0.98.
constexpr double none_below = 0.9;
constexpr double all_from = 0.97;

}  // namespace

double filled_indicator(double least_fill) {
  return std::clamp((least_fill - none_below) / (all_from - none_below), 0.0, 1.0);
}

template <int Dim>
void FindFilledNodes<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<Fluid> fluid,
                                      Read<node::Mass> m_i, Read<node::Capacity> capacity,
                                      Write<node::FillFraction> phi_i, Write<node::FilledIndicator> theta_i) const {
  for_each_row(theta_i.size(), [&](std::size_t i) { phi_i[i] = theta_i[i] = 0; });
  for_each_cell<Dim>(*cells, [&](std::size_t, const auto& cell) {
    const std::size_t i = Support<Dim>(*grid, cell).own();
    phi_i[i] = m_i[i] / (fluid->density * capacity[i]);
  });
  for_each_cell<Dim>(*cells, [&](std::size_t, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    double least = all_from;
    for (const std::size_t j : support.node) least = std::min(least, phi_i[j]);
    theta_i[support.own()] = filled_indicator(least);
  });
}

template struct FindFilledNodes<2>;
template struct FindFilledNodes<3>;

}  // namespace minamo
