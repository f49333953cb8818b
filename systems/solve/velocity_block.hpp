#pragma once
/// \file
/// The velocity block A = c_a m + c_v K of the equations of a step, and its inverse: the diagonal where viscosity is
/// small against inertia, a sparse Cholesky factorization where it is not.

#include "systems/solve/pressure_schur.hpp"

#include <memory>

namespace minamo {

template <int Dim>
class VelocityBlock {
 public:
  VelocityBlock();
  ~VelocityBlock();
  /// \param schur  assembled from the same terms; its blocks and mobility are kept by reference
  /// \throws StepRejected if the factorization fails.
  void prepare(const EquationTerms<Dim>& terms, const PressureSchur<Dim>& schur);
  /// How much of a vector about is left of v - A solve(v): 0 if solve() is the inverse, else it divides by the
  /// diagonal.
  double error() const { return error_; }
  /// Whether solve() multiplies by the mobility of the Schur complement.
  bool is_mobility() const { return !factorized_; }
  /// v = A^-1 v; zero towards walls.
  void solve(Values& v) const;
  /// What dividing by the diagonal has left of a right-hand side, out = (diagonal of A - A) u; zero towards walls.
  void find_rest(const Values& u, Values& out) const;

 private:
  void add_row(std::size_t r, std::size_t e);

  struct Factors;
  std::unique_ptr<Factors> factors_;
  const PressureSchur<Dim>* schur_ = nullptr;
  EquationTerms<Dim> terms_{};
  double error_ = 0;
  bool factorized_ = false;
};

}  // namespace minamo
