#include "systems/viscosity/solve_umfpack.hpp"

#include "systems/pressure/solve.hpp"

#include <algorithm>

namespace minamo {

namespace {

/// ClosedComponents' own is for right-hand sides side by side.
void remove_null_part(const ClosedComponents& closed, std::span<const double> null_vector, std::vector<double>& x) {
  std::vector<unknown::Sources> side_by_side(x.size(), unknown::Sources{});
  for (std::size_t l = 0; l < x.size(); ++l) side_by_side[l][0] = x[l];
  closed.remove_null_part(null_vector, side_by_side);
  for (std::size_t l = 0; l < x.size(); ++l) x[l] = side_by_side[l][0];
}

/// A row of every closed component, and how large its entry on the diagonal is to be.
std::vector<Grounded> grounded_rows(const ClosedComponents& closed, double tau, std::span<const double> diagonal) {
  std::vector<Grounded> rows;
  for (const std::uint32_t l : closed.grounded()) rows.push_back({l, tau * diagonal[l]});
  return rows;
}

/// (m/tau) (v* + w); zero at faces that walls hold.
template <int Dim>
std::vector<Vec<Dim>> momentum(double per_tau, std::span<const Vec<Dim>> mobility, std::span<const Vec<Dim>> predictor,
                               std::span<const Vec<Dim>> damping) {
  std::vector<Vec<Dim>> force(mobility.size());
  for_each_row(force.size(), [&](std::size_t i) {
    const Vec<Dim> mass = mobility[i].unaryExpr([](double per_mass) { return per_mass > 0 ? 1 / per_mass : 0; });
    force[i] = per_tau * mass.cwiseProduct(predictor[i] + damping[i]);
  });
  return force;
}

/// Minus one of the sources, what a velocity is to have as divergence.
std::vector<double> divergence_of(std::span<const unknown::Sources> source, unknown::Which which) {
  std::vector<double> divergence(source.size());
  for_each_row(source.size(), [&](std::size_t l) { divergence[l] = -source[l][which]; });
  return divergence;
}

void set_force(std::span<const double> of_unknown, std::span<const std::uint32_t> staggered, std::span<double> lambda) {
  for_each_row(lambda.size(), [&](std::size_t i) { lambda[i] = 0; });
  for_each_row(of_unknown.size(), [&](std::size_t l) { lambda[staggered[l]] = of_unknown[l]; });
}

}  // namespace

template <int Dim>
void SolveFacesUmfpack<Dim>::operator()(Read<Rates> rates, Uses<MacGrid<Dim>> mac, Read<face::Mobility<Dim>> mobility,
                                        Read<face::Predictor<Dim>> predictor, Read<unknown::Staggered> of_unknown,
                                        Read<unknown::Site<Dim>> unknown_site,
                                        Read<unknown::Neighbour<Dim>> unknown_neighbour,
                                        Read<unknown::Conductance<Dim>> conductance, Read<unknown::Diagonal> diagonal,
                                        Read<unknown::NullVector> null_vector, Read<unknown::Source> source,
                                        Write<WholeMatrices<Dim>> matrices, Write<face::BalanceVelocity<Dim>> v_f,
                                        Write<face::Damping<Dim>> damping, Write<face::Shift<Dim>> shift,
                                        Write<multiplier::Force> lambda, Write<SolveReport> report) const {
  const double per_tau = rates->acceleration / rates->velocity;
  ClosedComponents closed;
  closed.find(laplacian_of<Dim>(*mac.splines, unknown_site.span(), unknown_neighbour.span(), conductance.span(),
                                diagonal.span()),
              null_vector.span());
  WholeMatrix<Dim>& matrix = matrices->frictionless;
  matrix.start(Incidence<Dim>(mac), mobility.span(), per_tau, of_unknown.span(),
               grounded_rows(closed, 1 / per_tau, diagonal.span()));
  matrix.factorize();

  std::vector<unknown::Sources> sources(source.span().begin(), source.span().end());
  if (closed.count() > 0) closed.remove_null_part(null_vector.span(), sources);
  std::vector<double> of_unknown_row(sources.size());
  double residual = 0;
  const auto solve = [&](std::span<const Vec<Dim>> force, std::span<const double> divergence, std::span<Vec<Dim>> v) {
    *report = matrix.solve(force, divergence, v, of_unknown_row);
    residual = report->residual = std::max(residual, report->residual);
  };
  solve({}, divergence_of(sources, unknown::damping), damping.span());
  solve({}, divergence_of(sources, unknown::volume), shift.span());
  solve(momentum<Dim>(per_tau, mobility.span(), predictor.span(), damping.span()), {}, v_f.span());
  remove_null_part(closed, null_vector.span(), of_unknown_row);
  set_force(of_unknown_row, of_unknown.span(), lambda.span());
}

template <int Dim>
void SolveFrictionUmfpack<Dim>::operator()(
    Read<Rates> rates, Uses<MacGrid<Dim>> mac, Read<FrictionMatrices<Dim>> friction, Read<GridCells<Dim>> cells,
    Read<CellSites> sites, Read<face::Mobility<Dim>> mobility, Read<cell::Viscosity> mu_c,
    Read<face::Predictor<Dim>> predictor, Read<face::Damping<Dim>> damping, Read<unknown::Staggered> of_unknown,
    Read<unknown::Site<Dim>> unknown_site, Read<unknown::Neighbour<Dim>> unknown_neighbour,
    Read<unknown::Conductance<Dim>> conductance, Read<unknown::Diagonal> diagonal,
    Read<unknown::NullVector> null_vector, Update<WholeMatrices<Dim>> matrices, Update<face::BalanceVelocity<Dim>> v_f,
    Update<multiplier::Force> lambda, Update<SolveReport> report) const {
  const double per_tau = rates->acceleration / rates->velocity;
  ClosedComponents closed;
  closed.find(laplacian_of<Dim>(*mac.splines, unknown_site.span(), unknown_neighbour.span(), conductance.span(),
                                diagonal.span()),
              null_vector.span());
  WholeMatrix<Dim>& matrix = matrices->with_friction;
  matrix.start(Incidence<Dim>(mac), mobility.span(), per_tau, of_unknown.span(),
               grounded_rows(closed, 1 / per_tau, diagonal.span()));
  matrix.add({*mac.splines, *friction, *cells, *sites, mu_c.span()});
  matrix.factorize();
  const std::vector<Vec<Dim>> force = momentum<Dim>(per_tau, mobility.span(), predictor.span(), damping.span());
  std::vector<double> of_unknown_row(of_unknown.size());
  const double before = report->residual;
  *report = matrix.solve(force, {}, v_f.span(), of_unknown_row);
  report->residual = std::max(report->residual, before);
  remove_null_part(closed, null_vector.span(), of_unknown_row);
  set_force(of_unknown_row, of_unknown.span(), lambda.span());
}

template struct SolveFacesUmfpack<2>;
template struct SolveFacesUmfpack<3>;
template struct SolveFrictionUmfpack<2>;
template struct SolveFrictionUmfpack<3>;

}  // namespace minamo
