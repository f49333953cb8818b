#pragma once
/// \file
/// The neighbours of a node: those that can share a particle with it.

#include "components/sites.hpp"

#include <algorithm>
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
    typename SiteRows<Dim>::Finder find(rows_);
    visit<Dim - 1>(window(node), 0, {}, find, body);
  }

  /// Whether all neighbours inside the grid are in the table and meet the condition.
  template <class Condition>
  bool all_of(std::uint32_t node, const Condition& condition) const {
    typename SiteRows<Dim>::Finder find(rows_);
    return all_of<Dim - 1>(window(node), {}, find, condition);
  }

 private:
  using Address = typename SiteRows<Dim>::Address;
  using Finder = typename SiteRows<Dim>::Finder;

  /// The steps along every axis, 0 ... 4 for -2 ... 2, that stay inside the grid, and what they add to an address.
  struct Window {
    std::array<std::array<Address, 5>, static_cast<std::size_t>(Dim)> part;
    std::array<std::size_t, static_cast<std::size_t>(Dim)> begin;
    std::array<std::size_t, static_cast<std::size_t>(Dim)> end;
  };

  Window window(std::uint32_t node) const {
    Window around;
    for (int d = 0; d < Dim; ++d) {
      const auto axis = static_cast<std::size_t>(d);
      const int at = sites_[node][axis];
      const bool periodic = grid_.periodic[axis];
      around.begin[axis] = static_cast<std::size_t>(periodic ? 0 : std::max(0, 2 - at));
      around.end[axis] = static_cast<std::size_t>(periodic ? 5 : std::min(5, grid_.nodes(d) + 2 - at));
      for (std::size_t step = around.begin[axis]; step < around.end[axis]; ++step) {
        around.part[axis][step] = rows_.part(d, grid_.wrapped(d, at + static_cast<int>(step) - 2));
      }
    }
    return around;
  }

  template <int Axis, class Body>
  void visit(const Window& around, std::size_t place, const Address& from, Finder& find, const Body& body) const {
    constexpr auto axis = static_cast<std::size_t>(Axis);
    for (std::size_t step = around.begin[axis]; step < around.end[axis]; ++step) {
      const Address at = from + around.part[axis][step];
      if constexpr (Axis == 0) {
        if (const auto row = find(at)) body(5 * place + step, *row);
      } else {
        visit<Axis - 1>(around, 5 * place + step, at, find, body);
      }
    }
  }

  template <int Axis, class Condition>
  bool all_of(const Window& around, const Address& from, Finder& find, const Condition& condition) const {
    constexpr auto axis = static_cast<std::size_t>(Axis);
    for (std::size_t step = around.begin[axis]; step < around.end[axis]; ++step) {
      const Address at = from + around.part[axis][step];
      if constexpr (Axis == 0) {
        const auto row = find(at);
        if (!row || !condition(*row)) return false;
      } else {
        if (!all_of<Axis - 1>(around, at, find, condition)) return false;
      }
    }
    return true;
  }

  Grid<Dim> grid_;
  const SiteRows<Dim>& rows_;
  std::span<const Index<Dim>> sites_;
};

}  // namespace minamo
