#include "systems/measure/volume.hpp"

#include "systems/grid/support.hpp"
#include "systems/solve/stencil.hpp"

#include <cmath>

namespace minamo {

namespace {

/// V_I of every node, x fastest.
template <int Dim, class Body>
void for_each_node_volume(const Grid<Dim>& grid, const Body& body) {
  const double full = std::pow(grid.spacing, Dim);
  for (std::size_t i = 0; i < grid.node_count(); ++i) {
    double share = 1;
    std::size_t rest = i;
    for (int d = 0; d < Dim; ++d) {
      const auto nodes = static_cast<std::size_t>(grid.nodes(d));
      share *= axis_integral(static_cast<int>(rest % nodes), grid.cells[static_cast<std::size_t>(d)]);
      rest /= nodes;
    }
    body(i, share * full);
  }
}

}  // namespace

template <int Dim>
void MeasureDivergence<Dim>::operator()(Read<Grid<Dim>> grid, Read<Fluid> fluid, Read<Rates> rates,
                                        Read<matrix::Node> node, Read<matrix::Divergence<Dim>> divergence,
                                        Read<node::Mass> m_i, Read<node::KnownVelocity<Dim>> v_known,
                                        Read<node::Displacement<Dim>> u_i,
                                        Write<measure::MaxDivergence> largest) const {
  const Stencil<Dim> stencil(*grid);
  const auto of_row = [&](std::size_t r) {
    double sum = 0;
    stencil.for_each_neighbour(node[r], [&](std::size_t k, std::uint32_t j) {
      const Vec<Dim> v = rates->velocity * u_i[j] + v_known[j];
      for (std::size_t d = 0; d < Dim; ++d) sum += divergence[r][Dim * k + d] * v[static_cast<Eigen::Index>(d)];
    });
    return std::abs(sum) * fluid->density / m_i[node[r]];
  };
  largest->value = reduce_rows(node.size(), 0.0, of_row, [](double x, double y) { return std::max(x, y); });
}

template <int Dim>
void MeasureOverlap<Dim>::operator()(Read<Grid<Dim>> grid, Read<Fluid> fluid, Read<particle::Position<Dim>> x_p,
                                     Read<particle::Mass> m_p, Write<node::Volume> v_i,
                                     Write<measure::Overlap> overlap) const {
  // One after the other: particles have left the cells that they are sorted by.
  const auto volume = v_i.span();
  std::fill(volume.begin(), volume.end(), 0.0);
  double total = 0;
  for (std::size_t p = 0; p < x_p.size(); ++p) {
    const double v = m_p[p] / fluid->density;
    const Support<Dim> support(*grid, dual_cell<Dim>(*grid, x_p[p]));
    const Weights<Dim> weights(support, x_p[p]);
    for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) { volume[support.node[k]] += weights(offset) * v; });
    total += v;
  }
  double excess = 0;
  for_each_node_volume<Dim>(*grid, [&](std::size_t i, double full) { excess += std::max(0.0, volume[i] - full); });
  overlap->value = excess / total;
}

template struct MeasureDivergence<2>;
template struct MeasureDivergence<3>;
template struct MeasureOverlap<2>;
template struct MeasureOverlap<3>;

}  // namespace minamo
