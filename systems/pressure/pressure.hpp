#pragma once
/// \file
/// The pressure behind the multipliers.

#include "components/body.hpp"
#include "components/grid.hpp"
#include "components/particle.hpp"
#include "components/staggered.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/splines.hpp"
#include "systems/ranks/site_exchange.hpp"

namespace minamo {

/// (E75)  p_p = sum_l N_l p_l with M p = lambda, M_lk = sum_p V_p N_l N_k, inside the liquid the exact integral: the
/// multiplier is the pressure tested with N_l. A tenth of the sum over particles is lumped. Conjugate gradients,
/// preconditioned by the diagonal. Of multipliers that bodies cut, p_l = lambda_l/(phi_l V_l).
template <int Dim>
struct RecoverPressure {
  static constexpr Doc doc = "(E75) p_p from the multipliers";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<StaggeredIndex<Dim>> rows,
                  Read<staggered::Site<Dim>> site, Read<particle::QuadraturePosition<Dim>> y_p,
                  Read<particle::Volume> V_p, Read<multiplier::Force> lambda,
                  Optional<Read<multiplier::OpenShare>> open_share, Optional<Read<SiteExchange>> shared,
                  Write<multiplier::Pressure> p_l, Write<particle::Pressure> p_p) const;
};

}  // namespace minamo
