#pragma once
/// \file
/// (E110) Friction where bodies rub: E^T K E of the velocities of open faces and the motions of walls, E the extension
/// (E87). What pulls at a closed face pulls at what its velocity is made of, so no momentum is lost, and what walls
/// take is the force on them. A closed face that lets something through has a velocity of its own in the balance of
/// mass; a tie of friction holds it to the one that it should have.

#include "systems/viscosity/friction_operator.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

/// Whether walls move with their velocities, or stand still, as in a difference of two velocities.
enum class WallsMove { no, yes };

namespace detail {

/// What walls with a slip length add for their own motion, and the forces on them.
template <int Dim>
void add_sliding_walls(const FrictionOf<Dim>& of, WallsMove move, const double* x, double* out,
                       std::vector<RigidVector<Dim>>* on_walls) {
  constexpr std::size_t motions = rigid_motions<Dim>;
  for (std::size_t c = 0; c < of.cells.cells.size(); ++c) {
    if (!of.is_cut(c)) continue;
    of.cut->with(c, *of.at_rest, [&](const auto& cell, std::size_t k) {
      if (cell.wall(k) < 0) return;
      const auto wall = static_cast<std::size_t>(cell.wall(k));
      const RigidVector<Dim>& q = of.cut->motion[wall];
      RigidVector<Dim> pull = RigidVector<Dim>::Zero();
      of.for_each_face_of(c, [&](std::size_t i, std::size_t f) {
        const Eigen::Map<const RigidVector<Dim>> by_wall(cell.by_wall(k) + f * motions);
        pull += by_wall * x[i];
        if (move == WallsMove::yes) out[i] -= of.mu_c[c] * by_wall.dot(q);
      });
      if (on_walls == nullptr) return;
      using Square = Eigen::Matrix<double, rigid_motions<Dim>, rigid_motions<Dim>, Eigen::DontAlign>;
      (*on_walls)[wall] += of.mu_c[c] * (pull - Eigen::Map<const Square>(cell.on_wall(k)) * q);
    });
  }
}

}  // namespace detail

/// out = E^T K E v, or with moving walls what is affine in v.
/// \param tie       of closed faces, by number; empty: none [kg/s]
/// \param x         room, of the size of v
/// \param on_walls  if not null, the forces on the bodies come into it, by body; zero before
template <int Dim>
void apply_wall_friction(const FrictionOf<Dim>& of, WallsMove move, std::span<const double> tie,
                         std::span<const double> v, std::span<double> x, std::span<double> out,
                         std::vector<RigidVector<Dim>>* on_walls = nullptr) {
  const FaceExtension<Dim>& extension = *of.extension;
  std::copy(v.begin(), v.end(), x.begin());
  for_each_row(extension.targets.size(), [&](std::size_t k) {
    const auto& at = extension.targets[k];
    double value = extension.of_open_faces(at, v.data());
    if (at.wall >= 0 && move == WallsMove::yes)
      value += at.lever.dot(of.cut->motion[static_cast<std::size_t>(at.wall)]);
    x[at.number()] = value;
  });
  std::fill(out.begin(), out.end(), 0.0);
  apply_friction<Dim>(of, x.data(), out.data());
  detail::add_sliding_walls<Dim>(of, move, x.data(), out.data(), on_walls);
  add_up_faces<Dim>(of.shared, out);
  // One after the other: the same sums on any number of threads.
  for (const auto& at : extension.targets) {
    const std::size_t f = at.number();
    const double held = tie.empty() ? 0 : tie[f] * (v[f] - x[f]);
    const double pull = out[f] - held;
    out[f] = held;
    extension.for_each_source(at, [&](std::size_t source, double e) { out[source] += e * pull; });
    if (on_walls != nullptr && at.wall >= 0 && owns(of.shared, at.row))
      (*on_walls)[static_cast<std::size_t>(at.wall)] -= pull * at.lever;
  }
  if (on_walls != nullptr) add_up_on_all(of.shared, std::span(*on_walls));
}

/// Moves what a diagonal that bounds K has at closed faces to the open ones: of E^T D E it makes a diagonal that is no
/// smaller, by |sum_j e_j v_j|^2 <= sum_j |e_j| sum_j |e_j| v_j^2.
template <int Dim>
void bound_by_open_faces(const FaceExtension<Dim>& extension, std::span<double> bound) {
  for (const auto& at : extension.targets) {
    const std::size_t f = at.number();
    double sum = at.sticks ? 1 : 0;
    extension.for_each_source(at, [&](std::size_t, double e) { sum += std::abs(e); });
    extension.for_each_source(at, [&](std::size_t source, double e) { bound[source] += sum * std::abs(e) * bound[f]; });
  }
}

/// Gives closed faces the largest number of the open ones that their velocities are made of.
template <int Dim>
void most_of_open_faces(const FaceExtension<Dim>& extension, std::span<double> number) {
  for (const auto& at : extension.targets) {
    double most = 0;
    extension.for_each_source(at, [&](std::size_t source, double) { most = std::max(most, number[source]); });
    number[at.number()] = most;
  }
}

/// An estimate of the diagonal of E^T K E with its ties from that of K.
template <int Dim>
void move_diagonal_to_open_faces(const FaceExtension<Dim>& extension, std::span<const double> tie,
                                 std::span<double> diagonal) {
  for (const auto& at : extension.targets) {
    const std::size_t f = at.number();
    extension.for_each_source(
        at, [&](std::size_t source, double e) { diagonal[source] += e * e * (diagonal[f] + tie[f]); });
    diagonal[f] = tie[f];
  }
}

}  // namespace minamo
