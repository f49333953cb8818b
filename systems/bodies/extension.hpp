#pragma once
/// \file
/// (E87) Velocities of closed faces, on which particles beside a body have weight: linear functions through those of
/// the open faces around, by least squares. So a liquid that moves along a plane wall or rests stays exact, and the
/// wall acts through the balance of mass alone. Where the open faces lie on one side only and their velocities differ
/// by much, as beside a fast body, such a function leads far away: a value stays near those that it is made of.

#include "components/body.hpp"
#include "components/grid.hpp"
#include "engine/clock.hpp"
#include "engine/system.hpp"
#include "systems/conforming/splines.hpp"

#include <algorithm>
#include <limits>

namespace minamo {

/// How far beyond those of the open faces a closed one may move within a step, in units of h.
inline constexpr double beyond_open_faces = 0.1;

/// What the velocity of every closed face is made of.
struct FaceExtension {
  struct Target {
    std::uint32_t row;
    std::int32_t direction;
    std::size_t begin;  ///< in `source` and `weight`
    std::size_t count;
  };
  std::vector<Target> targets;
  std::vector<std::uint32_t> source;  ///< rows of open faces of the same direction
  std::vector<double> weight;         ///< [1]
  using rows_of = Staggered;
  static constexpr ComponentInfo info{"bodies.extension", "", "1", Lifetime::scratch};

  /// Sets the closed faces of a field.
  /// \param beyond  how far a value may lie outside of the range of those that it is made of
  template <int Dim>
  void apply(std::span<Vec<Dim>> field, double beyond) const {
    for_each_row(targets.size(), [&](std::size_t k) {
      const Target& at = targets[k];
      if (at.count == 0) return;
      double sum = 0;
      double least = std::numeric_limits<double>::infinity();
      double most = -least;
      for (std::size_t j = at.begin; j < at.begin + at.count; ++j) {
        const double value = field[source[j]][at.direction];
        sum += weight[j] * value;
        least = std::min(least, value);
        most = std::max(most, value);
      }
      field[at.row][at.direction] = std::min(std::max(sum, least - beyond), most + beyond);
    });
  }
};

/// (E87)
template <int Dim>
struct FindFaceExtension {
  static constexpr std::string_view doc = "(E87) what velocities of closed faces are made of";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<StaggeredIndex<Dim>> rows,
                  Read<staggered::Site<Dim>> site, Read<face::Held> held, Read<face::Open<Dim>> open,
                  Write<FaceExtension> extension) const;
};

/// (E87) of the velocity at the start of the step.
template <int Dim>
struct ExtendOldVelocity {
  static constexpr std::string_view doc = "(E87) v_f^n of closed faces";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<FaceExtension> extension,
                  Update<face::Velocity<Dim>> v_f) const {
    extension->apply<Dim>(v_f.span(), beyond_open_faces * grid->spacing / clock->step);
  }
};

/// (E87) of the velocities that the balances give.
template <int Dim>
struct ExtendBalanceVelocity {
  static constexpr std::string_view doc = "(E87) v_f, w_f and d_f of closed faces";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<FaceExtension> extension,
                  Update<face::BalanceVelocity<Dim>> v_f, Update<face::Damping<Dim>> w_f,
                  Update<face::Shift<Dim>> d_f) const {
    const double beyond = beyond_open_faces * grid->spacing;
    extension->apply<Dim>(v_f.span(), beyond / clock->step);
    extension->apply<Dim>(w_f.span(), beyond / clock->step);
    extension->apply<Dim>(d_f.span(), beyond);
  }
};

}  // namespace minamo
