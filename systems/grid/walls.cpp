#include "systems/grid/walls.hpp"

#include "engine/parallel.hpp"

namespace minamo {

template <int Dim>
void HoldVelocityAtWalls<Dim>::operator()(Read<node::Fixed> fixed, Update<node::Velocity<Dim>> v_i) const {
  for_each_row(v_i.size(), [&](std::size_t i) { hold<Dim>(fixed[i], v_i[i]); });
}

template <int Dim>
void HoldAccelerationAtWalls<Dim>::operator()(Read<node::Fixed> fixed, Update<node::Acceleration<Dim>> a_i) const {
  for_each_row(a_i.size(), [&](std::size_t i) { hold<Dim>(fixed[i], a_i[i]); });
}

template struct HoldVelocityAtWalls<2>;
template struct HoldVelocityAtWalls<3>;
template struct HoldAccelerationAtWalls<2>;
template struct HoldAccelerationAtWalls<3>;

}  // namespace minamo
