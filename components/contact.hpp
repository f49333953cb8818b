#pragma once
/// \file
/// Walls that the liquid may leave: where it touches them, and what is set aside until that is known.

#include "components/body.hpp"
#include "components/staggered.hpp"
#include "engine/schedule/loop.hpp"

namespace minamo {

/// Which sides of the box the liquid may leave: per axis the low and the high end.
template <int Dim>
struct SeparatingSides {
  std::array<std::array<bool, 2>, static_cast<std::size_t>(Dim)> side{};
  static constexpr ComponentInfo info{"separating.sides", "", "1", Lifetime::constant};
};

namespace face {

/// Directions whose face a separating side has held in the last step, bit d for direction d. [1]
struct Contact : Column<Staggered, std::uint8_t> {
  // State, because the next step starts from it.
  static constexpr ComponentInfo info{"face.contact", "", "1", Lifetime::state};
};

}  // namespace face

namespace multiplier {

/// 1 where the liquid leaves a separating body: no pressure there. [1]
struct Released : Column<Staggered, std::uint8_t> {
  // State, because the next step starts from it.
  static constexpr ComponentInfo info{"multiplier.released", "", "1", Lifetime::state};
};

}  // namespace multiplier

/// The faces on the separating sides that have a row, in the order of their sites.
template <int Dim>
struct SeparatingFaces {
  struct Face {
    std::uint32_t row;
    std::uint32_t multiplier;  ///< row of the one multiplier next to it
    std::int32_t direction;
    double away;           ///< 1 or -1: the sign of velocities that leave the side
    double weight;         ///< what the multiplier counts in B^T [1/m]
    double predictor = 0;  ///< v*_f, as if nothing held the face [m/s]
    double mobility = 0;   ///< 1/m_f, likewise [1/kg]
    bool is_held = true;
  };
  std::vector<Face> faces;
  using rows_of = Staggered;
  static constexpr ComponentInfo info{"separating.faces", "", "", Lifetime::scratch};
};

/// The multipliers next to separating bodies, in the order of their sites.
template <int Dim>
struct SeparatingRows {
  struct Row {
    std::uint32_t multiplier;  ///< row of the staggered table
    bool is_released;
  };
  std::vector<Row> rows;
  // What a pass changes, as it is before the first one.
  std::vector<Vec<Dim>> attached;         ///< of every face [kg]
  std::vector<Vec<Dim>> velocity;         ///< of every body [m/s]
  std::vector<Vec<rotations<Dim>>> spin;  ///< of every body [1/s]
  std::vector<double> work;               ///< on every body [J]
  std::vector<std::uint8_t> known;        ///< of every site, work space of systems
  using rows_of = Staggered;
  static constexpr ComponentInfo info{"separating.rows", "", "", Lifetime::scratch};
};

/// Repeats the balances of a step until no wall pulls and none is passed.
struct ContactLoop : LoopControl {
  int changes = 0;    ///< of contacts, in this pass so far
  int passes = 0;     ///< of the last loop
  int unsettled = 0;  ///< contacts that the last pass of the last loop would have changed
  static constexpr ComponentInfo info{"separating.loop", "", "", Lifetime::cache};
};

}  // namespace minamo
