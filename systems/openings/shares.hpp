#pragma once
/// \file
/// Which faces of the sides belong to openings, and which share of each.

#include "systems/bodies/body_set.hpp"
#include "systems/openings/opening_set.hpp"
#include "systems/scene/part.hpp"

namespace minamo {

/// What the sides of the box are outside of their openings.
template <int Dim>
struct Sides {
  const Grid<Dim>& grid;
  const Splines<Dim>& splines;
  const Walls<Dim>& walls;
  const BodySet<Dim>* bodies = nullptr;  ///< null: none
};

/// Sets Opening::share and OpeningSet::of_face. A face belongs to an opening by the share of what is nearer to it than
/// to other faces, where `where` is true and no body at rest is: of inflow any, of outflow at least half.
/// \param where  of every opening; none: everywhere
template <int Dim>
void find_shares(OpeningSet<Dim>& set, const std::vector<std::optional<Expression>>& where, const Sides<Dim>& sides,
                 SeedProblems& problems);

}  // namespace minamo
