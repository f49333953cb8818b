#pragma once
/// \file
/// (E93) Free bodies touch the sides of the grid and other bodies, without friction and without rebound.

#include "components/grid.hpp"
#include "systems/bodies/motion/free_motions.hpp"

namespace minamo {

/// Points that stand for the surface of a body are no farther apart than this share of the spacing of the grid.
inline constexpr double point_spacing = 0.5;

/// A point where a free body may touch something. Its gap changes by gradient . q + apart in a second.
struct Contact {
  double gap;                ///< at the start of the step [m]
  Eigen::VectorXd gradient;  ///< by motion
  double apart;              ///< what bodies whose motion is given add [m/s]
};

/// Where and how fast the bodies of a scene are.
template <int Dim>
struct BodyStates {
  std::span<const Vec<Dim>> position;
  std::span<const Mat<Dim>> rotation;
  std::span<const Vec<Dim>> velocity;
  std::span<const Vec<rotations<Dim>>> spin;
};

/// The points of free bodies that may touch a side of the grid or another body within a step: of every pair some that
/// lie far apart.
/// \param at     of the start of the step; of a body whose motion is given the mean velocities over it
/// \param reach  of every body, how far its points may move [m]
template <int Dim>
std::vector<Contact> find_contacts(const Grid<Dim>& grid, const BodySet<Dim>& set, const FreeMotions<Dim>& motions,
                                   const BodyStates<Dim>& at, std::span<const double> reach);

/// The change G^-1 sum_k gradient_k j_k of q, of impulses j_k >= 0, with which every contact moves apart by at least
/// least[k], and those that push by no more; by the method of Gauss and Seidel (C. Duriez, F. Dubois, A. Kheddar,
/// C. Andriot, IEEE Trans. Vis. Comput. Graph. 12 (2006) 36).
/// \param inverse  G^-1
Eigen::VectorXd push_apart(const std::vector<Contact>& contacts, const Eigen::MatrixXd& inverse,
                           const Eigen::VectorXd& q, const std::vector<double>& least);

}  // namespace minamo
