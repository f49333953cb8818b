#pragma once
/// \file
/// Sites near a site, whether it is in a cell of particles or not.

#include "components/sites.hpp"
#include "systems/grid/node_support.hpp"
#include "systems/grid/splines.hpp"

#include <optional>
#include <type_traits>
#include <utility>

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
      const auto other = splines.axis[d].site_at(site[d], begin[d] + k);
      if (other) along[d][static_cast<std::size_t>(count[d]++)] = *other;
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

/// The sites up to `Reach` steps away from one along every axis, itself among them.
template <int Dim, int Reach>
class SitesAround {
 public:
  static constexpr int side = 2 * Reach + 1;

  SitesAround(const Splines<Dim>& splines, const Index<Dim>& site) {
    for (std::size_t d = 0; d < Dim; ++d) {
      for (int k = 0; k < side; ++k)
        along_[d][static_cast<std::size_t>(k)] = splines.axis[d].site_at(site[d], k - Reach);
    }
  }
  /// Calls use(other, steps), x fastest, until it returns false.
  template <class Use>
  void for_each(const Use& use) const {
    Index<Dim> other;
    Index<Dim> steps;
    for_each_along<Dim - 1>(other, steps, use);
  }

 private:
  template <std::size_t D, class Use>
  bool for_each_along(Index<Dim>& other, Index<Dim>& steps, const Use& use) const {
    for (int k = 0; k < side; ++k) {
      const std::optional<int>& at = along_[D][static_cast<std::size_t>(k)];
      if (!at) continue;
      other[D] = *at;
      steps[D] = k - Reach;
      bool goes_on = true;
      if constexpr (D > 0) {
        goes_on = for_each_along<D - 1>(other, steps, use);
      } else {
        goes_on = use(std::as_const(other), std::as_const(steps));
      }
      if (!goes_on) return false;
    }
    return true;
  }

  std::array<std::array<std::optional<int>, static_cast<std::size_t>(side)>, static_cast<std::size_t>(Dim)> along_;
};

/// use(other, steps) for the sites up to `Reach` steps away along every axis, x fastest, itself among them.
template <int Dim, int Reach, class Use>
void for_each_site_around(const Splines<Dim>& splines, const Index<Dim>& site, const Use& use) {
  SitesAround<Dim, Reach>(splines, site).for_each([&](const Index<Dim>& other, const Index<Dim>& steps) {
    use(other, steps);
    return true;
  });
}

/// use(row, other, steps) for those of them that have rows, until it returns false, if it returns anything.
template <int Dim, int Reach, class Use>
void for_each_row_around(const Splines<Dim>& splines, const SiteRows<Dim>& rows, const Index<Dim>& site,
                         const Use& use) {
  typename SiteRows<Dim>::Finder find(rows);
  SitesAround<Dim, Reach>(splines, site).for_each([&](const Index<Dim>& other, const Index<Dim>& steps) {
    const auto row = find(other);
    if constexpr (std::is_same_v<decltype(use(*row, other, steps)), bool>) {
      return !row || use(*row, other, steps);
    } else {
      if (row) use(*row, other, steps);
      return true;
    }
  });
}

}  // namespace minamo
