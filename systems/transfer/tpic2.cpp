#include "systems/transfer/tpic2.hpp"

#include "systems/transfer/scatter.hpp"
#include "systems/transfer/spin.hpp"

namespace minamo {

namespace {

using AxisValues = std::array<double, 3>;

template <int Dim>
using Curvature = typename particle::VelocityCurvature<Dim>::value_type;

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

/// sum_I q_I times the product of one number per direction.
template <int Dim>
[[gnu::always_inline]] inline Vec<Dim> contract(const std::array<const AxisValues*, Dim>& factor,
                                                const std::array<Vec<Dim>, support_size<Dim>>& q) {
  const AxisValues& x = *factor[0];
  const AxisValues& y = *factor[1];
  Vec<Dim> sum = Vec<Dim>::Zero();
  for (std::size_t c = 0; c < (Dim == 3 ? 3 : 1); ++c) {
    Vec<Dim> plane = Vec<Dim>::Zero();
    for (std::size_t b = 0; b < 3; ++b) {
      const Vec<Dim>* row = q.data() + 9 * c + 3 * b;
      plane += y[b] * (x[0] * row[0] + x[1] * row[1] + x[2] * row[2]);
    }
    if constexpr (Dim == 3) {
      sum += (*factor[2])[c] * plane;
    } else {
      sum = plane;
    }
  }
  return sum;
}

/// All second derivatives of a nodal field at a particle, from those along the axes.
template <int Dim>
[[gnu::always_inline]] inline Curvature<Dim> curvature_of(const Mat<Dim>& along_axes, const Weights<Dim>& weights,
                                                          const std::array<Vec<Dim>, support_size<Dim>>& q) {
  Curvature<Dim> curvature;
  for_each_pair<Dim>([&](std::size_t column, std::size_t a, std::size_t b) {
    const auto into = static_cast<Eigen::Index>(column);
    if (a == b) {
      curvature.col(into) = along_axes.col(static_cast<Eigen::Index>(a));
    } else {
      std::array<const AxisValues*, Dim> factor;
      for (std::size_t d = 0; d < Dim; ++d) factor[d] = d == a || d == b ? &weights.slope[d] : &weights.value[d];
      curvature.col(into) = contract<Dim>(factor, q);
    }
  });
  return curvature;
}

/// phi_p of (E65), how much of a velocity's curvature the grid resolves.
template <int Dim>
double resolved_curvature(const Mat<Dim>& gradient, const Curvature<Dim>& curvature, double h) {
  double square = 0;
  for_each_pair<Dim>([&](std::size_t column, std::size_t a, std::size_t b) {
    square += (a == b ? 1 : 2) * curvature.col(static_cast<Eigen::Index>(column)).squaredNorm();
  });
  const double of_gradient = gradient.squaredNorm();
  const double sum = of_gradient + h * h * square;
  return sum > 0 ? of_gradient / sum : 0;
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
                                .fallback = 1,
                                .at_least = 0,
                                .at_most = 1})) {}

template <int Dim>
void G2PVelocityTpic2<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<LiquidShare> liquid,
                                       Read<particle::Configuration<Dim>> y_p, Read<node::NewVelocity<Dim>> v_i,
                                       Write<particle::Velocity<Dim>> v_p,
                                       Write<particle::VelocityGradient<Dim>> grad_v_p,
                                       Write<particle::VelocityCurvature<Dim>> h_p) const {
  gather_bent<Dim>(*grid, *cells, y_p.span(), v_i.span(), [&](std::size_t c, std::size_t p, const Bent<Dim>& v) {
    const auto& [value, gradient] = v.sample;
    const auto curvature = curvature_of<Dim>(v.second, v.weights, v.q);
    const double kept = share * liquid->interior[c] * resolved_curvature<Dim>(gradient, curvature, grid->spacing);
    v_p[p] = value;
    grad_v_p[p] = gradient + (1 - kept) * antisymmetric<Dim>(v.beyond);
    h_p[p] = kept * curvature;
  });
}

template struct P2GVelocityTpic2<2>;
template struct P2GVelocityTpic2<3>;
template struct G2PVelocityTpic2<2>;
template struct G2PVelocityTpic2<3>;

}  // namespace minamo
