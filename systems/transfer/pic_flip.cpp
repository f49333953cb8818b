#include "systems/transfer/pic_flip.hpp"

#include "systems/transfer/node_gather.hpp"
#include "systems/transfer/node_scatter.hpp"

namespace minamo {

template <int Dim>
void P2GVelocityPic<Dim>::operator()(Uses<ParticlesToNodes<Dim>> source, Read<particle::Velocity<Dim>> v_p,
                                     Write<node::Velocity<Dim>> v_i) const {
  scatter_constant<Dim>(source, v_p.span(), v_i.span());
}

template <int Dim>
void P2GAccelerationPic<Dim>::operator()(Uses<ParticlesToNodes<Dim>> source, Read<particle::Acceleration<Dim>> a_p,
                                         Write<node::Acceleration<Dim>> a_i) const {
  scatter_constant<Dim>(source, a_p.span(), a_i.span());
}

template <int Dim>
void G2PVelocityPic<Dim>::operator()(Uses<NodesToParticles<Dim>> target, Read<node::NewVelocity<Dim>> v_i,
                                     Write<particle::Velocity<Dim>> v_p) const {
  gather<Dim>(target, v_i.span(), [&](std::size_t p, const Vec<Dim>& v) { v_p[p] = v; });
}

template <int Dim>
G2PVelocityFlip<Dim>::G2PVelocityFlip(Input& input) : blend(flip_blend(input)) {}

template <int Dim>
void G2PVelocityFlip<Dim>::operator()(Uses<NodesToParticles<Dim>> target, Read<node::Velocity<Dim>> v_old,
                                      Read<node::NewVelocity<Dim>> v_new, Update<particle::Velocity<Dim>> v_p) const {
  const double alpha = blend;
  // alpha (v_p + S (v_new - v_old)) + (1 - alpha) S v_new = alpha v_p + S (v_new - alpha v_old).
  const auto increment = [&](std::size_t i) -> Vec<Dim> { return v_new[i] - alpha * v_old[i]; };
  gather<Dim>(target, increment, [&](std::size_t p, const Vec<Dim>& dv) { v_p[p] = alpha * v_p[p] + dv; });
}

template <int Dim>
void G2PAccelerationPic<Dim>::operator()(Uses<NodesToParticles<Dim>> target, Read<node::NewAcceleration<Dim>> a_i,
                                         Write<particle::Acceleration<Dim>> a_p) const {
  gather<Dim>(target, a_i.span(), [&](std::size_t p, const Vec<Dim>& a) { a_p[p] = a; });
}

template struct P2GVelocityPic<2>;
template struct P2GVelocityPic<3>;
template struct P2GAccelerationPic<2>;
template struct P2GAccelerationPic<3>;
template struct G2PVelocityPic<2>;
template struct G2PVelocityPic<3>;
template struct G2PVelocityFlip<2>;
template struct G2PVelocityFlip<3>;
template struct G2PAccelerationPic<2>;
template struct G2PAccelerationPic<3>;

}  // namespace minamo
