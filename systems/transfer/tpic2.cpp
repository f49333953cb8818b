#include "systems/transfer/tpic2.hpp"

#include "systems/transfer/node_affine.hpp"
#include "systems/transfer/node_scatter.hpp"

namespace minamo {

namespace {

/// What a particle brings to the nodes of its cell, times its mass: the series of (E64) as a polynomial in how many
/// nodes a node is from the first.
template <int Dim>
struct Series {
  PaddedVec<Dim> constant;
  std::array<PaddedVec<Dim>, Dim> linear;
  std::array<PaddedVec<Dim>, Dim*(Dim + 1) / 2> quadratic;

  /// `way` leads from the particle to the first node. [m]
  Series(double m, const Vec<Dim>& v, const Mat<Dim>& gradient, const SecondDerivatives<Dim>& curvature,
         const Vec<Dim>& way, const Weights<Dim>& weights, double h)
      : constant(padded<Dim>(v)) {
    for (int d = 0; d < Dim; ++d) {
      linear[index(d)] = padded<Dim>(gradient.col(d));
      constant += way[d] * linear[index(d)];
    }
    for_each_pair<Dim>([&](int column, int a, int b) {
      const PaddedVec<Dim> of = padded<Dim>(curvature.col(column));
      const double square = way[a] * way[b];
      linear[index(a)] += way[b] * of;
      if (a == b) {
        constant += 0.5 * (square - mean_square(way[a], weights.value[index(a)], h)) * of;
      } else {
        constant += square * of;
        linear[index(b)] += way[a] * of;
      }
      quadratic[index(column)] = ((a == b ? 0.5 : 1) * m * h * h) * of;
    });
    constant *= m;
    for (PaddedVec<Dim>& of : linear) of *= m * h;
  }

  [[gnu::always_inline]] PaddedVec<Dim> at(const Index<Dim>& offset) const {
    PaddedVec<Dim> q = constant;
    for (std::size_t d = 0; d < Dim; ++d) q += offset[d] * linear[d];
    for_each_pair<Dim>(
        [&](int column, int a, int b) { q += (offset[index(a)] * offset[index(b)]) * quadratic[index(column)]; });
    return q;
  }

 private:
  static constexpr std::size_t index(int i) { return static_cast<std::size_t>(i); }

  /// D of (E64) along an axis.
  static double mean_square(double way, const std::array<double, 3>& weight, double h) {
    return weight[0] * way * way + weight[1] * (way + h) * (way + h) + weight[2] * (way + 2 * h) * (way + 2 * h);
  }
};

}  // namespace

template <int Dim>
void P2GVelocityTpic2<Dim>::operator()(Uses<ParticlesToNodes<Dim>> source, Read<particle::Velocity<Dim>> v_p,
                                       Read<particle::VelocityGradient<Dim>> grad_v_p,
                                       Read<particle::VelocityCurvature<Dim>> h_p,
                                       Write<node::Velocity<Dim>> v_i) const {
  const auto add = [&](std::size_t p, const Support<Dim>& support, const Weights<Dim>& weights, auto& sum) {
    const Series<Dim> series(source.m_p[p], v_p[p], grad_v_p[p], h_p[p], support.corner - source.y_p[p], weights,
                             source.grid->spacing);
    for_each_support<Dim>(
        [&](std::size_t k, const Index<Dim>& offset) { sum[k] += weights(offset) * series.at(offset); });
  };
  scatter_mean<Dim>(source, v_i.span(), add);
}

template <int Dim>
G2PVelocityTpic2<Dim>::G2PVelocityTpic2(Input& in) : share(curvature_share(in)) {}

template <int Dim>
void G2PVelocityTpic2<Dim>::operator()(Uses<NodesToParticles<Dim>> target, Read<cell::BulkIndicator> b_c,
                                       Read<node::NewVelocity<Dim>> v_i, Write<particle::Velocity<Dim>> v_p,
                                       Write<particle::VelocityGradient<Dim>> grad_v_p,
                                       Write<particle::VelocityCurvature<Dim>> h_p) const {
  gather_with_affine<Dim>(target, v_i.span(),
                          [&](std::size_t c, std::size_t p, const Jet<Dim>& v, const Mat<Dim>& beyond) {
                            const double resolved = resolved_curvature<Dim>(v.gradient, v.second, target.grid->spacing);
                            const double kept = share * b_c[c] * resolved;
                            v_p[p] = v.value;
                            grad_v_p[p] = v.gradient + (1 - kept) * antisymmetric<Dim>(beyond);
                            h_p[p] = kept * v.second;
                          });
}

template struct P2GVelocityTpic2<2>;
template struct P2GVelocityTpic2<3>;
template struct G2PVelocityTpic2<2>;
template struct G2PVelocityTpic2<3>;

}  // namespace minamo
