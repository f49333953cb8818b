#pragma once
/// \file
/// (E84) The matrix of all equations of a step on the staggered grid, and its factors by UMFPACK.

#include "components/matrix.hpp"
#include "systems/grid/incidence.hpp"
#include "systems/linear/umfpack.hpp"
#include "systems/viscosity/friction_operator.hpp"

#include <Eigen/SparseCore>

#include <span>
#include <vector>

namespace minamo {

/// Liquid that walls enclose all around has a pressure that nothing fixes; this row of a multiplier fixes it at zero.
struct Grounded {
  std::uint32_t unknown;
  double diagonal;  ///< of the size of the matrix that the multipliers have among themselves [m^-2 s/kg]
};

template <int Dim>
class WholeMatrix {
 public:
  /// Starts (m/tau, -B^T; B, 0).
  /// \param mobility    1/m by row, zero at faces that walls hold, which are no unknowns [1/kg]
  /// \param per_tau     1/tau [1/s]
  /// \param of_unknown  rows of the active multipliers
  void start(const Incidence<Dim>& incidence, std::span<const Vec<Dim>> mobility, double per_tau,
             std::span<const std::uint32_t> of_unknown, std::span<const Grounded> grounded);
  /// Adds K to the velocities.
  void add(const FrictionOf<Dim>& friction);
  /// \throws StepRejected if the matrix is singular, with the size.
  void factorize();

  /// Solves for a force on every face and a divergence of every active multiplier; velocities of held faces are zero.
  /// \param force       f by row [N]; may be empty for zero
  /// \param divergence  g by active multiplier [1/s]; may be empty for zero
  /// \param lambda      by active multiplier [N m]; may be empty
  /// \return the size and what is left of the equations
  /// \throws StepRejected if the solution is not finite, with the size.
  SolveReport solve(std::span<const Vec<Dim>> force, std::span<const double> divergence, std::span<Vec<Dim>> v,
                    std::span<double> lambda);

 private:
  static constexpr std::int32_t none = -1;
  void enter(std::int32_t row, std::int32_t column, double value) { entries_.emplace_back(row, column, value); }

  std::vector<std::int32_t> place_;  ///< of face d of row i, at [Dim i + d]; none where a wall holds it
  std::int32_t faces_ = 0;           ///< unknowns before the first multiplier
  std::int32_t size_ = 0;
  std::vector<Eigen::Triplet<double, std::int32_t>> entries_;
  Eigen::SparseMatrix<double> sum_;
  matrix::Monolithic matrix_;
  UmfpackFactors factors_;
  std::vector<double> b_, x_;
};

}  // namespace minamo
