#pragma once
/// \file
/// (E92) Free bodies and the liquid at once: a few unknowns for every body around the matrix S of the multipliers.

#include "components/fluid.hpp"
#include "components/instant.hpp"
#include "components/staggered.hpp"
#include "components/step.hpp"
#include "components/surface_tension.hpp"
#include "engine/run/clock.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/body_set.hpp"
#include "systems/grid/mac_grid.hpp"
#include "systems/pressure/solve.hpp"
#include "systems/ranks/site_exchange.hpp"
#include "systems/viscosity/cut_friction.hpp"

namespace minamo {

/// (E92)  Corrects the solutions of (E77), which hold for bodies that keep their velocities, for those that free bodies
/// get; (E93) keeps them apart. The volume correction moves no body.
/// \throws StepRejected if a velocity is not finite
template <int Dim>
struct CoupleFreeBodies {
  static constexpr Doc doc = "(E92) (E93) velocities of free bodies, and what they change of the solutions";
  void operator()(Read<Clock> clock, Read<Rates> rates, Uses<MacGrid<Dim>> mac, Read<SolverTolerance> tolerance,
                  Read<BodyForce> force, Optional<Read<ode::AtBalances>> ode, Read<BodySet<Dim>> set,
                  Read<body::Position<Dim>> c_b, Read<body::Rotation<Dim>> R_b, Read<body::StopImpulse<Dim>> J_b,
                  Read<body::MiddlePosition<Dim>> c_middle, Read<body::MiddleRotation<Dim>> R_middle,
                  Read<face::BodyForce<Dim>> b_f, Read<face::AttachedMass<Dim>> attached,
                  Read<face::AttachedTo<Dim>> attached_to, Read<face::Closed<Dim>> closed,
                  Read<face::Closer<Dim>> closer, Read<unknown::Staggered> of_unknown,
                  Read<unknown::Site<Dim>> unknown_site, Read<unknown::Neighbour<Dim>> unknown_neighbour,
                  Read<unknown::Conductance<Dim>> conductance, Read<unknown::Diagonal> diagonal,
                  Read<unknown::NullVector> null_vector, Read<unknown::Source> source, Read<multiplier::Volume> v_l,
                  Read<multiplier::Capacity> capacity, Optional<Read<FrictionOnWalls<Dim>>> friction,
                  Optional<Read<surface::ForceOnBodies<Dim>>> lines, Optional<Read<SiteExchange>> shared,
                  Update<MultiplierSolver<Dim>> solver, Update<unknown::Solution> solution, Update<SolveReport> report,
                  Update<body::MeanVelocity<Dim>> V_mean, Update<body::MeanSpin<Dim>> omega_mean,
                  Update<body::Work> W_b, Write<body::EndVelocity<Dim>> V_end,
                  Write<body::EndSpin<Dim>> omega_end) const;
};

}  // namespace minamo
