#include "systems/transfer/xpic.hpp"

#include "systems/transfer/filter_series.hpp"
#include "systems/transfer/node_gather.hpp"

namespace minamo {

template <int Dim>
void FilterVelocityXpic<Dim>::operator()(Uses<ParticlesToNodes<Dim>> source, Read<node::Constraint> constraint,
                                         Optional<Read<node::ConstraintFrame<Dim>>> frame,
                                         Read<node::Velocity<Dim>> v_i, Write<node::Residue<Dim>> residue,
                                         Write<node::Smoothed<Dim>> smoothed,
                                         Write<node::FilteredVelocity<Dim>> v_filtered) const {
  filter_series<Dim>(source, {constraint.span(), frame.span()}, order, v_i.span(), residue.span(), smoothed.span(),
                     v_filtered.span());
}

template <int Dim>
void G2PVelocityXpic<Dim>::operator()(Uses<NodesToParticles<Dim>> target, Read<node::FilteredVelocity<Dim>> v_filtered,
                                      Read<node::Velocity<Dim>> v_old, Read<node::NewVelocity<Dim>> v_new,
                                      Write<particle::Velocity<Dim>> v_p) const {
  const auto at_node = [&](std::size_t i) { return Vec<Dim>(v_filtered[i] + v_new[i] - v_old[i]); };
  gather<Dim>(target, at_node, [&](std::size_t p, const Vec<Dim>& v) { v_p[p] = v; });
}

template struct FilterVelocityXpic<2>;
template struct FilterVelocityXpic<3>;
template struct G2PVelocityXpic<2>;
template struct G2PVelocityXpic<3>;

}  // namespace minamo
