#include "systems/pressure/solve.hpp"

#include "engine/run/step_control.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <functional>

namespace minamo {

namespace {

/// Rows from which on the work of a factorization is not even estimated.
template <int Dim>
constexpr std::size_t most_rows_factorized = Dim == 2 ? 20'000 : 2'000;
/// Floating-point operations per row up to which a factorization costs less than the iteration, which takes about 12
/// to 16 steps whatever the size. In 2-D the two tie around there, and a factorization is exact.
template <int Dim>
constexpr double most_work_per_row = Dim == 2 ? 5'000 : 700;
constexpr std::int64_t most_multigrid_iterations = 300;

/// Largest |b - S x| / |b| of the right-hand sides.
template <int Dim>
double residual_of(const StaggeredLaplacian<Dim>& matrix, std::span<const Sources> b, std::span<const Sources> x) {
  using Squares = std::array<double, 2 * most_sources>;
  const Squares sum = reduce_rows(
      b.size(), Squares{},
      [&](std::size_t l) {
        Squares of_row;
        for (std::size_t s = 0; s < most_sources; ++s) {
          double r = b[l][s] - matrix.diagonal[l] * x[l][s];
          matrix.for_each_neighbour(l, [&](std::size_t m, double conductance) { r += conductance * x[m][s]; });
          of_row[2 * s] = r * r;
          of_row[2 * s + 1] = b[l][s] * b[l][s];
        }
        return of_row;
      },
      [](Squares a, const Squares& other) {
        for (std::size_t k = 0; k < a.size(); ++k) a[k] += other[k];
        return a;
      });
  double largest = 0;
  for (std::size_t s = 0; s < most_sources; ++s) {
    if (sum[2 * s + 1] > 0) largest = std::max(largest, std::sqrt(sum[2 * s] / sum[2 * s + 1]));
  }
  return largest;
}

}  // namespace

template <int Dim>
StaggeredLaplacian<Dim> laplacian_of(const Splines<Dim>& splines, std::span<const Index<Dim>> site,
                                     std::span<const typename StaggeredLaplacian<Dim>::Neighbours> neighbour,
                                     std::span<const typename StaggeredLaplacian<Dim>::Conductances> conductance,
                                     std::span<const double> diagonal) {
  StaggeredLaplacian<Dim> matrix{site, neighbour, conductance, diagonal, splines.sites(), {}};
  for (std::size_t d = 0; d < Dim; ++d) matrix.periodic[d] = splines.axis[d].periodic();
  return matrix;
}

template <int Dim>
void MultiplierSolver<Dim>::prepare(const StaggeredLaplacian<Dim>& matrix, std::span<const double> null_vector) {
  const auto rows = matrix.rows();
  closed_.find(matrix, null_vector);
  is_direct_ = rows <= most_rows_factorized<Dim> &&
               direct_.analyse(matrix) <= most_work_per_row<Dim> * static_cast<double>(rows);
  if (!is_direct_) {
    try {
      multigrid_.prepare(matrix, null_vector, closed_);
    } catch (const std::domain_error& failure) {
      throw StepRejected(fmt::format("solve: {} ({} unknowns)", failure.what(), rows));
    }
  } else if (rows > 0 && !direct_.factorize(matrix, closed_.grounded())) {
    throw StepRejected(fmt::format("solve: the matrix is not positive definite ({} unknowns)", rows));
  }
}

template <int Dim>
SolveReport MultiplierSolver<Dim>::solve(const StaggeredLaplacian<Dim>& matrix, std::span<const double> null_vector,
                                         double tolerance, std::span<const Sources> b, std::span<Sources> x,
                                         std::size_t sources) {
  if (on_ranks_) return on_ranks_(b, x, tolerance);
  const auto rows = static_cast<std::int64_t>(matrix.rows());
  SolveReport report{.unknowns = rows, .active = rows, .iterations = 0, .residual = 0};
  if (rows == 0) return report;
  if (closed_.count() > 0) {
    b_.assign(b.begin(), b.end());
    closed_.remove_null_part(null_vector, b_);
    b = b_;
  }
  if (is_direct_) {
    direct_.solve(b, x);
    report.residual = residual_of<Dim>(matrix, b, x);
  } else {
    const MultigridReport done =
        multigrid_.solve({matrix, null_vector, b, sources, tolerance}, x, most_multigrid_iterations);
    report.iterations = done.iterations;
    report.residual = done.residual;
  }
  closed_.remove_null_part(null_vector, x);
  return report;
}

template <int Dim>
void PrepareMultipliers<Dim>::operator()(Read<Splines<Dim>> splines, Read<unknown::Site<Dim>> site,
                                         Read<unknown::Neighbour<Dim>> neighbour,
                                         Read<unknown::Conductance<Dim>> conductance, Read<unknown::Diagonal> diagonal,
                                         Read<unknown::NullVector> null_vector,
                                         Write<MultiplierSolver<Dim>> solver) const {
  solver->prepare(laplacian_of<Dim>(*splines, site.span(), neighbour.span(), conductance.span(), diagonal.span()),
                  null_vector.span());
}

template <int Dim>
void SolveMultipliers<Dim>::operator()(Read<Splines<Dim>> splines, Read<SolverTolerance> tolerance,
                                       Read<unknown::Site<Dim>> site, Read<unknown::Neighbour<Dim>> neighbour,
                                       Read<unknown::Conductance<Dim>> conductance, Read<unknown::Diagonal> diagonal,
                                       Read<unknown::NullVector> null_vector, Read<unknown::Source> source,
                                       Update<MultiplierSolver<Dim>> solver, Write<unknown::Solution> solution,
                                       Write<SolveReport> report) const {
  const auto matrix = laplacian_of<Dim>(*splines, site.span(), neighbour.span(), conductance.span(), diagonal.span());
  *report = solver->solve(matrix, null_vector.span(), tolerance->relative, source.span(), solution.span());
}

template class MultiplierSolver<2>;
template class MultiplierSolver<3>;
template StaggeredLaplacian<2> laplacian_of<2>(const Splines<2>&, std::span<const Index<2>>,
                                               std::span<const StaggeredLaplacian<2>::Neighbours>,
                                               std::span<const StaggeredLaplacian<2>::Conductances>,
                                               std::span<const double>);
template StaggeredLaplacian<3> laplacian_of<3>(const Splines<3>&, std::span<const Index<3>>,
                                               std::span<const StaggeredLaplacian<3>::Neighbours>,
                                               std::span<const StaggeredLaplacian<3>::Conductances>,
                                               std::span<const double>);
template struct PrepareMultipliers<2>;
template struct PrepareMultipliers<3>;
template struct SolveMultipliers<2>;
template struct SolveMultipliers<3>;

}  // namespace minamo
