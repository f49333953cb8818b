#pragma once
/// \file
/// (E119) Coarser levels for friction in the balances (E82): velocities that are smooth on cells two, four, ... times
/// as wide. Every level does what (E82) does on the grid itself: it divides by a diagonal and projects onto velocities
/// without divergence, which as sums of finer splines have none either. Their sum is the preconditioner, after
/// J. H. Bramble, J. E. Pasciak, J. Xu, Math. Comp. 55 (1990) 1, doi:10.1090/S0025-5718-1990-1023042-6.

#include "systems/viscosity/friction_level.hpp"
#include "systems/viscosity/friction_operator.hpp"

namespace minamo {

template <int Dim>
class FrictionLevels {
 public:
  /// \param mass        m/tau by face, 0 where walls hold it or bodies cut it [kg/s]
  /// \param multiplier  rows of the active ones
  void prepare(double spacing, const FrictionOf<Dim>& friction, std::span<const Index<Dim>> site,
               std::span<const double> mass, std::span<const std::uint32_t> multiplier);
  /// z += sum over the levels of P G^-1 (P^T r - B^T y), without divergence.
  /// \param r  without a part along gradients
  void correct(std::span<const double> r, double tolerance, std::span<double> z);

 private:
  void find_splines(double spacing, const FrictionOf<Dim>& friction);

  std::vector<FrictionSplines<Dim>> splines_;  ///< of every level
  std::vector<FrictionLevel<Dim>> levels_;
  std::size_t count_ = 0;  ///< of levels with multipliers
};

}  // namespace minamo
