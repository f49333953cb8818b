#pragma once
/// \file
/// From faces to particles: value and derivatives of a velocity that faces carry.

#include "components/particle.hpp"
#include "systems/grid/lanes.hpp"
#include "systems/transfer/bundles.hpp"
#include "systems/transfer/face_polynomial.hpp"

#include <span>

namespace minamo {

/// q(y) = sum_f N_f(y) q_f and, with the slopes of the splines, its gradient, row i of component i.
template <int Dim>
struct FaceJet {
  Vec<Dim> value;     ///< q(y)
  Mat<Dim> gradient;  ///< row i of component i [1/m]
};

namespace detail {

/// Sums of a component over its faces, with weights and, along one axis at a time, other numbers in their place.
template <int Dim, class Real>
struct ComponentSums {
  Real value;
  std::array<Real, static_cast<std::size_t>(Dim)> other;
};

/// One axis after the other.
template <int Dim, int K, int D, class Real>
[[gnu::always_inline]] inline ComponentSums<Dim, Real> component_sums(const std::array<double, cell_sites<Dim, K>>& q,
                                                                      const SplineNumbers<Dim, K, Real>& weights,
                                                                      const SplineNumbers<Dim, K, Real>& others) {
  constexpr std::size_t stride = K + 1;
  const auto& wx = weights.template of<D, 0>();
  const auto& wy = weights.template of<D, 1>();
  const auto& sx = others.template of<D, 0>();
  const auto& sy = others.template of<D, 1>();
  const auto plane = [&](const double* of) {
    std::array<Real, 3> sum{};  // value, along x, along y
    for (std::size_t b = 0; b < wy.size(); ++b) {
      Real line{};
      Real slope{};
      for (std::size_t a = 0; a < wx.size(); ++a) {
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
    return {sum[0], {sum[1], sum[2]}};
  } else {
    const auto& wz = weights.template of<D, 2>();
    const auto& sz = others.template of<D, 2>();
    ComponentSums<Dim, Real> all{};
    for (std::size_t c = 0; c < wz.size(); ++c) {
      const auto sum = plane(q.data() + c * stride * stride);
      all.value += wz[c] * sum[0];
      all.other[0] += wz[c] * sum[1];
      all.other[1] += wz[c] * sum[2];
      all.other[2] += sz[c] * sum[0];
    }
    return all;
  }
}

}  // namespace detail

/// At one point of a cell.
template <int Dim, int K>
FaceJet<Dim> jet_at(const FaceCoefficients<Dim, K>& q, const SplineWeights<Dim, K>& weights,
                    const SplineSlopes<Dim, K>& slopes) {
  FaceJet<Dim> jet;
  for_each_direction<Dim>([&](auto d) {
    constexpr int D = d();
    const auto sums = detail::component_sums<Dim, K, D, double>(q[D], weights, slopes);
    jet.value[D] = sums.value;
    for (std::size_t e = 0; e < Dim; ++e) jet.gradient(D, static_cast<Eigen::Index>(e)) = sums.other[e];
  });
  return jet;
}

/// A column of faces as a function of the row.
template <int Dim>
auto of_faces(std::span<const Vec<Dim>> q_f) {
  return [q_f](std::size_t i) -> const Vec<Dim>& { return q_f[i]; };
}

/// (E17), (E18)  use(c, group, q, xi) for every group of particles, c its cell, q the polynomials of the cell and xi
/// where in it the particles are; at_face(row) is the vector of the faces of a site.
template <int Dim, class AtFace, class Use>
void for_each_group_in_faces(const FaceTarget<Dim>& target, const AtFace& at_face, const Use& use) {
  with_degree(target.splines.degree, [&](auto degree) {
    for_each_cell<Dim>(target.cells, [&](std::size_t c, const auto& cell) {
      const CellFrame<Dim> frame(target.grid, target.splines, cell.node);
      const FacePolynomials<Dim, degree()> q(frame, target.sites.of(c), at_face);
      for_each_group(cell, [&](const Group& group) { use(c, group, q, local<Dim>(frame, target.y_p, group)); });
    });
  });
}

/// use(c, p, jet of q at y_p) for every particle p, c its cell.
template <int Dim, class AtFace, class Use>
void gather_faces_by_cell(const FaceTarget<Dim>& target, const AtFace& at_face, const Use& use) {
  for_each_group_in_faces<Dim>(
      target, at_face, [&](std::size_t c, const Group& group, const auto& q, const LanePlace<Dim>& xi) {
        const LaneJet<Dim> jet(q, xi);
        for_each_lane(group, [&](std::size_t lane, std::size_t p) { use(c, p, jet.of(lane)); });
      });
}

/// use(p, jet of q at y_p) for every particle.
template <int Dim, class AtFace, class Use>
void gather_faces_with_gradient(const FaceTarget<Dim>& target, const AtFace& at_face, const Use& use) {
  gather_faces_by_cell<Dim>(target, at_face, [&](std::size_t, std::size_t p, const Jet<Dim>& q) { use(p, q); });
}

/// use(p, q(y_p)) for every particle. Not by way of the jet: its derivatives are computed, too, where `use` is not
/// inlined.
template <int Dim, class AtFace, class Use>
void gather_faces(const FaceTarget<Dim>& target, const AtFace& at_face, const Use& use) {
  for_each_group_in_faces<Dim>(
      target, at_face, [&](std::size_t, const Group& group, const auto& q, const LanePlace<Dim>& xi) {
        std::array<Four, static_cast<std::size_t>(Dim)> value;
        for_each_direction<Dim>([&](auto d) { value[d()] = q.template at<d(), Four>(xi).value; });
        for_each_lane(group, [&](std::size_t lane, std::size_t p) { use(p, in_lane(value, lane)); });
      });
}

}  // namespace minamo
