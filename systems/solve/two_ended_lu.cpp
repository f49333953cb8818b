#include "systems/solve/two_ended_lu.hpp"

#include <oneapi/tbb/parallel_invoke.h>

#include <algorithm>

namespace minamo {

namespace {

/// Multiplications from which on a cut saves more than a second thread costs, and the part of them that those of the
/// middle may be.
constexpr double least_cost = 1e6;
constexpr double most_of_middle = 0.125;

/// The row before which half of the work is.
std::size_t half_of(const std::vector<std::uint32_t>& first, double cost) {
  std::size_t row = 0;
  for (double before = 0; 2 * before < cost; ++row) {
    const auto below = static_cast<double>(row - first[row]);
    before += below * below;
  }
  return row;
}

}  // namespace

template <class Scalar>
void TwoEndedLu<Scalar>::find_cut(const Envelope& envelope) {
  const auto& first = envelope.first;
  rows_ = first.size();
  begin_ = rows_;
  of_back_ = 0;
  middle_row_.clear();
  const double cost = envelope_cost(first);
  if (cost < least_cost) return;
  const std::size_t begin = half_of(first, cost);
  for (std::size_t i = begin; i < rows_; ++i) {
    if (first[i] < begin) middle_row_.push_back(static_cast<std::uint32_t>(i));
  }
  const auto size = static_cast<double>(middle_row_.size());
  if (size * size * size / 3 > most_of_middle * cost || 2 * middle_row_.size() > rows_ - begin) {
    middle_row_.clear();
    return;
  }
  begin_ = begin;
  of_back_ = rows_ - begin - middle_row_.size();
}

/// Where the back has the rows from begin_ on.
template <class Scalar>
void TwoEndedLu<Scalar>::order_back(const Envelope& envelope) {
  in_back_.resize(rows_ - begin_);
  std::uint32_t behind = 0;
  auto in_middle = static_cast<std::uint32_t>(rows_ - begin_);
  for (std::size_t i = rows_; i-- > begin_;) {
    in_back_[i - begin_] = envelope.first[i] < begin_ ? --in_middle : behind++;
  }
}

template <class Scalar>
template <class Front, class Back>
void TwoEndedLu<Scalar>::for_both(const Front& front, const Back& back) const {
  if (is_cut()) {
    tbb::parallel_invoke(front, back);
  } else {
    front();
  }
}

template <class Scalar>
void TwoEndedLu<Scalar>::start_front(const Envelope& envelope) {
  first_of_front_.assign(envelope.first.begin(), envelope.first.begin() + static_cast<std::ptrdiff_t>(begin_));
  for (const std::uint32_t i : middle_row_) first_of_front_.push_back(envelope.first[i]);
  front_.start(first_of_front_, middle_row_.size());
}

/// A row begins with the last row that it reaches, or the next of the back before it: after those behind that one.
template <class Scalar>
void TwoEndedLu<Scalar>::start_back(const Envelope& envelope) {
  behind_.resize(rows_ - begin_);
  std::uint32_t behind = 0;
  for (std::size_t i = rows_; i-- > begin_;) {
    behind_[i - begin_] = behind;
    if (in_back(i) < of_back_) ++behind;
  }
  first_of_back_.resize(rows_ - begin_);
  for (std::size_t i = begin_; i < rows_; ++i) first_of_back_[in_back(i)] = behind_[envelope.last[i] - begin_];
  back_.start(first_of_back_, middle_row_.size());
}

template <class Scalar>
void TwoEndedLu<Scalar>::start(const Envelope& envelope) {
  find_cut(envelope);
  order_back(envelope);
  for_both([&] { start_front(envelope); }, [&] { start_back(envelope); });
  first_of_middle_.assign(middle_row_.size(), 0);
  middle_.start(first_of_middle_);
}

template <class Scalar>
bool TwoEndedLu<Scalar>::factorize(double least) {
  bool front_is_regular = true;
  bool back_is_regular = true;
  for_both(
      [&] {
        front_.expect_pivots(least);
        front_is_regular = front_.factorize();
      },
      [&] {
        back_.expect_pivots(least);
        back_is_regular = back_.factorize();
      });
  if (!is_cut()) return front_is_regular;
  if (!front_is_regular || !back_is_regular) return false;
  middle_.expect_pivots(least);
  for (std::size_t j = 0; j < middle_row_.size(); ++j) {
    for (std::size_t i = 0; i < middle_row_.size(); ++i) {
      middle_.at(i, j) += front_.at(begin_ + i, begin_ + j) + back_.at(of_back_ + i, of_back_ + j);
    }
  }
  return middle_.factorize();
}

template <class Scalar>
void TwoEndedLu<Scalar>::solve(Values& b) {
  for_both(
      [&] {
        for (std::size_t i = 0; i < begin_; ++i) front_.x(i) = static_cast<Scalar>(b[i]);
        for (std::size_t i = 0; i < middle_row_.size(); ++i) front_.x(begin_ + i) = 0;
        front_.eliminate();
      },
      [&] {
        for (std::size_t i = begin_; i < rows_; ++i) back_.x(in_back(i)) = static_cast<Scalar>(b[i]);
        back_.eliminate();
      });
  for (std::size_t i = 0; i < middle_row_.size(); ++i) {
    middle_.x(i) = front_.x(begin_ + i) + back_.x(of_back_ + i);
  }
  middle_.eliminate();
  middle_.substitute();
  for (std::size_t i = 0; i < middle_row_.size(); ++i) {
    front_.x(begin_ + i) = back_.x(of_back_ + i) = middle_.x(i);
  }
  for_both(
      [&] {
        front_.substitute();
        for (std::size_t i = 0; i < begin_; ++i) b[i] = front_.x(i);
      },
      [&] {
        back_.substitute();
        for (std::size_t i = begin_; i < rows_; ++i) b[i] = back_.x(in_back(i));
      });
}

template class TwoEndedLu<float>;
template class TwoEndedLu<double>;

}  // namespace minamo
