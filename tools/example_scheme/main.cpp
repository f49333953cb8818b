/// \file
/// minamo with one more transfer scheme. RPIC, rigid particle-in-cell: particles carry a velocity and how it turns
/// around them; of how it strains they keep as much as the scene says. After C. Jiang, C. Schroeder, A. Selle, J.
/// Teran, A. Stomakhin, ACM TOG 34 (2015) 51, doi:10.1145/2766996, who carry the angular momentum instead of the
/// turning.

#include <minamo/minamo.hpp>

#include <minamo/systems/grid/support.hpp>
#include <minamo/systems/transfer/gather.hpp>
#include <minamo/systems/transfer/scatter.hpp>

using namespace minamo;

/// v_I = sum_p S_Ip m_p (v_p + G_p (x_I - y_p)) / m_I.
template <int Dim>
struct ScatterVelocity {
  static constexpr const char* doc = "v_I, RPIC";

  void operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<particle::QuadraturePosition<Dim>> y_p,
                  Read<particle::Mass> m_p, Read<particle::Velocity<Dim>> v_p,
                  Read<particle::VelocityGradient<Dim>> G_p, Read<node::Mass> m_i,
                  Write<node::Velocity<Dim>> v_i) const {
    const ScatterSource<Dim> source{*grid, *cells, y_p.span(), m_p.span(), m_i.span()};
    const auto add = [&](std::size_t p, const Support<Dim>& support, const Weights<Dim>& weights, auto& sum) {
      for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) {
        Vec<Dim> away = support.corner - y_p[p];
        for (int d = 0; d < Dim; ++d) away[d] += offset[static_cast<std::size_t>(d)] * grid->spacing;
        const Vec<Dim> momentum = m_p[p] * (v_p[p] + G_p[p] * away);
        sum[k] += weights(offset) * padded<Dim>(momentum);
      });
    };
    scatter_mean<Dim>(source, v_i.span(), add);
  }
};

/// v_p = sum_I S_Ip v_I, G_p = rotation (A - A^T)/2 + strain (A + A^T)/2, A = sum_I v_I (x) grad S_Ip.
template <int Dim>
struct GatherVelocity {
  static constexpr const char* doc = "v_p and G_p, RPIC";
  double rotation = 1;  // [1]
  double strain = 0;    // [1]

  GatherVelocity() = default;
  explicit GatherVelocity(Input& in) {
    rotation = in.number("rotation", {.doc = "share of the turning kept", .fallback = 1, .at_least = 0, .at_most = 1});
    strain = in.number("strain", {.doc = "share of the strain kept", .fallback = 0, .at_least = 0, .at_most = 1});
  }

  void operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<particle::QuadraturePosition<Dim>> y_p,
                  Read<node::NewVelocity<Dim>> v_i, Write<particle::Velocity<Dim>> v_p,
                  Write<particle::VelocityGradient<Dim>> G_p) const {
    gather_with_gradient<Dim>(*grid, *cells, y_p.span(), v_i.span(), [&](std::size_t p, const Jet<Dim>& v) {
      const Mat<Dim>& A = v.gradient;
      v_p[p] = v.value;
      G_p[p] = 0.5 * rotation * (A - A.transpose()) + 0.5 * strain * (A + A.transpose());
    });
  }
};

int main(int argc, char** argv) {
  return minamo::run(argc, argv, [](SystemRegistry& registry) {
    registry.add<ScatterVelocity>("p2g_velocity_rpic");
    registry.add<GatherVelocity>("g2p_velocity_rpic");
    registry.add(TransferScheme{.name = "rpic",
                                .doc = "particles take over the grid velocity and its rotation; damps strain",
                                .p2g_velocity = {"p2g_velocity_rpic"},
                                .g2p_velocity = {"g2p_velocity_rpic"},
                                .carries_gradient = true});
  });
}
