#pragma once
/// \file
/// Liquid that fills a closed box: components of the matrix without a free surface, where S is singular. S has a null
/// vector there, and a right-hand side a solution only if it has no part along that vector.

#include "systems/pressure/staggered_laplacian.hpp"

namespace minamo {

class ClosedComponents {
 public:
  /// \param null_vector  n_l > 0 with S n = 0 in a closed component
  template <int Dim>
  void find(const StaggeredLaplacian<Dim>& matrix, std::span<const double> null_vector);

  std::size_t count() const { return grounded_.size(); }
  /// Whether a row belongs to one.
  bool contains(std::size_t row) const { return number(row) > 0; }
  /// Which one that is, from 1; 0: none.
  std::size_t number(std::size_t row) const { return count() > 0 ? number_[row] : 0; }
  /// A row of each. With more on the diagonal of these rows S is definite, and where b has no part along the null
  /// vectors, the solution is one of S x = b, with x = 0 in these rows.
  std::span<const std::uint32_t> grounded() const { return grounded_; }
  /// Takes the part along the null vector of every closed component from right-hand sides, or from solutions.
  void remove_null_part(std::span<const double> null_vector, std::span<Sources> b) const;

 private:
  template <int Dim>
  void join_rows(const StaggeredLaplacian<Dim>& matrix);
  std::uint32_t first_row(std::uint32_t row);

  std::vector<std::uint32_t> joined_to_;  ///< row before in the same component; itself: the first
  std::vector<std::uint32_t> number_;     ///< 1 + number of the closed component; 0: none
  std::vector<std::uint32_t> grounded_;
  std::vector<std::uint8_t> is_open_;  ///< by the first row of a component
  struct Sums {
    double square = 0;
    Sources along{};
  };
  mutable std::vector<Sums> sums_;  ///< work space
};

}  // namespace minamo
