#include "systems/equal_order/unpack.hpp"

#include "engine/schedule/parallel.hpp"

namespace minamo {

template <int Dim>
void UnpackSolution<Dim>::operator()(Read<matrix::Displacement<Dim>> u, Read<matrix::Pressure> p, Read<node::Row> row,
                                     Update<node::Displacement<Dim>> u_i, Write<node::Pressure> p_i) const {
  for_each_row(row.size(), [&](std::size_t i) {
    p_i[i] = 0;
    if (row[i] < 0) return;
    const auto r = static_cast<std::size_t>(row[i]);
    u_i[i] += u[r];
    p_i[i] = p[r];
  });
}

template struct UnpackSolution<2>;
template struct UnpackSolution<3>;

}  // namespace minamo
