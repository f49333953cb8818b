#pragma once
/// \file
/// (E128) Work of forces per unit mass that have no potential, whoever adds them: without it the energy of the liquid
/// would rise where they drive it. (E59)

#include "components/energy_given.hpp"
#include "components/fluid.hpp"
#include "components/instant.hpp"
#include "components/node.hpp"
#include "components/particle.hpp"
#include "components/staggered.hpp"
#include "components/step.hpp"
#include "engine/run/clock.hpp"
#include "engine/schedule/system.hpp"
#include "systems/ranks/site_exchange.hpp"
#include "systems/volume/face_volume.hpp"

namespace minamo {

struct Scene;

/// The systems that a scene needs for (E128).
struct ForceWork {
  bool is_given = false;     ///< whether anything gives energy
  bool is_by_force = false;  ///< whether a force does
};
/// Any body force that is not constant, or along a periodic axis, and any system of a step that changes the force per
/// unit mass on the grid, also one from outside.
/// \param systems  of the slots of steps and standing steps
ForceWork force_work_of(const Scene& scene, std::span<const System> systems);

/// Before the first step.
template <int Dim>
struct BeginEnergyGiven {
  static constexpr Doc doc = "no energy is given yet";
  void operator()(Write<EnergyGiven> given) const;
};

/// (E128)  W = sum_I m_I (b_I - b) . u_I, b the part with a potential: constant, or zero.
template <int Dim>
struct CountForceWork {
  static constexpr Doc doc = "(E128) work of forces without a potential";
  void operator()(Read<Grid<Dim>> grid, Read<BodyForce> b, Optional<Read<NewmarkParameters>> newmark, Read<Rates> rates,
                  Optional<Read<ode::AtBalances>> ode, Read<node::Mass> m_i, Read<node::BodyForce<Dim>> b_i,
                  Read<node::Displacement<Dim>> u_i, Update<EnergyGiven> given) const;
};

/// (E128)  W = sum_f m_f (b_f - b) . u_f on faces that nothing holds; where no part of the body force has a potential
/// also sum_p m_p b_p . (d_p + s_p) of what moves particles without a velocity, so that a shift that lifts is seen.
template <int Dim>
struct CountFaceForceWork {
  static constexpr Doc doc = "(E128) work of forces without a potential";
  void operator()(Read<Grid<Dim>> grid, Read<BodyForce> b, Optional<Read<NewmarkParameters>> newmark, Read<Rates> rates,
                  Optional<Read<ode::AtBalances>> ode, Optional<Read<particle::BodyForce<Dim>>> b_p,
                  Read<particle::Mass> m_p, Optional<Read<particle::Shift<Dim>>> d_p,
                  Optional<Read<particle::Stir<Dim>>> s_p, Read<face::Held> held, Read<face::Mass<Dim>> m_f,
                  Read<face::BodyForce<Dim>> b_f, Read<face::Displacement<Dim>> u_f,
                  Optional<Read<SiteExchange>> shared, Update<EnergyGiven> given) const;
};

}  // namespace minamo
