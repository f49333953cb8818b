#pragma once
/// \file
/// Block elimination: the displacement is eliminated by the velocity block, and GMRES solves for the pressure, with
/// factors of a matrix near its operator as preconditioner. Equal to UMFPACK to the tolerance. The method as a
/// whole: README.md.

#include "components/fluid.hpp"
#include "components/grid.hpp"
#include "components/matrix.hpp"
#include "components/node.hpp"
#include "components/step.hpp"
#include "engine/run/clock.hpp"
#include "engine/run/linear_solver.hpp"
#include "engine/schedule/system.hpp"
#include "systems/equal_order/pressure_factors.hpp"
#include "systems/equal_order/schur_operator.hpp"
#include "systems/equal_order/velocity_factors.hpp"
#include "systems/linear/umfpack.hpp"

namespace minamo {

/// The monolithic system, where iterations fail: rare, and what UMFPACK is for.
struct Fallback {
  bool is_used = false;  ///< whether it has solved the step
  matrix::Monolithic matrix;
  UmfpackFactors factors;
  PackedVectors packed;
  using rows_of = ActiveNodes;
  static constexpr ComponentInfo info{"solve.fallback", "", "", Lifetime::scratch};
};

/// Room for a solve.
template <int Dim>
struct BlockWork {
  Gmres gmres;
  SchurVectors products;
  typename VelocityFactors<Dim>::Work velocity;
  Values momentum, mass;  ///< right-hand sides
  Values displacement, pressure;
  Values more_displacement, f, of_velocity;
  Values more_pressure, g, zero, unscaled;
  static constexpr ComponentInfo info{"solve.block_work", "", "", Lifetime::cache};
};

template <int Dim>
struct AssembleSchur {
  static constexpr Doc doc = "(E55) operator of the pressure";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Fluid> fluid, Read<Rates> rates, Read<node::Row> row,
                  Read<node::Constraint> fixed, Read<node::Mass> m_i, Read<matrix::Node> node,
                  Read<matrix::Neighbour<Dim>> neighbour, Read<matrix::Divergence<Dim>> divergence,
                  Read<matrix::Stabilization<Dim>> stabilization, Optional<Read<matrix::Viscosity<Dim>>> viscosity,
                  Write<SchurOperator<Dim>> schur) const;
};

template <int Dim>
struct FactorizeVelocity {
  static constexpr Doc doc = "(E60) factors of the velocity block";
  /// \throws StepRejected if there are none.
  void operator()(Read<node::Mass> m_i, Read<matrix::Node> node, Optional<Read<matrix::Viscosity<Dim>>> viscosity,
                  Read<SchurOperator<Dim>> schur, Write<VelocityFactors<Dim>> factors) const;
};

template <int Dim>
struct FactorizePressure {
  static constexpr Doc doc = "(E56) (E57) preconditioner of the pressure";
  void operator()(Read<Grid<Dim>> grid, Read<Fluid> fluid, Read<node::Constraint> fixed, Read<node::Mass> m_i,
                  Read<node::Site<Dim>> site, Read<node::Capacity> capacity, Read<matrix::Node> node,
                  Read<matrix::Divergence<Dim>> divergence, Read<matrix::StabilizationScale> scale,
                  Optional<Read<matrix::Viscosity<Dim>>> viscosity, Read<SchurOperator<Dim>> schur,
                  Write<PressureFactors<Dim>> factors) const;
};

/// The operators are read for products with the viscous part, and for the fallback.
template <int Dim>
struct SolveBlock {
  static constexpr Doc doc = "(E55) block elimination and GMRES";
  /// \throws StepRejected if neither GMRES nor UMFPACK solves the system, with the size, or if iterations for the
  ///   velocities of a stiff liquid do not converge, which shorter steps help.
  void operator()(Read<SolverTolerance> tolerance, Read<node::Row> row, Read<node::Constraint> fixed,
                  Read<node::Mass> m_i, Read<node::Pressure> p_i, Read<matrix::Node> node,
                  Read<matrix::Neighbour<Dim>> neighbour, Read<matrix::Divergence<Dim>> divergence,
                  Read<matrix::Stabilization<Dim>> stabilization, Optional<Read<matrix::Viscosity<Dim>>> viscosity,
                  Read<SchurOperator<Dim>> schur, Read<VelocityFactors<Dim>> velocity_factors,
                  Read<matrix::Momentum<Dim>> f, Read<matrix::Mass> g, Update<PressureFactors<Dim>> pressure_factors,
                  Update<BlockWork<Dim>> work, Write<Fallback> fallback, Write<matrix::Displacement<Dim>> u,
                  Write<matrix::Pressure> p, Write<SolveReport> report) const;
};

template <int Dim>
struct SolveVolumeBlock {
  static constexpr Doc doc = "(E37) d_I, by the factors of the step";
  /// \throws StepRejected as SolveBlock.
  void operator()(Read<SolverTolerance> tolerance, Read<node::Row> row, Read<node::Constraint> fixed,
                  Read<node::Mass> m_i, Read<matrix::Node> node, Read<matrix::Neighbour<Dim>> neighbour,
                  Read<matrix::Divergence<Dim>> divergence, Read<matrix::Stabilization<Dim>> stabilization,
                  Optional<Read<matrix::Viscosity<Dim>>> viscosity, Read<SchurOperator<Dim>> schur,
                  Read<VelocityFactors<Dim>> velocity_factors, Read<matrix::VolumeSource> g,
                  Update<PressureFactors<Dim>> pressure_factors, Update<BlockWork<Dim>> work, Update<Fallback> fallback,
                  Write<matrix::Shift<Dim>> d) const;
};

}  // namespace minamo
