#pragma once
/// \file
/// From faces to particles: value and gradient of a velocity that faces carry.

#include "components/particle.hpp"
#include "systems/conforming/support.hpp"

#include <span>

namespace minamo {

/// Coefficients of the faces of a cell, by direction.
template <int Dim, int K>
using FaceCoefficients = std::array<std::array<double, cell_sites<Dim, K>>, static_cast<std::size_t>(Dim)>;

/// at_face(row) is the vector of the three faces of a site.
template <int Dim, int K, class AtFace>
[[gnu::always_inline]] inline FaceCoefficients<Dim, K> coefficients(const std::uint32_t* rows, const AtFace& at_face) {
  FaceCoefficients<Dim, K> q;
  for (std::size_t k = 0; k < cell_sites<Dim, K>; ++k) {
    const Vec<Dim> of_site = at_face(rows[k]);
    for (std::size_t d = 0; d < Dim; ++d) q[d][k] = of_site[static_cast<Eigen::Index>(d)];
  }
  return q;
}

/// q(y) = sum_f N_f(y) q_f.
template <int Dim, int K>
[[gnu::always_inline]] inline Vec<Dim> value_at(const FaceCoefficients<Dim, K>& q,
                                                const SplineWeights<Dim, K>& weights) {
  Vec<Dim> value;
  for_each_direction<Dim>([&](auto d) {
    constexpr int D = d();
    double sum = 0;
    for_each_face<Dim, K, D>(
        [&](std::size_t k, const Index<Dim>& offset) { sum += weights.template face<D>(offset) * q[D][k]; });
    value[D] = sum;
  });
  return value;
}

namespace detail {

/// Value and derivatives of component D, one axis after the other.
template <int Dim, int K, int D>
[[gnu::always_inline]] inline void component_jet(const std::array<double, cell_sites<Dim, K>>& q,
                                                 const SplineWeights<Dim, K>& w, const SplineSlopes<Dim, K>& s,
                                                 Vec<Dim>& value, Mat<Dim>& gradient) {
  constexpr std::size_t n[] = {D == 0 ? K + 1 : K, D == 1 ? K + 1 : K, D == 2 ? K + 1 : K};
  constexpr std::size_t stride = K + 1;
  const double* wx = D == 0 ? w.along[0].data() : w.across[0].data();
  const double* wy = D == 1 ? w.along[1].data() : w.across[1].data();
  const double* sx = D == 0 ? s.along[0].data() : s.across[0].data();
  const double* sy = D == 1 ? s.along[1].data() : s.across[1].data();
  const auto plane = [&](const double* of) {
    std::array<double, 3> sum{};  // value, d/dx, d/dy
    for (std::size_t b = 0; b < n[1]; ++b) {
      double line = 0;
      double slope = 0;
      for (std::size_t a = 0; a < n[0]; ++a) {
        line += wx[a] * of[b * stride + a];
        slope += sx[a] * of[b * stride + a];
      }
      sum[0] += wy[b] * line;
      sum[1] += wy[b] * slope;
      sum[2] += sy[b] * line;
    }
    return sum;
  };
  if constexpr (Dim == 2) {
    const auto sum = plane(q.data());
    value[D] = sum[0];
    gradient(D, 0) = sum[1];
    gradient(D, 1) = sum[2];
  } else {
    const double* wz = D == 2 ? w.along[2].data() : w.across[2].data();
    const double* sz = D == 2 ? s.along[2].data() : s.across[2].data();
    value[D] = 0;
    gradient.row(D).setZero();
    for (std::size_t c = 0; c < n[2]; ++c) {
      const auto sum = plane(q.data() + c * stride * stride);
      value[D] += wz[c] * sum[0];
      gradient(D, 0) += wz[c] * sum[1];
      gradient(D, 1) += wz[c] * sum[2];
      gradient(D, 2) += sz[c] * sum[0];
    }
  }
}

}  // namespace detail

/// Value and gradient (row i of component i) at a point.
template <int Dim>
struct FaceJet {
  Vec<Dim> value;
  Mat<Dim> gradient;
};

template <int Dim, int K>
[[gnu::always_inline]] inline FaceJet<Dim>
jet_at(const FaceCoefficients<Dim, K>& q, const SplineWeights<Dim, K>& weights, const SplineSlopes<Dim, K>& slopes) {
  FaceJet<Dim> jet;
  for_each_direction<Dim>([&](auto d) {
    constexpr int D = d();
    detail::component_jet<Dim, K, D>(q[D], weights, slopes, jet.value, jet.gradient);
  });
  return jet;
}

/// What a gather reads beside the field.
template <int Dim>
struct FaceTarget {
  const Grid<Dim>& grid;
  const Splines<Dim>& splines;
  const OccupiedCells<Dim>& cells;
  const CellSites& sites;
  std::span<const Vec<Dim>> y_p;
};

/// use(p, q(y_p)) for every particle.
template <int Dim, class AtFace, class Use>
void gather_faces(const FaceTarget<Dim>& target, const AtFace& at_face, const Use& use) {
  with_degree(target.splines.degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_cell<Dim>(target.cells, [&](std::size_t c, const auto& cell) {
      const CellFrame<Dim> frame(target.grid, target.splines, cell.node);
      const auto q = coefficients<Dim, K>(target.sites.of(c), at_face);
      for (std::size_t p = cell.begin; p < cell.end; ++p) {
        const SplineWeights<Dim, K> weights(frame, frame.local(target.y_p[p]));
        use(p, value_at<Dim, K>(q, weights));
      }
    });
  });
}

/// use(p, jet of q at y_p) for every particle.
template <int Dim, class AtFace, class Use>
void gather_faces_with_gradient(const FaceTarget<Dim>& target, const AtFace& at_face, const Use& use) {
  with_degree(target.splines.degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_cell<Dim>(target.cells, [&](std::size_t c, const auto& cell) {
      const CellFrame<Dim> frame(target.grid, target.splines, cell.node);
      const auto q = coefficients<Dim, K>(target.sites.of(c), at_face);
      for (std::size_t p = cell.begin; p < cell.end; ++p) {
        const Vec<Dim> xi = frame.local(target.y_p[p]);
        use(p, jet_at<Dim, K>(q, SplineWeights<Dim, K>(frame, xi), SplineSlopes<Dim, K>(frame, xi)));
      }
    });
  });
}

}  // namespace minamo
