#include "systems/pressure/multigrid.hpp"

#include "engine/schedule/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// Residuals that are a smaller part of the right-hand side are none: in single precision they would be denormal, and
/// slow, or become so on the way.
constexpr double least_residual = 1e-25;

/// Conjugate gradients for right-hand sides side by side, each with its own numbers. Those that have converged stand
/// still.
/// \tparam Width  lanes: 2 or 4
template <int Dim, int Width>
class Lockstep {
 public:
  static constexpr std::size_t lanes = Width;
  static constexpr std::size_t used = std::min(lanes, most_sources);
  using Row = LaneRow<Width>;
  using Number = typename Row::Lanes;

  Lockstep(const MultigridProblem<Dim>& problem, MultigridCycle<Dim>& cycle, LockstepVectors<Width>& vectors)
      : problem_(problem),
        matrix_(problem.matrix),
        cycle_(cycle),
        finest_(cycle.finest()),
        r_(resized(vectors.r)),
        x_(resized(vectors.x)),
        p_(resized(vectors.p)),
        q_(resized(vectors.q)) {}

  MultigridReport run(std::int64_t most_iterations) {
    start();
    MultigridReport report;
    Number before{};
    Number left = norm_ * norm_;
    while (find_running(left) && report.iterations < most_iterations) {
      if (report.iterations == 0) hand_on_all();
      cycle_.apply();
      const Number along = turn_along();
      left = step(quotient(along, before), along);
      before = along;
      ++report.iterations;
    }
    return report;
  }

  /// \return largest |b - S x| / |b|
  double write(std::span<Sources> x) const {
    const Number square = sum_rows([&](std::size_t l) {
      const Number r = source(l) - times_matrix(x_, l);
      x[l] = {};
      for (std::size_t s = 0; s < used; ++s) x[l][s] = x_[l].lane[s];
      return Number{r * r};
    });
    double largest = 0;
    for (std::size_t s = 0; s < lanes; ++s) {
      if (norm_[s] == 0) continue;
      const double residual = std::sqrt(square[s]) / norm_[s];
      if (!(residual <= largest)) largest = residual;  // also if it is NaN
    }
    return largest;
  }

 private:
  std::span<Row> resized(std::vector<Row>& vector) const {
    vector.resize(matrix_.rows());
    return vector;
  }
  Number source(std::size_t l) const {
    Number b{};
    for (std::size_t s = 0; s < used; ++s) b[s] = problem_.b[l][s];
    return b;
  }
  template <class Value>
  Number sum_rows(const Value& value) const {
    const auto plus = [](const Row& a, const Row& b) { return Row{a.lane + b.lane}; };
    return reduce_rows(
               matrix_.rows(), Row{}, [&](std::size_t l) { return Row{value(l)}; }, plus)
        .lane;
  }

  /// x = 0
  void start() {
    const Number square = sum_rows([&](std::size_t l) {
      const Number b = r_[l].lane = source(l);
      x_[l].lane = p_[l].lane = Number{};
      return Number{b * b};
    });
    for (std::size_t s = 0; s < lanes; ++s) norm_[s] = std::sqrt(square[s]);
  }

  bool find_running(const Number& square) {
    bool has_running = false;
    for (std::size_t s = 0; s < lanes; ++s) {
      const bool is_running = std::sqrt(square[s]) > problem_.tolerance * norm_[s];
      scale_[s] = is_running ? cycle_.null_scale() / norm_[s] : 0;
      has_running = has_running || is_running;
    }
    return has_running;
  }

  /// 0 for those that stand still.
  Number quotient(const Number& over, const Number& under) const {
    Number quotient{};
    for (std::size_t s = 0; s < lanes; ++s) quotient[s] = scale_[s] > 0 && under[s] > 0 ? over[s] / under[s] : 0;
    return quotient;
  }

  /// What the preconditioner is to work on: the residual, scaled as its matrix is.
  void hand_on(std::size_t l, const Number& r) {
    Number scaled = r * scale_ * problem_.null_vector[l];
    const Number none{};
    scaled = scaled * scaled > least_residual * least_residual ? scaled : none;
    SingleRow::Lanes single{};
    for (std::size_t s = 0; s < used; ++s) single[s] = static_cast<float>(scaled[s]);
    finest_.b_of(l).lane = single;
  }
  void hand_on_all() {
    for_each_row(matrix_.rows(), [&](std::size_t l) { hand_on(l, r_[l].lane); });
  }
  Number preconditioned(std::size_t l) const {
    const SingleRow::Lanes x = finest_.x_of(l).lane;
    Number z{};
    for (std::size_t s = 0; s < used; ++s) z[s] = x[s];
    return z * problem_.null_vector[l];
  }

  /// \return r . z
  Number turn_along() const {
    return sum_rows([&](std::size_t l) { return Number{r_[l].lane * preconditioned(l)}; });
  }
  /// Row l of S times values.
  Number times_matrix(std::span<const Row> values, std::size_t l) const {
    Number sum = values[l].lane * matrix_.diagonal[l];
    matrix_.for_each_neighbour(l, [&](std::size_t m, double conductance) { sum -= values[m].lane * conductance; });
    return sum;
  }
  /// \param turn   how much of the last direction the new one keeps
  /// \param along  r . z
  /// \return |r|^2 after the step
  Number step(const Number& turn, const Number& along) {
    for_each_row(matrix_.rows(), [&](std::size_t l) { p_[l].lane = preconditioned(l) + turn * p_[l].lane; });
    const Number curvature = sum_rows([&](std::size_t l) {
      const Number q = q_[l].lane = times_matrix(p_, l);
      return Number{p_[l].lane * q};
    });
    const Number length = quotient(along, curvature);
    return sum_rows([&](std::size_t l) {
      x_[l].lane += length * p_[l].lane;
      const Number r = r_[l].lane -= length * q_[l].lane;
      hand_on(l, r);
      return Number{r * r};
    });
  }

  const MultigridProblem<Dim>& problem_;
  const StaggeredLaplacian<Dim>& matrix_;
  MultigridCycle<Dim>& cycle_;
  MultigridLevel<Dim>& finest_;
  std::span<Row> r_, x_, p_, q_;  ///< LockstepVectors
  Number norm_{};                 ///< |b|
  Number scale_{};                ///< of r in the preconditioner; 0: stands still
};

}  // namespace

template <int Dim>
void MultigridSolver<Dim>::prepare(const StaggeredLaplacian<Dim>& matrix, std::span<const double> null_vector,
                                   const ClosedComponents& closed) {
  cycle_.prepare(matrix, null_vector, closed);
}

template <int Dim>
template <int Width>
MultigridReport MultigridSolver<Dim>::solve_side_by_side(const MultigridProblem<Dim>& problem, std::span<Sources> x,
                                                         std::int64_t most_iterations,
                                                         LockstepVectors<Width>& vectors) {
  Lockstep<Dim, Width> iteration(problem, cycle_, vectors);
  MultigridReport report = iteration.run(most_iterations);
  report.residual = iteration.write(x);
  return report;
}

template <int Dim>
MultigridReport MultigridSolver<Dim>::solve(const MultigridProblem<Dim>& problem, std::span<Sources> x,
                                            std::int64_t most_iterations) {
  return problem.sources <= 2 ? solve_side_by_side(problem, x, most_iterations, two_)
                              : solve_side_by_side(problem, x, most_iterations, four_);
}

template class MultigridSolver<2>;
template class MultigridSolver<3>;

}  // namespace minamo
