#pragma once
/// \file
/// Support and weights of a point wherever it is: for loops over particles that have left the cells they are sorted by,
/// and for points that are no particles.

#include "components/sites.hpp"
#include "systems/grid/support.hpp"

namespace minamo {

/// Calls body(k, address) for the nodes of a dual cell.
template <int Dim, class Body>
void for_each_address(const Grid<Dim>& grid, const SiteRows<Dim>& rows, const SupportBox<Dim>& support,
                      const Body& body) {
  std::array<std::array<typename SiteRows<Dim>::Address, 3>, static_cast<std::size_t>(Dim)> part;
  for (int d = 0; d < Dim; ++d) {
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(d);
      part[axis][static_cast<std::size_t>(a)] = rows.part(d, grid.wrapped(d, support.first[axis] + a));
    }
  }
  for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) {
    typename SiteRows<Dim>::Address at;
    for (std::size_t d = 0; d < Dim; ++d) at = at + part[d][static_cast<std::size_t>(offset[d])];
    body(k, at);
  });
}

template <int Dim>
struct Place {
  SupportBox<Dim> support;
  Weights<Dim> weights;
  /// Rows of the nodes in the table of `rows`; none for a node that is not in it.
  std::array<std::optional<std::uint32_t>, support_size<Dim>> node;

  Place(const Grid<Dim>& grid, const SiteRows<Dim>& rows, const Vec<Dim>& x)
      : Place(grid, rows, fold<Dim>(grid, x), Folded{}) {}

  /// Calls body(row, offset) for the nodes in the table.
  template <class Body>
  void for_each_node(const Body& body) const {
    for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) {
      if (node[k]) body(std::size_t{*node[k]}, offset);
    });
  }

 private:
  struct Folded {};
  Place(const Grid<Dim>& grid, const SiteRows<Dim>& rows, const Vec<Dim>& y, Folded)
      : support(grid, dual_cell<Dim>(grid, y)), weights(support, y) {
    typename SiteRows<Dim>::Finder find(rows);
    for_each_address<Dim>(grid, rows, support, [&](std::size_t k, const auto& address) { node[k] = find(address); });
  }
};

}  // namespace minamo
