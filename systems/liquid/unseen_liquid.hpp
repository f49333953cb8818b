#pragma once
/// \file
/// Liquid that particles do not see: they are some fraction of a cell apart, and the surface may reach that far into
/// the spline of a multiplier that none of them touches.

#include "components/fluids.hpp"
#include "components/liquid.hpp"
#include "components/staggered.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/mac_grid.hpp"
#include "systems/ranks/site_exchange.hpp"

namespace minamo {

/// How many sites away from a face the multipliers are whose planes tell of those that its integral reaches: K - 1
/// beyond the two next to it, and as many again.
constexpr int sites_to_tellers(int degree) { return 2 * degree - 1; }

/// (E140)  psi_l of multipliers that are full or empty by their particles, from the planes around.
template <int Dim>
struct FindUnseenLiquid {
  static constexpr Doc doc =
      "(E140) distance from the surface of multipliers that are full or empty by their particles";
  void operator()(Read<Splines<Dim>> splines, Read<StaggeredIndex<Dim>> rows, Read<staggered::Site<Dim>> site,
                  Read<multiplier::FillFraction> fill, Read<multiplier::NearExact> near,
                  Read<multiplier::SurfaceNormal<Dim>> n_l, Optional<Read<SiteExchange>> shared,
                  Update<multiplier::ContinuedFill> phi, Update<multiplier::SurfaceDistance> psi,
                  Write<UnseenLiquid<Dim>> unseen) const;
};

/// (E140)  force of the pressure of those that are empty.
template <int Dim>
struct FindUnseenForce {
  static constexpr Doc doc = "(E140) pressure of liquid that reaches multipliers without particles";
  void operator()(Uses<MacGrid<Dim>> mac, Read<Fluid> fluid, Read<StaggeredIndex<Dim>> rows,
                  Read<UnseenLiquid<Dim>> unseen, Read<face::Mass<Dim>> m_f, Read<face::ExactShare<Dim>> share,
                  Read<face::ExactVolume<Dim>> volume, Read<face::PressureAcceleration<Dim>> q_f,
                  Optional<Read<face::Density<Dim>>> rho_f, Optional<Read<SiteExchange>> shared,
                  Write<face::UnseenForce<Dim>> force) const;
};

}  // namespace minamo
