#pragma once
/// \file
/// (E111) The fill fraction and the mean velocity of particles on a lattice as fine as they are.

#include "systems/shapes/marching.hpp"

#include <span>

namespace minamo {

template <int Dim>
class FillLattice {
 public:
  /// Width of the splines over the distance of two particles: gaps between them are no holes.
  static constexpr double width = 1.5;

  /// \param spacing  of the particles and of the lattice [m]
  FillLattice(const Bounds<Dim>& box, double spacing, std::span<const Vec<Dim>> position);

  void add(const Vec<Dim>& x, const Vec<Dim>& v, double volume);

  const SampleNodes<Dim>& nodes() const { return nodes_; }
  /// fill() of a node.
  double fill_at(std::size_t row) const { return sums_[row][0]; }
  /// sum_p V_p S/width^Dim between the nodes, linear along every axis. [1]
  double fill(const Vec<Dim>& x) const;
  /// Mean of the particles' velocities, weighted likewise; zero far from all. [m/s]
  Vec<Dim> velocity(const Vec<Dim>& x) const;

 private:
  static constexpr std::size_t corners = std::size_t{1} << Dim;
  /// use(row, weight) for the nodes around a point.
  template <class Use>
  void for_each_corner(const Vec<Dim>& x, const Use& use) const;

  SampleNodes<Dim> nodes_;
  std::vector<std::array<float, 1 + static_cast<std::size_t>(Dim)>> sums_;  ///< fill, and fill times velocity
};

}  // namespace minamo
