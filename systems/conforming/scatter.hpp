#pragma once
/// \file
/// From particles to faces: mass, and the mass-weighted mean of what particles carry. A transfer scheme says what a
/// particle brings to a face.

#include "components/particle.hpp"
#include "systems/conforming/support.hpp"

#include <span>

namespace minamo {

/// What a scatter reads beside the quantity itself.
template <int Dim>
struct FaceSource {
  const Grid<Dim>& grid;
  const Splines<Dim>& splines;
  const OccupiedCells<Dim>& cells;
  const CellSites& sites;
  std::span<const Vec<Dim>> y_p;
  std::span<const double> m_p;
};

/// Sums at the sites of a cell, by direction.
template <int Dim, int K>
using FaceSums = std::array<std::array<double, cell_sites<Dim, K>>, static_cast<std::size_t>(Dim)>;

/// Calls add(p, frame, xi, weights, sums) for every particle, and adds the sums of every cell to `out`, `Count` columns
/// of faces, which are set to zero first.
template <int Dim, int K, std::size_t Count, class Add>
void scatter_sums(const FaceSource<Dim>& source, const std::array<std::span<Vec<Dim>>, Count>& out, const Add& add) {
  for (const std::span<Vec<Dim>> column : out) {
    for_each_row(column.size(), [&](std::size_t i) { column[i].setZero(); });
  }
  for_each_cell_coloured<Dim>(source.cells, [&](std::size_t c, const auto& cell) {
    const CellFrame<Dim> frame(source.grid, source.splines, cell.node);
    std::array<FaceSums<Dim, K>, Count> sums{};
    for (std::size_t p = cell.begin; p < cell.end; ++p) {
      const Vec<Dim> xi = frame.local(source.y_p[p]);
      add(p, frame, xi, SplineWeights<Dim, K>(frame, xi), sums);
    }
    const std::uint32_t* rows = source.sites.of(c);
    for (std::size_t q = 0; q < Count; ++q) {
      for (std::size_t k = 0; k < cell_sites<Dim, K>; ++k) {
        for (std::size_t d = 0; d < Dim; ++d) out[q][rows[k]][static_cast<Eigen::Index>(d)] += sums[q][d][k];
      }
    }
  });
}

/// Divides nodal sums by the mass; faces without mass get zero.
template <int Dim>
void divide_by_mass(std::span<const Vec<Dim>> m_f, std::span<Vec<Dim>> q_f) {
  for_each_row(q_f.size(), [&](std::size_t i) {
    for (int d = 0; d < Dim; ++d) {
      if (m_f[i][d] > 0) q_f[i][d] /= m_f[i][d];
    }
  });
}

/// m_f = sum_p N_f m_p and q_f = sum_p N_f m_p q_pf / m_f. value(p, frame, xi, weights) tells of a particle what it
/// brings: an object whose at<D>(offset) is q_pf for a face of direction D.
template <int Dim, int K, class Value>
void scatter_mean(const FaceSource<Dim>& source, std::span<Vec<Dim>> m_f, std::span<Vec<Dim>> q_f, const Value& value) {
  scatter_sums<Dim, K, 2>(source, {m_f, q_f},
                          [&](std::size_t p, const CellFrame<Dim>& frame, const Vec<Dim>& xi,
                              const SplineWeights<Dim, K>& weights, auto& sums) {
                            const auto of_particle = value(p, frame, xi, weights);
                            const double m = source.m_p[p];
                            for_each_direction<Dim>([&](auto d) {
                              constexpr int D = d();
                              for_each_face<Dim, K, D>([&](std::size_t k, const Index<Dim>& offset) {
                                const double share = m * weights.template face<D>(offset);
                                sums[0][D][k] += share;
                                sums[1][D][k] += share * of_particle.template at<D>(offset);
                              });
                            });
                          });
  divide_by_mass<Dim>(m_f, q_f);
}

/// The same where the mass is known: q_f = sum_p N_f m_p q_pf / m_f.
template <int Dim, int K, class Value>
void scatter_mean_of(const FaceSource<Dim>& source, std::span<const Vec<Dim>> m_f, std::span<Vec<Dim>> q_f,
                     const Value& value) {
  scatter_sums<Dim, K, 1>(source, {q_f},
                          [&](std::size_t p, const CellFrame<Dim>& frame, const Vec<Dim>& xi,
                              const SplineWeights<Dim, K>& weights, auto& sums) {
                            const auto of_particle = value(p, frame, xi, weights);
                            const double m = source.m_p[p];
                            for_each_direction<Dim>([&](auto d) {
                              constexpr int D = d();
                              for_each_face<Dim, K, D>([&](std::size_t k, const Index<Dim>& offset) {
                                sums[0][D][k] +=
                                    m * weights.template face<D>(offset) * of_particle.template at<D>(offset);
                              });
                            });
                          });
  divide_by_mass<Dim>(m_f, q_f);
}

/// A quantity that is constant around a particle.
template <int Dim>
struct ConstantAround {
  const Vec<Dim>& q;
  template <int D>
  [[gnu::always_inline]] double at(const Index<Dim>&) const {
    return q[D];
  }
};

/// The first two terms of a Taylor series around a particle, q + grad q (x_f - y), x_f the Greville points of the face:
/// exact for a quantity that is linear in space.
template <int Dim, int K>
struct TaylorAround {
  /// By direction of the face and axis: what the way along the axis adds.
  std::array<std::array<std::array<double, K + 1>, static_cast<std::size_t>(Dim)>, static_cast<std::size_t>(Dim)> way;

  TaylorAround(const CellFrame<Dim>& frame, const Vec<Dim>& xi, const Vec<Dim>& q, const Mat<Dim>& gradient) {
    for (int d = 0; d < Dim; ++d) {
      for (int e = 0; e < Dim; ++e) {
        const double per_width = frame.spacing * gradient(d, e);
        const double start = (e == 0 ? q[d] : 0) - per_width * xi[e];
        const CellSplines& of = *frame.splines[static_cast<std::size_t>(e)];
        const auto& place = d == e ? of.along_place : of.across_place;
        auto& along = way[static_cast<std::size_t>(d)][static_cast<std::size_t>(e)];
        for (std::size_t a = 0; a < K + 1; ++a) along[a] = start + per_width * place[a];
      }
    }
  }
  template <int D>
  [[gnu::always_inline]] double at(const Index<Dim>& offset) const {
    double sum = 0;
    for (std::size_t e = 0; e < Dim; ++e) sum += way[D][e][static_cast<std::size_t>(offset[e])];
    return sum;
  }
};

}  // namespace minamo
