#include "systems/transfer/face_tpic2.hpp"

#include "systems/transfer/face_affine.hpp"
#include "systems/transfer/face_scatter.hpp"
#include "systems/transfer/tpic2.hpp"

namespace minamo {

template <int Dim>
void P2GFacesTpic2<Dim>::operator()(Uses<ParticlesToFaces<Dim>> source, Read<particle::Velocity<Dim>> v_p,
                                    Read<particle::VelocityGradient<Dim>> grad_v_p,
                                    Read<particle::VelocityCurvature<Dim>> h_p, Write<face::Mass<Dim>> m_f,
                                    Write<face::Velocity<Dim>> v_f) const {
  scatter_mean<Dim>(source, m_f.span(), v_f.span(), [&](std::size_t p) {
    return series::Quadratic<Dim>{v_p[p], grad_v_p[p], h_p[p]};
  });
}

template <int Dim>
G2PFacesTpic2<Dim>::G2PFacesTpic2(Input& in) : share(curvature_share(in)) {}

template <int Dim>
void G2PFacesTpic2<Dim>::operator()(Uses<FacesToParticles<Dim>> target, Read<cell::BulkIndicator> b_c,
                                    Read<face::NewVelocity<Dim>> v_f, Write<particle::Velocity<Dim>> v_p,
                                    Write<particle::VelocityGradient<Dim>> grad_v_p,
                                    Write<particle::VelocityCurvature<Dim>> h_p) const {
  const auto keep = [&](std::size_t c, std::size_t p, const Jet<Dim>& v) {
    const double kept = share * b_c[c] * resolved_curvature<Dim>(v.gradient, v.second, target.grid->spacing);
    v_p[p] = v.value;
    grad_v_p[p] = v.gradient;
    h_p[p] = kept * v.second;
    return kept;
  };
  if (has_spin_beyond(target.splines->degree)) {
    gather_faces_with_affine<Dim>(target, of_faces<Dim>(v_f.span()),
                                  [&](std::size_t c, std::size_t p, const Jet<Dim>& v, const Mat<Dim>& c_p) {
                                    const double kept = keep(c, p, v);
                                    grad_v_p[p] += (1 - kept) * spin_beyond<Dim>(c_p, v.gradient);
                                  });
  } else {
    gather_faces_by_cell<Dim>(target, of_faces<Dim>(v_f.span()), keep);
  }
}

template struct P2GFacesTpic2<2>;
template struct P2GFacesTpic2<3>;
template struct G2PFacesTpic2<2>;
template struct G2PFacesTpic2<3>;

}  // namespace minamo
