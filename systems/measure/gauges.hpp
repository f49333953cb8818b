#pragma once
/// \file
/// Gauges: the height of the liquid's surface along lines, as columns of the history.

#include "components/body.hpp"
#include "components/measure.hpp"
#include "components/particle.hpp"
#include "engine/run/communicator.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/body_set.hpp"

namespace minamo {

template <int Dim>
struct Gauges {
  struct Gauge {
    std::string name;                    ///< column of the history
    Vec<Dim> at = Vec<Dim>::Zero();      ///< where heights begin [m]
    Vec<Dim> along = Vec<Dim>::UnitY();  ///< unit, out of the liquid [1]
  };
  std::vector<Gauge> gauges;
  static constexpr ComponentInfo info{"gauges", "", "m", Lifetime::constant};
};

/// (E137)  The height of the first surface above `at`, or below it where `at` is dry; of the bed, a body or the end of
/// the box, where there is no liquid down to there, with the film that is on it. Drops in the air do not count. An
/// empty cell while a body covers `at`. [m]
template <int Dim>
struct MeasureGauges {
  static constexpr Doc doc = "(E137) height of the surface at the gauges";
  void operator()(Read<Grid<Dim>> grid, Read<Gauges<Dim>> gauges, Read<particle::Position<Dim>> x_p,
                  Read<particle::Volume> V_p, Optional<Read<BodySet<Dim>>> set, Optional<Read<body::Position<Dim>>> c_b,
                  Optional<Read<body::Rotation<Dim>>> R_b, Optional<Read<Ranks>> ranks,
                  Update<measure::Columns> columns) const;
};

}  // namespace minamo
