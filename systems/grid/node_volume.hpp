#pragma once
/// \file
/// Volume around nodes: of the grid, and of the particles.

#include "components/advected_node.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/contract.hpp"
#include "systems/grid/point_locator.hpp"

#include <span>

namespace minamo {

/// (E39)  V_I of a box with nothing inside: h^d, times 13/24 on a wall and 23/24 next to it. Kernels read
/// node::Capacity, which may be less. [m^3; m^2 in 2-D]
template <int Dim>
double full_volume(const Grid<Dim>& grid, const Index<Dim>& site) {
  double volume = 1;
  for (std::size_t d = 0; d < Dim; ++d) {
    volume *= grid.spacing;
    if (!grid.periodic[d]) volume *= axis_integral(site[d], grid.cells[d]);
  }
  return volume;
}

/// Numbers the nodes that particles touch, wherever they are.
template <int Dim>
void number_advected_nodes(const Grid<Dim>& grid, std::span<const Vec<Dim>> x_p, Resize<AdvectedNodes> nodes,
                           AdvectedNodeIndex<Dim>& rows, Write<advected_node::Site<Dim>> sites) {
  rows.start(grid);
  rows.runs.clear();
  typename SiteRows<Dim>::Adder add(rows);
  DualCellFinder<Dim> cell(grid);
  Vec<Dim> y;
  for (std::size_t p = 0; p < x_p.size(); ++p) {
    if (!cell.finds_another(x_p[p], y)) continue;
    rows.runs.push_back({cell.own(), static_cast<std::uint32_t>(p), {}});
    for_each_address<Dim>(grid, rows, SupportBox<Dim>(grid, cell.own()),
                          [&](std::size_t, const auto& address) { add(address); });
  }
  nodes.resize(rows.number_rows());
  rows.for_each([&](const Index<Dim>& site, std::uint32_t i) { sites[i] = site; });
}

/// What particles in one dual cell give to its nodes, sum_p S_I(x_p) V_p, from their sums of V_p xi^a eta^b zeta^c.
template <int Dim>
std::array<double, support_size<Dim>> volume_of_run(const Grid<Dim>& grid, const Index<Dim>& own,
                                                    std::span<const Vec<Dim>> x_p, std::span<const double> V_p) {
  const SupportBox<Dim> support(grid, own);
  std::array<double, support_size<Dim>> moments{};
  for (std::size_t p = 0; p < x_p.size(); ++p) {
    const Vec<Dim> xi = (in_cell<Dim>(grid, support.centre, x_p[p]) - support.centre) * support.per_spacing;
    std::array<std::array<double, weight_powers>, static_cast<std::size_t>(Dim)> powers;
    for (std::size_t d = 0; d < Dim; ++d) {
      const double x = xi[static_cast<Eigen::Index>(d)];
      powers[d] = {1, x, x * x};
    }
    for_each_support<Dim>([&](std::size_t k, const Index<Dim>& of) {
      double product = V_p[p];
      for (std::size_t d = Dim; d-- > 0;) product *= powers[d][static_cast<std::size_t>(of[d])];
      moments[k] += product;
    });
  }
  return contract_axes<Dim, weight_powers, 3>(moments, [&](std::size_t d) {
    return [&w = support.basis[d]->weight](std::size_t q, std::size_t k) { return w[q][k]; };
  });
}

/// (E35)  V~_I = sum_p S_I(x_p) V_p: first in every run, then one run after the other.
/// \pre the rows are those of these particles.
template <int Dim>
void gather_node_volume(const Grid<Dim>& grid, AdvectedNodeIndex<Dim>& rows, std::span<const Vec<Dim>> x_p,
                        std::span<const double> V_p, std::span<double> v_i) {
  constexpr std::size_t runs_per_task = 64;
  const auto add_up = [&](std::size_t r) {
    auto& run = rows.runs[r];
    const std::size_t end = r + 1 < rows.runs.size() ? rows.runs[r + 1].begin : x_p.size();
    const std::size_t count = end - run.begin;
    run.volume = volume_of_run<Dim>(grid, run.node, x_p.subspan(run.begin, count), V_p.subspan(run.begin, count));
  };
  for_each_row(rows.runs.size(), add_up, runs_per_task);
  std::fill(v_i.begin(), v_i.end(), 0.0);
  typename SiteRows<Dim>::Finder find(rows);
  for (const auto& run : rows.runs) {
    for_each_address<Dim>(grid, rows, SupportBox<Dim>(grid, run.node),
                          [&](std::size_t k, const auto& address) { v_i[*find(address)] += run.volume[k]; });
  }
}

}  // namespace minamo
