#pragma once
/// \file
/// EnvelopeLu from both ends of a long matrix at a time, each on a thread of its own, up to a few rows in the middle
/// that are solved last: one cut of nested dissection. A. George, SIAM J. Numer. Anal. 10 (1973) 345,
/// doi:10.1137/0710032. Where there is a cut depends on the matrix alone.

#include "systems/solve/envelope_lu.hpp"

namespace minamo {

/// The entries of every row of a matrix whose pattern is symmetric lie between these columns.
struct Envelope {
  std::vector<std::uint32_t> first;  ///< at most the row itself
  std::vector<std::uint32_t> last;   ///< at least the row itself
};

template <class Scalar>
class TwoEndedLu {
 public:
  void start(const Envelope& envelope);
  std::size_t rows() const { return rows_; }
  bool is_cut() const { return begin_ < rows_; }
  /// Entry; \pre within the envelope.
  Scalar& at(std::size_t row, std::size_t column) {
    if (row < begin_ || column < begin_) return front_.at(in_front(row), in_front(column));
    const std::size_t j = in_back(row);
    const std::size_t i = in_back(column);
    return j < of_back_ || i < of_back_ ? back_.at(j, i) : middle_.at(j - of_back_, i - of_back_);
  }
  /// False if a pivot is not finite, or not larger than `least` times what the diagonal was.
  bool factorize(double least);
  /// Overwrites b with the solution.
  void solve(Values& b);

 private:
  std::size_t in_back(std::size_t row) const { return in_back_[row - begin_]; }
  std::size_t in_front(std::size_t row) const { return row < begin_ ? row : begin_ + in_back(row) - of_back_; }
  void find_cut(const Envelope& envelope);
  void order_back(const Envelope& envelope);
  void start_front(const Envelope& envelope);
  void start_back(const Envelope& envelope);
  template <class Front, class Back>
  void for_both(const Front& front, const Back& back) const;

  std::size_t rows_ = 0;
  std::size_t begin_ = 0;                  ///< those before are the front
  std::size_t of_back_ = 0;                ///< rows
  std::vector<std::uint32_t> middle_row_;  ///< the others, which have entries in rows of the front
  std::vector<std::uint32_t> in_back_;     ///< of row begin_ + i: from the last one down, then those of the middle
  EnvelopeLu<Scalar> front_;               ///< keeps the middle, like the back
  EnvelopeLu<Scalar> back_;
  EnvelopeLu<Scalar> middle_;  ///< with all entries
  // Work space.
  std::vector<std::uint32_t> first_of_front_, first_of_back_, first_of_middle_;
  std::vector<std::uint32_t> behind_;  ///< how many rows of the back are behind row begin_ + i
};

}  // namespace minamo
