#include "systems/solve/block.hpp"

#include "systems/solve/compact_pressure.hpp"
#include "systems/solve/equations.hpp"
#include "systems/solve/monolithic.hpp"
#include "systems/solve/pressure_preconditioner.hpp"
#include "systems/solve/pressure_schur.hpp"
#include "systems/solve/umfpack.hpp"
#include "systems/solve/velocity_block.hpp"

#include <algorithm>
#include <limits>

namespace minamo {

template <int Dim>
struct BlockFactors<Dim>::Impl {
  EquationTerms<Dim> terms{};
  PressureSchur<Dim> schur;
  CompactPressure<Dim> compact;
  VelocityBlock<Dim> velocity_block;
  PressurePreconditioner<Dim> preconditioner;
  Gmres gmres;
  UmfpackFactors direct;
  matrix::Pattern direct_pattern;
  std::vector<double> direct_values;
  bool is_direct = false;  ///< whether it was UMFPACK that solved the step
  Values momentum;         ///< right-hand sides
  Values mass;
  Values displacement;
  Values pressure;
  // Work space.
  Values more_displacement, f, of_velocity;
  Values more_pressure, g, zero, unscaled;
};

template <int Dim>
BlockFactors<Dim>::BlockFactors() : impl(std::make_unique<Impl>()) {}
template <int Dim>
BlockFactors<Dim>::~BlockFactors() = default;

namespace {

constexpr int most_passes = 60;

/// About what whole factors cost, if there are none, or what UMFPACK costs: many iterations in space, where its factors
/// fill in.
template <int Dim>
std::int64_t most_iterations(const PressurePreconditioner<Dim>& preconditioner) {
  return Dim == 3 && !preconditioner.is_incomplete() ? 500 : 100;
}

template <int Dim>
using Impl = typename BlockFactors<Dim>::Impl;

/// Solves s S p = g, s the scale of a residual, and sets u = A^-1 (f + D^T p), with A as the velocity block solves
/// with. \param target  for the residual
template <int Dim>
Gmres::Report eliminate(Impl<Dim>& s, const Values& f, const Values& g, double target, Gmres::Start start, Values& u,
                        Values& p) {
  auto& schur = s.schur;
  const auto apply = [&](const Values& x, Values& out, double allowed) {
    if (s.velocity_block.is_mobility()) {
      schur.apply_with_mobility(x, out);
    } else {
      schur.push(x, s.of_velocity);
      // An error r of momentum becomes one of s B A^-1 r, B about c_v D, and s S s, S about B A^-1 D^T, about one.
      s.velocity_block.solve(s.of_velocity, allowed / std::sqrt(s.terms.c_v));
      schur.spread(s.of_velocity, x, out);
    }
    for_each_row(out.size(), [&](std::size_t r) { out[r] *= s.compact.scale()[r]; });
  };
  const auto precondition = [&](const Values& r, Values& out) {
    for_each_row(r.size(), [&](std::size_t i) { s.unscaled[i] = r[i] / s.compact.scale()[i]; });
    s.preconditioner.solve(s.unscaled, out);
  };
  const auto report = s.gmres.solve(apply, precondition, g, target, most_iterations(s.preconditioner), start, p);
  schur.push(p, u);
  add_scaled(1, f, u);
  s.velocity_block.solve(u, 0);
  return report;
}

/// g = s (mass - B (u + A^-1 f) - T p)
template <int Dim>
void reduce(Impl<Dim>& s, const Values& f, const Values& u, const Values& p, Values& g) {
  s.of_velocity = f;
  s.velocity_block.solve(s.of_velocity, 0);
  add_scaled(1, u, s.of_velocity);
  s.schur.spread(s.of_velocity, p, g);
  for_each_row(g.size(), [&](std::size_t r) { g[r] = s.compact.scale()[r] * (s.mass[r] - g[r]); });
}

/// The square of the motion that a momentum is worth, f A^-1 f with the mobility for A^-1.
template <int Dim>
double motion_by(const Impl<Dim>& s, const Values& f) {
  return weighted_square(s.schur.mobility(), f);
}

/// u A u. Walls hold what has no mobility.
template <int Dim>
double motion_of(const Impl<Dim>& s, const Values& u) {
  const Values& mobility = s.schur.mobility();
  return reduce_rows(
      u.size(), 0.0, [&](std::size_t i) { return mobility[i] > 0 ? u[i] * u[i] / mobility[i] : 0; }, std::plus<>());
}

/// Solves for displacement and pressure from the right-hand sides in momentum and mass. A diagonal velocity block is
/// not quite that of a viscous liquid: passes over what it leaves follow, each as exact as the block allows, until both
/// balances are met. What shear leaves in the one over momentum has no divergence and is not seen in that over mass.
/// Iterations are followed by passes, too, until what they have left is found to be small; it may stop falling above
/// the target where nearly all of the motion is free of divergence, so that rounding is what the target is a part of.
template <int Dim>
Gmres::Report solve_blocks(Impl<Dim>& s, double tolerance, Gmres::Start start) {
  std::fill(s.displacement.begin(), s.displacement.end(), 0.0);
  if (std::all_of(s.momentum.begin(), s.momentum.end(), [](double f) { return f == 0; })) {
    for_each_row(s.g.size(), [&](std::size_t r) { s.g[r] = s.compact.scale()[r] * s.mass[r]; });
  } else {
    reduce<Dim>(s, s.momentum, s.displacement, s.zero, s.g);
  }
  const double norm = std::sqrt(dot(s.g, s.g));
  const double left_by_block = s.velocity_block.error();
  const double target = tolerance * norm;
  Gmres::Report report =
      eliminate<Dim>(s, s.momentum, s.g, std::max(target, left_by_block * norm), start, s.displacement, s.pressure);
  s.more_displacement = s.displacement;
  const double all_motion = left_by_block > 0 ? motion_by<Dim>(s, s.momentum) + motion_of<Dim>(s, s.displacement) : 0;
  const double motion_target = tolerance * tolerance * all_motion;
  double left_before = std::numeric_limits<double>::infinity();
  for (int pass = 0; left_by_block > 0 && report.converged; ++pass) {
    s.velocity_block.find_rest(s.more_displacement, s.f);
    reduce<Dim>(s, s.f, s.displacement, s.pressure, s.g);
    const double left = std::sqrt(dot(s.g, s.g));
    const double left_of_motion = motion_by<Dim>(s, s.f);
    const bool is_as_small_as_it_gets = left <= target || left > 0.5 * left_before;
    if (s.velocity_block.is_iteration() && left_of_motion <= motion_target && is_as_small_as_it_gets) {
      s.displacement = s.of_velocity;  // whose balance that is
      report.residual = left;
      break;
    }
    left_before = left;
    const auto more = eliminate<Dim>(s, s.f, s.g, std::max(target, left_by_block * left), Gmres::Start::zero,
                                     s.more_displacement, s.more_pressure);
    add_scaled(1, s.more_displacement, s.displacement);
    add_scaled(1, s.more_pressure, s.pressure);
    report.iterations += more.iterations;
    report.residual = more.residual;
    const double rest = left_by_block * left_by_block * left_of_motion;
    const bool is_balanced = left_by_block * left <= target && rest <= motion_target;
    if (more.converged && is_balanced && !s.velocity_block.is_iteration()) break;
    report.converged = more.converged && pass < most_passes;
  }
  if (norm > 0) report.residual /= norm;
  return report;
}

template <int Dim>
void prepare(Impl<Dim>& s, const EquationTerms<Dim>& terms, const Grid<Dim>& grid, const Fluid& fluid,
             const matrix::StabilizationScale& scale, const Rates& rates, WholeFactors& whole) {
  s.schur.assemble(terms, grid);
  s.compact.assemble(terms, grid, fluid, laplacian_factor(rates, fluid, scale), s.schur);
  s.velocity_block.prepare(terms, s.schur);
  s.preconditioner.prepare(s.compact, s.schur, terms, viscous_part<Dim>(terms, grid, fluid, scale), whole);
  const std::size_t n = s.schur.rows();
  for (Values* v : {&s.mass, &s.pressure, &s.more_pressure, &s.g, &s.zero, &s.unscaled}) v->resize(n);
  std::fill(s.zero.begin(), s.zero.end(), 0.0);
  for (Values* v : {&s.momentum, &s.displacement, &s.more_displacement, &s.f, &s.of_velocity}) v->resize(Dim * n);
}

template <int Dim>
void take_right_hand_side(Impl<Dim>& s, const std::vector<double>& b) {
  for_each_row(s.mass.size(), [&](std::size_t r) {
    const double* row = b.data() + unknowns_per_row(Dim) * r;
    for (std::size_t d = 0; d < Dim; ++d) s.momentum[Dim * r + d] = row[d];
    s.mass[r] = row[Dim];
  });
}

template <int Dim>
void give_solution(const Impl<Dim>& s, std::vector<double>& x) {
  x.resize(unknowns_per_row(Dim) * s.mass.size());
  for_each_row(s.mass.size(), [&](std::size_t r) {
    double* row = x.data() + unknowns_per_row(Dim) * r;
    for (std::size_t d = 0; d < Dim; ++d) row[d] = s.displacement[Dim * r + d];
    row[Dim] = s.pressure[r];
  });
}

/// The monolithic system, where the iteration has failed: rare, and what UMFPACK is for.
template <int Dim>
SolveReport solve_directly(const Grid<Dim>& grid, const EquationTerms<Dim>& terms, const std::vector<double>& b,
                           Impl<Dim>& s, std::vector<double>& x) {
  fill_monolithic<Dim>(terms, grid, s.direct_pattern, s.direct_values);
  return solve_monolithic(s.direct, s.direct_pattern, s.direct_values, b, x);
}

bool is_solved(const Gmres::Report& report) { return report.converged && std::isfinite(report.residual); }

template <int Dim>
SolveReport solve(const Grid<Dim>& grid, const Fluid& fluid, double tolerance, const matrix::StabilizationScale& scale,
                  const Rates& rates, const EquationTerms<Dim>& terms, std::span<const double> p_i,
                  const std::vector<double>& b, WholeFactors& whole, Impl<Dim>& s, std::vector<double>& x) {
  s.terms = terms;
  s.is_direct = false;
  prepare<Dim>(s, terms, grid, fluid, scale, rates, whole);
  take_right_hand_side<Dim>(s, b);
  // The pressure of the step before is near.
  for_each_row(s.pressure.size(), [&](std::size_t r) { s.pressure[r] = p_i[terms.node[r]]; });
  Gmres::Report done = solve_blocks<Dim>(s, tolerance, Gmres::Start::x);
  if (!is_solved(done) && s.preconditioner.complete(s.compact, s.schur, whole)) {
    const std::int64_t before = done.iterations;
    done = solve_blocks<Dim>(s, tolerance, Gmres::Start::zero);
    done.iterations += before;
  }
  if (!is_solved(done)) {
    s.is_direct = true;
    SolveReport report = solve_directly<Dim>(grid, terms, b, s, x);
    report.iterations = done.iterations;
    return report;
  }
  give_solution<Dim>(s, x);
  return {.unknowns = static_cast<std::int64_t>(b.size()), .iterations = done.iterations, .residual = done.residual};
}

}  // namespace

template <int Dim>
void solve_again(BlockFactors<Dim>& factors, const std::vector<double>& b, const Grid<Dim>& grid, double tolerance,
                 std::vector<double>& x) {
  Impl<Dim>& s = *factors.impl;
  if (s.is_direct) return solve_again(s.direct, b, x);
  take_right_hand_side<Dim>(s, b);
  if (is_solved(solve_blocks<Dim>(s, tolerance, Gmres::Start::zero))) {
    give_solution<Dim>(s, x);
  } else {
    solve_directly<Dim>(grid, s.terms, b, s, x);
  }
}

template <int Dim>
void SolveBlock<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Fluid> fluid, Read<Rates> rates,
                                 Read<SolverTolerance> tolerance, Read<node::Row> row, Read<node::Constraint> fixed,
                                 Read<node::Mass> m_i, Read<node::Pressure> p_i, Read<NodeIndex<Dim>> rows,
                                 Read<node::Site<Dim>> site, Read<matrix::Node> node,
                                 Read<matrix::Divergence<Dim>> divergence,
                                 Read<matrix::Stabilization<Dim>> stabilization, Read<matrix::StabilizationScale> scale,
                                 Read<matrix::RightHandSide> right_hand_side, Update<WholeFactors> whole,
                                 Update<BlockFactors<Dim>> factors, Write<matrix::Solution> solution,
                                 Write<SolveReport> report) const {
  const EquationTerms<Dim> terms{rates->velocity,
                                 rates->acceleration,
                                 pressure_per_mass(clock->step, fluid->density, grid->spacing),
                                 row.span(),
                                 fixed.span(),
                                 m_i.span(),
                                 site.span(),
                                 &*rows,
                                 node.span(),
                                 divergence.span(),
                                 stabilization.span(),
                                 {}};
  *report = solve<Dim>(*grid, *fluid, tolerance->relative, *scale, *rates, terms, p_i.span(), right_hand_side->values,
                       *whole, *factors->impl, solution->values);
}

template <int Dim>
void SolveBlockViscous<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Fluid> fluid, Read<Rates> rates,
                                        Read<SolverTolerance> tolerance, Read<node::Row> row,
                                        Read<node::Constraint> fixed, Read<node::Mass> m_i, Read<node::Pressure> p_i,
                                        Read<NodeIndex<Dim>> rows, Read<node::Site<Dim>> site, Read<matrix::Node> node,
                                        Read<matrix::Divergence<Dim>> divergence,
                                        Read<matrix::Stabilization<Dim>> stabilization,
                                        Read<matrix::StabilizationScale> scale, Read<matrix::Viscosity<Dim>> viscosity,
                                        Read<matrix::RightHandSide> right_hand_side, Update<WholeFactors> whole,
                                        Update<BlockFactors<Dim>> factors, Write<matrix::Solution> solution,
                                        Write<SolveReport> report) const {
  const EquationTerms<Dim> terms{rates->velocity,
                                 rates->acceleration,
                                 pressure_per_mass(clock->step, fluid->density, grid->spacing),
                                 row.span(),
                                 fixed.span(),
                                 m_i.span(),
                                 site.span(),
                                 &*rows,
                                 node.span(),
                                 divergence.span(),
                                 stabilization.span(),
                                 viscosity.span()};
  *report = solve<Dim>(*grid, *fluid, tolerance->relative, *scale, *rates, terms, p_i.span(), right_hand_side->values,
                       *whole, *factors->impl, solution->values);
}

template struct BlockFactors<2>;
template struct BlockFactors<3>;
template struct SolveBlock<2>;
template struct SolveBlock<3>;
template struct SolveBlockViscous<2>;
template struct SolveBlockViscous<3>;
template void solve_again(BlockFactors<2>&, const std::vector<double>&, const Grid<2>&, double, std::vector<double>&);
template void solve_again(BlockFactors<3>&, const std::vector<double>&, const Grid<3>&, double, std::vector<double>&);

}  // namespace minamo
