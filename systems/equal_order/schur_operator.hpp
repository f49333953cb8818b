#pragma once
/// \file
/// The pressure Schur complement of the equations of a step, as an operator on pressures.
///
/// (E55)  S = B A^-1 D^T + T + e, B = c_v D + c_a G: what (E25), (E26) leave when the displacement is eliminated, A the
/// velocity block.

#include "components/node.hpp"
#include "systems/equal_order/operators.hpp"
#include "systems/linear/gmres.hpp"

namespace minamo {

/// Velocity and pressure of a row side by side, so that a product with a row is one with registers.
struct SchurVectors {
  std::vector<Four> velocity_and_pressure;  ///< and zeros for neighbours without a row
  Values pressure;                          ///< likewise
};

template <int Dim>
class SchurOperator {
 public:
  using rows_of = ActiveNodes;
  static constexpr ComponentInfo info{"solve.schur", "S", "", Lifetime::scratch};

  /// A number of every component for every place of the stencil.
  using Entries = std::array<Four, stencil_size<Dim>>;
  /// The row at every place of the stencil, rows() where there is none.
  using Neighbours = std::array<std::uint32_t, stencil_size<Dim>>;

  void assemble(const Operators<Dim>& terms);
  const Coefficients& coefficients() const { return coefficients_; }
  std::size_t rows() const { return neighbours_.size(); }
  const Neighbours& neighbours(std::size_t row) const { return neighbours_[row]; }
  /// D_JI of a row I, by directions.
  const Entries& gradient(std::size_t row) const { return gradient_[row]; }
  /// B_IJ by directions, then T_IJ.
  const Entries& divergence(std::size_t row) const { return divergence_[row]; }
  /// e_I
  double pressure_of_mass(std::size_t row) const { return pressure_of_mass_[row]; }
  /// 1/(c_a m_I + c_v K_II) at [Dim r + d], 0 towards walls.
  const Values& inverse_diagonal() const { return inverse_diagonal_; }

  /// out = D^T p, at [Dim r + d].
  void apply_gradient(const Values& p, SchurVectors& work, Values& out) const;
  /// out = B w + (T + e) p, w at [Dim r + d].
  void apply_divergence(const Values& w, const Values& p, SchurVectors& work, Values& out) const;
  /// out = S p with the inverse diagonal for A^-1.
  void apply_with_diagonal(const Values& p, SchurVectors& work, Values& out) const;

 private:
  void fill_row(const Operators<Dim>& terms, std::size_t row);
  void take_pressure(const Values& p, SchurVectors& work) const;
  Four gradient_at(std::size_t row, const SchurVectors& work) const;
  void find_divergence(const SchurVectors& work, Values& out) const;

  std::vector<Neighbours> neighbours_;
  std::vector<Entries> gradient_;
  std::vector<Entries> divergence_;
  Values pressure_of_mass_;
  Values inverse_diagonal_;
  Coefficients coefficients_;
};

}  // namespace minamo
