#pragma once
/// \file
/// The neighbours of a node: those that can share a particle with it.

#include "components/grid.hpp"

namespace minamo {

template <int Dim>
class Stencil {
 public:
  explicit Stencil(const Grid<Dim>& grid) : grid_(grid) {}

  /// Calls body(place, neighbour) for the neighbours inside the grid; the place is that of matrix.hpp. Rows rise but
  /// across the ends of periodic axes.
  template <class Body>
  void for_each_neighbour(std::uint32_t node, const Body& body) const {
    Index<Dim> at;
    std::size_t rest = node;
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto nodes = static_cast<std::size_t>(grid_.nodes(static_cast<int>(d)));
      at[d] = static_cast<int>(rest % nodes);
      rest /= nodes;
    }
    visit<Dim - 1>(at, 0, 0, body);
  }

 private:
  template <int Axis, class Body>
  void visit(const Index<Dim>& at, std::size_t place, std::size_t row, const Body& body) const {
    constexpr auto axis = static_cast<std::size_t>(Axis);
    for (int step = -2; step <= 2; ++step) {
      const int there = grid_.wrapped(Axis, at[axis] + step);
      if (there < 0 || there >= grid_.nodes(Axis)) continue;
      const std::size_t next_place = 5 * place + static_cast<std::size_t>(step + 2);
      const std::size_t next_row = row * static_cast<std::size_t>(grid_.nodes(Axis)) + static_cast<std::size_t>(there);
      if constexpr (Axis == 0) {
        body(next_place, static_cast<std::uint32_t>(next_row));
      } else {
        visit<Axis - 1>(at, next_place, next_row, body);
      }
    }
  }

  Grid<Dim> grid_;
};

}  // namespace minamo
