#include "systems/bodies/coupling/closed_faces.hpp"

#include "systems/bodies/geometry/cut.hpp"

#include <algorithm>

namespace minamo {

namespace {

/// The body that a face is closed by, or that liquid is attached to there; -1: none.
template <int Dim>
int adjacent_body(const typename face::AttachedTo<Dim>::value_type& attached,
                  const typename face::Closer<Dim>::value_type& closer, std::size_t d) {
  if (attached[d] >= 0) return attached[d];
  return closer[d][1] >= 0 ? closer[d][1] : closer[d][0];
}

/// A free body would have to take it up with the liquid around it, and what leaves a separating one would pull at it.
template <int Dim>
bool counts(const BodyScene<Dim>& body) {
  return body.free() == nullptr && body.wall.kind != BodyWall::Kind::separating;
}

}  // namespace

template <int Dim>
void CountClosedFaces<Dim>::operator()(
    Read<Clock> clock, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<FaceExtension<Dim>> extension,
    Read<VelocityOfParticles> of_particles, Read<BodySet<Dim>> set, Read<staggered::Site<Dim>> site,
    Read<face::Held> held, Read<face::Mass<Dim>> m_f, Read<face::Mobility<Dim>> mobility, Read<face::Open<Dim>> open,
    Read<face::OpenVolume<Dim>> open_volume, Read<face::Closer<Dim>> closer, Read<face::AttachedMass<Dim>> attached,
    Read<face::AttachedTo<Dim>> attached_to, Read<face::Velocity<Dim>> v_old, Read<face::NewVelocity<Dim>> v_new,
    Read<body::MiddlePosition<Dim>> c_b, Read<body::Velocity<Dim>> V_old, Read<body::Spin<Dim>> omega_old,
    Read<body::MeanVelocity<Dim>> V_b, Read<body::MeanSpin<Dim>> omega_b, Optional<Read<SiteExchange>> shared,
    Update<body::Force<Dim>> F_b, Update<body::Torque<Dim>> T_b, Update<body::Work> W_b) const {
  if (std::none_of(set->bodies.begin(), set->bodies.end(), counts<Dim>)) return;
  const SitePlaces<Dim> places(*grid, *splines);
  std::vector<RigidVector<Dim>> impulse(set->bodies.size(), RigidVector<Dim>::Zero());
  // Particles got momentum at a face; what moves with the body (E94) is part of its force already.
  const auto give = [&](std::size_t i, std::size_t d, double momentum) {
    if (!owns(of_ranks(shared), i)) return;
    const int adjacent = adjacent_body<Dim>(attached_to[i], closer[i], d);
    if (adjacent < 0 || !counts<Dim>(set->bodies[static_cast<std::size_t>(adjacent)])) return;
    const auto b = static_cast<std::size_t>(adjacent);
    const auto axis = static_cast<Eigen::Index>(d);
    const Vec<Dim> r = places.face(site[i], d) - c_b[b];
    const Vec<Dim> change = rigid_velocity(V_b[b], omega_b[b], r) - rigid_velocity(V_old[b], omega_old[b], r);
    const Vec<Dim> taken = (2 * attached[i][axis] * change[axis] - momentum) * Vec<Dim>::Unit(axis);
    impulse[b] += rigid_vector<Dim>(taken, moment_of(r, taken));
  };
  // One after the other: the same sums on any number of threads.
  std::vector<std::uint8_t> done(held.begin(), held.end());
  for (std::size_t t = 0; t < extension->targets.size(); ++t) {
    const auto& target = extension->targets[t];
    if (!extension->sets(target)) continue;
    const auto d = static_cast<std::size_t>(target.direction);
    done[target.row] = static_cast<std::uint8_t>(done[target.row] | 1U << d);
    const double before = of_particles->is_kept ? v_old[target.row][target.direction] : extension->before[t];
    give(target.row, d, m_f[target.row][target.direction] * (v_new[target.row][target.direction] - before));
  }
  for (std::size_t i = 0; i < site.size(); ++i) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      const bool is_adjacent = open_volume[i][axis] != 1 || open[i][axis] != 1;
      if (!is_adjacent || (done[i] >> d & 1) != 0 || mobility[i][axis] == 0) continue;
      const double in_balance = open[i][axis] / mobility[i][axis];
      give(i, d, (m_f[i][axis] - in_balance) * (v_new[i][axis] - v_old[i][axis]));
    }
  }
  add_up_on_all(of_ranks(shared), std::span(impulse));
  for (std::size_t b = 0; b < set->bodies.size(); ++b) {
    F_b[b] += impulse[b].template head<Dim>() / clock->step;
    T_b[b] += impulse[b].template tail<rotations<Dim>>() / clock->step;
    W_b[b] += impulse[b].dot(rigid_vector<Dim>(V_b[b], omega_b[b]));
  }
}

template struct CountClosedFaces<2>;
template struct CountClosedFaces<3>;

}  // namespace minamo
