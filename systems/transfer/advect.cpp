#include "systems/transfer/advect.hpp"

#include "systems/transfer/gather.hpp"

namespace minamo {

namespace {

template <int Dim>
bool inside(const Grid<Dim>& grid, const Vec<Dim>& x) {
  return (x.array() >= grid.low.array()).all() && (x.array() <= grid.high.array()).all();
}

}  // namespace

template <int Dim>
void Advect<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                             Read<particle::Configuration<Dim>> y_p, Read<node::Displacement<Dim>> u_i,
                             Update<particle::Position<Dim>> x_p, Update<PutBack> put_back) const {
  gather<Dim>(*grid, *cells, y_p.span(), u_i.span(), [&](std::size_t p, const Vec<Dim>& u) { x_p[p] += u; });

  // Not on the wall itself, so that particles that come back again and again stay apart from it by more than rounding.
  const double margin = 1e-6 * grid->spacing;
  for (Vec<Dim>& x : x_p) {
    if (inside<Dim>(*grid, x)) continue;
    x = x.cwiseMax((grid->low.array() + margin).matrix()).cwiseMin((grid->high.array() - margin).matrix());
    ++put_back->count;
  }
}

template struct Advect<2>;
template struct Advect<3>;

}  // namespace minamo
