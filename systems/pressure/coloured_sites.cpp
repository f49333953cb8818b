#include "systems/pressure/multigrid_level.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace minamo {

/// Parity of the sum of the coordinates. Around an odd number of sites the last is a neighbour of the first and both
/// are even: there the last counts as 2 and the sum modulo 3.
template <int Dim>
void ColouredSites<Dim>::place_by_colour(const Index<Dim>& counts, const Periodic& periodic) {
  std::array<int, static_cast<std::size_t>(Dim)> odd_end{};
  int colours = 2;
  for (std::size_t d = 0; d < odd_end.size(); ++d) {
    const bool is_odd = periodic[d] && counts[d] % 2 == 1 && counts[d] > 1;
    odd_end[d] = is_odd ? counts[d] - 1 : -1;
    if (is_odd) colours = 3;
  }
  colour_.resize(site_.size());
  std::array<std::uint32_t, 3> next{};
  for (std::size_t l = 0; l < site_.size(); ++l) {
    int sum = 0;
    for (std::size_t d = 0; d < odd_end.size(); ++d) sum += site_[l][d] == odd_end[d] ? 2 : site_[l][d] & 1;
    colour_[l] = static_cast<std::uint8_t>(colours == 2 ? sum & 1 : sum % 3);
    ++next[colour_[l]];
  }
  std::exclusive_scan(next.begin(), next.end(), next.begin(), 0U);
  colour_begin_.assign(next.begin(), next.begin() + colours);
  colour_begin_.push_back(static_cast<std::uint32_t>(site_.size()));
  place_.resize(site_.size());
  for (std::size_t l = 0; l < site_.size(); ++l) place_[l] = next[colour_[l]]++;
}

template <int Dim>
void ColouredSites<Dim>::keep_order() {
  place_.resize(site_.size());
  std::iota(place_.begin(), place_.end(), 0);
  colour_begin_ = {0, static_cast<std::uint32_t>(site_.size())};
}

template <int Dim>
void ColouredSites<Dim>::find_lines(const ColouredSites& fine) {
  lines_.clear();
  for (std::uint32_t l = 0; l < fine.site_.size(); ++l) {
    bool is_first = l == 0;
    for (std::size_t d = 1; d < static_cast<std::size_t>(Dim) && !is_first; ++d) {
      is_first = fine.site_[l][d] != fine.site_[l - 1][d];
    }
    if (is_first) lines_.push_back({l, l});
    lines_.back().end = l + 1;
  }
}

/// Makes the aggregates of lines that share them, from left to right.
template <int Dim>
void ColouredSites<Dim>::merge_lines(const ColouredSites& fine) {
  while (!merged_.empty()) {
    int x = std::numeric_limits<int>::max();
    for (const Run& run : merged_) x = std::min(x, fine.site_[run.begin][0] >> 1);
    const auto number = static_cast<std::uint32_t>(site_.size());
    Index<Dim> at = fine.site_[merged_.front().begin];
    for (int& coordinate : at) coordinate >>= 1;
    at[0] = x;
    site_.push_back(at);
    for (Run& run : merged_) {
      for (; run.begin != run.end && fine.site_[run.begin][0] >> 1 == x; ++run.begin) parent_[run.begin] = number;
    }
    std::erase_if(merged_, [](const Run& run) { return run.begin == run.end; });
  }
}

/// Makes the aggregates of lines from `begin` on and from `middle` on, which are planes side by side.
template <int Dim>
void ColouredSites<Dim>::merge_planes(const ColouredSites& fine, std::size_t begin, std::size_t middle,
                                      std::size_t end) {
  const auto y_of = [&](std::size_t line) { return fine.site_[lines_[line].begin][1] >> 1; };
  for (std::size_t lower = begin, upper = middle; lower < middle || upper < end;) {
    int y = std::numeric_limits<int>::max();
    if (lower < middle) y = std::min(y, y_of(lower));
    if (upper < end) y = std::min(y, y_of(upper));
    for (; lower < middle && y_of(lower) == y; ++lower) merged_.push_back(lines_[lower]);
    for (; upper < end && y_of(upper) == y; ++upper) merged_.push_back(lines_[upper]);
    merge_lines(fine);
  }
}

template <int Dim>
std::span<const std::uint32_t> ColouredSites<Dim>::assign_coarser(const ColouredSites& fine) {
  find_lines(fine);
  site_.clear();
  parent_.resize(fine.site_.size());
  if constexpr (Dim == 2) {
    merge_planes(fine, 0, lines_.size(), lines_.size());
  } else {
    const auto z_of = [&](std::size_t line) { return fine.site_[lines_[line].begin][2]; };
    for (std::size_t begin = 0, middle = 0, end = 0; begin < lines_.size(); begin = end) {
      for (middle = begin; middle < lines_.size() && z_of(middle) == z_of(begin);) ++middle;
      for (end = middle; end < lines_.size() && z_of(end) >> 1 == z_of(begin) >> 1;) ++end;
      merge_planes(fine, begin, middle, end);
    }
  }
  return parent_;
}

template class ColouredSites<2>;
template class ColouredSites<3>;

}  // namespace minamo
