#pragma once
/// \file
/// (E89) Particles stay outside of bodies.

#include "components/body.hpp"
#include "components/cells.hpp"
#include "components/grid.hpp"
#include "components/particle.hpp"
#include "components/step.hpp"
#include "engine/run/communicator.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/geometry/cut.hpp"

namespace minamo {

/// (E89)  A particle whose way to the middle of the step leads through a plate, or beyond the middle of one, stays on
/// its side and loses the part of its velocity that approaches the plate. The grid does not see that way. One that is
/// deep in another body by then, not a free one, goes to its surface likewise. What particles lose the body gets, with
/// the work of that; a free one does not: a light one would be thrown to and fro.
template <int Dim>
struct StopAtPlates {
  static constexpr Doc doc = "(E89) no particle takes the first half of a step through a plate, or deep into a body";
  void operator()(Read<Grid<Dim>> grid, Read<BodySet<Dim>> set, Read<StaticCut<Dim>> at_rest,
                  Read<body::Position<Dim>> c_b, Read<body::Rotation<Dim>> R_b, Read<body::Velocity<Dim>> V_b,
                  Read<body::Spin<Dim>> omega_b, Read<body::MiddlePosition<Dim>> c_middle,
                  Read<body::MiddleRotation<Dim>> R_middle, Read<particle::Mass> m_p, Read<particle::Position<Dim>> x_p,
                  Update<particle::QuadraturePosition<Dim>> y_p, Update<particle::Velocity<Dim>> v_p,
                  Optional<Read<Ranks>> ranks, Write<body::PlateImpulse<Dim>> J_b, Update<body::Work> W_b) const;
};

/// (E89)  A particle less than 1e-3 h from a body goes to that distance, along the normal; one that was inside loses
/// the part of its velocity that approaches the body. Out of a corner it goes along the wall that held it before, and
/// from a plate that it went into beyond its middle, or through, back to its side. What the balance of mass
/// leaves open in cut cells, and steps that are long for a curved wall, carry particles there. The momentum that
/// particles lose the body gets, and a free one takes no more than it can without being thrown back.
template <int Dim>
struct KeepOutOfBodies {
  static constexpr Doc doc = "(E89) particles stay outside of bodies";
  void operator()(Read<Grid<Dim>> grid, Read<BodySet<Dim>> set, Read<StaticCut<Dim>> at_rest,
                  Read<GridCells<Dim>> cells, Read<body::MiddlePosition<Dim>> c_middle,
                  Read<body::MiddleRotation<Dim>> R_middle, Read<body::Position<Dim>> c_b,
                  Read<body::Rotation<Dim>> R_b, Read<body::Velocity<Dim>> V_b, Read<body::Spin<Dim>> omega_b,
                  Read<particle::Mass> m_p, Read<particle::QuadraturePosition<Dim>> y_p,
                  Update<particle::Position<Dim>> x_p, Update<particle::Velocity<Dim>> v_p, Update<Clamped> clamped,
                  Optional<Read<Ranks>> ranks, Write<body::StopImpulse<Dim>> J_b) const;
};

}  // namespace minamo
