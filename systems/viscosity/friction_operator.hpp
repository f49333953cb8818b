#pragma once
/// \file
/// The friction matrix K = sum_c mu_c K^_c of the faces, never put together: cell by cell. Near bodies that rub it is
/// E^T K E, E the extension (E87), with the matrices of cells that are cut (E110).

#include "components/cells.hpp"
#include "systems/momentum/face_extension.hpp"
#include "systems/ranks/site_exchange.hpp"
#include "systems/viscosity/cut_friction.hpp"
#include "systems/viscosity/friction_matrices.hpp"

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
  /// Without bodies that rub all three are null.
  const FaceExtension<Dim>* extension = nullptr;
  const CutFriction<Dim>* cut = nullptr;
  const FrictionAtRest<Dim>* at_rest = nullptr;
  /// With other ranks: theirs is what they have of their cells.
  const SiteExchange* shared = nullptr;

  bool is_cut(std::size_t c) const { return cut != nullptr && cut->cuts(c); }
  const double* matrix_of(std::size_t c) const {
    if (!is_cut(c)) return matrices.of(splines, cells.cells[c].node);
    return cut->with(c, *at_rest, [](const auto& cell, std::size_t k) { return cell.matrix(k); });
  }
  const double* bounds_of(std::size_t c) const {
    if (!is_cut(c)) return matrices.bounds_of(splines, cells.cells[c].node);
    return cut->with(c, *at_rest, [](const auto& cell, std::size_t k) { return cell.bounds(k); });
  }
  /// Calls use(number in K, number of the face in the cell) for the faces of a cell.
  template <class Use>
  void for_each_face_of(std::size_t c, const Use& use) const {
    const std::uint32_t* rows = sites.of(c);
    with_degree(splines.degree, [&](auto degree) {
      for_each_cell_face<Dim, degree()>(
          [&](std::size_t f, std::size_t k, Eigen::Index d) { use(Dim * rows[k] + static_cast<std::size_t>(d), f); });
    });
  }
};

/// What every rank has of its cells becomes what all have, by face and direction.
template <int Dim>
void add_up_faces(const SiteExchange* shared, std::span<double> out) {
  if (shared != nullptr) shared->add_up(Dim, [&](std::size_t i) { return &out[Dim * i]; });
}

/// out += K v by cells; at(f) of a face of row i and direction d is that of number Dim i + d.
template <int Dim>
void apply_friction(const FrictionOf<Dim>& of, const double* v, double* out) {
  with_degree(of.splines.degree, [&](auto degree) {
    constexpr int K = degree();
    constexpr std::size_t n = cell_faces<Dim, K>;
    for_each_cell_coloured<Dim>(of.cells, [&](std::size_t c, const auto&) {
      const double mu = of.mu_c[c];
      if (mu == 0) return;
      const std::uint32_t* rows = of.sites.of(c);
      const double* matrix = of.matrix_of(c);
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

/// Adds mu_c times a diagonal of every cell: diagonal(number of the cell, f, how many faces it has).
template <int Dim, class Entry>
void add_friction_diagonal(const FrictionOf<Dim>& of, double* out, const Entry& entry) {
  with_degree(of.splines.degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_cell_coloured<Dim>(of.cells, [&](std::size_t c, const auto&) {
      const std::uint32_t* rows = of.sites.of(c);
      for_each_cell_face<Dim, K>([&](std::size_t f, std::size_t k, Eigen::Index d) {
        out[Dim * rows[k] + static_cast<std::size_t>(d)] += of.mu_c[c] * entry(c, f, cell_faces<Dim, K>);
      });
    });
  });
}

}  // namespace minamo
