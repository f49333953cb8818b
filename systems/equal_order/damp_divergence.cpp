#include "systems/equal_order/damp_divergence.hpp"

#include "engine/schedule/parallel.hpp"
#include "systems/grid/liquid_cells.hpp"
#include "systems/grid/node_neighbours.hpp"
#include "systems/grid/node_volume.hpp"
#include "systems/transfer/carry_gradient.hpp"

namespace minamo {

namespace {

/// Enough against what free surfaces feed into the oscillation, 0.03; more lets more of the noise of FLIP's particles
/// move them.
constexpr double kappa = 0.1;

/// w_c of (E61) for the dual cell of a node, whether there are particles in it or not.
template <int Dim>
double liquid_around(const Grid<Dim>& grid, const Index<Dim>& own, double density,
                     const typename matrix::Neighbour<Dim>::value_type& neighbour, std::span<const double> m_i,
                     std::span<const double> capacity) {
  const SupportBox<Dim> cell(grid, own);
  double mass = 0;
  double volume = 0;
  for_each_support<Dim>([&](std::size_t, const Index<Dim>& offset) {
    int place = 0;
    for (std::size_t d = Dim; d-- > 0;) place = 5 * place + cell.first[d] - own[d] + offset[d] + 2;
    const std::int32_t j = neighbour[static_cast<std::size_t>(place)];
    if (j == matrix::Neighbour<Dim>::none) {
      volume += full_volume<Dim>(grid, cell.site(grid, offset));
    } else {
      mass += m_i[static_cast<std::size_t>(j)];
      volume += capacity[static_cast<std::size_t>(j)];
    }
  });
  return liquid_indicator(mass / (density * volume));
}

}  // namespace

template <int Dim>
void DampDivergence<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Fluid> fluid,
                                     Read<node::Site<Dim>> site, Read<node::Mass> m_i, Read<node::Capacity> capacity,
                                     Read<node::Velocity<Dim>> v_i, Read<matrix::Node> node,
                                     Read<matrix::Neighbour<Dim>> neighbour, Read<matrix::Divergence<Dim>> divergence,
                                     Update<matrix::Mass> g) const {
  const double tau = 0.5 * clock->step;
  constexpr std::size_t rows_per_task = 256;
  for_each_row(
      node.size(),
      [&](std::size_t r) {
        // V_I g, row i the gradient of component i.
        Mat<Dim> slope = Mat<Dim>::Zero();
        for_each_neighbour<Dim>(neighbour[r], [&](std::size_t k, std::uint32_t j) {
          for (std::size_t d = 0; d < Dim; ++d) {
            slope.col(static_cast<Eigen::Index>(d)) += divergence[r][Dim * k + d] * v_i[j];
          }
        });
        const double per_volume = fluid->density / m_i[node[r]];
        const double resolved = resolved_share(tau * per_volume * slope.norm());
        double e = slope.trace();
        if (resolved > 0) {
          const double liquid =
              liquid_around<Dim>(*grid, site[node[r]], fluid->density, neighbour[r], m_i.span(), capacity.span());
          e += liquid * resolved * tau * per_volume * (slope * slope).trace();
        }
        g[r] += kappa * e;
      },
      rows_per_task);
}

template struct DampDivergence<2>;
template struct DampDivergence<3>;

}  // namespace minamo
