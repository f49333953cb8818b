#pragma once
/// \file
/// The preconditioner of the pressure Schur complement: the inverse of the compact matrix (E56), by LU within its
/// envelope where that is narrow, by sparse Cholesky of its symmetric part where it is not; and for viscous liquids
/// (E57)  plus b (m/rho)^-1, J. Cahouet, J.-P. Chabard, IJNMF 8 (1988) 869, doi:10.1002/fld.1650080802.

#include "components/fluid.hpp"
#include "components/solver.hpp"
#include "components/step.hpp"
#include "systems/solve/cholesky.hpp"
#include "systems/solve/envelope_lu.hpp"
#include "systems/solve/schur_approximation.hpp"

namespace minamo {

/// The factor of T in (E56).
double laplacian_factor(const Coefficients& coefficients, const Fluid& fluid, const matrix::StabilizationScale& scale);

/// b of (E57). With wave number k, inside the liquid, 1/S = 1/(1/(a/k^2 + mu') + tau k^2), a = rho c_a/c',
/// mu' = c_v mu/c', c' = c_v - c_a g; b/rho is what it has beyond P^-1 at k = 2/h.
template <int Dim>
double viscous_part(const Coefficients& coefficients, const Grid<Dim>& grid, const Fluid& fluid,
                    const matrix::StabilizationScale& scale);

template <int Dim>
class PressureFactors {
 public:
  using rows_of = ActiveNodes;
  static constexpr ComponentInfo info{"solve.pressure_factors", "P^-1", "", Lifetime::scratch};

  /// \throws StepRejected if the matrix cannot be factorized, std::bad_alloc if its factors do not fit into memory.
  void prepare(const SchurApproximation<Dim>& compact, const SchurOperator<Dim>& schur, const Operators<Dim>& terms,
               double viscous_part, WholeFactors& whole);
  /// Whole factors in the place of incomplete ones, with which GMRES may not converge where few particles have many
  /// nodes. \return whether they were incomplete. \throws as prepare()
  bool complete(const SchurApproximation<Dim>& compact, const SchurOperator<Dim>& schur, WholeFactors& whole);
  bool is_incomplete() const { return kind_ == Kind::incomplete; }
  /// out = about S^-1 r.
  void solve(const Values& r, Values& out);

 private:
  void find_order(const Operators<Dim>& terms);
  void find_envelope(const SchurApproximation<Dim>& compact, const StencilTiles<Dim>& tiles);
  template <class Scalar>
  bool factorize_envelope(const SchurApproximation<Dim>& compact, const StencilTiles<Dim>& tiles, double least_pivot,
                          EnvelopeLu<Scalar>& factors);
  bool factorize_narrow(const SchurApproximation<Dim>& compact, const StencilTiles<Dim>& tiles, WholeFactors& whole);
  void factorize_sparse(const SchurApproximation<Dim>& compact, const SchurOperator<Dim>& schur);
  void find_one_sided(const SchurApproximation<Dim>& compact);
  bool factorize_symmetric(const SchurApproximation<Dim>& compact, const StencilTiles<Dim>& tiles);
  bool factorize_pressure(const SchurApproximation<Dim>& compact, const SchurOperator<Dim>& schur);

  std::vector<std::uint32_t> order_;                        ///< the rows, as the envelope has them
  std::vector<std::uint32_t> place_;                        ///< where the envelope has a row
  std::vector<std::uint32_t> first_;                        ///< place of the first entry of a place
  std::vector<std::pair<Index<Dim>, std::uint32_t>> keys_;  ///< work space: coordinates, slowest first, and row
  Values ordered_;
  Values of_mass_;  ///< b/V_I; empty if not viscous
  enum class Kind { single_envelope, double_envelope, complete, incomplete };
  Kind kind_ = Kind::complete;
  EnvelopeLu<float> single_;
  EnvelopeLu<double> double_;
  SparseCholesky sparse_;
  struct OneSided {
    std::size_t row, column;
    double value;
  };
  std::vector<OneSided> one_sided_;  ///< work space
};

}  // namespace minamo
