#pragma once
/// \file
/// The cell matrices that the balances are made of. Those of cells full of liquid, (E68), are all alike: they are
/// looked up.

#include "systems/equal_order/cell_matrix.hpp"

namespace minamo {

template <int Dim>
class SlopeMatrices {
 public:
  SlopeMatrices(const SupportBox<Dim>& support, const Moments<Dim>& moments, std::size_t c);

  /// sum_p V_p S_I grad_j S_J, in units of h and of volume().
  const CellMatrix<Dim>& weight_slope(std::size_t j) { return at(j, -1, static_cast<int>(j)); }
  /// sum_p V_p grad_i S_I grad_j S_J, i <= j, in the same units.
  const CellMatrix<Dim>& slope_slope(std::size_t i, std::size_t j) {
    return at(Dim + i * Dim + j - i * (i + 1) / 2, static_cast<int>(i), static_cast<int>(j));
  }
  double volume() const { return volume_; }

 private:
  static constexpr std::size_t kinds = Dim + Dim * (Dim + 1) / 2;
  using Matrices = std::array<CellMatrix<Dim>, kinds>;

  static const Matrices& of_full_cell(const CellBasis<Dim>& basis);

  const CellMatrix<Dim>& at(std::size_t kind, int i, int j) {
    if (full_ != nullptr) return (*full_)[kind];
    cell_matrix<Dim>(*moments_, slope_factors<Dim>(*basis_, i, j), made_[kind]);
    return made_[kind];
  }

  const CellBasis<Dim>* basis_;
  const CellMoments<Dim>* moments_;
  const Matrices* full_;
  double volume_;
  Matrices made_;
};

}  // namespace minamo
