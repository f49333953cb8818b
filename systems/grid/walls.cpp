#include "systems/grid/walls.hpp"

#include "engine/schedule/parallel.hpp"
#include "systems/grid/constraint.hpp"

namespace minamo {

template <int Dim>
void ApplyWallCondition<Dim>::operator()(Read<node::Constraint> constraint,
                                         Optional<Read<node::ConstraintFrame<Dim>>> frame,
                                         Optional<Read<node::ConstraintVelocity<Dim>>> w_i,
                                         Update<node::Velocity<Dim>> v_i) const {
  const Constraints<Dim> constraints{constraint.span(), frame.span(), w_i.span()};
  for_each_row(v_i.size(), [&](std::size_t i) { hold<Dim>(constraints, i, v_i[i]); });
}

template <int Dim>
void ApplyWallConditionAcceleration<Dim>::operator()(Read<node::Constraint> constraint,
                                                     Optional<Read<node::ConstraintFrame<Dim>>> frame,
                                                     Update<node::Acceleration<Dim>> a_i) const {
  const Constraints<Dim> constraints{constraint.span(), frame.span()};
  for_each_row(a_i.size(), [&](std::size_t i) { hold_at_rest<Dim>(constraints, i, a_i[i]); });
}

template struct ApplyWallCondition<2>;
template struct ApplyWallCondition<3>;
template struct ApplyWallConditionAcceleration<2>;
template struct ApplyWallConditionAcceleration<3>;

}  // namespace minamo
