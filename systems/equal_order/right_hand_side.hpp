#pragma once
/// \file
/// The right-hand sides of (E25) and (E26), the same for every solver.

#include "components/fluid.hpp"
#include "components/grid.hpp"
#include "components/matrix.hpp"
#include "components/node.hpp"
#include "components/sites.hpp"
#include "components/step.hpp"
#include "engine/schedule/system.hpp"

namespace minamo {

template <int Dim>
struct FillRightHandSide {
  static constexpr Doc doc = "(E25) (E26) right-hand side";
  void operator()(Read<Rates> rates, Read<node::Constraint> constraint,
                  Optional<Read<node::ConstraintFrame<Dim>>> frame, Read<node::Mass> m_i,
                  Read<node::BodyForce<Dim>> b_i, Read<node::PredictedVelocity<Dim>> v_predicted,
                  Read<node::PredictedAcceleration<Dim>> a_predicted, Read<node::Displacement<Dim>> u_i,
                  Read<matrix::Node> node, Read<matrix::Neighbour<Dim>> neighbour,
                  Read<matrix::Divergence<Dim>> divergence, Read<matrix::StabilizationSource> source,
                  Optional<Read<matrix::Viscosity<Dim>>> viscosity, Write<matrix::Momentum<Dim>> f,
                  Write<matrix::Mass> g) const;
};

}  // namespace minamo
