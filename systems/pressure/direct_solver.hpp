#pragma once
/// \file
/// S x = b by one Cholesky factorization within the envelope: for plane and small problems. The rows are ordered by
/// their sites; which axis runs fastest is chosen by the work.

#include "systems/linear/envelope_cholesky.hpp"
#include "systems/pressure/staggered_laplacian.hpp"

namespace minamo {

/// The order of rows, axis by axis, with the narrowest envelope.
template <int Dim>
class EnvelopeOrder {
 public:
  void find(const StaggeredLaplacian<Dim>& matrix);
  /// Where a row stands.
  std::span<const std::uint32_t> place() const { return place_; }
  /// Place of the first entry of the row at a place.
  std::span<const std::uint32_t> first() const { return first_; }
  double work() const { return work_; }

 private:
  using Axes = std::array<std::size_t, static_cast<std::size_t>(Dim)>;
  void find_coordinates(const StaggeredLaplacian<Dim>& matrix);
  void sort_by(std::size_t axis);
  void try_order(const StaggeredLaplacian<Dim>& matrix, const Axes& fastest_first);

  struct Coordinates {
    std::vector<std::uint32_t> of_row;  ///< from 0 on; on an axis that the liquid goes around, both ways in turn
    std::uint32_t count = 0;
  };
  std::array<Coordinates, static_cast<std::size_t>(Dim)> coordinates_;
  std::vector<std::uint32_t> place_, first_;
  double work_ = 0;
  std::vector<std::uint32_t> order_, sorted_, begin_, try_place_, try_first_;  ///< work space
};

template <int Dim>
class DirectSolver {
 public:
  /// Orders the rows. \return about the floating-point operations of factorize()
  double analyse(const StaggeredLaplacian<Dim>& matrix);
  /// \pre analyse() has seen the same sites and neighbours
  /// \param grounded  rows whose diagonal is doubled: one of each closed component, or S is singular
  /// \return false if a pivot is not positive
  bool factorize(const StaggeredLaplacian<Dim>& matrix, std::span<const std::uint32_t> grounded = {});
  /// \pre factorize() has returned true
  void solve(std::span<const Sources> b, std::span<Sources> x);

 private:
  EnvelopeOrder<Dim> order_;
  EnvelopeCholesky factors_;
  std::vector<EnvelopeCholesky::Row> x_;
};

}  // namespace minamo
