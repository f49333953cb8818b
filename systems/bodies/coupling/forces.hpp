#pragma once
/// \file
/// (E90) What the liquid does to bodies.

#include "components/body.hpp"
#include "components/measure.hpp"
#include "components/step.hpp"
#include "components/surface_tension.hpp"
#include "engine/run/clock.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/body_set.hpp"
#include "systems/grid/mac_grid.hpp"
#include "systems/ranks/site_exchange.hpp"
#include "systems/viscosity/cut_friction.hpp"

namespace minamo {

/// (E90)  F_b = sum_f c_fb (B^T lambda)_f e_f and its moment: the force that does the work of the wall velocities in
/// the balance of mass; and the impulse of damping (E63) over the step. Friction (E110) and contact lines (E121) do
/// work, too.
template <int Dim>
struct PushBodies {
  static constexpr Doc doc = "(E90) force, torque and work of the pressure on bodies";
  void operator()(Read<Clock> clock, Uses<MacGrid<Dim>> mac, Read<BodySet<Dim>> set, Read<multiplier::Force> lambda,
                  Read<Rates> rates, Read<face::BodyForce<Dim>> b_f, Read<face::AttachedMass<Dim>> attached,
                  Read<face::AttachedTo<Dim>> attached_to, Read<multiplier::Row> row, Read<unknown::Solution> solution,
                  Read<face::Closed<Dim>> closed, Read<face::Closer<Dim>> closer, Read<body::MiddlePosition<Dim>> c_b,
                  Read<body::Velocity<Dim>> V_old, Read<body::Spin<Dim>> omega_old, Read<body::MeanVelocity<Dim>> V_b,
                  Read<body::MeanSpin<Dim>> omega_b, Optional<Read<FrictionOnWalls<Dim>>> friction,
                  Optional<Read<surface::ForceOnBodies<Dim>>> lines, Optional<Read<SiteExchange>> shared,
                  Write<body::Force<Dim>> F_b, Write<body::Torque<Dim>> T_b, Update<body::Work> W_b) const;
};

/// (E90)  What particles that a body stops, (E89), give it: force, torque and work of their impulse. A free body takes
/// up that of the end of the step in the next one, with the liquid around it. Of plates in the first half of the step
/// the work is known.
template <int Dim>
struct CountStops {
  static constexpr Doc doc = "(E90) force, torque and work of particles that bodies stop";
  void operator()(Read<Clock> clock, Read<body::StopImpulse<Dim>> J_b, Read<body::PlateImpulse<Dim>> J_plates,
                  Read<body::Velocity<Dim>> V_b, Read<body::Spin<Dim>> omega_b, Update<body::Force<Dim>> F_b,
                  Update<body::Torque<Dim>> T_b, Update<body::Work> W_b) const;
};

/// Columns of the history: NAME_force_x, ..., NAME_torque, NAME_position_x, ..., NAME_velocity_x, ..., NAME_angle,
/// NAME_rotation, NAME_work; where bodies rub also NAME_friction_x, ..., NAME_friction_torque.
template <int Dim>
struct MeasureBodies {
  static constexpr Doc doc = "forces, places and velocities of bodies";
  void operator()(Read<BodySet<Dim>> set, Read<body::Force<Dim>> F_b, Read<body::Torque<Dim>> T_b,
                  Read<body::Position<Dim>> c_b, Read<body::Velocity<Dim>> V_b, Read<body::Angle<Dim>> alpha_b,
                  Read<body::Spin<Dim>> omega_b, Read<body::Work> W_b, Optional<Read<FrictionOnWalls<Dim>>> friction,
                  Update<measure::Columns> columns) const;
};

/// The same of the start, where there is no force yet.
template <int Dim>
struct MeasureBodiesAtStart {
  static constexpr Doc doc = "places and velocities of bodies at the start";
  void operator()(Read<BodySet<Dim>> set, Read<body::Position<Dim>> c_b, Read<body::Velocity<Dim>> V_b,
                  Read<body::Angle<Dim>> alpha_b, Read<body::Spin<Dim>> omega_b, Read<body::Work> W_b,
                  Update<measure::Columns> columns) const;
};

}  // namespace minamo
