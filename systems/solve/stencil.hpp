#pragma once
/// \file
/// The neighbours of a node: those that can share a particle with it.

#include "components/sites.hpp"

#include <span>

namespace minamo {

template <int Dim>
class Stencil {
 public:
  /// \param rows, sites  of one node table
  Stencil(const Grid<Dim>& grid, const SiteRows<Dim>& rows, std::span<const Index<Dim>> sites)
      : grid_(grid), rows_(rows), sites_(sites) {}

  /// Calls body(place, neighbour) for the neighbours in the table; the place is that of matrix.hpp. Rows rise but
  /// across the ends of periodic axes.
  template <class Body>
  void for_each_neighbour(std::uint32_t node, const Body& body) const {
    visit<Dim - 1>(sites_[node], 0, {}, body);
  }

  /// Neighbours inside the grid, whether in the table or not.
  std::size_t places_inside(std::uint32_t node) const {
    std::size_t count = 1;
    for (int d = 0; d < Dim; ++d) {
      const int at = sites_[node][static_cast<std::size_t>(d)];
      const bool periodic = grid_.periodic[static_cast<std::size_t>(d)];
      count *= static_cast<std::size_t>(periodic ? 5 : std::min(at, 2) + 1 + std::min(grid_.nodes(d) - 1 - at, 2));
    }
    return count;
  }

 private:
  template <int Axis, class Body>
  void visit(const Index<Dim>& at, std::size_t place, const typename SiteRows<Dim>::Address& address,
             const Body& body) const {
    for (int step = -2; step <= 2; ++step) {
      const int there = grid_.wrapped(Axis, at[static_cast<std::size_t>(Axis)] + step);
      if (there < 0 || there >= grid_.nodes(Axis)) continue;
      const std::size_t next_place = 5 * place + static_cast<std::size_t>(step + 2);
      const auto next_address = rows_.moved(address, Axis, there);
      if constexpr (Axis == 0) {
        if (const auto row = rows_.find(next_address)) body(next_place, *row);
      } else {
        visit<Axis - 1>(at, next_place, next_address, body);
      }
    }
  }

  Grid<Dim> grid_;
  const SiteRows<Dim>& rows_;
  std::span<const Index<Dim>> sites_;
};

}  // namespace minamo
