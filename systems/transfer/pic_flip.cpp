#include "systems/transfer/pic_flip.hpp"

#include "systems/transfer/node_gather.hpp"
#include "systems/transfer/node_scatter.hpp"

namespace minamo {

template <int Dim>
void P2GVelocityPic<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                     Read<particle::QuadraturePosition<Dim>> y_p, Read<particle::Mass> m_p,
                                     Read<particle::Velocity<Dim>> v_p, Read<node::Mass> m_i,
                                     Write<node::Velocity<Dim>> v_i) const {
  scatter_constant<Dim>({*grid, *cells, y_p.span(), m_p.span(), m_i.span()}, v_p.span(), v_i.span());
}

template <int Dim>
void P2GAccelerationPic<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                         Read<particle::QuadraturePosition<Dim>> y_p, Read<particle::Mass> m_p,
                                         Read<particle::Acceleration<Dim>> a_p, Read<node::Mass> m_i,
                                         Write<node::Acceleration<Dim>> a_i) const {
  scatter_constant<Dim>({*grid, *cells, y_p.span(), m_p.span(), m_i.span()}, a_p.span(), a_i.span());
}

template <int Dim>
void G2PVelocityPic<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                     Read<particle::QuadraturePosition<Dim>> y_p, Read<node::NewVelocity<Dim>> v_i,
                                     Write<particle::Velocity<Dim>> v_p) const {
  gather<Dim>(*grid, *cells, y_p.span(), v_i.span(), [&](std::size_t p, const Vec<Dim>& v) { v_p[p] = v; });
}

template <int Dim>
G2PVelocityFlip<Dim>::G2PVelocityFlip(Input& input) : blend(flip_blend(input)) {}

template <int Dim>
void G2PVelocityFlip<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                      Read<particle::QuadraturePosition<Dim>> y_p, Read<node::Velocity<Dim>> v_old,
                                      Read<node::NewVelocity<Dim>> v_new, Update<particle::Velocity<Dim>> v_p) const {
  const double alpha = blend;
  // alpha (v_p + S (v_new - v_old)) + (1 - alpha) S v_new = alpha v_p + S (v_new - alpha v_old).
  const auto increment = [&](std::size_t i) -> Vec<Dim> { return v_new[i] - alpha * v_old[i]; };
  gather<Dim>(*grid, *cells, y_p.span(), increment,
              [&](std::size_t p, const Vec<Dim>& dv) { v_p[p] = alpha * v_p[p] + dv; });
}

template <int Dim>
void G2PAccelerationPic<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                         Read<particle::QuadraturePosition<Dim>> y_p,
                                         Read<node::NewAcceleration<Dim>> a_i,
                                         Write<particle::Acceleration<Dim>> a_p) const {
  gather<Dim>(*grid, *cells, y_p.span(), a_i.span(), [&](std::size_t p, const Vec<Dim>& a) { a_p[p] = a; });
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
