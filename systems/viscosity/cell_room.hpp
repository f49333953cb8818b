#pragma once
/// \file
/// How much of an occupied cell is liquid, for its friction.

#include "engine/schedule/system.hpp"
#include "systems/viscosity/cut_friction.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

template <int Dim>
class CellRoom {
 public:
  CellRoom(double spacing, const Optional<Read<CutFriction<Dim>>>& cut,
           const Optional<Read<FrictionAtRest<Dim>>>& at_rest)
      : per_cell_(std::pow(spacing, -Dim)), cut_(cut ? &*cut : nullptr), at_rest_(cut ? &*at_rest : nullptr) {}

  /// Of what walls leave open of a cell, the share that is liquid: by its particles, all where all around is full.
  /// \param theta   (E67), 1 where all around is full [1]
  /// \param volume  of its particles [m^d]
  double liquid_share(std::size_t c, double theta, double volume) const {
    if (cut_ == nullptr || !cut_->cuts(c)) return (1 - theta) * volume * per_cell_ + theta;
    const double open = cut_->with(c, *at_rest_, [](const auto& cell, std::size_t k) { return cell.share(k); });
    return open > 0 ? (1 - theta) * std::min(1.0, volume * per_cell_ / open) + theta : 0;
  }

 private:
  double per_cell_;
  const CutFriction<Dim>* cut_;
  const FrictionAtRest<Dim>* at_rest_;
};

}  // namespace minamo
