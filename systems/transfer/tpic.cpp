#include "systems/transfer/tpic.hpp"

#include "systems/transfer/node_affine.hpp"
#include "systems/transfer/node_gather.hpp"
#include "systems/transfer/node_scatter.hpp"

namespace minamo {

template <int Dim>
void P2GVelocityTpic<Dim>::operator()(Uses<ParticlesToNodes<Dim>> source, Read<particle::Velocity<Dim>> v_p,
                                      Read<particle::VelocityGradient<Dim>> grad_v_p,
                                      Write<node::Velocity<Dim>> v_i) const {
  scatter_taylor<Dim>(source, v_p.span(), grad_v_p.span(), v_i.span());
}

template <int Dim>
void P2GAccelerationTpic<Dim>::operator()(Uses<ParticlesToNodes<Dim>> source, Read<particle::Acceleration<Dim>> a_p,
                                          Read<particle::AccelerationGradient<Dim>> grad_a_p,
                                          Write<node::Acceleration<Dim>> a_i) const {
  scatter_taylor<Dim>(source, a_p.span(), grad_a_p.span(), a_i.span());
}

template <int Dim>
G2PVelocityTpic<Dim>::G2PVelocityTpic(Input& in) : conserves_spin(is_spin_conserved(in)) {}

template <int Dim>
void G2PVelocityTpic<Dim>::operator()(Uses<NodesToParticles<Dim>> target, Read<node::NewVelocity<Dim>> v_i,
                                      Write<particle::Velocity<Dim>> v_p,
                                      Write<particle::VelocityGradient<Dim>> grad_v_p) const {
  if (!conserves_spin) {
    gather_with_gradient<Dim>(target, v_i.span(), [&](std::size_t p, const Jet<Dim>& v) {
      v_p[p] = v.value;
      grad_v_p[p] = v.gradient;
    });
    return;
  }
  gather_with_affine<Dim>(target, v_i.span(),
                          [&](std::size_t, std::size_t p, const Jet<Dim>& v, const Mat<Dim>& beyond) {
                            v_p[p] = v.value;
                            grad_v_p[p] = v.gradient + antisymmetric<Dim>(beyond);
                          });
}

template <int Dim>
void G2PAccelerationTpic<Dim>::operator()(Uses<NodesToParticles<Dim>> target, Read<node::NewAcceleration<Dim>> a_i,
                                          Write<particle::Acceleration<Dim>> a_p,
                                          Write<particle::AccelerationGradient<Dim>> grad_a_p) const {
  gather_with_gradient<Dim>(target, a_i.span(), [&](std::size_t p, const Jet<Dim>& a) {
    a_p[p] = a.value;
    grad_a_p[p] = a.gradient;
  });
}

template struct P2GVelocityTpic<2>;
template struct P2GVelocityTpic<3>;
template struct P2GAccelerationTpic<2>;
template struct P2GAccelerationTpic<3>;
template struct G2PVelocityTpic<2>;
template struct G2PVelocityTpic<3>;
template struct G2PAccelerationTpic<2>;
template struct G2PAccelerationTpic<3>;

}  // namespace minamo
