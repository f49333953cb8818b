#pragma once
/// \file
/// The preconditioner of the pressure Schur complement: about the inverse of the matrix (E56), by LU within its
/// envelope where that is narrow, by incomplete LU where it is not; and for viscous liquids
/// (E57)  plus b (m/rho)^-1, J. Cahouet, J.-P. Chabard, IJNMF 8 (1988) 869, doi:10.1002/fld.1650080802.

#include "components/fluid.hpp"
#include "components/grid.hpp"
#include "systems/equal_order/schur_approximation.hpp"
#include "systems/linear/envelope_lu.hpp"
#include "systems/linear/incomplete_lu.hpp"

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

  /// \param schur     assembled from the same terms
  /// \param site      of every node
  /// \param capacity  of every node
  void prepare(const Operators<Dim>& terms, const SchurOperator<Dim>& schur, const Grid<Dim>& grid,
               std::span<const Index<Dim>> site, std::span<const double> capacity, const Fluid& fluid,
               const matrix::StabilizationScale& scale);
  /// s_I = P_II^-1/2: light nodes weigh as much in a scaled residual as heavy ones.
  const Values& scale() const { return approximation_.scale(); }
  /// LU in the place of incomplete LU, with which GMRES may not converge where few particles have many nodes, as wide
  /// as the envelope may be. \return whether it was incomplete, and has been replaced.
  /// \throws std::bad_alloc if it does not fit into memory.
  bool complete();
  /// out = about S^-1 r.
  void solve(const Values& r, Values& out);

 private:
  void find_order(std::span<const Index<Dim>> site, std::span<const std::uint32_t> node);
  void find_envelope();
  bool factorize_envelope();

  SchurApproximation<Dim> approximation_;
  bool is_complete_ = true;
  std::vector<std::uint32_t> place_;                        ///< where the envelope has a row
  std::vector<std::uint32_t> first_;                        ///< place of the first entry of a place
  std::vector<std::pair<Index<Dim>, std::uint32_t>> keys_;  ///< work space: coordinates, slowest first, and row
  Values ordered_;
  Values of_mass_;  ///< b/(m/rho); empty if not viscous
  EnvelopeLu complete_;
  IncompleteLu incomplete_;
};

}  // namespace minamo
