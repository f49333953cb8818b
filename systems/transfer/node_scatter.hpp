#pragma once
/// \file
/// The particle-to-grid kernels that transfer schemes are made of: mass-weighted means at nodes of what particles
/// carry, taken as constant around a particle or with its gradient.

#include "components/particle.hpp"
#include "systems/grid/node_support.hpp"
#include "systems/transfer/bundles.hpp"
#include "systems/transfer/padded.hpp"

#include <span>

namespace minamo {

/// Calls add(p, support, weights, sum) for every particle, where `sum` holds 3^d nodal sums of its cell as PaddedVec,
/// and divides the nodal sums by the nodal mass. Nodes without mass get zero.
template <int Dim, class Add>
void scatter_mean(const NodeSource<Dim>& source, std::span<Vec<Dim>> out, const Add& add) {
  for_each_row(out.size(), [&](std::size_t i) { out[i].setZero(); });
  for_each_cell_coloured<Dim>(source.cells, [&](std::size_t, const auto& cell) {
    const Support<Dim> support(source.grid, cell);
    std::array<PaddedVec<Dim>, support_size<Dim>> sum;
    sum.fill(PaddedVec<Dim>::Zero());
    for (std::size_t p = cell.begin; p < cell.end; ++p) {
      add(p, support, Weights<Dim>(support, source.y_p[p]), sum);
    }
    for (std::size_t k = 0; k < sum.size(); ++k) out[support.node[k]] += unpadded<Dim>(sum[k]);
  });
  for_each_row(out.size(), [&](std::size_t i) {
    if (source.m_i[i] > 0) out[i] /= source.m_i[i];
  });
}

/// (E4)  q_I = sum_p S_Ip m_p q_p / m_I.
template <int Dim>
void scatter_constant(const NodeSource<Dim>& source, std::span<const Vec<Dim>> q_p, std::span<Vec<Dim>> q_i) {
  scatter_mean<Dim>(source, q_i, [&](std::size_t p, const Support<Dim>&, const Weights<Dim>& weights, auto& sum) {
    const PaddedVec<Dim> mq = padded<Dim>(source.m_p[p] * q_p[p]);
    for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) { sum[k] += weights(offset) * mq; });
  });
}

/// (E5)  q_I = sum_p S_Ip m_p (q_p + grad q_p (x_I - y_p)) / m_I.
template <int Dim>
void scatter_taylor(const NodeSource<Dim>& source, std::span<const Vec<Dim>> q_p, std::span<const Mat<Dim>> grad_q_p,
                    std::span<Vec<Dim>> q_i) {
  const double h = source.grid.spacing;
  scatter_mean<Dim>(
      source, q_i, [&](std::size_t p, const Support<Dim>& support, const Weights<Dim>& weights, auto& sum) {
        const Vec<Dim> at_corner = source.m_p[p] * (q_p[p] + grad_q_p[p] * (support.corner - source.y_p[p]));
        const PaddedVec<Dim> first = padded<Dim>(at_corner);
        std::array<PaddedVec<Dim>, Dim> per_node;
        for (std::size_t d = 0; d < Dim; ++d) {
          per_node[d] = padded<Dim>((source.m_p[p] * h) * grad_q_p[p].col(static_cast<Eigen::Index>(d)));
        }
        for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) {
          PaddedVec<Dim> mq = first;
          for (std::size_t d = 0; d < Dim; ++d) mq += offset[d] * per_node[d];
          sum[k] += weights(offset) * mq;
        });
      });
}

}  // namespace minamo
