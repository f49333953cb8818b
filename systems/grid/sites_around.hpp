#pragma once
/// \file
/// Sites near a site, whether it is in a cell of particles or not.

#include "components/sites.hpp"
#include "systems/grid/node_support.hpp"
#include "systems/grid/splines.hpp"

namespace minamo {

/// The site next to one towards a side, 2 d below and 2 d + 1 above along axis d, if there is one.
template <int Dim>
std::optional<Index<Dim>> adjacent_site(const Splines<Dim>& splines, const Index<Dim>& site, std::size_t side) {
  Index<Dim> steps{};
  steps[side / 2] = side % 2 == 0 ? -1 : 1;
  return splines.site_at(site, steps);
}

/// use(other) for the sites of a window that begins some steps from one, x fastest.
/// \param extent  of the window along every axis, up to twice the largest degree
template <int Dim, class Use>
void for_each_site_in_window(const Splines<Dim>& splines, const Index<Dim>& site, const Index<Dim>& begin,
                             const Index<Dim>& extent, const Use& use) {
  std::array<std::array<int, 2 * static_cast<std::size_t>(largest_degree)>, static_cast<std::size_t>(Dim)> along;
  Index<Dim> count{};
  for (std::size_t d = 0; d < Dim; ++d) {
    for (int k = 0; k < extent[d]; ++k) {
      Index<Dim> steps{};
      steps[d] = begin[d] + k;
      if (const auto other = splines.site_at(site, steps)) along[d][static_cast<std::size_t>(count[d]++)] = (*other)[d];
    }
    if (count[d] == 0) return;
  }
  Index<Dim> at{};
  while (at[Dim - 1] < count[Dim - 1]) {
    Index<Dim> other;
    for (std::size_t d = 0; d < Dim; ++d) other[d] = along[d][static_cast<std::size_t>(at[d])];
    use(other);
    for (std::size_t d = 0; d < Dim && ++at[d] == count[d] && d + 1 < Dim; ++d) at[d] = 0;
  }
}

/// use(other, steps) for the sites up to `Reach` steps away along every axis, x fastest, itself among them.
template <int Dim, int Reach, class Use>
void for_each_site_around(const Splines<Dim>& splines, const Index<Dim>& site, const Use& use) {
  constexpr std::size_t side = 2 * Reach + 1;
  for (std::size_t k = 0; k < power(side, Dim); ++k) {
    Index<Dim> steps;
    std::size_t rest = k;
    for (std::size_t d = 0; d < Dim; ++d, rest /= side) steps[d] = static_cast<int>(rest % side) - Reach;
    if (const auto other = splines.site_at(site, steps)) use(*other, steps);
  }
}

/// use(row, other, steps) for those of them that have rows.
template <int Dim, int Reach, class Use>
void for_each_row_around(const Splines<Dim>& splines, const SiteRows<Dim>& rows, const Index<Dim>& site,
                         const Use& use) {
  constexpr std::size_t side = 2 * Reach + 1;
  struct Along {
    int site;
    typename SiteRows<Dim>::Address part;
    bool is_there;
  };
  std::array<std::array<Along, side>, static_cast<std::size_t>(Dim)> along;
  for (std::size_t d = 0; d < Dim; ++d) {
    for (std::size_t k = 0; k < side; ++k) {
      Index<Dim> steps{};
      steps[d] = static_cast<int>(k) - Reach;
      const auto other = splines.site_at(site, steps);
      const int at = other ? (*other)[d] : 0;
      along[d][k] = {at, rows.part(static_cast<int>(d), at), other.has_value()};
    }
  }
  typename SiteRows<Dim>::Finder find(rows);
  for (std::size_t k = 0; k < power(side, Dim); ++k) {
    Index<Dim> other;
    Index<Dim> steps;
    typename SiteRows<Dim>::Address address;
    bool is_there = true;
    std::size_t rest = k;
    for (std::size_t d = 0; d < Dim; ++d, rest /= side) {
      const Along& of = along[d][rest % side];
      other[d] = of.site;
      steps[d] = static_cast<int>(rest % side) - Reach;
      address = address + of.part;
      is_there = is_there && of.is_there;
    }
    if (!is_there) continue;
    if (const auto row = find(address)) use(*row, other, steps);
  }
}

}  // namespace minamo
