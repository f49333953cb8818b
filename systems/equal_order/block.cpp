#include "systems/equal_order/block.hpp"

#include "systems/equal_order/monolithic.hpp"

#include <algorithm>
#include <limits>

namespace minamo {

namespace {

constexpr int most_passes = 60;

/// About what whole factors cost.
constexpr std::int64_t most_iterations = 100;

/// What the solves of a step look at.
template <int Dim>
struct BlockSystem {
  const SchurOperator<Dim>& schur;
  const VelocityFactors<Dim>& velocity;
  typename VelocityFactors<Dim>::Matrix of_velocity;
  PressureFactors<Dim>& preconditioner;
  BlockWork<Dim>& work;

  /// u = A^-1 u
  void solve_for_velocity(Values& u, double target) const { velocity.solve(of_velocity, u, target, work.velocity); }
};

template <int Dim>
void prepare(const SchurOperator<Dim>& schur, BlockWork<Dim>& w) {
  const std::size_t n = schur.rows();
  for (Values* v : {&w.mass, &w.pressure, &w.more_pressure, &w.g, &w.zero, &w.unscaled}) v->resize(n);
  std::fill(w.zero.begin(), w.zero.end(), 0.0);
  for (Values* v : {&w.momentum, &w.displacement, &w.more_displacement, &w.f, &w.of_velocity}) v->resize(Dim * n);
}

/// Solves s S p = g, s the scale of a residual, and sets u = A^-1 (f + D^T p), with A as the velocity block solves
/// with. \param target  for the residual
template <int Dim>
Gmres::Report eliminate(const BlockSystem<Dim>& s, const Values& f, const Values& g, double target, Gmres::Start start,
                        Values& u, Values& p) {
  const Values& scale = s.preconditioner.scale();
  const auto apply = [&](const Values& x, Values& out, double allowed) {
    if (s.velocity.is_diagonal()) {
      s.schur.apply_with_diagonal(x, s.work.products, out);
    } else {
      s.schur.apply_gradient(x, s.work.products, s.work.of_velocity);
      // An error r of momentum becomes one of s B A^-1 r, B about c_v D, and s S s, S about B A^-1 D^T, about one.
      s.solve_for_velocity(s.work.of_velocity, allowed / std::sqrt(s.schur.coefficients().c_v));
      s.schur.apply_divergence(s.work.of_velocity, x, s.work.products, out);
    }
    for_each_row(out.size(), [&](std::size_t r) { out[r] *= scale[r]; });
  };
  const auto precondition = [&](const Values& r, Values& out) {
    for_each_row(r.size(), [&](std::size_t i) { s.work.unscaled[i] = r[i] / scale[i]; });
    s.preconditioner.solve(s.work.unscaled, out);
  };
  const auto report = s.work.gmres.solve(apply, precondition, g, target, most_iterations, start, p);
  s.schur.apply_gradient(p, s.work.products, u);
  add_scaled(1, f, u);
  s.solve_for_velocity(u, 0);
  return report;
}

/// g = s (mass - B (u + A^-1 f) - T p)
template <int Dim>
void reduce(const BlockSystem<Dim>& s, const Values& f, const Values& u, const Values& p, Values& g) {
  Values& v = s.work.of_velocity;
  v = f;
  s.solve_for_velocity(v, 0);
  add_scaled(1, u, v);
  s.schur.apply_divergence(v, p, s.work.products, g);
  for_each_row(g.size(), [&](std::size_t r) { g[r] = s.preconditioner.scale()[r] * (s.work.mass[r] - g[r]); });
}

/// The square of the motion that a momentum is worth, f A^-1 f with the inverse_diagonal for A^-1.
template <int Dim>
double motion_by(const BlockSystem<Dim>& s, const Values& f) {
  return weighted_square(s.schur.inverse_diagonal(), f);
}

/// u A u. Walls hold what has no inverse_diagonal.
template <int Dim>
double motion_of(const BlockSystem<Dim>& s, const Values& u) {
  const Values& inverse_diagonal = s.schur.inverse_diagonal();
  return reduce_rows(
      u.size(), 0.0, [&](std::size_t i) { return inverse_diagonal[i] > 0 ? u[i] * u[i] / inverse_diagonal[i] : 0; },
      std::plus<>());
}

/// Solves for displacement and pressure from the right-hand sides in momentum and mass. A diagonal velocity block is
/// not quite that of a viscous liquid: passes over what it leaves follow, each as exact as the block allows, until both
/// balances are met. What shear leaves in the one over momentum has no divergence and is not seen in that over mass.
/// Iterations are followed by passes, too, until what they have left is found to be small; it may stop falling above
/// the target where nearly all of the motion is free of divergence, so that rounding is what the target is a part of.
template <int Dim>
Gmres::Report solve_blocks(const BlockSystem<Dim>& s, double tolerance, Gmres::Start start) {
  BlockWork<Dim>& w = s.work;
  std::fill(w.displacement.begin(), w.displacement.end(), 0.0);
  if (std::all_of(w.momentum.begin(), w.momentum.end(), [](double f) { return f == 0; })) {
    for_each_row(w.g.size(), [&](std::size_t r) { w.g[r] = s.preconditioner.scale()[r] * w.mass[r]; });
  } else {
    reduce<Dim>(s, w.momentum, w.displacement, w.zero, w.g);
  }
  const double norm = std::sqrt(dot(w.g, w.g));
  const double left_by_block = s.velocity.error();
  const double target = tolerance * norm;
  Gmres::Report report =
      eliminate<Dim>(s, w.momentum, w.g, std::max(target, left_by_block * norm), start, w.displacement, w.pressure);
  w.more_displacement = w.displacement;
  const double all_motion = left_by_block > 0 ? motion_by<Dim>(s, w.momentum) + motion_of<Dim>(s, w.displacement) : 0;
  const double motion_target = tolerance * tolerance * all_motion;
  double left_before = std::numeric_limits<double>::infinity();
  for (int pass = 0; left_by_block > 0 && report.converged; ++pass) {
    s.velocity.residual(s.of_velocity, w.more_displacement, w.velocity, w.f);
    reduce<Dim>(s, w.f, w.displacement, w.pressure, w.g);
    const double left = std::sqrt(dot(w.g, w.g));
    const double left_of_motion = motion_by<Dim>(s, w.f);
    const bool is_as_small_as_it_gets = left <= target || left > 0.5 * left_before;
    if (s.velocity.is_iteration() && left_of_motion <= motion_target && is_as_small_as_it_gets) {
      w.displacement = w.of_velocity;  // whose balance that is
      report.residual = left;
      break;
    }
    left_before = left;
    const auto more = eliminate<Dim>(s, w.f, w.g, std::max(target, left_by_block * left), Gmres::Start::zero,
                                     w.more_displacement, w.more_pressure);
    add_scaled(1, w.more_displacement, w.displacement);
    add_scaled(1, w.more_pressure, w.pressure);
    report.iterations += more.iterations;
    report.residual = more.residual;
    const double rest = left_by_block * left_by_block * left_of_motion;
    const bool is_balanced = left_by_block * left <= target && rest <= motion_target;
    if (more.converged && is_balanced && !s.velocity.is_iteration()) break;
    report.converged = more.converged && pass < most_passes;
  }
  if (norm > 0) report.residual /= norm;
  return report;
}

bool is_solved(const Gmres::Report& report) { return report.converged && std::isfinite(report.residual); }

template <int Dim>
void take_displacement(const Values& from, std::span<Vec<Dim>> u) {
  for_each_row(u.size(), [&](std::size_t r) {
    for (int d = 0; d < Dim; ++d) u[r][d] = from[Dim * r + static_cast<std::size_t>(d)];
  });
}

template <int Dim>
void fall_back(const Operators<Dim>& operators, Fallback& to) {
  fill_monolithic<Dim>(operators, to.matrix);
  to.factors.factorize(to.matrix);
}

/// A shift is a correction: three digits less of it do no harm.
double shift_tolerance(const SolverTolerance& tolerance) { return std::min(1e-2, 1000 * tolerance.relative); }

}  // namespace

template <int Dim>
void AssembleSchur<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Fluid> fluid, Read<Rates> rates,
                                    Read<node::Row> row, Read<node::Constraint> fixed, Read<node::Mass> m_i,
                                    Read<matrix::Node> node, Read<matrix::Neighbour<Dim>> neighbour,
                                    Read<matrix::Divergence<Dim>> divergence,
                                    Read<matrix::Stabilization<Dim>> stabilization,
                                    Optional<Read<matrix::Viscosity<Dim>>> viscosity,
                                    Write<SchurOperator<Dim>> schur) const {
  const double e = pressure_per_mass(clock->step, fluid->density, grid->spacing);
  schur->assemble({{rates->velocity, rates->acceleration, e},
                   row.span(),
                   fixed.span(),
                   m_i.span(),
                   node.span(),
                   neighbour.span(),
                   divergence.span(),
                   stabilization.span(),
                   viscosity.span()});
}

template <int Dim>
void FactorizeVelocity<Dim>::operator()(Read<node::Mass> m_i, Read<matrix::Node> node,
                                        Optional<Read<matrix::Viscosity<Dim>>> viscosity,
                                        Read<SchurOperator<Dim>> schur, Write<VelocityFactors<Dim>> factors) const {
  factors->prepare({schur->coefficients(), {}, {}, m_i.span(), node.span(), {}, {}, {}, viscosity.span()}, *schur);
}

template <int Dim>
void FactorizePressure<Dim>::operator()(Read<Grid<Dim>> grid, Read<Fluid> fluid, Read<node::Constraint> fixed,
                                        Read<node::Mass> m_i, Read<node::Site<Dim>> site, Read<node::Capacity> capacity,
                                        Read<matrix::Node> node, Read<matrix::Divergence<Dim>> divergence,
                                        Read<matrix::StabilizationScale> scale,
                                        Optional<Read<matrix::Viscosity<Dim>>> viscosity,
                                        Read<SchurOperator<Dim>> schur, Write<PressureFactors<Dim>> factors) const {
  factors->prepare(
      {schur->coefficients(), {}, fixed.span(), m_i.span(), node.span(), {}, divergence.span(), {}, viscosity.span()},
      *schur, *grid, site.span(), capacity.span(), *fluid, *scale);
}

template <int Dim>
void SolveBlock<Dim>::operator()(Read<SolverTolerance> tolerance, Read<node::Row> row, Read<node::Constraint> fixed,
                                 Read<node::Mass> m_i, Read<node::Pressure> p_i, Read<matrix::Node> node,
                                 Read<matrix::Neighbour<Dim>> neighbour, Read<matrix::Divergence<Dim>> divergence,
                                 Read<matrix::Stabilization<Dim>> stabilization,
                                 Optional<Read<matrix::Viscosity<Dim>>> viscosity, Read<SchurOperator<Dim>> schur,
                                 Read<VelocityFactors<Dim>> velocity_factors, Read<matrix::Momentum<Dim>> f,
                                 Read<matrix::Mass> g, Update<PressureFactors<Dim>> pressure_factors,
                                 Update<BlockWork<Dim>> work, Write<Fallback> fallback,
                                 Write<matrix::Displacement<Dim>> u, Write<matrix::Pressure> p,
                                 Write<SolveReport> report) const {
  const BlockSystem<Dim> system{*schur, *velocity_factors, {*schur, viscosity.span()}, *pressure_factors, *work};
  prepare<Dim>(*schur, *work);
  for_each_row(g.size(), [&](std::size_t r) {
    for (std::size_t d = 0; d < Dim; ++d) work->momentum[Dim * r + d] = f[r][static_cast<Eigen::Index>(d)];
    work->mass[r] = g[r];
    // The pressure of the step before is near.
    work->pressure[r] = p_i[node[r]];
  });
  Gmres::Report done = solve_blocks<Dim>(system, tolerance->relative, Gmres::Start::x);
  if (!is_solved(done) && pressure_factors->complete()) {
    const std::int64_t before = done.iterations;
    done = solve_blocks<Dim>(system, tolerance->relative, Gmres::Start::zero);
    done.iterations += before;
  }
  fallback->is_used = !is_solved(done);
  if (!fallback->is_used) {
    take_displacement<Dim>(work->displacement, u.span());
    std::copy(work->pressure.begin(), work->pressure.end(), p.begin());
    *report = {.unknowns = static_cast<std::int64_t>((Dim + 1) * g.size()), .residual = done.residual};
  } else {
    fall_back<Dim>({schur->coefficients(), row.span(), fixed.span(), m_i.span(), node.span(), neighbour.span(),
                    divergence.span(), stabilization.span(), viscosity.span()},
                   *fallback);
    pack<Dim>(f.span(), g.span(), fallback->packed.b);
    fallback->factors.solve(fallback->packed.b, fallback->packed.x);
    *report = fallback->factors.report(fallback->packed.b, fallback->packed.x);
    unpack<Dim>(fallback->packed.x, u.span(), p.span());
  }
  report->active = static_cast<std::int64_t>(g.size());
  report->iterations = done.iterations;
}

template <int Dim>
void SolveVolumeBlock<Dim>::operator()(Read<SolverTolerance> tolerance, Read<node::Row> row,
                                       Read<node::Constraint> fixed, Read<node::Mass> m_i, Read<matrix::Node> node,
                                       Read<matrix::Neighbour<Dim>> neighbour, Read<matrix::Divergence<Dim>> divergence,
                                       Read<matrix::Stabilization<Dim>> stabilization,
                                       Optional<Read<matrix::Viscosity<Dim>>> viscosity, Read<SchurOperator<Dim>> schur,
                                       Read<VelocityFactors<Dim>> velocity_factors, Read<matrix::VolumeSource> g,
                                       Update<PressureFactors<Dim>> pressure_factors, Update<BlockWork<Dim>> work,
                                       Update<Fallback> fallback, Write<matrix::Shift<Dim>> d) const {
  if (!fallback->is_used) {
    const BlockSystem<Dim> system{*schur, *velocity_factors, {*schur, viscosity.span()}, *pressure_factors, *work};
    prepare<Dim>(*schur, *work);
    std::fill(work->momentum.begin(), work->momentum.end(), 0.0);
    std::copy(g.begin(), g.end(), work->mass.begin());
    if (is_solved(solve_blocks<Dim>(system, shift_tolerance(*tolerance), Gmres::Start::zero))) {
      take_displacement<Dim>(work->displacement, d.span());
      return;
    }
    fall_back<Dim>({schur->coefficients(), row.span(), fixed.span(), m_i.span(), node.span(), neighbour.span(),
                    divergence.span(), stabilization.span(), viscosity.span()},
                   *fallback);
  }
  pack<Dim>({}, g.span(), fallback->packed.b);
  fallback->factors.solve(fallback->packed.b, fallback->packed.x);
  unpack<Dim>(fallback->packed.x, d.span(), {});
}

template struct AssembleSchur<2>;
template struct AssembleSchur<3>;
template struct FactorizeVelocity<2>;
template struct FactorizeVelocity<3>;
template struct FactorizePressure<2>;
template struct FactorizePressure<3>;
template struct SolveBlock<2>;
template struct SolveBlock<3>;
template struct SolveVolumeBlock<2>;
template struct SolveVolumeBlock<3>;

}  // namespace minamo
