#include "systems/transfer/apic.hpp"

#include "systems/transfer/node_affine.hpp"

namespace minamo {

template <int Dim>
void G2PVelocityApic<Dim>::operator()(Uses<NodesToParticles<Dim>> target, Read<node::NewVelocity<Dim>> v_i,
                                      Write<particle::Velocity<Dim>> v_p,
                                      Write<particle::VelocityGradient<Dim>> c_p) const {
  gather_with_affine<Dim>(target, v_i.span(),
                          [&](std::size_t, std::size_t p, const Jet<Dim>& v, const Mat<Dim>& beyond) {
                            v_p[p] = v.value;
                            c_p[p] = v.gradient + beyond;
                          });
}

template <int Dim>
void G2PAccelerationApic<Dim>::operator()(Uses<NodesToParticles<Dim>> target, Read<node::NewAcceleration<Dim>> a_i,
                                          Write<particle::Acceleration<Dim>> a_p,
                                          Write<particle::AccelerationGradient<Dim>> c_p) const {
  gather_with_affine<Dim>(target, a_i.span(),
                          [&](std::size_t, std::size_t p, const Jet<Dim>& a, const Mat<Dim>& beyond) {
                            a_p[p] = a.value;
                            c_p[p] = a.gradient + beyond;
                          });
}

template struct G2PVelocityApic<2>;
template struct G2PVelocityApic<3>;
template struct G2PAccelerationApic<2>;
template struct G2PAccelerationApic<3>;

}  // namespace minamo
