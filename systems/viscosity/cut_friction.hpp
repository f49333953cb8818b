#pragma once
/// \file
/// (E110) Friction of cells that walls cut: the integrals of (E80) over what is open of the cell, and of (E83) over the
/// piece of a wall in it.

#include "components/cells.hpp"
#include "components/rigid.hpp"

#include <vector>

namespace minamo {

/// Matrices of cells, one after the other. A cell has n faces.
template <int Dim>
class CutMatrices {
 public:
  static constexpr std::size_t motions = rigid_motions<Dim>;

  void clear(std::size_t faces) {
    faces_ = faces;
    share_.clear();
    wall_.clear();
    numbers_.clear();
  }
  std::size_t size() const { return share_.size(); }
  /// Adds cells whose numbers are zero. \return the number of the first
  std::size_t add(std::size_t count) {
    const std::size_t first = size();
    share_.resize(first + count, 0.0);
    wall_.resize(first + count, -1);
    numbers_.resize((first + count) * stride(), 0.0);
    return first;
  }

  std::size_t bytes_per_cell() const { return stride() * sizeof(double); }

  /// Share of the cell that no wall takes. [1]
  double& share(std::size_t k) { return share_[k]; }
  double share(std::size_t k) const { return share_[k]; }
  /// The wall with a slip length in the cell, or -1.
  std::int32_t& wall(std::size_t k) { return wall_[k]; }
  std::int32_t wall(std::size_t k) const { return wall_[k]; }

  /// K^ of a cell, n x n, symmetric. [m in 3-D; 1 in 2-D]
  double* matrix(std::size_t k) { return numbers_.data() + k * stride(); }
  const double* matrix(std::size_t k) const { return numbers_.data() + k * stride(); }
  /// Row sums of what is off and on the diagonal, without signs, by face.
  double* bounds(std::size_t k) { return matrix(k) + faces_ * faces_; }
  const double* bounds(std::size_t k) const { return matrix(k) + faces_ * faces_; }
  /// What the motions of the wall take from the force of a face, n x motions: the force on the wall is its transpose
  /// times the velocities less `on_wall` times the motions.
  double* by_wall(std::size_t k) { return bounds(k) + faces_; }
  const double* by_wall(std::size_t k) const { return bounds(k) + faces_; }
  double* on_wall(std::size_t k) { return by_wall(k) + faces_ * motions; }
  const double* on_wall(std::size_t k) const { return by_wall(k) + faces_ * motions; }

 private:
  std::size_t stride() const { return faces_ * faces_ + faces_ + faces_ * motions + motions * motions; }

  std::size_t faces_ = 0;
  std::vector<double> share_;
  std::vector<std::int32_t> wall_;
  std::vector<double> numbers_;
};

/// Of the cells that bodies at rest cut.
template <int Dim>
struct FrictionAtRest {
  std::vector<std::int32_t> place;  ///< by cell of the grid, x fastest: its number in `matrices`, or -1; may be empty
  CutMatrices<Dim> matrices;
  static constexpr ComponentInfo info{"friction.at_rest", "K^", "m^(d-2)", Lifetime::constant};
};

/// Of the cells of a step.
template <int Dim>
struct CutFriction {
  static constexpr std::int32_t whole = -1;
  /// By occupied cell: `whole`, a number k >= 0 in `moving`, or -2 - k for one among those at rest.
  std::vector<std::int32_t> place;
  CutMatrices<Dim> moving;               ///< cells that moving bodies cut
  std::vector<RigidVector<Dim>> motion;  ///< mean over the step of every body [m/s, 1/s]
  using rows_of = Cells;
  static constexpr ComponentInfo info{"friction.cut", "K^", "m^(d-2)", Lifetime::scratch};

  bool cuts(std::size_t c) const { return place[c] != whole; }
  /// Calls use(matrices, number) for a cell that is cut.
  template <class Use>
  auto with(std::size_t c, const FrictionAtRest<Dim>& at_rest, const Use& use) const {
    return place[c] >= 0 ? use(moving, static_cast<std::size_t>(place[c]))
                         : use(at_rest.matrices, static_cast<std::size_t>(-2 - place[c]));
  }
};

/// Force of friction on every body, and its torque. [N, N m]
template <int Dim>
struct FrictionOnWalls {
  std::vector<RigidVector<Dim>> of;
  static constexpr ComponentInfo info{"friction.on_walls", "", "N", Lifetime::scratch};
};

}  // namespace minamo
