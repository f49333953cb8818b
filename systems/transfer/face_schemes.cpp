#include "systems/transfer/face_schemes.hpp"

#include "systems/transfer/advect.hpp"
#include "systems/transfer/face_affine.hpp"
#include "systems/transfer/face_gather.hpp"
#include "systems/transfer/face_scatter.hpp"
#include "systems/transfer/pic_flip.hpp"
#include "systems/transfer/tpic.hpp"

#include <atomic>

namespace minamo {

template <int Dim>
void P2GFacesPic<Dim>::operator()(Uses<ParticlesToFaces<Dim>> source, Read<particle::Velocity<Dim>> v_p,
                                  Write<face::Mass<Dim>> m_f, Write<face::Velocity<Dim>> v_f) const {
  scatter_mean<Dim>(source, m_f.span(), v_f.span(), [&](std::size_t p) { return series::Constant<Dim>{v_p[p]}; });
}

template <int Dim>
void P2GFacesTpic<Dim>::operator()(Uses<ParticlesToFaces<Dim>> source, Read<particle::Velocity<Dim>> v_p,
                                   Read<particle::VelocityGradient<Dim>> grad_v_p, Write<face::Mass<Dim>> m_f,
                                   Write<face::Velocity<Dim>> v_f) const {
  scatter_mean<Dim>(source, m_f.span(), v_f.span(), [&](std::size_t p) {
    return series::Linear<Dim>{v_p[p], grad_v_p[p]};
  });
}

template <int Dim>
void G2PFacesPic<Dim>::operator()(Uses<FacesToParticles<Dim>> target, Read<face::NewVelocity<Dim>> v_f,
                                  Write<particle::Velocity<Dim>> v_p) const {
  gather_faces<Dim>(target, of_faces<Dim>(v_f.span()), [&](std::size_t p, const Vec<Dim>& v) { v_p[p] = v; });
}

template <int Dim>
G2PFacesFlip<Dim>::G2PFacesFlip(Input& input) : blend(flip_blend(input)) {}

template <int Dim>
void G2PFacesFlip<Dim>::operator()(Uses<FacesToParticles<Dim>> target, Read<face::Velocity<Dim>> v_old,
                                   Read<face::NewVelocity<Dim>> v_new, Update<particle::Velocity<Dim>> v_p) const {
  const double alpha = blend;
  const auto increment = [&](std::size_t i) -> Vec<Dim> { return v_new[i] - alpha * v_old[i]; };
  gather_faces<Dim>(target, increment, [&](std::size_t p, const Vec<Dim>& dv) { v_p[p] = alpha * v_p[p] + dv; });
}

template <int Dim>
G2PFacesTpic<Dim>::G2PFacesTpic(Input& in) : conserves_spin(is_spin_conserved(in)) {}

template <int Dim>
void G2PFacesTpic<Dim>::operator()(Uses<FacesToParticles<Dim>> target, Read<face::NewVelocity<Dim>> v_f,
                                   Write<particle::Velocity<Dim>> v_p,
                                   Write<particle::VelocityGradient<Dim>> grad_v_p) const {
  if (conserves_spin && has_spin_beyond(target.splines->degree)) {
    gather_faces_with_affine<Dim>(target, of_faces<Dim>(v_f.span()),
                                  [&](std::size_t, std::size_t p, const Jet<Dim>& v, const Mat<Dim>& c_p) {
                                    v_p[p] = v.value;
                                    grad_v_p[p] = v.gradient + spin_beyond<Dim>(c_p, v.gradient);
                                  });
  } else {
    gather_faces_with_gradient<Dim>(target, of_faces<Dim>(v_f.span()), [&](std::size_t p, const Jet<Dim>& v) {
      v_p[p] = v.value;
      grad_v_p[p] = v.gradient;
    });
  }
}

template <int Dim>
void G2PFacesApic<Dim>::operator()(Uses<FacesToParticles<Dim>> target, Read<face::NewVelocity<Dim>> v_f,
                                   Write<particle::Velocity<Dim>> v_p,
                                   Write<particle::VelocityGradient<Dim>> c_p) const {
  gather_faces_with_affine<Dim>(target, of_faces<Dim>(v_f.span()),
                                [&](std::size_t, std::size_t p, const Jet<Dim>& v, const Mat<Dim>& c) {
                                  v_p[p] = v.value;
                                  c_p[p] = c;
                                });
}

template <int Dim>
void P2GFaceAccelerationPic<Dim>::operator()(Uses<ParticlesToFaces<Dim>> source, Read<particle::Acceleration<Dim>> a_p,
                                             Read<face::Mass<Dim>> m_f, Write<face::Acceleration<Dim>> a_f) const {
  scatter_mean_of<Dim>(source, m_f.span(), a_f.span(), [&](std::size_t p) { return series::Constant<Dim>{a_p[p]}; });
}

template <int Dim>
void P2GFaceAccelerationTpic<Dim>::operator()(Uses<ParticlesToFaces<Dim>> source, Read<particle::Acceleration<Dim>> a_p,
                                              Read<particle::AccelerationGradient<Dim>> grad_a_p,
                                              Read<face::Mass<Dim>> m_f, Write<face::Acceleration<Dim>> a_f) const {
  scatter_mean_of<Dim>(source, m_f.span(), a_f.span(), [&](std::size_t p) {
    return series::Linear<Dim>{a_p[p], grad_a_p[p]};
  });
}

template <int Dim>
void G2PFaceAccelerationPic<Dim>::operator()(Uses<FacesToParticles<Dim>> target, Read<face::NewAcceleration<Dim>> a_f,
                                             Write<particle::Acceleration<Dim>> a_p) const {
  gather_faces<Dim>(target, of_faces<Dim>(a_f.span()), [&](std::size_t p, const Vec<Dim>& a) { a_p[p] = a; });
}

template <int Dim>
void G2PFaceAccelerationTpic<Dim>::operator()(Uses<FacesToParticles<Dim>> target, Read<face::NewAcceleration<Dim>> a_f,
                                              Write<particle::Acceleration<Dim>> a_p,
                                              Write<particle::AccelerationGradient<Dim>> grad_a_p) const {
  gather_faces_with_gradient<Dim>(target, of_faces<Dim>(a_f.span()), [&](std::size_t p, const Jet<Dim>& a) {
    a_p[p] = a.value;
    grad_a_p[p] = a.gradient;
  });
}

template <int Dim>
void G2PFaceAccelerationApic<Dim>::operator()(Uses<FacesToParticles<Dim>> target, Read<face::NewAcceleration<Dim>> a_f,
                                              Write<particle::Acceleration<Dim>> a_p,
                                              Write<particle::AccelerationGradient<Dim>> c_p) const {
  gather_faces_with_affine<Dim>(target, of_faces<Dim>(a_f.span()),
                                [&](std::size_t, std::size_t p, const Jet<Dim>& a, const Mat<Dim>& c) {
                                  a_p[p] = a.value;
                                  c_p[p] = c;
                                });
}

template <int Dim>
void AdvectByFaces<Dim>::operator()(Uses<FacesToParticles<Dim>> target, Read<face::Displacement<Dim>> u_f,
                                    Optional<Read<OpeningSet<Dim>>> openings, Update<particle::Position<Dim>> x_p,
                                    Update<Clamped> clamped) const {
  std::atomic<std::int64_t> count = 0;
  gather_faces<Dim>(target, of_faces<Dim>(u_f.span()), [&](std::size_t p, const Vec<Dim>& u) {
    const Placed<Dim> placed = openings ? inside_or_out<Dim>(*openings, *target.grid, *target.splines, x_p[p] + u)
                                        : inside_box<Dim>(*target.grid, x_p[p] + u);
    x_p[p] = placed.x;
    if (placed.clamped) ++count;
  });
  clamped->count += count;
}

template struct P2GFacesPic<2>;
template struct P2GFacesPic<3>;
template struct P2GFacesTpic<2>;
template struct P2GFacesTpic<3>;
template struct G2PFacesPic<2>;
template struct G2PFacesPic<3>;
template struct G2PFacesFlip<2>;
template struct G2PFacesFlip<3>;
template struct G2PFacesTpic<2>;
template struct G2PFacesTpic<3>;
template struct G2PFacesApic<2>;
template struct G2PFacesApic<3>;
template struct P2GFaceAccelerationPic<2>;
template struct P2GFaceAccelerationPic<3>;
template struct P2GFaceAccelerationTpic<2>;
template struct P2GFaceAccelerationTpic<3>;
template struct G2PFaceAccelerationPic<2>;
template struct G2PFaceAccelerationPic<3>;
template struct G2PFaceAccelerationTpic<2>;
template struct G2PFaceAccelerationTpic<3>;
template struct G2PFaceAccelerationApic<2>;
template struct G2PFaceAccelerationApic<3>;
template struct AdvectByFaces<2>;
template struct AdvectByFaces<3>;

}  // namespace minamo
