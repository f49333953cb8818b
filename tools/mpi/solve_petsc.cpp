#include "tools/mpi/solve_petsc.hpp"

#include <petscksp.h>
#include <spdlog/fmt/fmt.h>

#include <array>
#include <cmath>

namespace minamo {

namespace {

constexpr PetscInt most_iterations = 500;
/// Of the diagonal, for the multigrid's matrix in closed components: small compared to all eigenvalues of S but those
/// of the null vectors, large compared to rounding.
constexpr double to_be_definite = 1e-8;

void check(PetscErrorCode code) {
  if (code != 0) throw std::runtime_error(fmt::format("petsc: error {}", code));
}

/// Options of hypre's multigrid with which iterations grow least with size in 3-D (systems/ranks/README.md). A weak
/// threshold, for all entries are alike but at the surface; smoothing by Jacobi, which does not know where ranks end,
/// damped, for a chessboard it would only turn around. Who gives PETSc an option of that name has that.
constexpr std::array<std::array<const char*, 2>, 6> of_multigrid{{{"coarsen_type", "HMIS"},
                                                                  {"interp_type", "standard"},
                                                                  {"P_max", "6"},
                                                                  {"strong_threshold", "0.1"},
                                                                  {"relax_type_all", "Jacobi"},
                                                                  {"relax_weight_all", "0.8"}}};

void set_options_of_multigrid() {
  for (const auto& [name, value] : of_multigrid) {
    const std::string option = fmt::format("-minamo_pc_hypre_boomeramg_{}", name);
    PetscBool is_given = PETSC_FALSE;
    check(PetscOptionsHasName(nullptr, nullptr, option.c_str(), &is_given));
    if (is_given == PETSC_FALSE) check(PetscOptionsSetValue(nullptr, option.c_str(), value));
  }
}

/// The matrix of all ranks as one of them sees it, between the unknowns that it knows.
template <int Dim>
struct MatrixOfRanks {
  const SiteExchange& shared;
  std::span<const std::uint32_t> of_unknown;  ///< site of every unknown
  std::span<const typename unknown::Neighbour<Dim>::value_type> neighbour;
  std::span<const typename unknown::Conductance<Dim>::value_type> conductance;
  std::span<const double> diagonal, null_vector;

  StaggeredLaplacian<Dim> laplacian() const { return {{}, neighbour, conductance, diagonal}; }
};

struct Solved {
  std::int64_t iterations = 0;
  double residual = 0;  ///< |b - S x| / |b|
};

}  // namespace

/// Matrix and vectors of a step. The solver itself stays, for its options.
struct PetscSolver::Impl {
  KSP solver = nullptr;
  ::Mat matrix = nullptr;
  ::Mat definite = nullptr;  ///< of the multigrid
  ::Vec right = nullptr;
  ::Vec solution = nullptr;
  MatNullSpace null_space = nullptr;
  std::vector<std::size_t> own;  ///< unknowns that this rank answers for: its rows of the matrix and of vectors
  std::vector<PetscInt> number;  ///< of every unknown among those of all ranks; -1: no rank owns it
  PetscInt all = 0;              ///< unknowns of all ranks
  ClosedComponents closed;

  Impl() {
    check(KSPCreate(PETSC_COMM_WORLD, &solver));
    check(KSPSetType(solver, KSPCG));
    PC preconditioner = nullptr;
    check(KSPGetPC(solver, &preconditioner));
    check(PCSetType(preconditioner, PCHYPRE));
    check(PCHYPRESetType(preconditioner, "boomeramg"));
    check(KSPSetNormType(solver, KSP_NORM_UNPRECONDITIONED));
    check(KSPSetOptionsPrefix(solver, "minamo_"));
    set_options_of_multigrid();
    check(KSPSetFromOptions(solver));
  }
  ~Impl() {
    forget();
    KSPDestroy(&solver);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void forget() {
    KSPReset(solver);
    MatDestroy(&matrix);
    MatDestroy(&definite);
    VecDestroy(&right);
    VecDestroy(&solution);
    MatNullSpaceDestroy(&null_space);
  }

  template <int Dim>
  void set(const MatrixOfRanks<Dim>& of) {
    forget();
    number_unknowns(of.shared, of.of_unknown);
    closed = {};
    if (all == 0) return;
    const auto rows = static_cast<PetscInt>(own.size());
    check(MatCreateAIJ(PETSC_COMM_WORLD, rows, rows, all, all, 2 * Dim + 1, nullptr, 2 * Dim, nullptr, &matrix));
    check(MatCreateVecs(matrix, &solution, &right));
    for (const std::size_t l : own) set_row<Dim>(of, l);
    check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
    check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
    check(MatSetOption(matrix, MAT_SPD, PETSC_TRUE));
    const std::vector<std::int64_t> numbers(number.begin(), number.end());
    closed.find_on_ranks(of.laplacian(), of.null_vector, of.of_unknown, numbers, of.shared);
    set_null_space(of.null_vector);
    make_definite(of.diagonal);
    check(KSPSetOperators(solver, matrix, definite));
  }
  /// \param b    of an unknown
  /// \param use  use(unknown, x) for those that this rank owns; not called where b is zero on all ranks
  template <class SourceOf, class Use>
  Solved solve(const SourceOf& b, double tolerance, const Use& use) {
    double* values = nullptr;
    check(VecGetArray(right, &values));
    for (std::size_t k = 0; k < own.size(); ++k) values[k] = b(own[k]);
    check(VecRestoreArray(right, &values));
    if (null_space != nullptr) check(MatNullSpaceRemove(null_space, right));
    double size = 0;
    check(VecNorm(right, NORM_2, &size));
    if (size == 0) return {};
    check(KSPSetTolerances(solver, tolerance, 0, PETSC_DEFAULT, most_iterations));
    check(KSPSolve(solver, right, solution));
    PetscInt iterations = 0;
    double residual = 0;
    check(KSPGetIterationNumber(solver, &iterations));
    check(KSPGetResidualNorm(solver, &residual));
    const double* x = nullptr;
    check(VecGetArrayRead(solution, &x));
    for (std::size_t k = 0; k < own.size(); ++k) use(own[k], x[k]);
    check(VecRestoreArrayRead(solution, &x));
    return {iterations, residual / size};
  }

 private:
  void number_unknowns(const SiteExchange& shared, std::span<const std::uint32_t> of_unknown) {
    own.clear();
    for (std::size_t l = 0; l < of_unknown.size(); ++l) {
      if (shared.owns(of_unknown[l])) own.push_back(l);
    }
    all = static_cast<PetscInt>(shared.ranks().sum(static_cast<std::int64_t>(own.size())));
    auto next = static_cast<double>(shared.ranks().sum_below(static_cast<std::int64_t>(own.size()))) + 1;
    std::vector<double> one_past(shared.rows(), 0);
    for (const std::size_t l : own) one_past[of_unknown[l]] = next++;
    shared.copy_from_owner(std::span(one_past));
    number.clear();
    for (const std::uint32_t i : of_unknown) number.push_back(static_cast<PetscInt>(one_past[i]) - 1);
  }
  template <int Dim>
  void set_row(const MatrixOfRanks<Dim>& of, std::size_t l) {
    const auto set = [&](PetscInt column, double value) {
      check(MatSetValues(matrix, 1, &number[l], 1, &column, &value, INSERT_VALUES));
    };
    set(number[l], of.diagonal[l]);
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto set_neighbour = [&](std::int32_t m, bool is_below) {
        if (m == staggered::none) return;
        const auto other = static_cast<std::size_t>(m);
        if (number[other] >= 0) set(number[other], -of.conductance[is_below ? other : l][d]);
      };
      set_neighbour(of.neighbour[l][2 * d], true);
      set_neighbour(of.neighbour[l][2 * d + 1], false);
    }
  }
  /// S n = 0 where walls enclose the liquid all around: a vector for every closed component.
  void set_null_space(std::span<const double> null_vector) {
    if (closed.count() == 0) return;
    std::vector<::Vec> basis(closed.count());
    for (std::size_t k = 0; k < basis.size(); ++k) {
      check(VecDuplicate(right, &basis[k]));
      double* values = nullptr;
      check(VecGetArray(basis[k], &values));
      for (std::size_t l = 0; l < own.size(); ++l) values[l] = closed.number(own[l]) == k + 1 ? null_vector[own[l]] : 0;
      check(VecRestoreArray(basis[k], &values));
      check(VecNormalize(basis[k], nullptr));
    }
    const auto count = static_cast<PetscInt>(basis.size());
    check(MatNullSpaceCreate(PETSC_COMM_WORLD, PETSC_FALSE, count, basis.data(), &null_space));
    check(MatSetNullSpace(matrix, null_space));
    // The space holds on to the vectors.
    for (::Vec& vector : basis) check(VecDestroy(&vector));
  }
  /// With the coarse grids of a singular matrix the multigrid is not definite, by rounding, and CG gives up. What it
  /// adds along the null vectors is taken out again.
  void make_definite(std::span<const double> diagonal) {
    if (closed.count() == 0) {
      check(PetscObjectReference(reinterpret_cast<PetscObject>(matrix)));
      definite = matrix;
      return;
    }
    check(MatDuplicate(matrix, MAT_COPY_VALUES, &definite));
    for (const std::size_t l : own) {
      if (!closed.contains(l)) continue;
      check(MatSetValue(definite, number[l], number[l], to_be_definite * diagonal[l], ADD_VALUES));
    }
    check(MatAssemblyBegin(definite, MAT_FINAL_ASSEMBLY));
    check(MatAssemblyEnd(definite, MAT_FINAL_ASSEMBLY));
  }
};

template <int Dim>
void SolveMultipliersPetsc<Dim>::operator()(Read<SiteExchange> shared, Read<SolverTolerance> tolerance,
                                            Read<multiplier::Row> row, Read<unknown::Staggered> of_unknown,
                                            Read<unknown::Neighbour<Dim>> neighbour,
                                            Read<unknown::Conductance<Dim>> conductance,
                                            Read<unknown::Diagonal> diagonal, Read<unknown::NullVector> null_vector,
                                            Read<unknown::Source> source, Update<PetscSolver> solver,
                                            Write<MultiplierSolver<Dim>> again, Write<unknown::Solution> solution,
                                            Write<SolveReport> report) const {
  auto& petsc = solver->impl();
  petsc.set(MatrixOfRanks<Dim>{*shared, of_unknown.span(), neighbour.span(), conductance.span(), diagonal.span(),
                               null_vector.span()});
  // Of what follows in the step nothing changes these.
  const auto solve = [&petsc, exchange = &*shared, rows = row.size(),
                      of = of_unknown.span()](std::span<const Sources> b, std::span<Sources> x, double relative) {
    SolveReport of_step{.unknowns = petsc.all, .active = petsc.all, .iterations = 0, .residual = 0};
    std::fill(x.begin(), x.end(), Sources{});
    if (petsc.all == 0) return of_step;
    std::vector<Sources> of_site(rows, Sources{});
    for (std::size_t s = 0; s < most_sources; ++s) {
      const Solved solved = petsc.solve([&](std::size_t l) { return b[l][s]; }, relative,
                                        [&](std::size_t l, double value) { of_site[of[l]][s] = value; });
      of_step.iterations = std::max(of_step.iterations, solved.iterations);
      of_step.residual = std::max(of_step.residual, solved.residual);
    }
    exchange->copy_from_owner(std::span(of_site));
    for (std::size_t l = 0; l < x.size(); ++l) x[l] = of_site[of[l]];
    return of_step;
  };
  again->leave_to_ranks(petsc.closed, solve);
  *report = solve(source.span(), solution.span(), tolerance->relative);
}

template <int Dim>
void PetscMultiplierMatrix<Dim>::start(const Splines<Dim>&, const Graph& graph) {
  graph_ = graph;
  solver_.impl().set(MatrixOfRanks<Dim>{*graph.shared, graph.staggered, graph.neighbour, this->conductance_,
                                        this->diagonal_, graph.null_vector});
}

template <int Dim>
void PetscMultiplierMatrix<Dim>::solve(std::span<const double> b, double tolerance, std::span<double> x) {
  std::fill(x.begin(), x.end(), 0.0);
  if (solver_.impl().all == 0) return;
  std::vector<double> of_site(graph_.shared->rows(), 0.0);
  // A factorization, as one process has in 2-D, is exact. With as much as is asked for a paste that starts from rest
  // was left with residuals of 1e-6.
  constexpr double finer = 1e-2;
  solver_.impl().solve([&](std::size_t l) { return b[l]; }, finer * tolerance,
                       [&](std::size_t l, double value) { of_site[graph_.staggered[l]] = value; });
  graph_.shared->copy_from_owner(std::span(of_site));
  for (std::size_t l = 0; l < x.size(); ++l) x[l] = of_site[graph_.staggered[l]];
}

namespace {

template <int Dim>
std::unique_ptr<MultiplierMatrix<Dim>> new_petsc_matrix() {
  return std::make_unique<PetscMultiplierMatrix<Dim>>();
}

}  // namespace

void add_petsc(SystemRegistry& registry) {
  registry.add<SolveMultipliersPetsc>("solve_multipliers_petsc", OnRanks::exchanges);
  set_multipliers_of_ranks<2>(new_petsc_matrix<2>);
  set_multipliers_of_ranks<3>(new_petsc_matrix<3>);
}

PetscSolver::PetscSolver() = default;
PetscSolver::~PetscSolver() = default;
PetscSolver::PetscSolver(PetscSolver&&) noexcept = default;
PetscSolver& PetscSolver::operator=(PetscSolver&&) noexcept = default;

PetscSolver::Impl& PetscSolver::impl() {
  if (!impl_) impl_ = std::make_unique<Impl>();
  return *impl_;
}

template struct SolveMultipliersPetsc<2>;
template struct SolveMultipliersPetsc<3>;
template class PetscMultiplierMatrix<2>;
template class PetscMultiplierMatrix<3>;

}  // namespace minamo
