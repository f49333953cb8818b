#include "systems/transfer/mass.hpp"

#include "systems/grid/node_support.hpp"

namespace minamo {

template <int Dim>
void P2GMass<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                              Read<particle::QuadraturePosition<Dim>> y_p, Read<particle::Mass> m_p,
                              Write<node::Mass> m_i) const {
  const auto m_node = m_i.span();
  std::fill(m_node.begin(), m_node.end(), 0.0);
  for_each_cell_coloured<Dim>(*cells, [&](std::size_t, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    std::array<double, support_size<Dim>> sum{};
    for (std::size_t p = cell.begin; p < cell.end; ++p) {
      const Weights<Dim> weights(support, y_p[p]);
      const double m = m_p[p];
      for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) { sum[k] += weights(offset) * m; });
    }
    for (std::size_t k = 0; k < sum.size(); ++k) m_node[support.node[k]] += sum[k];
  });
}

template struct P2GMass<2>;
template struct P2GMass<3>;

}  // namespace minamo
