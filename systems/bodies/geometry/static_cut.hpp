#pragma once
/// \file
/// (E85) What bodies at rest leave open of all sites of the grid.

#include "systems/bodies/body_set.hpp"
#include "systems/grid/site_places.hpp"

#include <limits>

namespace minamo {

template <int Dim>
struct SiteCut {
  Vec<Dim> open = Vec<Dim>::Ones();  ///< of its faces [1]
  double share = 1;                  ///< of the volume of its multiplier, weighted with its spline [1]
};

/// The cut of all sites of the grid by the bodies at rest.
template <int Dim>
struct StaticCut {
  Index<Dim> sites{};             ///< per direction
  std::vector<SiteCut<Dim>> of;   ///< of all sites, x fastest; empty without bodies at rest
  std::vector<double> clearance;  ///< within this of any point of a cell of the grid, x fastest, is no body [m]
  static constexpr ComponentInfo info{"bodies.static_cut", "a_f", "1", Lifetime::constant};

  const SiteCut<Dim>& at(const Index<Dim>& site) const { return of[row_in<Dim>(sites, site)]; }
  double clearance_of(const Grid<Dim>& grid, const Index<Dim>& cell) const {
    return of.empty() ? std::numeric_limits<double>::infinity() : clearance[row_in<Dim>(grid.cells, cell)];
  }
};

template <int Dim>
StaticCut<Dim> cut_by_bodies_at_rest(const BodySet<Dim>& set, const Grid<Dim>& grid, const Splines<Dim>& splines);

}  // namespace minamo
