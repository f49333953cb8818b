#include "systems/measure/force_work.hpp"

#include "engine/schedule/parallel.hpp"
#include "systems/scene/scene.hpp"
#include "systems/time/body_force.hpp"

#include <algorithm>
#include <functional>

namespace minamo {

namespace {

bool changes_force(const System& system) {
  return std::any_of(system.access.begin(), system.access.end(), [](const Access& access) {
    return access.mode == Mode::update &&
           (access.component == face::BodyForce<2>::info.name || access.component == node::BodyForce<2>::info.name);
  });
}

bool gives_energy(const System& system) {
  return std::any_of(system.access.begin(), system.access.end(), [](const Access& access) {
    return access.mode == Mode::update && access.component == EnergyGiven::info.name;
  });
}

/// What the rows of a grid add up to in a step.
template <int Dim>
struct SumOfForces {
  double work = 0;                    ///< [J]
  double weight = 0;                  ///< [N]
  Vec<Dim> moved = Vec<Dim>::Zero();  ///< sum of m u [kg m]
};

template <int Dim>
SumOfForces<Dim> operator+(const SumOfForces<Dim>& a, const SumOfForces<Dim>& b) {
  return {a.work + b.work, a.weight + b.weight, a.moved + b.moved};
}

/// \param uniform  the body force of this step, where it is the same everywhere and has no potential
template <int Dim>
void note_work(const SumOfForces<Dim>& of, bool is_newmark, const std::optional<Vec<Dim>>& uniform,
               EnergyGiven& given) {
  given.by_forces += of.work;
  given.weight = std::max(given.weight, of.weight);
  if (!uniform) return;
  // Newmark's rule takes the means of forces at both ends of the step, and the balances hold at the end.
  for (int d = 0; d < Dim; ++d) {
    double& before = given.uniform_force[static_cast<std::size_t>(d)];
    if (is_newmark && given.has_stepped) given.by_forces += 0.5 * (before - (*uniform)[d]) * of.moved[d];
    before = (*uniform)[d];
  }
  given.has_stepped = true;
}

}  // namespace

ForceWork force_work_of(const Scene& scene, std::span<const System> systems) {
  ForceWork needed;
  needed.is_by_force = !has_potential(scene.facts.get<BodyForce>(), scene.grid.periodic);
  const auto look_at = [&](const System& system) {
    needed.is_by_force = needed.is_by_force || changes_force(system);
    needed.is_given = needed.is_given || gives_energy(system);
  };
  for (const System& system : systems) look_at(system);
  for (const ExtraSystem& extra : scene.systems) look_at(extra.system);
  needed.is_given = needed.is_given || needed.is_by_force;
  return needed;
}

template <int Dim>
void BeginEnergyGiven<Dim>::operator()(Write<EnergyGiven> given) const {
  *given = {};
}

template <int Dim>
void CountForceWork<Dim>::operator()(Read<Grid<Dim>> grid, Read<BodyForce> b, Optional<Read<NewmarkParameters>> newmark,
                                     Read<Rates> rates, Optional<Read<ode::AtBalances>> ode, Read<node::Mass> m_i,
                                     Read<node::BodyForce<Dim>> b_i, Read<node::Displacement<Dim>> u_i,
                                     Update<EnergyGiven> given) const {
  const auto potential = force_with_potential<Dim>(*grid, *b);
  const Vec<Dim> counted_by_height = potential.value_or(Vec<Dim>::Zero());
  const SumOfForces<Dim> sum = reduce_rows(
      u_i.size(), SumOfForces<Dim>{},
      [&](std::size_t i) {
        return SumOfForces<Dim>{m_i[i] * (b_i[i] - counted_by_height).dot(u_i[i]), m_i[i] * b_i[i].norm(),
                                m_i[i] * u_i[i]};
      },
      std::plus<>());
  std::optional<Vec<Dim>> uniform;
  if (!potential && b->is_uniform()) uniform = uniform_force<Dim>(*b, instant_of(ode, rates));
  note_work<Dim>(sum, static_cast<bool>(newmark), uniform, *given);
}

template <int Dim>
void CountFaceForceWork<Dim>::operator()(
    Read<Grid<Dim>> grid, Read<BodyForce> b, Optional<Read<NewmarkParameters>> newmark, Read<Rates> rates,
    Optional<Read<ode::AtBalances>> ode, Optional<Read<particle::BodyForce<Dim>>> b_p, Read<particle::Mass> m_p,
    Optional<Read<particle::Shift<Dim>>> d_p, Optional<Read<particle::Stir<Dim>>> s_p, Read<face::Held> held,
    Read<face::Mass<Dim>> m_f, Read<face::BodyForce<Dim>> b_f, Read<face::Displacement<Dim>> u_f,
    Optional<Read<SiteExchange>> shared, Update<EnergyGiven> given) const {
  const auto potential = force_with_potential<Dim>(*grid, *b);
  const Vec<Dim> counted_by_height = potential.value_or(Vec<Dim>::Zero());
  SumOfForces<Dim> sum = reduce_rows(
      u_f.size(), SumOfForces<Dim>{},
      [&](std::size_t i) {
        SumOfForces<Dim> of;
        if (!owns(of_ranks(shared), i)) return of;
        for (int d = 0; d < Dim; ++d) {
          if ((held[i] >> d & 1) != 0) continue;
          of.moved[d] = m_f[i][d] * u_f[i][d];
          of.work += (b_f[i][d] - counted_by_height[d]) * of.moved[d];
          of.weight += m_f[i][d] * std::abs(b_f[i][d]);
        }
        return of;
      },
      std::plus<>());
  std::optional<Vec<Dim>> uniform;
  if (!potential && b->is_uniform()) uniform = uniform_force<Dim>(*b, instant_of(ode, rates));
  if (!potential && d_p && s_p) {
    sum.work += reduce_rows(
        m_p.size(), 0.0, [&](std::size_t p) { return m_p[p] * (uniform ? *uniform : b_p[p]).dot(d_p[p] + s_p[p]); },
        std::plus<>());
  }
  if (shared) {
    sum.work = shared->ranks().sum(sum.work);
    sum.weight = shared->ranks().sum(sum.weight);
    shared->ranks().sum(std::span<double>(sum.moved.data(), Dim));
  }
  note_work<Dim>(sum, static_cast<bool>(newmark), uniform, *given);
}

template struct BeginEnergyGiven<2>;
template struct BeginEnergyGiven<3>;
template struct CountForceWork<2>;
template struct CountForceWork<3>;
template struct CountFaceForceWork<2>;
template struct CountFaceForceWork<3>;

}  // namespace minamo
