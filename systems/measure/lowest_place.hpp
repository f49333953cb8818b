#pragma once
/// \file
/// How low a liquid that keeps its volume can lie: what of it lies lower has lost volume, whatever the motion.

#include "components/fluid.hpp"
#include "components/grid.hpp"
#include "systems/bodies/geometry/cut.hpp"
#include "systems/grid/splines.hpp"

#include <optional>
#include <vector>

namespace minamo {

/// Room for liquid by height: that of nodes or multipliers, each at its place, less what bodies at rest take.
struct LowestPlace {
  struct Layer {
    double volume = 0;  ///< [m^3; m^2 in 2-D]
    double moment = 0;  ///< volume times height [m^4; m^3 in 2-D]
  };
  bool is_known = false;
  std::vector<double> down;   ///< unit vector; empty where nothing pulls everywhere and always the same way [1]
  std::vector<Layer> layers;  ///< from the lowest up
  static constexpr ComponentInfo info{"measure.lowest_place", "", "m", Lifetime::cache};

  /// (E127)  Height of the middle of a volume that fills the layers from below. [m]
  double lowest_middle(double volume) const;
  /// The volume whose lowest middle has this height. [m^3; m^2 in 2-D]
  double volume_of(double middle) const;
};

/// The direction in which the constant components of a body force pull, those along periodic axes left out.
template <int Dim>
std::optional<Vec<Dim>> way_down(const Grid<Dim>& grid, const BodyForce& b);

/// Heights are against `down`, from the low corner of the grid.
/// \param splines  of the conforming discretization; null: nodes
/// \param at_rest  null without bodies
template <int Dim>
LowestPlace lowest_place(const Grid<Dim>& grid, const Vec<Dim>& down, const Splines<Dim>* splines,
                         const StaticCut<Dim>* at_rest);

}  // namespace minamo
