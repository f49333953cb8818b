#include "systems/grid/activate.hpp"

#include <array>

namespace minamo {

double mass_threshold(std::span<const double> m_i, std::size_t width, const SiteExchange* shared) {
  std::array<double, 2> sums{};  // mass, entries with mass
  for (std::size_t k = 0; k < m_i.size(); ++k) {
    if (!owns(shared, k / width)) continue;
    sums[0] += m_i[k];
    sums[1] += m_i[k] > 0 ? 1 : 0;
  }
  if (shared != nullptr) shared->ranks().sum(sums);
  return sums[1] == 0 ? 0 : share_of_mean_mass * sums[0] / sums[1];
}

namespace {

/// The node of a wall, or of a corner, that a node lies next to; the node itself where there is none.
template <int Dim>
Index<Dim> on_wall(const Grid<Dim>& grid, Index<Dim> site) {
  for (std::size_t d = 0; d < Dim; ++d) {
    if (grid.periodic[d]) continue;
    if (site[d] == 1) site[d] = 0;
    if (site[d] == grid.cells[d] - 1) site[d] = grid.cells[d];
  }
  return site;
}

}  // namespace

template <int Dim>
void Activate<Dim>::operator()(Read<Grid<Dim>> grid, Read<NodeIndex<Dim>> index, Read<node::Site<Dim>> site,
                               Read<node::Mass> m_i, Resize<ActiveNodes> rows, Write<node::Row> row,
                               Write<matrix::Node> node) const {
  // (E7): the rows of lighter nodes are noise to the solver and their accelerations are noise to the particles. Not so
  // next to a wall: water that lies flat on it gives the first node inside hardly any mass but all of its thickening,
  // since the slope of its weight does not vanish, (E2). As a ballistic node it would thin the water out for ever.
  const double threshold = mass_threshold(m_i.span());
  const auto lies_on_wall = [&](std::size_t i) {
    const Index<Dim> wall = on_wall<Dim>(*grid, site[i]);
    if (wall == site[i] || m_i[i] == 0) return false;
    const auto at_wall = index->find(wall);
    return at_wall && m_i[*at_wall] > threshold;
  };
  std::int32_t count = 0;
  for (std::size_t i = 0; i < m_i.size(); ++i) row[i] = m_i[i] > threshold || lies_on_wall(i) ? count++ : -1;
  rows.resize(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < m_i.size(); ++i) {
    if (row[i] >= 0) node[static_cast<std::size_t>(row[i])] = static_cast<std::uint32_t>(i);
  }
}

template struct Activate<2>;
template struct Activate<3>;

}  // namespace minamo
