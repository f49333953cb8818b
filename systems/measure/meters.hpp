#pragma once
/// \file
/// Meters: the volume of liquid that passes a plane, as columns of the history.

#include "components/grid.hpp"
#include "components/measure.hpp"
#include "components/particle.hpp"
#include "engine/run/clock.hpp"
#include "engine/run/communicator.hpp"
#include "engine/schedule/system.hpp"
#include "systems/shapes/shape.hpp"

namespace minamo {

template <int Dim>
struct Meters {
  struct Meter {
    std::string name;                     ///< column of the history
    Vec<Dim> point = Vec<Dim>::Zero();    ///< of the plane [m]
    Vec<Dim> normal = Vec<Dim>::UnitX();  ///< unit, in the direction that counts as positive [1]
    double width = 0;                     ///< to either side of the plane, over which passing is spread [m]
    SharedShape<Dim> within;              ///< what passes outside of it does not count; null: all counts
  };
  std::vector<Meter> meters;
  static constexpr ComponentInfo info{"meters", "", "m", Lifetime::constant};
};

/// A row per meter, in the order of the scene.
struct MeterRows {
  static constexpr std::string_view name = "meter";
};

namespace meter {

/// Volume that has passed since the start. [m^d]
struct Volume : Column<MeterRows, double> {
  static constexpr ComponentInfo info{"meter.volume", "", "m^d", Lifetime::state};
};

/// Mean of the last step; NaN before the first. [m^d/s]
struct Rate : Column<MeterRows, double> {
  static constexpr ComponentInfo info{"meter.rate", "Q", "m^d/s", Lifetime::state};
};

/// Where a particle is before the step moves it. [m]
template <int Dim>
struct FormerPosition : Column<Particles, Vec<Dim>> {
  static constexpr ComponentInfo info{"particle.former_position", "", "m", Lifetime::scratch};
};

}  // namespace meter

template <int Dim>
struct KeepFormerPositions {
  static constexpr Doc doc = "where particles are before the step, for meters";
  void operator()(Read<particle::Position<Dim>> x_p, Write<meter::FormerPosition<Dim>> former) const;
};

/// (E138)  What passes the planes in the step, whatever moves it.
template <int Dim>
struct PassMeters {
  static constexpr Doc doc = "(E138) volume that passes the meters";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Meters<Dim>> meters, Read<particle::Volume> V_p,
                  Read<meter::FormerPosition<Dim>> former, Read<particle::Position<Dim>> x_p,
                  Optional<Read<Ranks>> ranks, Update<meter::Volume> volume, Write<meter::Rate> rate) const;
};

/// Columns of the history: NAME, the rate, and NAME_volume.
template <int Dim>
struct MeasureMeters {
  static constexpr Doc doc = "flow rate and volume through the meters";
  void operator()(Read<Meters<Dim>> meters, Read<meter::Volume> volume, Read<meter::Rate> rate,
                  Update<measure::Columns> columns) const;
};

}  // namespace minamo
