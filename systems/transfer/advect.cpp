#include "systems/transfer/advect.hpp"

#include "systems/transfer/gather.hpp"

namespace minamo {

template <int Dim>
Vec<Dim> inside_box(const Grid<Dim>& grid, const Vec<Dim>& x) {
  if ((x.array() >= grid.low.array()).all() && (x.array() <= grid.high.array()).all()) return x;
  // Not on the wall itself, so that particles that come back again and again stay apart from it by more than rounding.
  const double margin = 1e-6 * grid.spacing;
  return x.cwiseMax((grid.low.array() + margin).matrix()).cwiseMin((grid.high.array() - margin).matrix());
}

template <int Dim>
void Advect<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                             Read<particle::Configuration<Dim>> y_p, Read<node::Displacement<Dim>> u_i,
                             Update<particle::Position<Dim>> x_p, Update<PutBack> put_back) const {
  gather<Dim>(*grid, *cells, y_p.span(), u_i.span(), [&](std::size_t p, const Vec<Dim>& u) { x_p[p] += u; });
  for (Vec<Dim>& x : x_p) {
    const Vec<Dim> put = inside_box<Dim>(*grid, x);
    put_back->count += put != x;
    x = put;
  }
}

template Vec<2> inside_box<2>(const Grid<2>&, const Vec<2>&);
template Vec<3> inside_box<3>(const Grid<3>&, const Vec<3>&);
template struct Advect<2>;
template struct Advect<3>;

}  // namespace minamo
