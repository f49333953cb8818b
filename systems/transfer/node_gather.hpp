#pragma once
/// \file
/// The grid-to-particle kernels that transfer schemes are made of.

#include "systems/transfer/bundles.hpp"
#include "systems/transfer/node_polynomial.hpp"

#include <span>

namespace minamo {

/// A nodal field as a function of the node's row.
template <int Dim>
auto of_nodes(std::span<const Vec<Dim>> q_i) {
  return [q_i](std::size_t i) -> const Vec<Dim>& { return q_i[i]; };
}

/// (E17)  q_p = sum_I S_Ip q_I; use(p, q_p) for every particle. The nodal field is a function of the node's row.
template <int Dim, class AtNode, class Use>
void gather(const NodeTarget<Dim>& target, const AtNode& at_node, const Use& use) {
  for_each_cell<Dim>(target.cells, [&](std::size_t, const auto& cell) {
    const CellPolynomial<Dim> q(Support<Dim>(target.grid, cell), at_node);
    for (std::size_t p = cell.begin; p < cell.end; ++p) use(p, q.at(q.local(target.y_p[p])).value);
  });
}

/// The same of a nodal column.
template <int Dim, class Use>
void gather(const NodeTarget<Dim>& target, std::span<const Vec<Dim>> q_i, const Use& use) {
  gather<Dim>(target, of_nodes<Dim>(q_i), use);
}

/// (E17), (E18)  use(p, jet of the nodal field) for every particle.
template <int Dim, class Use>
void gather_with_gradient(const NodeTarget<Dim>& target, std::span<const Vec<Dim>> q_i, const Use& use) {
  for_each_cell<Dim>(target.cells, [&](std::size_t, const auto& cell) {
    const CellPolynomial<Dim> q(Support<Dim>(target.grid, cell), of_nodes<Dim>(q_i));
    for (std::size_t p = cell.begin; p < cell.end; ++p) use(p, q.at(q.local(target.y_p[p])));
  });
}

}  // namespace minamo
