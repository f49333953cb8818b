#pragma once
/// \file
/// What the balances of faces get so that pressure meets exact integrals over the liquid while inertia stays with the
/// particles: water at rest then rests, whatever the angle of its surface.

#include "components/body.hpp"
#include "components/contact.hpp"
#include "components/fluids.hpp"
#include "components/liquid.hpp"
#include "components/staggered.hpp"
#include "components/step.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/geometry/cut.hpp"
#include "systems/grid/mac_grid.hpp"
#include "systems/ranks/site_exchange.hpp"

namespace minamo {

/// (E132)  q_f = -sum_g (B^T lambda)_g/sum_g rho_g V^_g of the last step, over the faces g around f.
template <int Dim>
struct FindPressureAcceleration {
  static constexpr Doc doc = "(E132) acceleration by which the pressure of the last step acted";
  void operator()(Uses<MacGrid<Dim>> mac, Read<Fluid> fluid, Read<StaggeredIndex<Dim>> rows, Read<face::Held> held,
                  Optional<Read<face::Contact>> contact, Read<multiplier::Force> lambda, Read<multiplier::Volume> v_l,
                  Read<face::Mass<Dim>> m_f, Read<face::Mobility<Dim>> mobility, Read<face::ExactVolume<Dim>> volume,
                  Optional<Read<face::UnseenForce<Dim>>> unseen, Optional<Read<face::Open<Dim>>> open,
                  Optional<Read<face::Density<Dim>>> rho_f, Optional<Read<DrySides<Dim>>> dry,
                  Optional<Read<SiteExchange>> shared, Write<face::PressureSums<Dim>> sums,
                  Write<face::PressureAcceleration<Dim>> q_f) const;
};

/// (E133)  w_f: 1 where the liquid is nearly at rest, 0 where it moves, and in spray.
template <int Dim>
struct FindExactShare {
  static constexpr Doc doc = "(E133) where forces are those on exact integrals over the liquid";
  void operator()(Uses<MacGrid<Dim>> mac, Read<Fluid> fluid, Read<StaggeredIndex<Dim>> rows,
                  Read<multiplier::Volume> v_l, Read<multiplier::Capacity> capacity, Read<face::Mass<Dim>> m_f,
                  Read<face::Mobility<Dim>> mobility, Read<face::Velocity<Dim>> v_f,
                  Read<face::PressureAcceleration<Dim>> q_f, Optional<Read<face::Open<Dim>>> open_face,
                  Optional<Read<multiplier::OpenShare>> open, Optional<Read<face::Density<Dim>>> rho_f,
                  Optional<Read<DrySides<Dim>>> dry, Optional<Read<SiteExchange>> shared,
                  Write<multiplier::NearLiquid> near, Write<multiplier::NearExact> buffer,
                  Write<face::ExactShare<Dim>> share) const;
};

/// (E134)  v*_f += tau (rho_f V^_f/m_f - 1) q_f.
template <int Dim>
struct AddExactPressure {
  static constexpr Doc doc = "(E134) pressure acts on exact integrals over the liquid";
  void operator()(Read<Rates> rates, Read<Fluid> fluid, Read<face::Mobility<Dim>> mobility,
                  Read<face::ExactShare<Dim>> share, Read<face::ExactVolume<Dim>> volume,
                  Optional<Read<face::UnseenForce<Dim>>> unseen, Read<face::PressureAcceleration<Dim>> q_f,
                  Optional<Read<face::Density<Dim>>> rho_f, Update<face::Predictor<Dim>> predictor) const;
};

}  // namespace minamo
