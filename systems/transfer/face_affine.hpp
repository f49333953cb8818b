#pragma once
/// \file
/// APIC's affine part of a velocity that faces carry, (E45) component by component.

#include "systems/transfer/face_gather.hpp"

namespace minamo {

/// N_f (x_f - y)_a / D_aa of the splines of a cell, D = sum_f N_f (x_f - y) (x) (x_f - y), which is diagonal. Where it
/// vanishes, in the point of a face, the derivatives of the splines are in its place.
template <int Dim, int K, class Real>
struct AffineSlopes : SplineNumbers<Dim, K, Real> {
  template <class Place>
  AffineSlopes(const CellFrame<Dim>& frame, const Place& xi, const SplineWeights<Dim, K, Real>& weights,
               const SplineSlopes<Dim, K, Real>& slopes) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const Real x = coordinate(xi, d);
      const CellSplines& of = *frame.splines[d];
      find(x, frame.per_spacing, of.along_place, weights.along[d], slopes.along[d], this->along[d]);
      find(x, frame.per_spacing, of.across_place, weights.across[d], slopes.across[d], this->across[d]);
    }
  }

 private:
  template <class Numbers>
  [[gnu::always_inline]] static void find(const Real& x, double per_spacing,
                                          const std::array<double, CellSplines::most>& place, const Numbers& weight,
                                          const Numbers& slope, Numbers& affine) {
    Real spread{};
    for (std::size_t a = 0; a < weight.size(); ++a) {
      affine[a] = weight[a] * (place[a] - x);
      spread += affine[a] * (place[a] - x);
    }
    constexpr double in_a_point = 1e-9;
    const Real scale = per_spacing / (spread > in_a_point ? spread : Real{} + 1.0);
    for (std::size_t a = 0; a < weight.size(); ++a) {
      affine[a] = spread > in_a_point ? affine[a] * scale : slope[a];
    }
  }
};

/// (E17), (E45)  use(c, p, jet of q at y_p, C_p) for every particle p, c its cell. Row d of C_p is
/// D^-1 sum_f N_f q_f (x_f - y) over the faces of direction d.
template <int Dim, class AtFace, class Use>
void gather_faces_with_affine(const FaceTarget<Dim>& target, const AtFace& at_face, const Use& use) {
  with_degree(target.splines.degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_cell<Dim>(target.cells, [&](std::size_t c, const auto& cell) {
      const CellFrame<Dim> frame(target.grid, target.splines, cell.node);
      const auto q = coefficients<Dim, K>(target.sites.of(c), at_face);
      const FacePolynomials<Dim, K> polynomials(frame, q);
      for_each_group(cell, [&](const Group& group) {
        const LanePlace<Dim> xi = local<Dim>(frame, target.y_p, group);
        const LaneJet<Dim> jet(polynomials, xi);
        const SplineWeights<Dim, K, Four> weights(frame, xi);
        const AffineSlopes<Dim, K, Four> affine(frame, xi, weights, SplineSlopes<Dim, K, Four>(frame, xi));
        std::array<std::array<Four, static_cast<std::size_t>(Dim)>, static_cast<std::size_t>(Dim)> lane_c;
        for_each_direction<Dim>(
            [&](auto d) { lane_c[d()] = detail::component_sums<Dim, K, d(), Four>(q[d()], weights, affine).other; });
        for_each_lane(group, [&](std::size_t lane, std::size_t p) {
          Mat<Dim> c_p;
          for (std::size_t d = 0; d < Dim; ++d) {
            for (std::size_t e = 0; e < Dim; ++e) {
              c_p(static_cast<Eigen::Index>(d), static_cast<Eigen::Index>(e)) = lane_c[d][e][lane];
            }
          }
          use(c, p, jet.of(lane), c_p);
        });
      });
    });
  });
}

/// What APIC's affine part has of spin in addition to that of the gradient.
template <int Dim>
[[gnu::always_inline]] inline Mat<Dim> spin_beyond(const Mat<Dim>& c_p, const Mat<Dim>& gradient) {
  const Mat<Dim> beyond = c_p - gradient;
  return 0.5 * (beyond - beyond.transpose());
}

/// Whether there is any: with hats across, the derivatives across are those of APIC already.
inline bool has_spin_beyond(int degree) { return degree > 2; }

}  // namespace minamo
