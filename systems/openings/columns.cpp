#include "systems/openings/columns.hpp"

namespace minamo {

template <int Dim>
std::size_t columns_along(const Opening<Dim>& opening, const Grid<Dim>& grid, std::size_t axis) {
  // Where there are walls two more: those that drift in, from whichever end.
  return static_cast<std::size_t>(opening.per_cell * grid.cells[axis]) + (grid.periodic[axis] ? 0 : 2);
}

template <int Dim>
std::size_t columns_of(const Opening<Dim>& opening, const Grid<Dim>& grid) {
  if (!opening.is_inflow()) return 0;
  std::size_t count = 1;
  for (std::size_t e = 0; e < Dim; ++e) count *= e == opening.side / 2 ? 1 : columns_along<Dim>(opening, grid, e);
  return count;
}

template std::size_t columns_along<2>(const Opening<2>&, const Grid<2>&, std::size_t);
template std::size_t columns_along<3>(const Opening<3>&, const Grid<3>&, std::size_t);
template std::size_t columns_of<2>(const Opening<2>&, const Grid<2>&);
template std::size_t columns_of<3>(const Opening<3>&, const Grid<3>&);

}  // namespace minamo
