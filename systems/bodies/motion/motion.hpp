#pragma once
/// \file
/// (E88) Motion of bodies: where they are in the middle of the step, and at its end.

#include "engine/run/clock.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/body_set.hpp"

namespace minamo {

/// Velocity and angular velocity of a body at an instant; of a tabulated one the mean over a moment, of a free one
/// those at the start.
template <int Dim>
std::pair<Vec<Dim>, Vec<rotations<Dim>>> velocity_at(const BodyScene<Dim>& body, double time);

/// (E34)  Of the points of moving bodies that may lie in the grid the largest |V_b| + |omega_b| r_b, now and over the
/// time ahead; free bodies keep their velocities. [m/s]
/// \param ahead  [s]
template <int Dim>
double largest_speed_of_bodies(World& world, double ahead);

/// (E88)  c_b and R_b in the middle of the step, and the mean of V_b and omega_b over it, by Simpson's rule; free
/// bodies as if they kept their velocities. \throws std::runtime_error if a velocity is not finite: no shorter step
/// gets past it
template <int Dim>
struct PlaceBodies {
  static constexpr Doc doc = "(E88) bodies in the middle of the step; their work so far";
  void operator()(Read<Clock> clock, Read<BodySet<Dim>> set, Read<body::Position<Dim>> c_b,
                  Read<body::Rotation<Dim>> R_b, Read<body::Velocity<Dim>> V_old, Read<body::Spin<Dim>> omega_old,
                  Read<body::Work> W_b, Write<body::MiddlePosition<Dim>> c_middle,
                  Write<body::MiddleRotation<Dim>> R_middle, Write<body::MeanVelocity<Dim>> V_b,
                  Write<body::MeanSpin<Dim>> omega_b, Write<body::OldWork> W_old) const;
};

/// (E88)  c_b, R_b, V_b and omega_b at the end of the step.
template <int Dim>
struct MoveBodies {
  static constexpr Doc doc = "(E88) bodies at the end of the step";
  void operator()(Read<Clock> clock, Read<BodySet<Dim>> set, Read<body::MeanVelocity<Dim>> V_mean,
                  Read<body::MeanSpin<Dim>> omega_mean, Optional<Read<body::EndVelocity<Dim>>> V_end,
                  Optional<Read<body::EndSpin<Dim>>> omega_end, Update<body::Position<Dim>> c_b,
                  Update<body::Rotation<Dim>> R_b, Update<body::Angle<Dim>> alpha_b, Update<body::Velocity<Dim>> V_b,
                  Update<body::Spin<Dim>> omega_b) const;
};

}  // namespace minamo
