#pragma once
/// \file
/// Energy, momentum and largest speed of the particles.

#include "components/body.hpp"
#include "components/energy_given.hpp"
#include "components/fluid.hpp"
#include "components/grid.hpp"
#include "components/measure.hpp"
#include "components/openings.hpp"
#include "components/particle.hpp"
#include "engine/run/communicator.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/splines.hpp"

#include <span>

namespace minamo {

/// K of (E28). [J]
template <int Dim>
double kinetic_energy(std::span<const double> m_p, std::span<const Vec<Dim>> v_p);

/// (E28)  K = sum m_p |v_p|^2 / 2;  U = -sum m_p b . (x_p - low corner) for a constant b.
template <int Dim>
struct MeasureEnergy {
  static constexpr Doc doc = "(E28) kinetic and potential energy";
  void operator()(Read<Grid<Dim>> grid, Read<BodyForce> b, Read<particle::Mass> m_p, Read<particle::Position<Dim>> x_p,
                  Read<particle::Velocity<Dim>> v_p, Optional<Read<Ranks>> ranks, Write<measure::Energy> energy) const;
};

/// (E59)  E - W: the energy of the liquid and the work that it has done on bodies (E90), less what came in through
/// openings (E100), the work of forces without a potential (E128), and what systems say that they have given. A column
/// of the history, energy_balance, where that is not K + U.
template <int Dim>
struct MeasureEnergyBalance {
  static constexpr Doc doc = "(E59) energy less what was given, which no step raises";
  void operator()(Read<measure::Energy> energy, Optional<Read<body::Work>> W_b, Optional<Read<opening::EnergyIn>> E_o,
                  Optional<Read<EnergyGiven>> given, Write<measure::EnergyBalance> balance,
                  Update<measure::Columns> columns) const;
};

/// (E29)  P = sum m_p v_p;  L = sum m_p (x_p - x_c) x v_p.
/// (E30)  Where particles carry velocity gradients L has more: sum m_p (D_11 dv/dx - D_22 du/dy) in 2-D, its
/// cyclic kin in 3-D, with D_p = sum_I S_I(x_p) (x_I - x_p) (x) (x_I - x_p), which is diagonal.
template <int Dim>
struct MeasureMomentum {
  static constexpr Doc doc = "(E29) (E30) momentum and angular momentum";
  void operator()(Read<Grid<Dim>> grid, Optional<Read<Splines<Dim>>> splines, Read<particle::Mass> m_p,
                  Read<particle::Position<Dim>> x_p, Read<particle::Velocity<Dim>> v_p,
                  Optional<Read<particle::VelocityGradient<Dim>>> grad_v_p, Optional<Read<Ranks>> ranks,
                  Write<measure::Momentum<Dim>> momentum) const;
};

/// max |v_p|.
template <int Dim>
struct MeasureMaxSpeed {
  static constexpr Doc doc = "largest particle speed";
  void operator()(Read<particle::Velocity<Dim>> v_p, Optional<Read<Ranks>> ranks, Write<measure::MaxSpeed> speed) const;
};

}  // namespace minamo
