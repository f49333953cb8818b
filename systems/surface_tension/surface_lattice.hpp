#pragma once
/// \file
/// The lattice on which the free surface is found: the centroids of quadratic splines, one per site, and nodes on the
/// walls.

#include "components/staggered.hpp"
#include "systems/grid/splines.hpp"

#include <span>

namespace minamo {

/// Nodes of an axis. Between walls node 0 and the last one are on the walls, node s + 1 is site s between them; along a
/// periodic axis node s is site s.
class SurfaceAxis {
 public:
  SurfaceAxis() = default;
  SurfaceAxis(int cells, bool periodic) : cells_(cells), periodic_(periodic) {}

  /// Quadratic splines.
  int sites() const { return periodic_ ? cells_ : cells_ + 2; }
  int node_of(int site) const { return periodic_ ? site : site + 1; }
  /// \pre the node is not on a wall; along a periodic axis it may be one beyond an end
  int site_of(int node) const { return periodic_ ? (node + cells_) % cells_ : node - 1; }
  bool is_low_wall(int node) const { return !periodic_ && node == 0; }
  bool is_high_wall(int node) const { return !periodic_ && node == sites() + 1; }
  bool is_on_wall(int node) const { return is_low_wall(node) || is_high_wall(node); }
  /// From the low end, in units of h. Along a periodic axis it may lie beyond the ends.
  double place(int node) const;
  /// Integral of the spline of a site, in units of h.
  double integral(int site) const;

 private:
  /// Knot k of 4 of the spline of a site.
  int knot(int site, int k) const;

  int cells_ = 0;
  bool periodic_ = false;
};

template <int Dim>
class SurfaceLattice {
 public:
  SurfaceLattice(const Grid<Dim>& grid, const StaggeredIndex<Dim>& rows);

  const SurfaceAxis& axis(std::size_t d) const { return axis_[d]; }
  /// Whether there is a quadratic spline at a site: with splines of degree 3 an axis has a site more.
  bool has(const Index<Dim>& site) const;
  /// Integral of the quadratic spline of a site that has one. [m^d]
  double capacity(const Index<Dim>& site) const;
  bool is_site(const Index<Dim>& node) const;
  Vec<Dim> place(const Index<Dim>& node) const;
  /// The row of a node that is a site, if the liquid touches it.
  std::optional<std::uint32_t> row(const Index<Dim>& node) const;
  std::optional<std::uint32_t> row_of_site(const Index<Dim>& site) const { return rows_.find(site); }
  /// Calls use(row or none, weight) for the sites from which the value at a node comes: itself, or those at a wall,
  /// by linear extrapolation. The weights are 1 in sum.
  template <class Use>
  void for_each_source(const Index<Dim>& node, const Use& use) const {
    from_axis(node, Dim - 1, 1, [&](const Index<Dim>& at, double weight) { use(row(at), weight); });
  }
  /// The same with the sites themselves.
  template <class Use>
  void for_each_source_site(const Index<Dim>& node, const Use& use) const {
    from_axis(node, Dim - 1, 1, [&](const Index<Dim>& at, double weight) { use(site_of(at), weight); });
  }
  /// \pre the node is a site
  Index<Dim> site_of(Index<Dim> node) const {
    for (std::size_t d = 0; d < Dim; ++d) node[d] = axis_[d].site_of(node[d]);
    return node;
  }
  Vec<Dim> place_of_site(Index<Dim> site) const {
    for (std::size_t d = 0; d < Dim; ++d) site[d] = axis_[d].node_of(site[d]);
    return place(site);
  }

 private:
  template <class Use>
  void from_axis(Index<Dim> node, int d, double weight, const Use& use) const {
    if (d < 0) {
      use(node, weight);
      return;
    }
    const auto k = static_cast<std::size_t>(d);
    if (!axis_[k].is_on_wall(node[k])) {
      from_axis(node, d - 1, weight, use);
      return;
    }
    // The two sites at a wall stand h/4 and 3 h/4 from it.
    const int inward = axis_[k].is_low_wall(node[k]) ? 1 : -1;
    node[k] += inward;
    from_axis(node, d - 1, 1.5 * weight, use);
    node[k] += inward;
    from_axis(node, d - 1, -0.5 * weight, use);
  }

  std::array<SurfaceAxis, static_cast<std::size_t>(Dim)> axis_;
  Vec<Dim> low_;
  double spacing_;
  const StaggeredIndex<Dim>& rows_;
};

}  // namespace minamo
