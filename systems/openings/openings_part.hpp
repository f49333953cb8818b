#pragma once
/// \file
/// What other parts know of the openings of a scene.

#include "systems/openings/opening_set.hpp"

namespace minamo {

/// One of the two, as the scene has dimensions.
struct OpeningsOfScene {
  OpeningSet<2> in_plane;
  OpeningSet<3> in_space;

  template <int Dim>
  const OpeningSet<Dim>& of() const {
    if constexpr (Dim == 2) {
      return in_plane;
    } else {
      return in_space;
    }
  }
  template <int Dim>
  OpeningSet<Dim>& of() {
    return const_cast<OpeningSet<Dim>&>(std::as_const(*this).template of<Dim>());
  }
};

/// Most particles per cell and direction that come in.
inline int most_per_cell(const OpeningsOfScene& openings) {
  int most = 1;
  for (const auto& opening : openings.in_plane.openings) most = std::max(most, opening.per_cell);
  for (const auto& opening : openings.in_space.openings) most = std::max(most, opening.per_cell);
  return most;
}

/// Whether liquid comes in, so that there may be more of it than at the start.
inline bool has_inflow(const OpeningsOfScene& openings) {
  const auto is_inflow = [](const auto& opening) { return opening.is_inflow(); };
  return std::any_of(openings.in_plane.openings.begin(), openings.in_plane.openings.end(), is_inflow) ||
         std::any_of(openings.in_space.openings.begin(), openings.in_space.openings.end(), is_inflow);
}

}  // namespace minamo
