#include "systems/pressure/closed_components.hpp"

#include "systems/ranks/gathered.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace minamo {

/// What a row may miss of S n = 0 in a closed component, as part of S_ll n_l: rounding of those who assemble S.
constexpr double closed_up_to = 1e-10;

std::uint32_t ClosedComponents::first_row(std::uint32_t row) {
  while (joined_to_[row] != row) row = joined_to_[row] = joined_to_[joined_to_[row]];
  return row;
}

template <int Dim, class Use>
void ClosedComponents::join_rows(const StaggeredLaplacian<Dim>& matrix, const Use& use) {
  joined_to_.resize(matrix.rows());
  for (std::uint32_t l = 0; l < joined_to_.size(); ++l) {
    joined_to_[l] = l;
    std::uint32_t first = l;
    matrix.for_each_neighbour(l, [&](std::size_t m, double conductance) {
      if (m >= l || conductance <= 0 || !use(l, m)) return;
      const std::uint32_t other = first_row(static_cast<std::uint32_t>(m));
      joined_to_[std::max(first, other)] = std::min(first, other);
      first = std::min(first, other);
    });
  }
}

namespace {

/// Whether S n is not zero in a row: there is a free surface.
template <int Dim>
bool is_open(const StaggeredLaplacian<Dim>& matrix, std::span<const double> n, std::size_t l) {
  const double own = matrix.diagonal[l] * n[l];
  double left = own;
  matrix.for_each_neighbour(l, [&](std::size_t m, double conductance) { left -= conductance * n[m]; });
  return std::abs(left) > closed_up_to * own;
}

/// Labels of rows, of which those with a free surface have the least: it spreads over a component until all of its rows
/// have the same, on all ranks.
class LabelsOnRanks {
 public:
  static constexpr double nobody = 0;  ///< of rows that no rank owns
  static constexpr double open = 1;    ///< all others are larger

  /// \param part  the first row of what is joined here, by row
  LabelsOnRanks(const SiteExchange& shared, std::span<const std::uint32_t> of_unknown,
                std::span<const std::uint8_t> is_own, std::vector<std::uint32_t> part)
      : shared_(shared),
        of_unknown_(of_unknown),
        is_own_(is_own),
        part_(std::move(part)),
        label_(shared.rows(), nobody),
        least_(of_unknown.size()) {}

  double& of(std::size_t row) { return label_[of_unknown_[row]]; }
  /// Whether a row that this rank owns has another label than `open`.
  bool any_may_be_closed() {
    for (std::size_t l = 0; l < part_.size(); ++l) {
      if (is_own_[l] != 0 && of(l) != open) return true;
    }
    return false;
  }
  /// Takes the labels of others from those that own them.
  void hear() { shared_.copy_from_owner(std::span(label_)); }
  /// Over what is joined here. \return whether a row that this rank owns has got another one
  bool spread() {
    std::fill(least_.begin(), least_.end(), std::numeric_limits<double>::infinity());
    for (std::size_t l = 0; l < part_.size(); ++l) {
      if (of(l) > nobody) least_[part_[l]] = std::min(least_[part_[l]], of(l));
    }
    bool changes = false;
    for (std::size_t l = 0; l < part_.size(); ++l) {
      if (is_own_[l] == 0 || least_[part_[l]] >= of(l)) continue;
      of(l) = least_[part_[l]];
      changes = true;
    }
    return changes;
  }

 private:
  const SiteExchange& shared_;
  std::span<const std::uint32_t> of_unknown_;
  std::span<const std::uint8_t> is_own_;
  std::vector<std::uint32_t> part_;
  std::vector<double> label_;  ///< by row of the staggered table
  std::vector<double> least_;  ///< by the first row of what is joined
};

}  // namespace

template <int Dim>
void ClosedComponents::find(const StaggeredLaplacian<Dim>& matrix, std::span<const double> n) {
  join_rows(matrix, [](std::size_t, std::size_t) { return true; });
  is_open_.assign(matrix.rows(), 0);
  for (std::uint32_t l = 0; l < matrix.rows(); ++l) {
    if (is_open<Dim>(matrix, n, l)) is_open_[first_row(l)] = 1;
  }
  grounded_.clear();
  number_.resize(matrix.rows());
  for (std::uint32_t l = 0; l < matrix.rows(); ++l) {
    const std::uint32_t first = first_row(l);
    if (first == l && is_open_[l] == 0) grounded_.push_back(l);
    number_[l] = first != l ? number_[first] : is_open_[l] == 0 ? static_cast<std::uint32_t>(grounded_.size()) : 0;
  }
  count_ = grounded_.size();
}

template <int Dim>
void ClosedComponents::find_on_ranks(const StaggeredLaplacian<Dim>& matrix, std::span<const double> n,
                                     std::span<const std::uint32_t> of_unknown, std::span<const std::int64_t> number,
                                     const SiteExchange& shared) {
  ranks_ = &shared.ranks();
  is_own_.resize(matrix.rows());
  for (std::size_t l = 0; l < matrix.rows(); ++l) is_own_[l] = shared.owns(of_unknown[l]) ? 1 : 0;
  // What couples two rows, the rank of each knows. (Others may know it in part.)
  join_rows(matrix, [&](std::size_t l, std::size_t m) {
    return (is_own_[l] != 0 && number[m] >= 0) || (is_own_[m] != 0 && number[l] >= 0);
  });
  std::vector<std::uint32_t> part(matrix.rows());
  for (std::uint32_t l = 0; l < matrix.rows(); ++l) part[l] = first_row(l);
  LabelsOnRanks labels(shared, of_unknown, is_own_, std::move(part));
  const auto label_of = [&](std::size_t l) { return static_cast<double>(number[l]) + LabelsOnRanks::open + 1; };
  for (std::size_t l = 0; l < matrix.rows(); ++l) {
    if (is_own_[l] != 0) labels.of(l) = is_open<Dim>(matrix, n, l) ? LabelsOnRanks::open : label_of(l);
  }
  labels.spread();
  count_ = 0;
  if (!ranks_->any(labels.any_may_be_closed())) return;
  do {
    labels.hear();
  } while (ranks_->any(labels.spread()));

  std::vector<double> own;
  for (std::size_t l = 0; l < matrix.rows(); ++l) {
    if (is_own_[l] != 0 && labels.of(l) == label_of(l)) own.push_back(label_of(l));
  }
  const std::vector<double> all = gathered_on_all(*ranks_, std::span<const double>(own));
  count_ = all.size();
  number_.assign(matrix.rows(), 0);
  for (std::size_t l = 0; l < matrix.rows(); ++l) {
    const auto found = std::lower_bound(all.begin(), all.end(), labels.of(l));
    if (found != all.end() && *found == labels.of(l)) number_[l] = static_cast<std::uint32_t>(found - all.begin()) + 1;
  }
}

void ClosedComponents::remove_null_part(std::span<const double> n, std::span<Sources> b) const {
  if (count() == 0) return;
  constexpr std::size_t width = 1 + most_sources;  // |n|^2, and n b of every source
  sums_.assign(width * count(), 0);
  for (std::size_t l = 0; l < b.size(); ++l) {
    if (!counts(l)) continue;
    double* sums = &sums_[width * (number_[l] - 1)];
    sums[0] += n[l] * n[l];
    for (std::size_t s = 0; s < most_sources; ++s) sums[1 + s] += n[l] * b[l][s];
  }
  add_up(sums_);
  for (std::size_t l = 0; l < b.size(); ++l) {
    if (number_[l] == 0) continue;
    const double* sums = &sums_[width * (number_[l] - 1)];
    for (std::size_t s = 0; s < most_sources; ++s) b[l][s] -= n[l] * (sums[1 + s] / sums[0]);
  }
}

template void ClosedComponents::find<2>(const StaggeredLaplacian<2>&, std::span<const double>);
template void ClosedComponents::find<3>(const StaggeredLaplacian<3>&, std::span<const double>);
template void ClosedComponents::find_on_ranks<2>(const StaggeredLaplacian<2>&, std::span<const double>,
                                                 std::span<const std::uint32_t>, std::span<const std::int64_t>,
                                                 const SiteExchange&);
template void ClosedComponents::find_on_ranks<3>(const StaggeredLaplacian<3>&, std::span<const double>,
                                                 std::span<const std::uint32_t>, std::span<const std::int64_t>,
                                                 const SiteExchange&);

}  // namespace minamo
