#include "systems/equal_order/limit_shift.hpp"

#include "engine/schedule/parallel.hpp"
#include "systems/measure/conservation.hpp"

#include <algorithm>
#include <functional>

namespace minamo {

namespace {

template <class Value>
double sum_rows(std::size_t rows, const Value& value) {
  return reduce_rows(rows, 0.0, value, std::plus<>());
}

}  // namespace

template <int Dim>
void StoreKineticEnergy<Dim>::operator()(Read<particle::Mass> m_p, Read<particle::Velocity<Dim>> v_p,
                                         Write<EnergyBefore> before) const {
  before->kinetic = kinetic_energy<Dim>(m_p.span(), v_p.span());
}

template <int Dim>
void LimitShift<Dim>::operator()(Read<Fluid> fluid, Read<EnergyBefore> before, Read<particle::Mass> m_p,
                                 Read<particle::Velocity<Dim>> v_p, Read<node::Mass> m_i,
                                 Read<node::BodyForce<Dim>> b_i, Read<node::Displacement<Dim>> u_i,
                                 Read<node::Site<Dim>> sites, Read<AdvectedNodeIndex<Dim>> end_rows,
                                 Read<advected_node::Volume> end_v_i, Update<node::Shift<Dim>> d_i) const {
  const double lifted = -sum_rows(d_i.size(), [&](std::size_t i) {
    const auto end = d_i[i].isZero(0) ? std::nullopt : end_rows->find(sites[i]);
    return end ? fluid->density * end_v_i[*end] * b_i[i].dot(d_i[i]) : 0.0;
  });
  if (lifted <= 0) return;
  const double work = sum_rows(u_i.size(), [&](std::size_t i) { return m_i[i] * b_i[i].dot(u_i[i]); });
  const double lost = work - (kinetic_energy<Dim>(m_p.span(), v_p.span()) - before->kinetic);
  const double share = std::clamp(lost / lifted, 0.0, 1.0);
  for_each_row(d_i.size(), [&](std::size_t i) { d_i[i] *= share; });
}

template struct StoreKineticEnergy<2>;
template struct StoreKineticEnergy<3>;
template struct LimitShift<2>;
template struct LimitShift<3>;

}  // namespace minamo
