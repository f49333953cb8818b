#pragma once
/// \file
/// (E105) What the loop over the balances has in addition to the systems that it repeats.

#include "components/body.hpp"
#include "components/contact.hpp"
#include "components/measure.hpp"
#include "engine/run/communicator.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/mac_grid.hpp"

namespace minamo {

/// Passes after which a contact that still changes stays as it is.
inline constexpr int most_contact_passes = 10;

/// (E77) B v* for the contact of this pass, source of the balances; the others are zero.
template <int Dim>
struct FillContactSource {
  static constexpr Doc doc = "(E77) B v*, with what is in contact at rest";
  void operator()(Uses<MacGrid<Dim>> mac, Read<face::Predictor<Dim>> predictor, Optional<Read<face::Open<Dim>>> open,
                  Optional<Read<face::WallFlux<Dim>>> wall_flux, Read<unknown::Staggered> of_unknown,
                  Write<unknown::Source> source) const;
};

/// It is enough when no contact has changed, or after most_contact_passes.
template <int Dim>
struct EndContactPass {
  static constexpr Doc doc = "(E105) whether the contact has settled";
  void operator()(Optional<Read<Ranks>> ranks, Update<ContactLoop> loop) const;
};

/// `contact_passes` and `contact_unsettled` of the history.
template <int Dim>
struct MeasureContact {
  static constexpr Doc doc = "(E105) passes of the contact, and what of it did not settle";
  void operator()(Read<ContactLoop> loop, Update<measure::Columns> columns) const;
};

}  // namespace minamo
