#pragma once
/// \file
/// (E105) Sides of the box that the liquid may leave. The normal velocity of a face on such a side is an unknown of the
/// balances where the side would have to pull, and zero where it pushes.

#include "components/contact.hpp"
#include "components/step.hpp"
#include "engine/run/clock.hpp"
#include "engine/run/linear_solver.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/mac_grid.hpp"
#include "systems/pressure/solve.hpp"

namespace minamo {

/// The faces on separating sides; those that another wall holds are not among them.
template <int Dim>
struct FindSeparatingFaces {
  static constexpr Doc doc = "faces on the sides that the liquid may leave";
  void operator()(Uses<MacGrid<Dim>> mac, Read<SeparatingSides<Dim>> sides, Read<face::Held> held,
                  Write<SeparatingFaces<Dim>> separating) const;
};

/// (E106)  v_f^n is zero where the side has held the face in the last step, and nowhere into the side: an impact is
/// without rebound.
template <int Dim>
struct StopOldVelocityAtSides {
  static constexpr Doc doc = "(E106) v_f^n on separating sides";
  void operator()(Read<SeparatingFaces<Dim>> separating, Read<face::Contact> contact,
                  Update<face::Velocity<Dim>> v_f) const;
};

/// (E105) The contact that the pressure of the last step and v* let expect.
template <int Dim>
struct StartContactOfSides {
  static constexpr Doc doc = "(E105) expected contact with separating sides";
  void operator()(Read<Rates> rates, Read<face::Predictor<Dim>> predictor, Read<face::Mobility<Dim>> mobility,
                  Read<multiplier::Force> lambda, Update<SeparatingFaces<Dim>> separating) const;
};

/// (E105) Faces in contact have no velocity and no mobility, the others those of the balances.
template <int Dim>
struct HoldContactOfSides {
  static constexpr Doc doc = "(E105) holds faces in contact with separating sides";
  void operator()(Read<SeparatingFaces<Dim>> separating, Update<face::Predictor<Dim>> predictor,
                  Update<face::Mobility<Dim>> mobility) const;
};

/// (E107)  No volume is added next to a face that the liquid leaves: what is missing there is air.
template <int Dim>
struct LimitVolumeSourceAtSides {
  static constexpr Doc doc = "(E107) no volume added where liquid leaves a side";
  void operator()(Read<SeparatingFaces<Dim>> separating, Read<multiplier::Row> row,
                  Update<unknown::Source> source) const;
};

/// (E105) Releases faces on which the side pulls and holds those that would pass it. Liquid that is enclosed all around
/// stays where it is, for its pressure is known up to a constant.
template <int Dim>
struct CompareContactOfSides {
  static constexpr Doc doc = "(E105) contact with separating sides after a solve";
  void operator()(Read<SolverTolerance> tolerance, Read<face::BalanceVelocity<Dim>> v_f, Read<multiplier::Row> row,
                  Read<unknown::Solution> solution, Read<unknown::NullVector> null_vector, Read<unknown::Source> source,
                  Read<MultiplierSolver<Dim>> solver, Optional<Read<SiteExchange>> shared,
                  Update<SeparatingFaces<Dim>> separating, Update<ContactLoop> loop) const;
};

/// What the solver's tolerance leaves of velocities into a side, and shifts into it, are taken out.
template <int Dim>
struct KeepContactOfSides {
  static constexpr Doc doc = "(E105) contact of the step, no shift into separating sides";
  void operator()(Read<SeparatingFaces<Dim>> separating, Update<face::BalanceVelocity<Dim>> v_f,
                  Update<face::Shift<Dim>> shift, Write<face::Contact> contact) const;
};

/// (E106)  v_f^{n+1}: zero in contact, nowhere into the side.
template <int Dim>
struct StopNewVelocityAtSides {
  static constexpr Doc doc = "(E106) v_f at the end of the step on separating sides";
  void operator()(Read<SeparatingFaces<Dim>> separating, Update<face::NewVelocity<Dim>> v_new) const;
};

}  // namespace minamo
