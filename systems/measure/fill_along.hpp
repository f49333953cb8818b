#pragma once
/// \file
/// (E137) How full of liquid the places along a line are, and where the surface is on it.

#include "components/grid.hpp"
#include "systems/shapes/shape.hpp"

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace minamo {

/// Signed distance to the nearest body; empty without bodies. [m]
template <int Dim>
using DistanceToBodies = std::function<double(const Vec<Dim>&)>;

/// (E137)  phi(x) = sum_i N_i(x) sum_p V_p N_i(x_p)/V_i over sum_i N_i(x) a_i, with hat functions N_i of the nodes in a
/// box of them, V_i the integral of one, and a_i what bodies leave open of it.
template <int Dim>
class FillOfHats {
 public:
  /// For places in the box between two points of the grid.
  FillOfHats(const Grid<Dim>& grid, const Vec<Dim>& from, const Vec<Dim>& to, const DistanceToBodies<Dim>& distance);

  void add(const Vec<Dim>& x_p, double V_p);
  double at(const Vec<Dim>& x) const;
  /// What add() has summed, to be summed over ranks.
  std::span<double> volumes() { return volume_; }

 private:
  static constexpr std::size_t corners = std::size_t{1} << Dim;
  /// use(row, weight) for the nodes of the cell of a point that are in the box.
  template <class Use>
  void for_each_corner(const Vec<Dim>& x, const Use& use) const;
  double open_share(const Vec<Dim>& node, const DistanceToBodies<Dim>& distance) const;

  const Grid<Dim>& grid_;
  Bounds<Dim> reach_;             ///< particles outside of it touch no node of the box; endless along periodic axes [m]
  Index<Dim> first_{};            ///< node
  Index<Dim> count_{};            ///< of nodes
  std::vector<double> volume_;    ///< sum_p V_p N_i [m^d]
  std::vector<double> share_;     ///< a_i [1]
  std::vector<double> integral_;  ///< V_i [m^d]
};

struct FillSample {
  double at = 0;  ///< along the line [m]
  double fill = 0;
};

/// (E137) Height of the surface over the point 0 of a line.
/// \param line   in rising order, with a sample at 0; fill is linear in between
/// \param reach  how far the surface is smeared out to either side [m]
/// \pre not empty
double height_of_surface(std::span<const FillSample> line, double reach);

}  // namespace minamo
