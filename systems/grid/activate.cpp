#include "systems/grid/activate.hpp"

namespace minamo {

namespace {

double mean_mass(Read<node::Mass> m_i) {
  double mass = 0;
  std::size_t count = 0;
  for (const double m : m_i) {
    mass += m;
    count += m > 0;
  }
  return count == 0 ? 0 : mass / static_cast<double>(count);
}

}  // namespace

template <int Dim>
void Activate<Dim>::operator()(Read<node::Mass> m_i, Resize<ActiveNodes> rows, Write<node::Row> row,
                               Write<matrix::Node> node) const {
  // (E7): the rows of lighter nodes are noise to the solver and their accelerations are noise to the particles.
  const double light = 1e-4 * mean_mass(m_i);
  std::int32_t count = 0;
  for (std::size_t i = 0; i < m_i.size(); ++i) row[i] = m_i[i] > light ? count++ : -1;
  rows.resize(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < m_i.size(); ++i) {
    if (row[i] >= 0) node[static_cast<std::size_t>(row[i])] = static_cast<std::uint32_t>(i);
  }
}

template struct Activate<2>;
template struct Activate<3>;

}  // namespace minamo
