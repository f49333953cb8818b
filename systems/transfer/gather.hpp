#pragma once
/// \file
/// The grid-to-particle kernels that transfer schemes are made of.

#include "components/particle.hpp"
#include "systems/grid/support.hpp"

#include <span>

namespace minamo {

/// Value and gradient of a nodal field at a particle.
template <int Dim>
struct Sample {
  Vec<Dim> value;
  Mat<Dim> gradient;  ///< row i: gradient of component i
};

/// (E17)  q_p = sum_I S_Ip q_I; use(p, q_p) for every particle.
template <int Dim, class Use>
void gather(const Grid<Dim>& grid, const OccupiedCells<Dim>& cells, std::span<const Vec<Dim>> y_p,
            std::span<const Vec<Dim>> q_i, const Use& use) {
  for_each_cell<Dim>(cells, [&](std::size_t, const auto& cell) {
    const Support<Dim> support(grid, cell.node);
    std::array<Vec<Dim>, support_size<Dim>> q;
    for (std::size_t k = 0; k < q.size(); ++k) q[k] = q_i[support.node[k]];
    for (std::size_t p = cell.begin; p < cell.end; ++p) {
      const Weights<Dim> weights(support, y_p[p]);
      Vec<Dim> q_p = Vec<Dim>::Zero();
      for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) { q_p += weights(offset) * q[k]; });
      use(p, q_p);
    }
  });
}

/// (E17), (E18)  with grad q_p = sum_I q_I (x) grad S_Ip; use(p, sample) for every particle.
template <int Dim, class Use>
void gather_with_gradient(const Grid<Dim>& grid, const OccupiedCells<Dim>& cells, std::span<const Vec<Dim>> y_p,
                          std::span<const Vec<Dim>> q_i, const Use& use) {
  for_each_cell<Dim>(cells, [&](std::size_t, const auto& cell) {
    const Support<Dim> support(grid, cell.node);
    std::array<Vec<Dim>, support_size<Dim>> q;
    for (std::size_t k = 0; k < q.size(); ++k) q[k] = q_i[support.node[k]];
    for (std::size_t p = cell.begin; p < cell.end; ++p) {
      const Weights<Dim> weights(support, y_p[p]);
      Sample<Dim> sample{Vec<Dim>::Zero(), Mat<Dim>::Zero()};
      for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) {
        sample.value += weights(offset) * q[k];
        sample.gradient += q[k] * weights.gradient(offset).transpose();
      });
      use(p, sample);
    }
  });
}

}  // namespace minamo
