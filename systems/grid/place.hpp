#pragma once
/// \file
/// Support and weights of a point wherever it is: for loops over particles that have left the cells they are sorted by,
/// and for points that are no particles.

#include "components/sites.hpp"
#include "systems/grid/support.hpp"

namespace minamo {

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
    for_each_support<Dim>(
        [&](std::size_t k, const Index<Dim>& offset) { node[k] = rows.find(support.site(grid, offset)); });
  }
};

}  // namespace minamo
