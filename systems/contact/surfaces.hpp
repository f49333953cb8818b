#pragma once
/// \file
/// (E108) Bodies that the liquid may leave. A multiplier next to such a body pushes, or there is none and the cell may
/// take in air.

#include "components/body.hpp"
#include "components/contact.hpp"
#include "components/step.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/body_set.hpp"
#include "systems/grid/mac_grid.hpp"
#include "systems/pressure/solve.hpp"

namespace minamo {

/// The multipliers with a face that a separating body closes, in part or whole; released as in the last step.
template <int Dim>
struct FindSeparatingRows {
  static constexpr Doc doc = "multipliers near bodies that the liquid may leave";
  void operator()(Read<BodySet<Dim>> set, Read<Splines<Dim>> splines, Read<staggered::Site<Dim>> site,
                  Read<staggered::Neighbour<Dim>> neighbour, Read<face::Closed<Dim>> closed,
                  Read<face::Closer<Dim>> closer, Read<multiplier::Released> released,
                  Write<SeparatingRows<Dim>> separating) const;
};

/// (E109) Faces that no particle touches take the mean velocity of those next to them that have one, up to three faces
/// away. They count among those that velocities of closed faces are made of (E87): at rest in a falling liquid they
/// would hold it at the body.
template <int Dim>
struct FillEmptyFaces {
  static constexpr Doc doc = "(E109) v_f^n of faces without mass";
  void operator()(Read<staggered::Neighbour<Dim>> neighbour, Read<face::Mass<Dim>> m_f,
                  Update<SeparatingRows<Dim>> separating, Update<face::Velocity<Dim>> v_f) const;
};

/// What the passes of the loop change of bodies, for each to start from.
template <int Dim>
struct StartContactOfBodies {
  static constexpr Doc doc = "(E108) bodies before the first pass";
  void operator()(Read<face::AttachedMass<Dim>> attached, Read<body::MeanVelocity<Dim>> V_b,
                  Read<body::MeanSpin<Dim>> omega_b, Read<body::Work> W_b,
                  Update<SeparatingRows<Dim>> separating) const;
};

/// (E108) Sets which multipliers are released, and takes back what the last pass has changed of bodies.
template <int Dim>
struct ReleaseFromBodies {
  static constexpr Doc doc = "(E108) multipliers that liquid leaving a body has no pressure at";
  void operator()(Read<SeparatingRows<Dim>> separating, Write<multiplier::Released> released,
                  Write<body::MeanVelocity<Dim>> V_b, Write<body::MeanSpin<Dim>> omega_b, Write<body::Work> W_b) const;
};

/// (E109) Liquid moves with a separating body, (E94), only where it presses it. It goes on with other bodies next to
/// it.
template <int Dim>
struct DetachFromBodies {
  static constexpr Doc doc = "(E109) no attached mass where liquid leaves a body";
  void operator()(Read<BodySet<Dim>> set, Read<staggered::Neighbour<Dim>> neighbour, Read<multiplier::Row> row,
                  Read<face::AttachedTo<Dim>> attached_to, Update<SeparatingRows<Dim>> separating,
                  Write<face::AttachedMass<Dim>> attached) const;
};

/// (E108) Releases multipliers that pull, and takes back those around which the liquid would be squeezed. Enclosed
/// liquid as in (E105).
template <int Dim>
struct CompareContactOfBodies {
  static constexpr Doc doc = "(E108) contact with separating bodies after a solve";
  void operator()(Read<SolverTolerance> tolerance, Uses<MacGrid<Dim>> mac, Read<face::Open<Dim>> open,
                  Read<face::Closed<Dim>> closed, Read<face::Closer<Dim>> closer, Read<body::MiddlePosition<Dim>> c_b,
                  Read<body::MeanVelocity<Dim>> V_b, Read<body::MeanSpin<Dim>> omega_b,
                  Read<face::BalanceVelocity<Dim>> v_f, Read<multiplier::Row> row, Read<unknown::Solution> solution,
                  Read<unknown::NullVector> null_vector, Read<unknown::Source> source,
                  Read<MultiplierSolver<Dim>> solver, Optional<Read<SiteExchange>> shared,
                  Update<SeparatingRows<Dim>> separating, Update<ContactLoop> loop) const;
};

}  // namespace minamo
