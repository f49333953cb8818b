#include "systems/equal_order/pressure_gradient.hpp"

#include "systems/transfer/node_gather.hpp"
#include "systems/transfer/node_scatter.hpp"

namespace minamo {

template <int Dim>
void G2PPressureGradient<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                          Read<particle::QuadraturePosition<Dim>> y_p, Read<node::Pressure> p_i,
                                          Write<particle::PressureGradient<Dim>> grad_p_p) const {
  for_each_cell<Dim>(*cells, [&](std::size_t, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    for (std::size_t p = cell.begin; p < cell.end; ++p) {
      const Weights<Dim> weights(support, y_p[p]);
      Vec<Dim> gradient = Vec<Dim>::Zero();
      for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) {
        gradient += p_i[support.node[k]] * weights.gradient(offset);
      });
      grad_p_p[p] = gradient;
    }
  });
}

template <int Dim>
void P2GPressureGradient<Dim>::operator()(Uses<ParticlesToNodes<Dim>> source,
                                          Read<particle::PressureGradient<Dim>> grad_p_p,
                                          Write<node::PressureGradient<Dim>> g_i) const {
  scatter_constant<Dim>(source, grad_p_p.span(), g_i.span());
}

template struct G2PPressureGradient<2>;
template struct G2PPressureGradient<3>;
template struct P2GPressureGradient<2>;
template struct P2GPressureGradient<3>;

}  // namespace minamo
