#pragma once
/// \file
/// (E87) Velocities of closed faces, on which particles beside a body have weight: linear functions through those of
/// the open faces around, by least squares. So a liquid that moves along a plane wall or rests stays exact, and the
/// wall acts through the balance of mass alone.

#include "components/body.hpp"
#include "components/grid.hpp"
#include "engine/system.hpp"
#include "systems/conforming/splines.hpp"

namespace minamo {

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
  template <int Dim>
  void apply(std::span<Vec<Dim>> field) const {
    for_each_row(targets.size(), [&](std::size_t k) {
      const Target& at = targets[k];
      if (at.count == 0) return;
      double sum = 0;
      for (std::size_t j = at.begin; j < at.begin + at.count; ++j) sum += weight[j] * field[source[j]][at.direction];
      field[at.row][at.direction] = sum;
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
  void operator()(Read<FaceExtension> extension, Update<face::Velocity<Dim>> v_f) const {
    extension->apply<Dim>(v_f.span());
  }
};

/// (E87) of the velocities that the balances give.
template <int Dim>
struct ExtendBalanceVelocity {
  static constexpr std::string_view doc = "(E87) v_f, w_f and d_f of closed faces";
  void operator()(Read<FaceExtension> extension, Update<face::BalanceVelocity<Dim>> v_f, Update<face::Damping<Dim>> w_f,
                  Update<face::Shift<Dim>> d_f) const {
    extension->apply<Dim>(v_f.span());
    extension->apply<Dim>(w_f.span());
    extension->apply<Dim>(d_f.span());
  }
};

}  // namespace minamo
