#include "systems/transfer/advect.hpp"

#include "systems/transfer/node_gather.hpp"

#include <atomic>

namespace minamo {

template <int Dim>
Placed<Dim> put_inside_box(const Grid<Dim>& grid, Vec<Dim> x) {
  bool clamped = false;
  for (int d = 0; d < Dim; ++d) {
    if (x[d] >= grid.low[d] && x[d] <= grid.high[d]) continue;
    if (grid.periodic[static_cast<std::size_t>(d)]) {
      const double length = grid.high[d] - grid.low[d];
      x[d] -= length * std::floor((x[d] - grid.low[d]) / length);
    } else {
      clamped = true;
    }
  }
  return {keep_off_walls<Dim>(grid, x), clamped};
}

template <int Dim>
void Advect<Dim>::operator()(Uses<NodesToParticles<Dim>> target, Read<node::Displacement<Dim>> u_i,
                             Update<particle::Position<Dim>> x_p, Update<Clamped> clamped) const {
  std::atomic<std::int64_t> count = 0;
  gather<Dim>(target, u_i.span(), [&](std::size_t p, const Vec<Dim>& u) {
    const Placed<Dim> placed = inside_box<Dim>(*target.grid, x_p[p] + u);
    x_p[p] = placed.x;
    if (placed.clamped) ++count;
  });
  clamped->count += count;
}

template Placed<2> put_inside_box<2>(const Grid<2>&, Vec<2>);
template Placed<3> put_inside_box<3>(const Grid<3>&, Vec<3>);
template struct Advect<2>;
template struct Advect<3>;

}  // namespace minamo
