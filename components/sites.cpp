#include "components/sites.hpp"

namespace minamo {

template <int Dim>
std::size_t SiteRows<Dim>::number_rows() {
  numbers_.sort();
  return number_along<Dim - 1>(numbers_.used(), 0, 0);
}

template <int Dim>
template <int Axis>
std::uint32_t SiteRows<Dim>::number_along(std::span<const std::uint32_t> pages, std::size_t within,
                                          std::uint32_t count) {
  for (std::size_t begin = 0, end = 0; begin < pages.size(); begin = end) {
    while (end < pages.size() && pages[end] / pages_before_[Axis] == pages[begin] / pages_before_[Axis]) ++end;
    for (std::size_t k = 0; k < width; ++k) {
      const std::size_t at = within + (k << (Axis * width_bits));
      if constexpr (Axis == 0) {
        std::uint32_t& one_past = page_of(pages[begin])[at];
        if (one_past != 0) one_past = ++count;
      } else {
        count = number_along<Axis - 1>(pages.subspan(begin, end - begin), at, count);
      }
    }
  }
  return count;
}

template class SiteRows<2>;
template class SiteRows<3>;

}  // namespace minamo
