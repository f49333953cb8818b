#include "tools/mpi/solve_petsc.hpp"

#include <petscksp.h>
#include <spdlog/fmt/fmt.h>

#include <array>
#include <cmath>

namespace minamo {

namespace {

constexpr PetscInt most_iterations = 500;

void check(PetscErrorCode code) {
  if (code != 0) throw std::runtime_error(fmt::format("petsc: error {}", code));
}

/// Options of hypre's multigrid with which iterations grow least with size in space (systems/ranks/README.md). A weak
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

}  // namespace

/// Matrix and vectors of a step. The solver itself stays, for its options.
struct PetscSolver::Impl {
  KSP solver = nullptr;
  ::Mat matrix = nullptr;
  ::Vec right = nullptr;
  ::Vec solution = nullptr;
  MatNullSpace null_space = nullptr;

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
    VecDestroy(&right);
    VecDestroy(&solution);
    MatNullSpaceDestroy(&null_space);
  }
};

namespace {

/// The unknowns that this rank answers for, in their order: its rows of the matrix and of vectors.
std::vector<std::size_t> own_unknowns(const SiteExchange& shared, std::span<const std::uint32_t> of_unknown) {
  std::vector<std::size_t> own;
  for (std::size_t l = 0; l < of_unknown.size(); ++l) {
    if (shared.owns(of_unknown[l])) own.push_back(l);
  }
  return own;
}

/// Numbers of the unknowns among those of all ranks; none of what no rank owns. \param sites  rows of their table
std::vector<PetscInt> number_globally(const SiteExchange& shared, std::size_t sites,
                                      std::span<const std::uint32_t> of_unknown, std::span<const std::size_t> own) {
  auto next = static_cast<double>(shared.ranks().sum_below(static_cast<std::int64_t>(own.size()))) + 1;
  std::vector<double> one_past(sites, 0);
  for (const std::size_t l : own) one_past[of_unknown[l]] = next++;
  shared.copy_from_owner(std::span(one_past));
  std::vector<PetscInt> number;
  for (const std::uint32_t i : of_unknown) number.push_back(static_cast<PetscInt>(one_past[i]) - 1);
  return number;
}

/// Sets the null space where walls enclose the liquid all around: S n = 0.
void note_closed_box(PetscSolver::Impl& petsc, const SiteExchange& shared, std::span<const std::size_t> own,
                     std::span<const double> null_vector, std::span<const double> diagonal) {
  double* values = nullptr;
  double largest = 0;
  check(VecGetArray(petsc.right, &values));
  for (std::size_t k = 0; k < own.size(); ++k) {
    values[k] = null_vector[own[k]];
    largest = std::max(largest, diagonal[own[k]] * null_vector[own[k]]);
  }
  check(VecRestoreArray(petsc.right, &values));
  check(MatMult(petsc.matrix, petsc.right, petsc.solution));
  double left = 0;
  check(VecNorm(petsc.solution, NORM_INFINITY, &left));
  if (left > 1e-10 * shared.ranks().largest(largest)) return;
  check(VecNormalize(petsc.right, nullptr));
  check(MatNullSpaceCreate(PETSC_COMM_WORLD, PETSC_FALSE, 1, &petsc.right, &petsc.null_space));
  check(MatSetNullSpace(petsc.matrix, petsc.null_space));
  // The space holds on to this vector.
  check(VecDestroy(&petsc.right));
  check(MatCreateVecs(petsc.matrix, nullptr, &petsc.right));
}

}  // namespace

template <int Dim>
void SolveMultipliersPetsc<Dim>::operator()(Read<SiteExchange> shared, Read<SolverTolerance> tolerance,
                                            Read<multiplier::Row> row, Read<unknown::Staggered> of_unknown,
                                            Read<unknown::Neighbour<Dim>> neighbour,
                                            Read<unknown::Conductance<Dim>> conductance,
                                            Read<unknown::Diagonal> diagonal, Read<unknown::NullVector> null_vector,
                                            Read<unknown::Source> source, Update<PetscSolver> solver,
                                            Write<unknown::Solution> solution, Write<SolveReport> report) const {
  const std::vector<std::size_t> own = own_unknowns(*shared, of_unknown.span());
  const auto rows = static_cast<PetscInt>(own.size());
  const auto all = static_cast<PetscInt>(shared->ranks().sum(static_cast<std::int64_t>(rows)));
  const auto number = number_globally(*shared, row.size(), of_unknown.span(), own);
  *report = {.unknowns = all, .active = all, .iterations = 0, .residual = 0};
  for (auto& x : solution) x = {};
  if (all == 0) return;

  auto& petsc = solver->impl();
  petsc.forget();
  check(MatCreateAIJ(PETSC_COMM_WORLD, rows, rows, all, all, 2 * Dim + 1, nullptr, 2 * Dim, nullptr, &petsc.matrix));
  check(MatCreateVecs(petsc.matrix, &petsc.solution, &petsc.right));
  for (const std::size_t l : own) {
    const auto set = [&](PetscInt column, double value) {
      check(MatSetValues(petsc.matrix, 1, &number[l], 1, &column, &value, INSERT_VALUES));
    };
    set(number[l], diagonal[l]);
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto set_neighbour = [&](std::int32_t m, bool is_below) {
        if (m == staggered::none) return;
        const auto other = static_cast<std::size_t>(m);
        if (number[other] >= 0) set(number[other], -conductance[is_below ? other : l][d]);
      };
      set_neighbour(neighbour[l][2 * d], true);
      set_neighbour(neighbour[l][2 * d + 1], false);
    }
  }
  check(MatAssemblyBegin(petsc.matrix, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(petsc.matrix, MAT_FINAL_ASSEMBLY));
  check(MatSetOption(petsc.matrix, MAT_SPD, PETSC_TRUE));
  note_closed_box(petsc, *shared, own, null_vector.span(), diagonal.span());
  check(KSPSetOperators(petsc.solver, petsc.matrix, petsc.matrix));
  check(KSPSetTolerances(petsc.solver, tolerance->relative, 0, PETSC_DEFAULT, most_iterations));

  std::vector<Sources> of_site(row.size(), Sources{});
  for (std::size_t s = 0; s < most_sources; ++s) {
    double* values = nullptr;
    check(VecGetArray(petsc.right, &values));
    for (std::size_t k = 0; k < own.size(); ++k) values[k] = source[own[k]][s];
    check(VecRestoreArray(petsc.right, &values));
    if (petsc.null_space != nullptr) check(MatNullSpaceRemove(petsc.null_space, petsc.right));
    double size = 0;
    check(VecNorm(petsc.right, NORM_2, &size));
    if (size == 0) continue;
    check(KSPSolve(petsc.solver, petsc.right, petsc.solution));
    PetscInt iterations = 0;
    double residual = 0;
    check(KSPGetIterationNumber(petsc.solver, &iterations));
    check(KSPGetResidualNorm(petsc.solver, &residual));
    report->iterations = std::max<std::int64_t>(report->iterations, iterations);
    report->residual = std::max(report->residual, residual / size);
    const double* x = nullptr;
    check(VecGetArrayRead(petsc.solution, &x));
    for (std::size_t k = 0; k < own.size(); ++k) of_site[of_unknown[own[k]]][s] = x[k];
    check(VecRestoreArrayRead(petsc.solution, &x));
  }
  shared->copy_from_owner(std::span(of_site));
  for (std::size_t l = 0; l < number.size(); ++l) solution[l] = of_site[of_unknown[l]];
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

}  // namespace minamo
