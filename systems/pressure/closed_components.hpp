#pragma once
/// \file
/// Liquid that fills a closed box: components of the matrix without a free surface, where S is singular. S has a null
/// vector there, and a right-hand side a solution only if it has no part along that vector.

#include "systems/pressure/staggered_laplacian.hpp"
#include "systems/ranks/site_exchange.hpp"

namespace minamo {

class ClosedComponents {
 public:
  /// \param null_vector  n_l > 0 with S n = 0 in a closed component
  template <int Dim>
  void find(const StaggeredLaplacian<Dim>& matrix, std::span<const double> null_vector);
  /// The same where the matrix is spread over ranks, with one number for a component on all of them.
  /// \param of_unknown  site of every row
  /// \param number      of every row among those of all ranks, from 0; -1: no rank owns it
  template <int Dim>
  void find_on_ranks(const StaggeredLaplacian<Dim>& matrix, std::span<const double> null_vector,
                     std::span<const std::uint32_t> of_unknown, std::span<const std::int64_t> number,
                     const SiteExchange& shared);

  std::size_t count() const { return count_; }
  /// Whether a row belongs to one.
  bool contains(std::size_t row) const { return number(row) > 0; }
  /// Which one that is, from 1; 0: none.
  std::size_t number(std::size_t row) const { return count() > 0 ? number_[row] : 0; }
  /// Whether a row counts in a sum over the rows of its component; on several ranks it does on one.
  bool counts(std::size_t row) const { return contains(row) && (ranks_ == nullptr || is_own_[row] != 0); }
  /// Sums over rows that count here become those over all.
  void add_up(std::span<double> sums) const {
    if (ranks_ != nullptr && count_ > 0) ranks_->sum(sums);
  }
  /// A row of each. With more on the diagonal of these rows S is definite, and where b has no part along the null
  /// vectors, the solution is one of S x = b, with x = 0 in these rows. On several ranks none.
  std::span<const std::uint32_t> grounded() const { return grounded_; }
  /// Takes the part along the null vector of every closed component from right-hand sides, or from solutions.
  void remove_null_part(std::span<const double> null_vector, std::span<Sources> b) const;

 private:
  /// Joins rows that the matrix couples, if use(row, other) says so.
  template <int Dim, class Use>
  void join_rows(const StaggeredLaplacian<Dim>& matrix, const Use& use);
  std::uint32_t first_row(std::uint32_t row);

  std::vector<std::uint32_t> joined_to_;  ///< row before in the same component; itself: the first
  std::vector<std::uint32_t> number_;     ///< 1 + number of the closed component; 0: none
  std::vector<std::uint32_t> grounded_;
  std::vector<std::uint8_t> is_open_;  ///< by the first row of a component
  std::size_t count_ = 0;
  Communicator* ranks_ = nullptr;     ///< null: this process has all rows
  std::vector<std::uint8_t> is_own_;  ///< on several ranks: whether this one owns a row
  mutable std::vector<double> sums_;  ///< work space
};

}  // namespace minamo
