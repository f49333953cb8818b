#pragma once
/// \file
/// Whether Newmark's method has an oscillation that nothing damps.

#include "components/node.hpp"
#include "components/staggered.hpp"
#include "engine/run/clock.hpp"
#include "engine/schedule/system.hpp"
#include "systems/ranks/site_exchange.hpp"

namespace minamo {

/// Steps one after the other in which the forces within the liquid turned over. (E122)
struct Turns {
  std::int64_t in_a_row = 0;  ///< up to the last step
  std::int64_t longest = 0;   ///< the most so far
  static constexpr ComponentInfo info{"newmark.turns", "", "1", Lifetime::state};
};

/// (E122)  f = a - b; a step turns over if sum_I m_I f_I^n . f_I^{n+1} < 0 and f^{n+1} is more than rounding.
template <int Dim>
struct WatchTurns {
  static constexpr Doc doc = "(E122) whether pressure and acceleration turn over, newmark";
  void operator()(Read<Clock> clock, Read<node::Mass> m_i, Read<node::Velocity<Dim>> v_i,
                  Read<node::Acceleration<Dim>> a_old, Read<node::NewAcceleration<Dim>> a_new,
                  Read<node::BodyForce<Dim>> b_i, Update<Turns> turns) const;
};

/// (E122) on faces.
template <int Dim>
struct WatchTurnsOfFaces {
  static constexpr Doc doc = "(E122) whether pressure and acceleration turn over, newmark";
  void operator()(Read<Clock> clock, Read<face::Mass<Dim>> m_f, Read<face::Velocity<Dim>> v_f,
                  Read<face::Acceleration<Dim>> a_old, Read<face::NewAcceleration<Dim>> a_new,
                  Read<face::BodyForce<Dim>> b_f, Optional<Read<SiteExchange>> shared, Update<Turns> turns) const;
};

}  // namespace minamo
