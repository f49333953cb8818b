#pragma once
/// \file
/// APIC's affine part of a velocity that faces carry, (E45) component by component.

#include "systems/conforming/gather.hpp"

namespace minamo {

/// C_p: row d is D^-1 sum_f N_f q_f (x_f - y) over the faces of direction d, D = sum_f N_f (x_f - y) (x) (x_f - y),
/// which is diagonal. Where D vanishes, in the point of a face, it is the gradient.
template <int Dim, int K>
[[gnu::always_inline]] inline Mat<Dim> affine_at(const FaceCoefficients<Dim, K>& q, const CellFrame<Dim>& frame,
                                                 const Vec<Dim>& xi, const SplineWeights<Dim, K>& weights,
                                                 const Mat<Dim>& gradient) {
  Mat<Dim> c = gradient;
  for_each_direction<Dim>([&](auto d) {
    constexpr int D = d();
    Vec<Dim> moment = Vec<Dim>::Zero();
    for_each_face<Dim, K, D>([&](std::size_t k, const Index<Dim>& offset) {
      const double share = weights.template face<D>(offset) * q[D][k];
      for (int e = 0; e < Dim; ++e) {
        moment[e] += share * (frame.template face_place<D>(e, offset[static_cast<std::size_t>(e)]) - xi[e]);
      }
    });
    for (int e = 0; e < Dim; ++e) {
      double spread = 0;
      for (int a = 0; a < (e == D ? K + 1 : K); ++a) {
        const double away = frame.template face_place<D>(e, a) - xi[e];
        spread += weights.template factor<D>(e, a) * away * away;
      }
      constexpr double in_a_point = 1e-9;
      if (spread > in_a_point) c(D, e) = moment[e] / spread * frame.per_spacing;
    }
  });
  return c;
}

/// use(p, jet of q at y_p, C_p) for every particle.
template <int Dim, class AtFace, class Use>
void gather_faces_with_affine(const FaceTarget<Dim>& target, const AtFace& at_face, const Use& use) {
  with_degree(target.splines.degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_cell<Dim>(target.cells, [&](std::size_t c, const auto& cell) {
      const CellFrame<Dim> frame(target.grid, target.splines, cell.node);
      const auto q = coefficients<Dim, K>(target.sites.of(c), at_face);
      for (std::size_t p = cell.begin; p < cell.end; ++p) {
        const Vec<Dim> xi = frame.local(target.y_p[p]);
        const SplineWeights<Dim, K> weights(frame, xi);
        const FaceJet<Dim> jet = jet_at<Dim, K>(q, weights, SplineSlopes<Dim, K>(frame, xi));
        use(p, jet, affine_at<Dim, K>(q, frame, xi, weights, jet.gradient));
      }
    });
  });
}

}  // namespace minamo
