#pragma once
/// \file
/// (E77) The balances of a step on the staggered grid. Momentum: m_f (v_f - v°_f)/tau = m_f (b_f + c_f) + (B^T
/// lambda)_f; mass: B v = 0. The integrator chooses v° and tau = c_v/c_a. Without pressure the velocity would be the
/// predictor v*; then v = v* - m^-1 B^T x with S x = B v*, S = B m^-1 B^T, and lambda = -x/tau.

#include "components/body.hpp"
#include "components/cells.hpp"
#include "components/fluid.hpp"
#include "components/instant.hpp"
#include "components/liquid.hpp"
#include "components/openings.hpp"
#include "components/particle.hpp"
#include "components/staggered.hpp"
#include "components/step.hpp"
#include "engine/run/clock.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/incidence.hpp"
#include "systems/grid/mac_grid.hpp"
#include "systems/momentum/face_extension.hpp"
#include "systems/transfer/bundles.hpp"

namespace minamo {

/// (E8) on faces: no velocity where a wall holds.
template <int Dim>
struct HoldFaces {
  static constexpr Doc doc = "(E8) wall conditions on v_f^n";
  void operator()(Read<face::Held> held, Update<face::Velocity<Dim>> v_f) const;
};

/// (E8) for the acceleration.
template <int Dim>
struct HoldFaceAccelerations {
  static constexpr Doc doc = "(E8) wall conditions on a_f^n";
  void operator()(Read<face::Held> held, Update<face::Acceleration<Dim>> a_f) const;
};

/// (E12)  v° = v^n, tau = dt/2.
template <int Dim>
struct PredictFacesMidpoint {
  static constexpr Doc doc = "(E12) rates and v°_f, midpoint";
  void operator()(Read<Clock> clock, Read<face::Velocity<Dim>> v_f, Write<Rates> rates,
                  Write<face::Predictor<Dim>> predictor) const;
};

/// (E13)  v° = v^n, tau = dt.
template <int Dim>
struct PredictFacesBackwardEuler {
  static constexpr Doc doc = "(E13) rates and v°_f, backward Euler";
  void operator()(Read<Clock> clock, Read<face::Velocity<Dim>> v_f, Write<Rates> rates,
                  Write<face::Predictor<Dim>> predictor) const;
};

/// (E10)  v° = v^n + (1 - gamma) dt a^n, tau = gamma dt.
template <int Dim>
struct PredictFacesNewmark {
  static constexpr Doc doc = "(E10) rates and v°_f, newmark";
  void operator()(Read<Clock> clock, Read<NewmarkParameters> newmark, Read<face::Velocity<Dim>> v_f,
                  Read<face::Acceleration<Dim>> a_f, Write<Rates> rates, Write<face::Predictor<Dim>> predictor) const;
};

/// (E14)  b_f = b(t), the same everywhere.
template <int Dim>
struct UniformFaceForce {
  static constexpr Doc doc = "(E14) b_f, uniform";
  void operator()(Read<BodyForce> b, Read<Rates> rates, Optional<Read<ode::AtBalances>> ode, Read<face::Held> held,
                  Write<face::BodyForce<Dim>> b_f) const;
};

/// (E14)  b_f = sum_p N_f m_p b_p / m_f.
template <int Dim>
struct P2GFaceForce {
  static constexpr Doc doc = "(E14) b_f, from the particles";
  void operator()(Uses<ParticlesToFaces<Dim>> source, Read<particle::BodyForce<Dim>> b_p, Read<face::Mass<Dim>> m_f,
                  Read<face::Held> held, Write<face::BodyForce<Dim>> b_f) const;
};

/// (E53) on faces: m_f c_f = s sum_p w_c N_f m_p grad f_p (x_f - y_p) with |grad f_p| <= 0.03/dt^2; v*_f gets tau c_f.
template <int Dim>
struct AddFaceInertia {
  static constexpr Doc doc = "(E53) first moment that lumping the mass leaves out";
  void operator()(Uses<ParticlesToFaces<Dim>> source, Read<Clock> clock, Read<ForceStep> step, Read<Rates> rates,
                  Read<cell::LiquidIndicator> w_c, Read<particle::ForceGradient<Dim>> grad_f_p,
                  Read<face::Mass<Dim>> m_f, Read<face::Held> held, Optional<Read<FaceExtension<Dim>>> extension,
                  Write<face::InertiaCorrection<Dim>> c_f, Update<face::Predictor<Dim>> predictor) const;
};

/// Sources B v* of the balances; the others are zero.
template <int Dim>
void set_balance_sources(const Incidence<Dim>& incidence, const Passage<Dim>& passage,
                         std::span<const std::uint32_t> of_unknown, std::span<const Vec<Dim>> predictor,
                         std::span<unknown::Sources> source) {
  for_each_row(source.size(), [&](std::size_t l) {
    source[l] = {};
    source[l][unknown::balance] = incidence.divergence(of_unknown[l], predictor, passage);
  });
}

/// v*_f gets tau b_f; the source of the balances is B v*, the others are zero.
template <int Dim>
struct FillFaceSource {
  static constexpr Doc doc = "(E77) B v*, source of the balances";
  void operator()(Read<Rates> rates, Uses<MacGrid<Dim>> mac, Read<face::Held> held, Read<face::BodyForce<Dim>> b_f,
                  Optional<Read<face::Prescribed<Dim>>> prescribed, Optional<Read<face::Open<Dim>>> open,
                  Optional<Read<face::WallFlux<Dim>>> wall_flux, Read<unknown::Staggered> of_unknown,
                  Update<face::Predictor<Dim>> predictor, Write<unknown::Source> source) const;
};

/// (E63) on the staggered grid: a share kappa of the divergence of v^n beyond that of a velocity without divergence in
/// the middle of the step is taken from v^n before the step.
template <int Dim>
struct DampFaceDivergence {
  static constexpr Doc doc = "(E63) takes a share of the divergence at the start of the step";
  void operator()(Uses<MacGrid<Dim>> mac, Read<face::Velocity<Dim>> v_f, Read<multiplier::Volume> v_l,
                  Read<multiplier::DivergenceAhead> ahead_l, Optional<Read<face::Open<Dim>>> open,
                  Optional<Read<face::OldWallFlux<Dim>>> wall_flux, Read<unknown::Staggered> of_unknown,
                  Update<unknown::Source> source) const;
};

/// Velocities and shift without divergence, or with the one that they are to have: q - m^-1 B^T x of the solutions x.
template <int Dim>
struct ProjectFaces {
  static constexpr Doc doc = "(E77) v_f, w_f, d_f and lambda_l from the solutions";
  void operator()(Read<Rates> rates, Uses<MacGrid<Dim>> mac, Read<face::Mobility<Dim>> mobility,
                  Read<face::Predictor<Dim>> predictor, Read<multiplier::Row> row, Read<unknown::Solution> solution,
                  Write<face::BalanceVelocity<Dim>> v_f, Write<face::Damping<Dim>> damping,
                  Write<face::Shift<Dim>> shift, Write<multiplier::Force> lambda) const;
};

/// (E12)  v^{n+1} = 2 v - (v^n + w), u = dt v.
template <int Dim>
struct CorrectFacesMidpoint {
  static constexpr Doc doc = "(E12) v_f at the end of the step and u_f, midpoint";
  void operator()(Read<Clock> clock, Read<face::Velocity<Dim>> v_old, Read<face::BalanceVelocity<Dim>> v_f,
                  Read<face::Damping<Dim>> damping, Write<face::NewVelocity<Dim>> v_new,
                  Write<face::Displacement<Dim>> u_f) const;
};

/// (E10)  v^{n+1} = v, a^{n+1} = (v - v^n)/(gamma dt) - (1/gamma - 1) a^n, u by the rule.
template <int Dim>
struct CorrectFacesNewmark {
  static constexpr Doc doc = "(E10) v_f, a_f at the end of the step and u_f, newmark";
  void operator()(Read<Clock> clock, Read<NewmarkParameters> newmark, Read<face::Velocity<Dim>> v_old,
                  Read<face::Acceleration<Dim>> a_old, Read<face::BalanceVelocity<Dim>> v_f,
                  Write<face::NewVelocity<Dim>> v_new, Write<face::NewAcceleration<Dim>> a_new,
                  Write<face::Displacement<Dim>> u_f) const;
};

/// (E13)  v^1 = v and a^0 = (v - v^0)/dt, of a standing step.
template <int Dim>
struct CorrectFacesBackwardEuler {
  static constexpr Doc doc = "(E13) v_f and a_f of the starting step";
  void operator()(Read<Clock> clock, Read<face::Velocity<Dim>> v_old, Read<face::BalanceVelocity<Dim>> v_f,
                  Write<face::NewVelocity<Dim>> v_new, Write<face::NewAcceleration<Dim>> a_new) const;
};

/// (E54) on faces, taken at the centre of mass of the particles of a cell.
template <int Dim>
struct G2PFaceForceGradient {
  static constexpr Doc doc = "(E54) grad f_p";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<GridCells<Dim>> cells,
                  Read<CellSites> sites, Read<particle::QuadraturePosition<Dim>> y_p, Read<face::Velocity<Dim>> v_old,
                  Read<face::NewVelocity<Dim>> v_new, Read<face::InertiaCorrection<Dim>> c_f,
                  Write<particle::ForceGradient<Dim>> grad_f_p, Write<ForceStep> step) const;
};

}  // namespace minamo
