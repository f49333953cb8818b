#include "systems/bodies/coupling/forces.hpp"

#include "systems/bodies/geometry/cut.hpp"
#include "systems/grid/incidence.hpp"

#include <spdlog/fmt/fmt.h>

#include <optional>

namespace minamo {

namespace {

template <int Dim>
struct BodyRow {
  Vec<Dim> force;
  Vec<rotations<Dim>> torque;
  Vec<Dim> position;
  Vec<Dim> velocity;
  Vec<rotations<Dim>> angle;
  Vec<rotations<Dim>> spin;
  double work;
  std::optional<RigidVector<Dim>> friction = {};
};

template <int Dim>
void set_columns(measure::Columns& columns, const std::string& name, const BodyRow<Dim>& row) {
  const auto vector = [&](const char* what, const Vec<Dim>& value, const char* unit) {
    for (int d = 0; d < Dim; ++d) columns.set(fmt::format("{}_{}_{}", name, what, "xyz"[d]), value[d], unit);
  };
  const auto rotation = [&](const char* what, const Vec<rotations<Dim>>& value, const char* unit) {
    if constexpr (Dim == 2) {
      columns.set(fmt::format("{}_{}", name, what), value[0], unit);
    } else {
      vector(what, value, unit);
    }
  };
  const char* force = Dim == 2 ? "N/m" : "N";
  const char* torque = Dim == 2 ? "N" : "N m";
  vector("force", row.force, force);
  rotation("torque", row.torque, torque);
  vector("position", row.position, "m");
  vector("velocity", row.velocity, "m/s");
  rotation("angle", row.angle, "rad");
  rotation("rotation", row.spin, "rad/s");
  columns.set(name + "_work", row.work, Dim == 2 ? "J/m" : "J");
  if (!row.friction) return;
  vector("friction", row.friction->template head<Dim>(), force);
  rotation("friction_torque", row.friction->template tail<rotations<Dim>>(), torque);
}

}  // namespace

template <int Dim>
void PushBodies<Dim>::operator()(Read<Clock> clock, Uses<MacGrid<Dim>> mac, Read<BodySet<Dim>> set,
                                 Read<multiplier::Force> lambda, Read<Rates> rates, Read<face::BodyForce<Dim>> b_f,
                                 Read<face::AttachedMass<Dim>> attached, Read<face::AttachedTo<Dim>> attached_to,
                                 Read<multiplier::Row> row, Read<unknown::Solution> solution,
                                 Read<face::Closed<Dim>> closed, Read<face::Closer<Dim>> closer,
                                 Read<body::MiddlePosition<Dim>> c_b, Read<body::Velocity<Dim>> V_old,
                                 Read<body::Spin<Dim>> omega_old, Read<body::MeanVelocity<Dim>> V_b,
                                 Read<body::MeanSpin<Dim>> omega_b, Optional<Read<FrictionOnWalls<Dim>>> friction,
                                 Optional<Read<surface::ForceOnBodies<Dim>>> lines, Optional<Read<SiteExchange>> shared,
                                 Write<body::Force<Dim>> F_b, Write<body::Torque<Dim>> T_b,
                                 Update<body::Work> W_b) const {
  const Incidence<Dim> incidence(mac);
  const SitePlaces<Dim> places(mac);
  for (std::size_t b = 0; b < set->bodies.size(); ++b) {
    F_b[b].setZero();
    T_b[b].setZero();
  }
  const auto at = [&](std::size_t l) { return lambda[l]; };
  // The impulse that takes divergence at the start of the step acts on bodies, too. Its work is that of the velocity
  // then.
  const auto damping = [&](std::size_t l) {
    return row[l] == staggered::none ? 0 : -solution[static_cast<std::size_t>(row[l])][unknown::damping];
  };
  const double per_tau = rates->acceleration / rates->velocity;
  const auto push = [&](std::size_t b, const Vec<Dim>& r, const Vec<Dim>& force) {
    F_b[b] += force;
    T_b[b] += moment_of(r, force);
  };
  std::vector<RigidVector<Dim>> impulse(set->bodies.size(), RigidVector<Dim>::Zero());
  // One after the other: the same sums on any number of threads.
  for (std::size_t i = 0; i < mac.site.size(); ++i) {
    if (!owns(of_ranks(shared), i)) continue;
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      if (attached_to[i][d] >= 0) {
        const auto b = static_cast<std::size_t>(attached_to[i][d]);
        const Vec<Dim> r = places.face(mac.site[i], d) - c_b[b];
        const Vec<Dim> change = rigid_velocity(V_b[b], omega_b[b], r) - rigid_velocity(V_old[b], omega_old[b], r);
        push(b, r, attached[i][axis] * (b_f[i][axis] - per_tau * change[axis]) * Vec<Dim>::Unit(axis));
      }
      if (closer[i][d][0] < 0 && closer[i][d][1] < 0) continue;
      const double drop = incidence.gradient(i, d, at);
      const double damped = incidence.gradient(i, d, damping);
      if (drop == 0 && damped == 0) continue;
      const Vec<Dim> x = places.face(mac.site[i], d);
      for (const std::size_t moving : {0, 1}) {
        if (closer[i][d][moving] < 0) continue;
        const auto b = static_cast<std::size_t>(closer[i][d][moving]);
        const Vec<Dim> r = x - c_b[b];
        push(b, r, closed[i][d][moving] * drop * Vec<Dim>::Unit(axis));
        const Vec<Dim> of_damping = closed[i][d][moving] * damped * Vec<Dim>::Unit(axis);
        impulse[b] += rigid_vector<Dim>(of_damping, moment_of(r, of_damping));
      }
    }
  }
  add_up_on_all(of_ranks(shared), F_b.span());
  add_up_on_all(of_ranks(shared), T_b.span());
  add_up_on_all(of_ranks(shared), std::span(impulse));
  for (std::size_t b = 0; b < set->bodies.size(); ++b) {
    if (lines) {
      F_b[b] += lines->of[b].template head<Dim>();
      T_b[b] += lines->of[b].template tail<rotations<Dim>>();
    }
    W_b[b] += clock->step * (F_b[b].dot(V_b[b]) + T_b[b].dot(omega_b[b]));
    if (set->rubs) W_b[b] += clock->step * friction->of[b].dot(rigid_vector<Dim>(V_b[b], omega_b[b]));
    W_b[b] += impulse[b].dot(rigid_vector<Dim>(V_old[b], omega_old[b]));
    F_b[b] += impulse[b].template head<Dim>() / clock->step;
    T_b[b] += impulse[b].template tail<rotations<Dim>>() / clock->step;
  }
}

template <int Dim>
void CountStops<Dim>::operator()(Read<Clock> clock, Read<body::StopImpulse<Dim>> J_b,
                                 Read<body::PlateImpulse<Dim>> J_plates, Read<body::Velocity<Dim>> V_b,
                                 Read<body::Spin<Dim>> omega_b, Update<body::Force<Dim>> F_b,
                                 Update<body::Torque<Dim>> T_b, Update<body::Work> W_b) const {
  for (std::size_t b = 0; b < J_b.size(); ++b) {
    const RigidVector<Dim> force = (J_b[b] + J_plates[b]) / clock->step;
    F_b[b] += force.template head<Dim>();
    T_b[b] += force.template tail<rotations<Dim>>();
    W_b[b] += J_b[b].dot(rigid_vector<Dim>(V_b[b], omega_b[b]));
  }
}

template <int Dim>
void MeasureBodies<Dim>::operator()(Read<BodySet<Dim>> set, Read<body::Force<Dim>> F_b, Read<body::Torque<Dim>> T_b,
                                    Read<body::Position<Dim>> c_b, Read<body::Velocity<Dim>> V_b,
                                    Read<body::Angle<Dim>> alpha_b, Read<body::Spin<Dim>> omega_b, Read<body::Work> W_b,
                                    Optional<Read<FrictionOnWalls<Dim>>> friction,
                                    Update<measure::Columns> columns) const {
  for (std::size_t b = 0; b < set->bodies.size(); ++b) {
    BodyRow<Dim> row{F_b[b], T_b[b], c_b[b], V_b[b], alpha_b[b], omega_b[b], W_b[b]};
    if (set->rubs) row.friction = friction->of[b];
    set_columns<Dim>(*columns, set->bodies[b].name, row);
  }
}

template <int Dim>
void MeasureBodiesAtStart<Dim>::operator()(Read<BodySet<Dim>> set, Read<body::Position<Dim>> c_b,
                                           Read<body::Velocity<Dim>> V_b, Read<body::Angle<Dim>> alpha_b,
                                           Read<body::Spin<Dim>> omega_b, Read<body::Work> W_b,
                                           Update<measure::Columns> columns) const {
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t b = 0; b < set->bodies.size(); ++b) {
    BodyRow<Dim> row{Vec<Dim>::Constant(nothing),
                     Vec<rotations<Dim>>::Constant(nothing),
                     c_b[b],
                     V_b[b],
                     alpha_b[b],
                     omega_b[b],
                     W_b[b]};
    if (set->rubs) row.friction = RigidVector<Dim>::Constant(nothing);
    set_columns<Dim>(*columns, set->bodies[b].name, row);
  }
}

template struct CountStops<2>;
template struct CountStops<3>;
template struct PushBodies<2>;
template struct PushBodies<3>;
template struct MeasureBodiesAtStart<2>;
template struct MeasureBodiesAtStart<3>;
template struct MeasureBodies<2>;
template struct MeasureBodies<3>;

}  // namespace minamo
