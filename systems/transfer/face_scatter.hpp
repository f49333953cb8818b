#pragma once
/// \file
/// From particles to faces: mass, and the mass-weighted mean of what particles carry. A transfer scheme says what a
/// particle brings, as a series around it.

#include "components/particle.hpp"
#include "systems/grid/lanes.hpp"
#include "systems/ranks/site_exchange.hpp"
#include "systems/transfer/bundles.hpp"
#include "systems/transfer/face_polynomial.hpp"
#include "systems/transfer/face_series.hpp"

#include <span>

namespace minamo {

namespace detail {

/// Sums at the faces of a cell, by direction, in the order of for_each_face().
template <int Dim, int K>
using LaneSums = std::array<std::array<Four, (K + 1) * power(K, Dim - 1)>, static_cast<std::size_t>(Dim)>;

/// Adds m N_f to the masses, if there are any, and m N_f q_f to the sums, for the faces of direction D.
template <int D, int Dim, int K, class Series>
[[gnu::always_inline]] inline void add_to_faces(const Four& m, const SplineWeights<Dim, K, Four>& weights,
                                                const LaneSeries<Dim, K, Series>& q, LaneSums<Dim, K>* mass,
                                                LaneSums<Dim, K>& sum) {
  const auto& wx = weights.template of<D, 0>();
  const auto& wy = weights.template of<D, 1>();
  const FaceSeries<D, Dim, K, Series> at(q);
  std::size_t k = 0;
  const auto row = [&](const Four& m_bc, const auto& of_row) {
    for (std::size_t a = 0; a < wx.size(); ++a) {
      const Four share = m_bc * wx[a];
      if (mass != nullptr) (*mass)[D][k] += share;
      sum[D][k] += share * of_row(a);
      ++k;
    }
  };
  if constexpr (Dim == 2) {
    for (std::size_t b = 0; b < wy.size(); ++b) row(m * wy[b], at.row(b));
  } else {
    const auto& wz = weights.template of<D, 2>();
    for (std::size_t c = 0; c < wz.size(); ++c) {
      const Four m_c = m * wz[c];
      for (std::size_t b = 0; b < wy.size(); ++b) row(m_c * wy[b], at.row(b, c));
    }
  }
}

/// Adds the sums of a cell to those of its faces.
template <int Dim, int K>
[[gnu::always_inline]] inline void add_lanes(const LaneSums<Dim, K>& sums, const std::uint32_t* rows,
                                             std::span<Vec<Dim>> out) {
  for_each_direction<Dim>([&](auto d) {
    constexpr int D = d();
    std::size_t i = 0;
    for_each_face<Dim, K, D>([&](std::size_t k, const Index<Dim>&) { out[rows[k]][D] += sum_of_lanes(sums[D][i++]); });
  });
}

/// Sums of m_p N_f q_pf, and into m_f, unless it is empty, those of m_p N_f.
template <int Dim, int K, class OfCell>
void scatter_sums(const FaceSource<Dim>& source, std::span<Vec<Dim>> m_f, std::span<Vec<Dim>> q_f,
                  const OfCell& of_cell) {
  for (const std::span<Vec<Dim>> column : {m_f, q_f}) {
    for_each_row(column.size(), [&](std::size_t i) { column[i].setZero(); });
  }
  for_each_cell_coloured<Dim>(source.cells, [&](std::size_t c, const auto& cell) {
    const CellFrame<Dim> frame(source.grid, source.splines, cell.node);
    const auto& of_particle = of_cell(c, frame, std::integral_constant<int, K>());
    LaneSums<Dim, K> mass{};
    LaneSums<Dim, K> sum{};
    for_each_group(cell, [&](const Group& group) {
      const LanePlace<Dim> xi = local<Dim>(frame, source.y_p, group);
      const SplineWeights<Dim, K, Four> weights(frame, xi);
      const Four m = unused_are_zero(group, of_group(group, [&](std::size_t p) { return source.m_p[p]; }));
      const std::array of_lanes{of_particle(group.particle(0)), of_particle(group.particle(1)),
                                of_particle(group.particle(2)), of_particle(group.particle(3))};
      const LaneSeries<Dim, K, std::decay_t<decltype(of_lanes[0])>> q(frame, xi, of_lanes);
      for_each_direction<Dim>([&](auto d) { add_to_faces<d()>(m, weights, q, m_f.empty() ? nullptr : &mass, sum); });
    });
    if (!m_f.empty()) add_lanes<Dim, K>(mass, source.sites.of(c), m_f);
    add_lanes<Dim, K>(sum, source.sites.of(c), q_f);
  });
  if (source.shared == nullptr) return;
  if (!m_f.empty()) source.shared->add_up(m_f);
  source.shared->add_up(q_f);
}

}  // namespace detail

/// Divides sums at faces by the mass; faces without mass get zero.
template <int Dim>
void divide_by_mass(std::span<const Vec<Dim>> m_f, std::span<Vec<Dim>> q_f) {
  for_each_row(q_f.size(), [&](std::size_t i) {
    for (int d = 0; d < Dim; ++d) {
      if (m_f[i][d] > 0) q_f[i][d] /= m_f[i][d];
    }
  });
}

/// m_f = sum_p N_f m_p and q_f = sum_p N_f m_p q_pf / m_f. of_particle(p) is the series that a particle brings, one of
/// series::Constant, Linear and Quadratic.
template <int Dim, class OfParticle>
void scatter_mean(const FaceSource<Dim>& source, std::span<Vec<Dim>> m_f, std::span<Vec<Dim>> q_f,
                  const OfParticle& of_particle) {
  with_degree(source.splines.degree, [&](auto degree) {
    detail::scatter_sums<Dim, degree()>(
        source, m_f, q_f, [&](std::size_t, const auto&, auto) -> const auto& { return of_particle; });
  });
  divide_by_mass<Dim>(m_f, q_f);
}

/// The same where the mass is known, and what a particle brings may depend on its cell: of_cell(c, frame, degree) is
/// of_particle for the particles of a cell.
template <int Dim, class OfCell>
void scatter_mean_by_cell(const FaceSource<Dim>& source, std::span<const Vec<Dim>> m_f, std::span<Vec<Dim>> q_f,
                          const OfCell& of_cell) {
  with_degree(source.splines.degree,
              [&](auto degree) { detail::scatter_sums<Dim, degree()>(source, {}, q_f, of_cell); });
  divide_by_mass<Dim>(m_f, q_f);
}

/// The same for what does not.
template <int Dim, class OfParticle>
void scatter_mean_of(const FaceSource<Dim>& source, std::span<const Vec<Dim>> m_f, std::span<Vec<Dim>> q_f,
                     const OfParticle& of_particle) {
  scatter_mean_by_cell<Dim>(
      source, m_f, q_f, [&](std::size_t, const auto&, auto) -> const auto& { return of_particle; });
}

}  // namespace minamo
