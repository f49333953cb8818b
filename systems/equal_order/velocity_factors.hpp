#pragma once
/// \file
/// The velocity block A = c_a m + c_v K of the equations of a step, and about its inverse. Unknowns whose friction is
/// large against their inertia (all of them in viscous liquids; in water those of light nodes at walls) have
/// viscous rows, s; the others n have the diagonal d for A_nn:
///
/// (E60)  A^ = [d_n, 0; A_sn, A_ss], with a sparse Cholesky factorization of A_ss. A^ - A has rows n only, which add up
/// to a small part of the diagonal.
///
/// Where the factors would cost more, for moderate friction or many unknowns in 3-D, conjugate gradients solve with A
/// itself, as exactly as each call asks for.

#include "systems/equal_order/schur_operator.hpp"
#include "systems/linear/cholesky.hpp"
#include "systems/linear/conjugate_gradients.hpp"

namespace minamo {

/// Viscous rows in 3-D beyond which factors, of 2 GB there, are not tried.
inline constexpr std::size_t most_factorized_in_space = 40000;

enum class ViscousSolver { cheapest, factors, iteration };

template <int Dim>
class VelocityFactors {
 public:
  using rows_of = ActiveNodes;
  static constexpr ComponentInfo info{"solve.velocity_factors", "A^", "", Lifetime::scratch};

  using Viscosity = std::span<const typename matrix::Viscosity<Dim>::value_type>;
  /// What a solve looks at in addition to the factors, too large to be copied into them. \pre as prepare() had it
  struct Matrix {
    const SchurOperator<Dim>& schur;
    Viscosity viscosity;
  };
  /// Room for a solve, and what it has left.
  struct Work {
    Values of_viscous, left;
    ConjugateGradients iteration;
  };

  /// \param schur  assembled from the same terms
  /// \throws StepRejected if the factorization fails, std::bad_alloc if it does not fit into memory.
  void prepare(const Operators<Dim>& terms, const SchurOperator<Dim>& schur,
               ViscousSolver solver = ViscousSolver::cheapest);
  /// How much of a vector about is left of v - A solve(v), 0 if solve() is the inverse; of iterations what a pass with
  /// many calls is to leave.
  double error() const { return error_; }
  /// Whether solve() multiplies by the inverse_diagonal of the Schur complement.
  bool is_diagonal() const { return viscous_.empty(); }
  /// Whether solve() iterates: what it leaves is then not bounded by error(), but found.
  bool is_iteration() const { return is_iteration_; }
  /// v = A^^-1 v; zero towards walls.
  /// \param target  for what an iteration leaves, in the norm that weighs squares with the inverse_diagonal; it goes on
  /// until
  ///   either that is reached or a hundredth of error()
  /// \throws StepRejected if an iteration does not converge.
  void solve(const Matrix& matrix, Values& v, double target, Work& work) const;
  /// What the last solve() has left of its right-hand side, (A^ - A) u; zero towards walls.
  /// \param u  its solution
  void residual(const Matrix& matrix, const Values& u, const Work& work, Values& out) const;

 private:
  void find_friction(const Operators<Dim>& terms, const Values& inverse_diagonal);
  void collect_viscous(double least);
  bool prefers_iteration() const;
  void factorize(const Matrix& matrix);
  void add_row(const Matrix& matrix, std::size_t i);
  void solve_iteratively(const Matrix& matrix, Values& v, double target, Work& work) const;
  void times_viscosity(const Matrix& matrix, const Values& u, Values& out) const;

  /// An entry of A_sn.
  struct Coupling {
    std::uint32_t viscous;  ///< place in `viscous_`
    std::uint32_t unknown;
    double value;
  };

  double c_v_ = 0;
  Values inertia_;                      ///< c_a m_I of every row
  Values friction_;                     ///< of every unknown, over its inertia
  std::vector<std::uint32_t> viscous_;  ///< unknowns Dim r + d
  std::vector<std::int32_t> place_;     ///< of every unknown in `viscous_`, -1 if it is not there
  std::vector<Coupling> couplings_;
  SparseCholesky factors_;
  double error_ = 0;
  bool is_iteration_ = false;
};

}  // namespace minamo
