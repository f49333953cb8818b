#include "systems/transfer/tpic2.hpp"

#include "systems/transfer/gather.hpp"
#include "systems/transfer/scatter.hpp"

namespace minamo {

namespace {

using AxisValues = std::array<double, 3>;

/// use(column, a, b) for the columns of a curvature.
template <int Dim, class Use>
void for_each_pair(const Use& use) {
  std::size_t column = 0;
  for (std::size_t a = 0; a < Dim; ++a) {
    for (std::size_t b = a; b < Dim; ++b) use(column++, a, b);
  }
}

/// Of an axis, for its three nodes: the way to the node, and half its square beyond the mean of that.
struct Way {
  AxisValues way;     ///< [m]
  AxisValues square;  ///< [m^2]
};

template <int Dim>
std::array<Way, Dim> ways_from(const Vec<Dim>& y, const Support<Dim>& support, const Weights<Dim>& weights, double h) {
  std::array<Way, Dim> ways;
  for (std::size_t d = 0; d < Dim; ++d) {
    auto& [way, square] = ways[d];
    const auto axis = static_cast<Eigen::Index>(d);
    double mean = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      way[k] = support.corner[axis] - y[axis] + h * static_cast<double>(k);
      mean += weights.value[d][k] * way[k] * way[k];
    }
    for (std::size_t k = 0; k < 3; ++k) square[k] = 0.5 * (way[k] * way[k] - mean);
  }
  return ways;
}

/// Value, gradient and second derivatives of a nodal field at a particle.
template <int Dim>
struct Curved {
  Vec<Dim> value = Vec<Dim>::Zero();
  Mat<Dim> gradient = Mat<Dim>::Zero();
  typename particle::VelocityCurvature<Dim>::value_type curvature =
      particle::VelocityCurvature<Dim>::value_type::Zero();
};

/// The second derivatives of the weights of an axis: constant within a dual cell.
template <int Dim>
std::array<AxisValues, Dim> second_derivatives(const Support<Dim>& support) {
  std::array<AxisValues, Dim> second;
  for (std::size_t d = 0; d < Dim; ++d) {
    for (std::size_t k = 0; k < 3; ++k) {
      second[d][k] = support.basis[d]->slope[k][1] * support.per_spacing * support.per_spacing;
    }
  }
  return second;
}

/// Direction by direction, as interpolate().
template <int Dim>
Curved<Dim> interpolate_curved(const Weights<Dim>& weights, const std::array<AxisValues, Dim>& second,
                               const std::array<Vec<Dim>, support_size<Dim>>& q) {
  const auto& [w, s] = weights;
  Curved<Dim> sum;
  for (std::size_t c = 0; c < (Dim == 3 ? 3 : 1); ++c) {
    const Vec<Dim> zero = Vec<Dim>::Zero();
    Vec<Dim> value = zero, x = zero, y = zero, xx = zero, xy = zero, yy = zero;
    for (std::size_t b = 0; b < 3; ++b) {
      const Vec<Dim>* row = q.data() + 9 * c + 3 * b;
      const auto along_row = [row](const AxisValues& of) -> Vec<Dim> {
        return of[0] * row[0] + of[1] * row[1] + of[2] * row[2];
      };
      const Vec<Dim> of_row = along_row(w[0]);
      const Vec<Dim> slope = along_row(s[0]);
      value += w[1][b] * of_row;
      x += w[1][b] * slope;
      y += s[1][b] * of_row;
      xx += w[1][b] * along_row(second[0]);
      xy += s[1][b] * slope;
      yy += second[1][b] * of_row;
    }
    if constexpr (Dim == 2) {
      sum.value = value;
      sum.gradient << x, y;
      sum.curvature << xx, xy, yy;
    } else {
      Mat<3> gradient;
      gradient << w[2][c] * x, w[2][c] * y, s[2][c] * value;
      sum.value += w[2][c] * value;
      sum.gradient += gradient;
      Eigen::Matrix<double, 3, 6> curvature;
      curvature << w[2][c] * xx, w[2][c] * xy, s[2][c] * x, w[2][c] * yy, s[2][c] * y, second[2][c] * value;
      sum.curvature += curvature;
    }
  }
  return sum;
}

}  // namespace

template <int Dim>
void P2GVelocityTpic2<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                       Read<particle::Configuration<Dim>> y_p, Read<particle::Mass> m_p,
                                       Read<particle::Velocity<Dim>> v_p,
                                       Read<particle::VelocityGradient<Dim>> grad_v_p,
                                       Read<particle::VelocityCurvature<Dim>> h_p, Read<node::Mass> m_i,
                                       Write<node::Velocity<Dim>> v_i) const {
  const auto add = [&](std::size_t p, const Support<Dim>& support, const Weights<Dim>& weights, auto& sum) {
    const auto ways = ways_from<Dim>(y_p[p], support, weights, grid->spacing);
    for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) {
      const auto at = [&](std::size_t d) { return static_cast<std::size_t>(offset[d]); };
      Vec<Dim> q = v_p[p];
      for (std::size_t d = 0; d < Dim; ++d) q += ways[d].way[at(d)] * grad_v_p[p].col(static_cast<Eigen::Index>(d));
      for_each_pair<Dim>([&](std::size_t column, std::size_t a, std::size_t b) {
        const double factor = a == b ? ways[a].square[at(a)] : ways[a].way[at(a)] * ways[b].way[at(b)];
        q += factor * h_p[p].col(static_cast<Eigen::Index>(column));
      });
      sum[k] += (m_p[p] * weights(offset)) * q;
    });
  };
  scatter_mean<Dim>({*grid, *cells, y_p.span(), m_p.span(), m_i.span()}, v_i.span(), add);
}

template <int Dim>
G2PVelocityTpic2<Dim>::G2PVelocityTpic2(Input& in)
    : share(in.number("share", {.doc = "share of the second derivatives that is kept; 0 is TPIC",
                                .fallback = 0.5,
                                .at_least = 0,
                                .at_most = 1})) {}

template <int Dim>
void G2PVelocityTpic2<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<LiquidShare> liquid,
                                       Read<particle::Configuration<Dim>> y_p, Read<node::NewVelocity<Dim>> v_i,
                                       Write<particle::Velocity<Dim>> v_p,
                                       Write<particle::VelocityGradient<Dim>> grad_v_p,
                                       Write<particle::VelocityCurvature<Dim>> h_p) const {
  for_each_cell<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    std::array<Vec<Dim>, support_size<Dim>> q;
    for (std::size_t k = 0; k < q.size(); ++k) q[k] = v_i[support.node[k]];
    const auto second = second_derivatives<Dim>(support);
    const double kept = share * liquid->of_cell[c];
    for (std::size_t p = cell.begin; p < cell.end; ++p) {
      const auto v = interpolate_curved<Dim>(Weights<Dim>(support, y_p[p]), second, q);
      v_p[p] = v.value;
      grad_v_p[p] = v.gradient;
      h_p[p] = kept * v.curvature;
    }
  });
}

template struct P2GVelocityTpic2<2>;
template struct P2GVelocityTpic2<3>;
template struct G2PVelocityTpic2<2>;
template struct G2PVelocityTpic2<3>;

}  // namespace minamo
