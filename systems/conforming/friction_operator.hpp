#pragma once
/// \file
/// The friction matrix K = sum_c mu_c K^_c of the faces, never put together: cell by cell.

#include "components/cells.hpp"
#include "systems/conforming/friction_matrices.hpp"

#include <span>

namespace minamo {

/// What K is made of.
template <int Dim>
struct FrictionOf {
  const Splines<Dim>& splines;
  const FrictionMatrices<Dim>& matrices;
  const OccupiedCells<Dim>& cells;
  const CellSites& sites;
  std::span<const double> mu_c;
};

/// out = K v by cells; at(f) of a face of row i and direction d is that of number Dim i + d.
template <int Dim>
void apply_friction(const FrictionOf<Dim>& of, const double* v, double* out) {
  with_degree(of.splines.degree, [&](auto degree) {
    constexpr int K = degree();
    constexpr std::size_t n = cell_faces<Dim, K>;
    for_each_cell_coloured<Dim>(of.cells, [&](std::size_t c, const auto& cell) {
      const double mu = of.mu_c[c];
      if (mu == 0) return;
      const std::uint32_t* rows = of.sites.of(c);
      const double* matrix = of.matrices.of(of.splines, cell.node);
      std::array<double, n> x;
      std::array<double, n> y{};
      for_each_cell_face<Dim, K>([&](std::size_t f, std::size_t k, Eigen::Index d) {
        x[f] = mu * v[Dim * rows[k] + static_cast<std::size_t>(d)];
      });
      for (std::size_t g = 0; g < n; ++g) {
        for (std::size_t f = 0; f < n; ++f) y[f] += matrix[g * n + f] * x[g];
      }
      for_each_cell_face<Dim, K>([&](std::size_t f, std::size_t k, Eigen::Index d) {
        out[Dim * rows[k] + static_cast<std::size_t>(d)] += y[f];
      });
    });
  });
}

/// Adds mu_c times a diagonal of every cell: diagonal(kind's numbers, f).
template <int Dim, class Entry>
void add_friction_diagonal(const FrictionOf<Dim>& of, double* out, const Entry& entry) {
  with_degree(of.splines.degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_cell_coloured<Dim>(of.cells, [&](std::size_t c, const auto& cell) {
      const std::uint32_t* rows = of.sites.of(c);
      for_each_cell_face<Dim, K>([&](std::size_t f, std::size_t k, Eigen::Index d) {
        out[Dim * rows[k] + static_cast<std::size_t>(d)] += of.mu_c[c] * entry(cell.node, f, cell_faces<Dim, K>);
      });
    });
  });
}

}  // namespace minamo
