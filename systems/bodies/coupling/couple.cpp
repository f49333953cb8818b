#include "systems/bodies/coupling/couple.hpp"

#include "engine/run/step_control.hpp"
#include "systems/bodies/coupling/motion_columns.hpp"
#include "systems/bodies/geometry/cut.hpp"
#include "systems/bodies/particles/contact.hpp"
#include "systems/bodies/particles/room.hpp"
#include "systems/grid/incidence.hpp"
#include "systems/linear/dense.hpp"
#include "systems/shapes/rotation.hpp"

#include <Eigen/LU>
#include <spdlog/fmt/fmt.h>

#include <optional>

namespace minamo {

namespace {

using unknown::Which;

/// What of the balances of free bodies does not depend on the liquid.
struct BodyBalances {
  Eigen::MatrixXd mass;     ///< M [kg, kg m^2]
  Eigen::MatrixXd springs;  ///< what springs and dampers add to it
  Eigen::VectorXd impulse;  ///< tau f of the body force, of springs, and of the turn of the inertia [N s, N m s]
};

template <int Dim>
BodyBalances balances_of(const BodySet<Dim>& set, const FreeMotions<Dim>& motions, const BodyStates<Dim>& at,
                         std::span<const Mat<Dim>> R_middle, std::span<const Vec<Dim>> body_force, double tau) {
  const Eigen::Index n = motions.count();
  BodyBalances of{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  for (std::size_t b = 0; b < set.bodies.size(); ++b) {
    const Free<Dim>* free = set.bodies[b].free();
    if (free == nullptr) continue;
    const auto I_middle = turned_inertia<Dim>(*free, R_middle[b]);
    const Vec<rotations<Dim>> turn = (turned_inertia<Dim>(*free, at.rotation[b]) - I_middle) * at.spin[b];
    const Spring<Dim>& spring = free->spring;
    const double drag = spring.stiffness * tau + spring.damping;
    const Vec<Dim> pull = spring.stiffness * (spring.to - at.position[b]) - drag * at.velocity[b];
    motions.for_each_of(b, [&](Eigen::Index k, int c) {
      if (c < Dim) {
        of.mass(k, k) = free->mass;
        of.springs(k, k) = tau * drag;
        of.impulse[k] = tau * (free->mass * body_force[b][c] + pull[c]);
        return;
      }
      motions.for_each_of(b, [&](Eigen::Index j, int e) {
        if (e >= Dim) of.mass(k, j) = I_middle(c - Dim, e - Dim);
      });
      of.impulse[k] = turn[c - Dim];
    });
  }
  return of;
}

/// Liquid that is enclosed all around and full leaves a body only motions that do not change its room: N q = -r.
struct Enclosures {
  std::vector<std::size_t> component;  ///< number of the closed component of a row
  Eigen::MatrixXd N;                   ///< n^T U of these components [1/m, 1]

  bool any() const { return N.rows() > 0; }
  /// N^T s with an s that is large compared with a matrix of the motions.
  Eigen::MatrixXd stiffness(const Eigen::MatrixXd& G) const {
    constexpr double large = 1e8;
    Eigen::MatrixXd stiff = N.transpose();
    for (Eigen::Index k = 0; k < N.rows(); ++k) stiff.col(k) *= large * G.trace() / N.row(k).squaredNorm();
    return stiff;
  }
  /// Row of a component, if it has one.
  std::optional<Eigen::Index> row_of(std::size_t number) const {
    const auto at = std::find(component.begin(), component.end(), number);
    if (number == 0 || at == component.end()) return {};
    return at - component.begin();
  }
  /// r = n^T b, b by unknown.
  template <class At>
  Eigen::VectorXd sums(std::span<const double> n_l, const ClosedComponents& closed, const At& b) const {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(N.rows());
    for (std::size_t l = 0; any() && l < n_l.size(); ++l) {
      if (!closed.counts(l)) continue;
      if (const auto row = row_of(closed.number(l))) sum[*row] += n_l[l] * b(l);
    }
    closed.add_up(entries_of(sum));
    return sum;
  }
};

Enclosures enclosures_of(const Fluxes& fluxes, std::span<const double> n_l, const ClosedComponents& closed,
                         const std::vector<bool>& is_full) {
  const Eigen::Index motions = fluxes.columns.count();
  const auto components = static_cast<Eigen::Index>(closed.count());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(components, motions);
  Eigen::MatrixXd absolute = sum;
  for (const std::size_t l : fluxes.touched) {
    if (!closed.counts(l) || !is_full[closed.number(l) - 1]) continue;
    const auto row = static_cast<Eigen::Index>(closed.number(l) - 1);
    for (Eigen::Index k = 0; k < motions; ++k) {
      sum(row, k) += n_l[l] * fluxes.columns.at(k, l);
      absolute(row, k) += n_l[l] * std::abs(fluxes.columns.at(k, l));
    }
  }
  closed.add_up(entries_of(sum));
  closed.add_up(entries_of(absolute));
  sum = (sum.array().abs() > least_change_of_room * absolute.array()).select(sum, 0).eval();
  Enclosures enclosures;
  for (Eigen::Index row = 0; row < components; ++row) {
    if (!sum.row(row).isZero(0)) enclosures.component.push_back(static_cast<std::size_t>(row) + 1);
  }
  enclosures.N.resize(static_cast<Eigen::Index>(enclosures.component.size()), motions);
  for (std::size_t k = 0; k < enclosures.component.size(); ++k)
    enclosures.N.row(static_cast<Eigen::Index>(k)) = sum.row(static_cast<Eigen::Index>(enclosures.component[k]) - 1);
  return enclosures;
}

/// A matrix of the motions that is nowhere below the bodies' own masses. What the grid attaches to a body is less than
/// zero where it reaches over faces, and in a splash that may be more than all that it carries along: a light body
/// would have no inertia left.
Eigen::MatrixXd at_least(const Eigen::MatrixXd& own, const Eigen::MatrixXd& G) {
  const Modes carried = modes_of(G - own, own);
  if (carried.lambda.minCoeff() >= 0) return G;
  // V^T own V = 1, so that own = V^-T V^-1.
  const Eigen::MatrixXd scaled = own * carried.V;
  return own + scaled * carried.lambda.cwiseMax(0).asDiagonal() * scaled.transpose();
}

/// How far the points of every body may go within a step, with a margin. [m]
template <int Dim>
std::vector<double> reach_of(const BodySet<Dim>& set, const BodyStates<Dim>& at, double step, double margin) {
  std::vector<double> reach;
  for (std::size_t b = 0; b < set.bodies.size(); ++b) {
    double radius = 0;
    for (const Vec<Dim>& X : set.bodies[b].surface) radius = std::max(radius, (X - set.bodies[b].pivot).norm());
    reach.push_back(margin + 2 * step * (at.velocity[b].norm() + at.spin[b].norm() * radius));
  }
  return reach;
}

/// The least speeds with which contacts move apart: in the balances so that no gap becomes negative, and one that is so
/// opens slowly; at the end of the step, where a gap is used up, none.
std::vector<double> least_in_balances(const std::vector<Contact>& contacts, double step) {
  constexpr double opened_share = 0.2;
  std::vector<double> least;
  for (const Contact& contact : contacts) least.push_back(-(contact.gap < 0 ? opened_share : 1) * contact.gap / step);
  return least;
}
std::vector<double> least_at_end(const std::vector<Contact>& contacts, const Eigen::VectorXd& q,
                                 std::vector<double> least, double margin) {
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const bool is_used_up = contacts[k].gradient.dot(q) + contacts[k].apart <= least[k] + margin;
    least[k] = is_used_up ? 0 : -std::numeric_limits<double>::infinity();
  }
  return least;
}

/// What lies between walls and the faces of the grid (E94).
template <int Dim>
struct AttachedLiquid {
  std::span<const typename staggered::Site<Dim>::value_type> site;
  std::span<const Vec<Dim>> mass;
  std::span<const typename face::AttachedTo<Dim>::value_type> to;
  const SiteExchange* shared = nullptr;
};

/// Calls use(site, axis, along) for the liquid that free bodies carry, with what every motion moves it along its axis.
template <int Dim, class Use>
void for_each_attached(const SitePlaces<Dim>& places, const FreeMotions<Dim>& motions,
                       std::span<const Vec<Dim>> middle_position, const AttachedLiquid<Dim>& liquid, const Use& use) {
  Eigen::VectorXd along(motions.count());
  for (std::size_t i = 0; i < liquid.site.size(); ++i) {
    if (!owns(liquid.shared, i)) continue;
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      if (liquid.to[i][d] < 0 || liquid.mass[i][axis] == 0) continue;
      const auto b = static_cast<std::size_t>(liquid.to[i][d]);
      along.setZero();
      motions.for_each_at(b, places.face(liquid.site[i], d) - middle_position[b], Vec<Dim>::Unit(axis),
                          [&](Eigen::Index k, double weight) { along[k] = weight; });
      if (!along.isZero(0)) use(i, axis, along);
    }
  }
}

/// Sets the spins at the end of the step: the angular momentum changes by twice of what it does up to the middle,
/// I (2 omega - omega^n) - I^n omega^n.
void turn_inertia(const BodySet<3>& set, const FreeMotions<3>& motions, const BodyStates<3>& at,
                  std::span<const Mat<3>> R_middle, std::span<const Vec<3>> omega_mean, double step,
                  Eigen::VectorXd& end) {
  for (std::size_t b = 0; b < set.bodies.size(); ++b) {
    const Free<3>* free = set.bodies[b].free();
    if (free == nullptr) continue;
    const Vec<3> momentum = turned_inertia<3>(*free, R_middle[b]) * (at.spin[b] + motions.spin_in(end, b)) -
                            turned_inertia<3>(*free, at.rotation[b]) * at.spin[b];
    const Mat<3> R_end = rotation_by(Vec<3>(step * omega_mean[b])) * at.rotation[b];
    const Vec<3> spin = turned_inertia<3>(*free, R_end).inverse() * momentum;
    motions.for_each_of(b, [&](Eigen::Index k, int c) {
      if (c >= 3) end[k] = spin[c - 3];
    });
  }
}

}  // namespace

template <int Dim>
void CoupleFreeBodies<Dim>::operator()(
    Read<Clock> clock, Read<Rates> rates, Uses<MacGrid<Dim>> mac, Read<SolverTolerance> tolerance,
    Read<BodyForce> force, Optional<Read<ode::AtBalances>> ode, Read<BodySet<Dim>> set, Read<body::Position<Dim>> c_b,
    Read<body::Rotation<Dim>> R_b, Read<body::StopImpulse<Dim>> J_b, Read<body::MiddlePosition<Dim>> c_middle,
    Read<body::MiddleRotation<Dim>> R_middle, Read<face::BodyForce<Dim>> b_f, Read<face::AttachedMass<Dim>> attached,
    Read<face::AttachedTo<Dim>> attached_to, Read<face::Closed<Dim>> closed, Read<face::Closer<Dim>> closer,
    Read<unknown::Staggered> of_unknown, Read<unknown::Site<Dim>> unknown_site,
    Read<unknown::Neighbour<Dim>> unknown_neighbour, Read<unknown::Conductance<Dim>> conductance,
    Read<unknown::Diagonal> diagonal, Read<unknown::NullVector> null_vector, Read<unknown::Source> source,
    Read<multiplier::Volume> v_l, Read<multiplier::Capacity> capacity, Optional<Read<FrictionOnWalls<Dim>>> friction,
    Optional<Read<surface::ForceOnBodies<Dim>>> lines, Optional<Read<SiteExchange>> shared,
    Update<MultiplierSolver<Dim>> solver, Update<unknown::Solution> solution, Update<SolveReport> report,
    Update<body::MeanVelocity<Dim>> V_mean, Update<body::MeanSpin<Dim>> omega_mean, Update<body::Work> W_b,
    Write<body::EndVelocity<Dim>> V_end, Write<body::EndSpin<Dim>> omega_end) const {
  const FreeMotions<Dim> motions(*set);
  const std::vector<Vec<Dim>> V(V_mean.begin(), V_mean.end());
  const std::vector<Vec<rotations<Dim>>> omega(omega_mean.begin(), omega_mean.end());
  const BodyStates<Dim> at{c_b.span(), R_b.span(), V, omega};

  Fluxes fluxes{MotionColumns(motions.count(), solution.size()), {}, of_ranks(shared)};
  const Incidence<Dim> incidence(mac);
  const SitePlaces<Dim> places(mac);
  const auto add_flux = [&](std::size_t l, std::size_t f, std::size_t d, double per_width) {
    const std::int16_t b = closer[f][d][1];
    if (b < 0) return false;
    const Vec<Dim> r = places.face(mac.site[f], d) - c_middle[static_cast<std::size_t>(b)];
    bool is_free = false;
    motions.for_each_at(static_cast<std::size_t>(b), r, Vec<Dim>::Unit(static_cast<Eigen::Index>(d)),
                        [&](Eigen::Index k, double weight) {
                          fluxes.columns.at(k, l) += per_width * closed[f][d][1] * weight;
                          is_free = true;
                        });
    return is_free;
  };
  for (std::size_t l = 0; l < solution.size(); ++l) {
    bool is_touched = false;
    for (std::size_t d = 0; d < Dim; ++d) {
      const double per_width = incidence.per_width(of_unknown[l], d);
      is_touched |= add_flux(l, incidence.above(of_unknown[l], d), d, per_width);
      is_touched |= add_flux(l, of_unknown[l], d, -per_width);
    }
    if (is_touched && owns(of_ranks(shared), of_unknown[l])) fluxes.touched.push_back(l);
  }
  const ClosedComponents& closed_parts = solver->closed();
  const Enclosures enclosures =
      enclosures_of(fluxes, null_vector.span(), closed_parts,
                    full_components(closed_parts, of_unknown.span(), v_l.span(), capacity.span()));
  if (enclosures.any()) closed_parts.remove_null_part(null_vector.span(), solution.span());

  // S^-1 U.
  const auto matrix = laplacian_of<Dim>(*mac.splines, unknown_site.span(), unknown_neighbour.span(), conductance.span(),
                                        diagonal.span());
  MotionColumns response(motions.count(), solution.size());
  for (std::size_t k = 0; k < response.blocks(); ++k) {
    const SolveReport done =
        solver->solve(matrix, null_vector.span(), tolerance->relative, fluxes.columns.block(k), response.block(k));
    report->iterations += done.iterations;
    report->residual = std::max(report->residual, done.residual);
    // Or x^T U would depend on which of its solutions this is.
    if (enclosures.any()) closed_parts.remove_null_part(null_vector.span(), response.block(k));
  }
  const auto transposed_times = [&](Which which) {
    return fluxes.transposed_times([&](std::size_t l) { return solution[l][which]; });
  };
  const auto correct = [&](Which which, const Eigen::VectorXd& change, const Eigen::VectorXd& pi) {
    for_each_row(solution.size(), [&](std::size_t l) {
      for (Eigen::Index k = 0; k < motions.count(); ++k) solution[l][which] += response.at(k, l) * change[k];
      if (!enclosures.any()) return;
      if (const auto row = enclosures.row_of(closed_parts.number(l))) solution[l][which] += pi[*row] * null_vector[l];
    });
  };

  std::vector<Vec<Dim>> body_force;
  const Instant now = instant_of(ode, rates);
  Arguments arguments(now);
  for (std::size_t b = 0; b < set->bodies.size(); ++b)
    body_force.push_back(vector_at<Dim>(force->of_place_and_time, arguments.at<Dim>(c_middle[b])));
  const double tau = rates->velocity / rates->acceleration;
  BodyBalances balances = balances_of<Dim>(*set, motions, at, R_middle.span(), body_force, tau);
  const Eigen::MatrixXd own = balances.mass;
  Eigen::MatrixXd attached_mass = Eigen::MatrixXd::Zero(own.rows(), own.cols());
  Eigen::VectorXd attached_impulse = Eigen::VectorXd::Zero(own.rows());
  for_each_attached<Dim>(places, motions, c_middle.span(),
                         {mac.site.span(), attached.span(), attached_to.span(), of_ranks(shared)},
                         [&](std::size_t i, Eigen::Index axis, const Eigen::VectorXd& along) {
                           attached_mass += attached[i][axis] * along * along.transpose();
                           attached_impulse += tau * attached[i][axis] * b_f[i][axis] * along;
                         });
  add_up_on_all(of_ranks(shared), entries_of(attached_mass));
  add_up_on_all(of_ranks(shared), entries_of(attached_impulse));
  balances.mass += attached_mass;
  balances.impulse += attached_impulse;
  for (std::size_t b = 0; b < set->bodies.size(); ++b)
    motions.for_each_of(b, [&](Eigen::Index k, int c) { balances.impulse[k] += tau / clock->step * J_b[b][c]; });
  for (std::size_t b = 0; set->rubs && b < set->bodies.size(); ++b)
    motions.for_each_of(b, [&](Eigen::Index k, int c) { balances.impulse[k] += tau * friction->of[b][c]; });
  for (std::size_t b = 0; lines && b < set->bodies.size(); ++b)
    motions.for_each_of(b, [&](Eigen::Index k, int c) { balances.impulse[k] += tau * lines->of[b][c]; });
  // G = M + U^T S^-1 U: the mass of the bodies, and of the liquid that they carry along.
  Eigen::MatrixXd G = balances.mass;
  for (Eigen::Index k = 0; k < motions.count(); ++k)
    G.col(k) += fluxes.transposed_times([&](std::size_t l) { return response.at(k, l); });
  G = at_least(own, 0.5 * (G + G.transpose()));
  // The pressure in an enclosure, x = pi n with pi = s (N q + r), as if the liquid yielded by 1e-8 of what the mass of
  // the bodies does: all motions stay unknowns.
  const Eigen::MatrixXd stiffness = enclosures.stiffness(G);
  G += stiffness * enclosures.N;
  const auto pressures = [&](const Eigen::VectorXd& q, const Eigen::VectorXd& r) -> Eigen::VectorXd {
    Eigen::VectorXd pi = enclosures.N * q + r;
    for (Eigen::Index k = 0; k < pi.size(); ++k) pi[k] *= stiffness.col(k).norm() / enclosures.N.row(k).norm();
    return pi;
  };
  const auto squeezed = [&](Which which) {
    return enclosures.sums(null_vector.span(), closed_parts, [&](std::size_t l) { return source[l][which]; });
  };
  const Eigen::MatrixXd inverse = inverse_of(G + balances.springs);

  const Eigen::VectorXd damping =
      -solve_symmetric(G, transposed_times(unknown::damping) + stiffness * squeezed(unknown::damping));
  correct(unknown::damping, damping, pressures(damping, squeezed(unknown::damping)));
  const Eigen::VectorXd start = motions.gather(V, omega) + damping;
  const Eigen::VectorXd change =
      inverse * (balances.impulse - transposed_times(unknown::balance) - stiffness * squeezed(unknown::balance));
  const std::vector<Contact> contacts =
      find_contacts<Dim>(*mac.grid, *set, motions, at, reach_of<Dim>(*set, at, clock->step, 0.1 * mac.grid->spacing));
  const auto least = least_in_balances(contacts, clock->step);
  const Eigen::VectorXd pushed = push_apart(contacts, inverse, start + change, least);
  correct(unknown::balance, change + pushed, pressures(change + pushed, squeezed(unknown::balance)));
  const Eigen::VectorXd middle = start + change + pushed;
  if (!middle.allFinite())
    throw StepRejected(fmt::format("bodies: a velocity is not finite at t = {:.6g} s", clock->time));

  for (std::size_t b = 0; b < set->bodies.size(); ++b) {
    if (set->bodies[b].free() == nullptr) continue;
    // Of the work of the impulse J = M w, J (V + w/2), push_bodies knows the first part.
    const Eigen::VectorXd impulse = balances.mass * damping;
    motions.for_each_of(b, [&](Eigen::Index k, int) { W_b[b] += 0.5 * impulse[k] * damping[k]; });
    V_mean[b] = motions.velocity_in(middle, b);
    omega_mean[b] = motions.spin_in(middle, b);
  }
  Eigen::VectorXd end = start + 2 * change;
  if constexpr (Dim == 3) turn_inertia(*set, motions, at, R_middle.span(), omega_mean.span(), clock->step, end);
  end +=
      push_apart(contacts, inverse, end, least_at_end(contacts, middle, least, 1e-6 * mac.grid->spacing / clock->step));
  for (std::size_t b = 0; b < set->bodies.size(); ++b) {
    V_end[b] = motions.velocity_in(end, b);
    omega_end[b] = motions.spin_in(end, b);
  }
}

template struct CoupleFreeBodies<2>;
template struct CoupleFreeBodies<3>;

}  // namespace minamo
