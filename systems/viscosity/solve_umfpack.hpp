#pragma once
/// \file
/// (E84) The balances of a step as one sparse matrix, velocities and multipliers at once, by UMFPACK: the reference
/// that the Schur complement (solve.hpp) and the projected conjugate gradients (solve_friction.hpp) are measured
/// against.
///
///   (m/tau + K) v - B^T lambda = f,   B v = g
///
/// Unknowns are the faces that no wall holds, in the order of their rows and directions, then the active multipliers.

#include "components/friction.hpp"
#include "components/step.hpp"
#include "engine/run/linear_solver.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/mac_grid.hpp"
#include "systems/pressure/closed_components.hpp"
#include "systems/viscosity/friction_matrices.hpp"
#include "systems/viscosity/whole_matrix.hpp"

namespace minamo {

/// Factors of the matrix without friction, and of that with it.
template <int Dim>
struct WholeMatrices {
  using rows_of = Staggered;
  WholeMatrix<Dim> frictionless, with_friction;
  static constexpr ComponentInfo info{"solve.whole_matrices", "", "", Lifetime::scratch};
};

/// v_f, the damping w_f (E63), the shift d_f and lambda_l of a step without friction in the balances:
/// f = (m/tau) (v* + w), g = 0 for v; f = 0 for w and d, whose divergence is given.
template <int Dim>
struct SolveFacesUmfpack {
  static constexpr Doc doc = "(E84) v_f, damping and shift by sparse LU of all equations at once";
  /// \throws StepRejected if the matrix is singular or the solution not finite, with the size.
  void operator()(Read<Rates> rates, Uses<MacGrid<Dim>> mac, Read<face::Mobility<Dim>> mobility,
                  Read<face::Predictor<Dim>> predictor, Read<unknown::Staggered> of_unknown,
                  Read<unknown::Site<Dim>> unknown_site, Read<unknown::Neighbour<Dim>> unknown_neighbour,
                  Read<unknown::Conductance<Dim>> conductance, Read<unknown::Diagonal> diagonal,
                  Read<unknown::NullVector> null_vector, Read<unknown::Source> source,
                  Write<WholeMatrices<Dim>> matrices, Write<face::BalanceVelocity<Dim>> v_f,
                  Write<face::Damping<Dim>> damping, Write<face::Shift<Dim>> shift, Write<multiplier::Force> lambda,
                  Write<SolveReport> report) const;
};

/// v_f and lambda_l with friction in the balances (E82); damping and the shift stay as they are.
template <int Dim>
struct SolveFrictionUmfpack {
  static constexpr Doc doc = "(E84) v_f and lambda_l with friction, by sparse LU of all equations at once";
  /// \throws StepRejected if the matrix is singular or the solution not finite, with the size.
  void operator()(Read<Rates> rates, Uses<MacGrid<Dim>> mac, Read<FrictionMatrices<Dim>> friction,
                  Read<GridCells<Dim>> cells, Read<CellSites> sites, Read<face::Mobility<Dim>> mobility,
                  Read<cell::Viscosity> mu_c, Read<face::Predictor<Dim>> predictor, Read<face::Damping<Dim>> damping,
                  Read<unknown::Staggered> of_unknown, Read<unknown::Site<Dim>> unknown_site,
                  Read<unknown::Neighbour<Dim>> unknown_neighbour, Read<unknown::Conductance<Dim>> conductance,
                  Read<unknown::Diagonal> diagonal, Read<unknown::NullVector> null_vector,
                  Update<WholeMatrices<Dim>> matrices, Update<face::BalanceVelocity<Dim>> v_f,
                  Update<multiplier::Force> lambda, Update<SolveReport> report) const;
};

}  // namespace minamo
