/// \file
/// minamo with one more transfer scheme. RPIC, rigid particle-in-cell: particles carry a velocity and how it turns
/// around them; of how it strains they keep as much as the scene says. After C. Jiang, C. Schroeder, A. Selle, J.
/// Teran, A. Stomakhin, ACM TOG 34 (2015) 51, doi:10.1145/2766996, who carry the angular momentum instead of the
/// turning.

#include <minamo/minamo.hpp>

#include <minamo/systems/grid/node_support.hpp>
#include <minamo/systems/transfer/face_gather.hpp>
#include <minamo/systems/transfer/face_scatter.hpp>
#include <minamo/systems/transfer/node_gather.hpp>
#include <minamo/systems/transfer/node_scatter.hpp>

using namespace minamo;

/// v_I = sum_p S_Ip m_p (v_p + G_p (x_I - y_p)) / m_I.
template <int Dim>
struct ScatterVelocity {
  static constexpr const char* doc = "v_I, RPIC";

  void operator()(Uses<ParticlesToNodes<Dim>> source, Read<particle::Velocity<Dim>> v_p,
                  Read<particle::VelocityGradient<Dim>> G_p, Write<node::Velocity<Dim>> v_i) const {
    const auto add = [&](std::size_t p, const Support<Dim>& support, const Weights<Dim>& weights, auto& sum) {
      for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) {
        Vec<Dim> away = support.corner - source.y_p[p];
        for (int d = 0; d < Dim; ++d) away[d] += offset[static_cast<std::size_t>(d)] * source.grid->spacing;
        const Vec<Dim> momentum = source.m_p[p] * (v_p[p] + G_p[p] * away);
        sum[k] += weights(offset) * padded<Dim>(momentum);
      });
    };
    scatter_mean<Dim>(source, v_i.span(), add);
  }
};

/// What is kept of a velocity gradient A: G_p = rotation (A - A^T)/2 + strain (A + A^T)/2.
struct Kept {
  double rotation = 1;  // [1]
  double strain = 0;    // [1]

  Kept() = default;
  explicit Kept(Input& in) {
    rotation = in.number("rotation", {.doc = "share of the turning kept", .fallback = 1, .at_least = 0, .at_most = 1});
    strain = in.number("strain", {.doc = "share of the strain kept", .fallback = 0, .at_least = 0, .at_most = 1});
  }
  template <int Dim>
  Mat<Dim> of(const Mat<Dim>& A) const {
    return 0.5 * rotation * (A - A.transpose()) + 0.5 * strain * (A + A.transpose());
  }
};

/// v_p = sum_I S_Ip v_I, G_p of A = sum_I v_I (x) grad S_Ip.
template <int Dim>
struct GatherVelocity {
  static constexpr const char* doc = "v_p and G_p, RPIC";
  Kept kept;

  GatherVelocity() = default;
  explicit GatherVelocity(Input& in) : kept(in) {}

  void operator()(Uses<NodesToParticles<Dim>> target, Read<node::NewVelocity<Dim>> v_i,
                  Write<particle::Velocity<Dim>> v_p, Write<particle::VelocityGradient<Dim>> G_p) const {
    gather_with_gradient<Dim>(target, v_i.span(), [&](std::size_t p, const Jet<Dim>& v) {
      v_p[p] = v.value;
      G_p[p] = kept.of<Dim>(v.gradient);
    });
  }
};

/// The same for the conforming discretization, whose velocities live on faces: m_f = sum_p N_f m_p, v_f = sum_p N_f m_p
/// (v_p + G_p (x_f - y_p)) / m_f.
template <int Dim>
struct ScatterToFaces {
  static constexpr const char* doc = "m_f and v_f, RPIC";

  void operator()(Uses<ParticlesToFaces<Dim>> source, Read<particle::Velocity<Dim>> v_p,
                  Read<particle::VelocityGradient<Dim>> G_p, Write<face::Mass<Dim>> m_f,
                  Write<face::Velocity<Dim>> v_f) const {
    const auto of_particle = [&](std::size_t p) { return series::Linear<Dim>{v_p[p], G_p[p]}; };
    scatter_mean<Dim>(source, m_f.span(), v_f.span(), of_particle);
  }
};

template <int Dim>
struct GatherFromFaces {
  static constexpr const char* doc = "v_p and G_p, RPIC";
  Kept kept;

  GatherFromFaces() = default;
  explicit GatherFromFaces(Input& in) : kept(in) {}

  void operator()(Uses<FacesToParticles<Dim>> target, Read<face::NewVelocity<Dim>> v_f,
                  Write<particle::Velocity<Dim>> v_p, Write<particle::VelocityGradient<Dim>> G_p) const {
    gather_faces_with_gradient<Dim>(target, of_faces<Dim>(v_f.span()), [&](std::size_t p, const Jet<Dim>& v) {
      v_p[p] = v.value;
      G_p[p] = kept.of<Dim>(v.gradient);
    });
  }
};

int main(int argc, char** argv) {
  return minamo::run(argc, argv, [](SystemRegistry& registry) {
    registry.add<ScatterVelocity>("p2g_velocity_rpic");
    registry.add<GatherVelocity>("g2p_velocity_rpic");
    registry.add<ScatterToFaces>("p2g_faces_rpic");
    registry.add<GatherFromFaces>("g2p_faces_rpic");
    registry.add(TransferScheme{.name = "rpic",
                                .doc = "particles take over the grid velocity and its rotation; damps strain",
                                .p2g_velocity = {"p2g_velocity_rpic"},
                                .g2p_velocity = {"g2p_velocity_rpic"},
                                .p2g_faces = {"p2g_faces_rpic"},
                                .g2p_faces = {"g2p_faces_rpic"},
                                .carries_gradient = true});
  });
}
