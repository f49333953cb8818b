#pragma once
/// \file
/// Body force per unit mass at the nodes, and the nodes that only it moves.

#include "components/fluid.hpp"
#include "components/grid.hpp"
#include "components/instant.hpp"
#include "components/node.hpp"
#include "components/particle.hpp"
#include "components/step.hpp"
#include "engine/schedule/system.hpp"
#include "systems/transfer/bundles.hpp"

#include <optional>

namespace minamo {

/// b(t) of a force that is the same everywhere. \throws StepRejected if it is not finite
template <int Dim>
Vec<Dim> uniform_force(const BodyForce& b, const Instant& now);

/// |b| of the components that are constant. [m/s^2]
double size_of_constant_force(const BodyForce& b);

/// Whether there is a potential of a force: it is constant, and pulls along no periodic axis, where things never stop
/// falling.
/// \param periodic  by axis
template <class Periodic>
bool has_potential(const BodyForce& b, const Periodic& periodic) {
  for (std::size_t d = 0; d < b.of_place_and_time.size(); ++d) {
    const Expression& component = b.of_place_and_time[d];
    if (!component.is_constant() || (component({}) != 0 && periodic[d])) return false;
  }
  return true;
}

/// The constant force that there is a potential of, U = -m b . (x - x_low) in (E28).
template <int Dim>
std::optional<Vec<Dim>> force_with_potential(const Grid<Dim>& grid, const BodyForce& b);

/// (E14)  b_I = b(t), the same everywhere.
template <int Dim>
struct UniformBodyForce {
  static constexpr Doc doc = "(E14) b_I, uniform";
  void operator()(Read<BodyForce> b, Read<Rates> rates, Optional<Read<ode::AtBalances>> ode, Read<node::Mass> m_i,
                  Write<node::BodyForce<Dim>> b_i) const;
};

/// b_p = b(y_p, t).
template <int Dim>
struct SampleBodyForce {
  static constexpr Doc doc = "b_p at the particles";
  void operator()(Read<BodyForce> b, Read<Rates> rates, Optional<Read<ode::AtBalances>> ode,
                  Read<particle::QuadraturePosition<Dim>> y_p, Write<particle::BodyForce<Dim>> b_p) const;
};

/// (E14)  b_I = sum_p S_Ip m_p b_p / m_I.
template <int Dim>
struct P2GBodyForce {
  static constexpr Doc doc = "(E14) b_I, from the particles";
  void operator()(Uses<ParticlesToNodes<Dim>> source, Read<particle::BodyForce<Dim>> b_p,
                  Write<node::BodyForce<Dim>> b_i) const;
};

/// (E15)  Light nodes move freely, a_I = b_I: u_I = (b_I - a^_I)/c_a. Active nodes get what walls
/// prescribe, zero where they are at rest; the solve adds the rest.
/// With this every node with mass has a velocity: a uniform flow has no divergence, and of the linear momentum only the
/// pressure force on light nodes is lost, less than 1e-5 in tests/property/conservation_test.cpp.
template <int Dim>
struct MoveBallisticNodes {
  static constexpr Doc doc = "(E15) u_I of light nodes";
  void operator()(Read<node::Row> row, Read<node::Constraint> constraint,
                  Optional<Read<node::ConstraintFrame<Dim>>> frame, Optional<Read<node::ConstraintVelocity<Dim>>> w_i,
                  Read<node::Mass> m_i, Read<node::BodyForce<Dim>> b_i, Read<Rates> rates,
                  Read<node::PredictedVelocity<Dim>> v_predicted, Read<node::PredictedAcceleration<Dim>> a_predicted,
                  Write<node::Displacement<Dim>> u_i) const;
};

}  // namespace minamo
