#pragma once
/// \file
/// Conditions of the tables of the step: what a scene has or asks for. Every one has the words that lists show.

#include "components/rheology.hpp"
#include "components/surface_tension.hpp"
#include "engine/run/communicator.hpp"
#include "systems/bodies/bodies_part.hpp"
#include "systems/measure/exact_part.hpp"
#include "systems/openings/openings_part.hpp"
#include "systems/scene/discretization.hpp"
#include "systems/scene/schemes.hpp"
#include "systems/step/step_table.hpp"
#include "systems/time/body_force.hpp"
#include "systems/transfer/scheme.hpp"
#include "systems/viscosity/friction_choice.hpp"

#include <algorithm>

namespace minamo::condition {

template <class Fact>
bool has(const Scene& scene) {
  return scene.facts.find<Fact>() != nullptr;
}
inline bool is_scheme(const Scene& scene, const std::string& part, std::string_view scheme) {
  const auto chosen = scene.schemes.find(part);
  return chosen != scene.schemes.end() && chosen->second == scheme;
}
/// Whether one of the bodies of the scene is of a kind.
template <class Kind>
bool any_body(const Scene& scene, const Kind& is) {
  const auto* bodies = scene.facts.find<BodiesOfScene>();
  return bodies != nullptr && (is(bodies->in_plane) || is(bodies->in_space));
}
inline bool is_viscous_on_nodes(const Scene& scene) {
  return scene.facts.get<Fluid>().viscosity > 0 || is_scheme(scene, "stabilization", "vms");
}

inline bool have_one_density(const Fluids& fluids) {
  return std::all_of(fluids.of.begin(), fluids.of.end(),
                     [&](const Fluid& fluid) { return fluid.density == fluids.of.front().density; });
}

/// Only if a part asks for it by Recipe::add().
inline constexpr Condition asked{"a part asks", [](const Scene&) { return false; }};

inline constexpr Condition one_process{"one process", [](const Scene&) { return all_ranks() == nullptr; }};
inline constexpr Condition several_ranks{"ranks", [](const Scene&) { return all_ranks() != nullptr; }};

inline constexpr Condition conforming{"the conforming discretization", [](const Scene& s) { return is_conforming(s); }};
inline constexpr Condition equal_order{"equal_order", [](const Scene& scene) { return !is_conforming(scene); }};
inline constexpr Condition degree_3{"degree 3", [](const Scene& scene) {
                                      return is_conforming(scene) && scene.facts.get<Discretization>().degree != 2;
                                    }};
inline constexpr Condition umfpack{"umfpack", [](const Scene& s) { return is_scheme(s, "solver", "umfpack"); }};

inline constexpr Condition bodies{"bodies", has<BodiesOfScene>};
inline constexpr Condition no_bodies{"no bodies", [](const Scene& scene) { return !has<BodiesOfScene>(scene); }};
inline constexpr Condition free_bodies{"free bodies", [](const Scene& scene) {
                                         return any_body(scene, [](const auto& set) { return set.any_is_free(); });
                                       }};
inline constexpr Condition moving_bodies{"moving bodies", [](const Scene& scene) {
                                           return any_body(scene, [](const auto& set) { return set.any_moves(); });
                                         }};
inline constexpr Condition friction_of_bodies{
    "viscous bodies", [](const Scene& scene) { return finds_friction(scene.facts.get<BodiesOfScene>(), scene); }};
inline constexpr Condition periodic{"periodic sides", [](const Scene& scene) {
                                      const auto& axes = scene.grid.periodic;
                                      return std::find(axes.begin(), axes.end(), true) != axes.end();
                                    }};
inline constexpr Condition openings{"openings", has<OpeningsOfScene>};
inline constexpr Condition sponge{"sponge", [](const Scene& scene) { return scene.keys.contains("sponge"); }};
inline constexpr Condition separating{"separating walls", has<RepeatsBalances>};
inline constexpr Condition no_separating{"no separating walls",
                                         [](const Scene& scene) { return !has<RepeatsBalances>(scene); }};
inline constexpr Condition separating_sides{"separating sides", [](const Scene& scene) {
                                              const auto* walls = scene.facts.find<RepeatsBalances>();
                                              return walls != nullptr && walls->at_sides;
                                            }};
inline constexpr Condition separating_bodies{"separating bodies", [](const Scene& scene) {
                                               const auto* walls = scene.facts.find<RepeatsBalances>();
                                               return walls != nullptr && walls->at_bodies;
                                             }};

inline constexpr Condition several_densities{"several densities", [](const Scene& scene) {
                                               const auto* fluids = scene.facts.find<Fluids>();
                                               return fluids != nullptr && !have_one_density(*fluids);
                                             }};
inline constexpr Condition fluids{"several liquids", has<Fluids>};
inline constexpr Condition rheology_of_one{
    "rheology", [](const Scene& scene) { return has<Rheology>(scene) && !has<Fluids>(scene); }};
inline constexpr Condition rheology_of_several{
    "rheology", [](const Scene& scene) { return has<Rheology>(scene) && has<Fluids>(scene); }};
inline constexpr Condition shear_dependent{"rheology", has<Rheology>};
inline constexpr Condition rheology_of_pressure{"rheology of pressure", [](const Scene& scene) {
                                                  const auto* rheology = scene.facts.find<Rheology>();
                                                  return rheology != nullptr && depends_on_pressure(rheology->laws);
                                                }};
inline constexpr Condition iterated_viscosity{"iterations > 1", [](const Scene& scene) {
                                                const auto* rheology = scene.facts.find<Rheology>();
                                                return rheology != nullptr && rheology->iterations > 1;
                                              }};
inline constexpr Condition viscous{"viscous", [](const Scene& scene) { return friction_of(scene) != Friction::none; }};
inline constexpr Condition explicit_viscosity{
    "explicit viscosity", [](const Scene& scene) { return friction_of(scene) == Friction::at_start; }};
inline constexpr Condition implicit_viscosity{
    "implicit viscosity", [](const Scene& scene) { return friction_of(scene) == Friction::in_balances; }};
inline constexpr Condition viscous_on_nodes{"viscous or vms", is_viscous_on_nodes};
inline constexpr Condition inviscid_on_nodes{"inviscid, not vms",
                                             [](const Scene& scene) { return !is_viscous_on_nodes(scene); }};
inline constexpr Condition surface_tension{"surface tension", has<SurfaceTension>};

inline constexpr Condition midpoint{"midpoint", [](const Scene& s) { return is_scheme(s, "integrator", "midpoint"); }};
inline constexpr Condition newmark{"newmark", [](const Scene& s) { return is_scheme(s, "integrator", "newmark"); }};
inline constexpr Condition midpoint_or_newmark{"midpoint, newmark",
                                               [](const Scene& s) { return midpoint.holds(s) || newmark.holds(s); }};
inline constexpr Condition fixed_step{"fixed step", [](const Scene& scene) { return scene.time.step.has_value(); }};
inline constexpr Condition ode_variables{"ode", [](const Scene& scene) { return scene.start.ode_count > 0; }};
inline constexpr Condition force_in_time{"uniform body force",
                                         [](const Scene& s) { return s.facts.get<BodyForce>().is_uniform(); }};
inline constexpr Condition force_of_place{"body force of place",
                                          [](const Scene& s) { return !s.facts.get<BodyForce>().is_uniform(); }};
inline constexpr Condition some_force{"body force", [](const Scene& s) { return !s.facts.get<BodyForce>().is_zero(); }};

inline constexpr Condition exact{"exact", [](const Scene& s) { return is_scheme(s, "quadrature", "exact"); }};
inline constexpr Condition rows_remember{"exact, or separating walls",
                                         [](const Scene& s) { return exact.holds(s) || separating.holds(s); }};
inline constexpr Condition mixed_or_exact{"mixed, exact", [](const Scene& s) {
                                            return is_scheme(s, "quadrature", "mixed") ||
                                                   is_scheme(s, "quadrature", "exact");
                                          }};
inline constexpr Condition by_particles{"particles",
                                        [](const Scene& s) { return is_scheme(s, "quadrature", "particles"); }};
inline constexpr Condition moments{"mixed, exact, particles",
                                   [](const Scene& s) { return mixed_or_exact.holds(s) || by_particles.holds(s); }};
inline constexpr Condition projection{"projection",
                                      [](const Scene& s) { return is_scheme(s, "volume", "projection"); }};
inline constexpr Condition delta{"delta", [](const Scene& s) { return is_scheme(s, "volume", "delta"); }};
inline constexpr Condition projection_or_delta{"projection, delta",
                                               [](const Scene& s) { return projection.holds(s) || delta.holds(s); }};
inline constexpr Condition oss{"oss", [](const Scene& s) { return is_scheme(s, "stabilization", "oss"); }};
inline constexpr Condition vms{"vms", [](const Scene& s) { return is_scheme(s, "stabilization", "vms"); }};
inline constexpr Condition pspg_or_vms{
    "pspg, vms", [](const Scene& s) { return is_scheme(s, "stabilization", "pspg") || vms.holds(s); }};
inline constexpr Condition pspg_or_oss{
    "pspg, oss", [](const Scene& s) { return is_scheme(s, "stabilization", "pspg") || oss.holds(s); }};
inline constexpr Condition built_in_stabilization{"pspg, vms, oss",
                                                  [](const Scene& s) { return pspg_or_vms.holds(s) || oss.holds(s); }};

inline constexpr Condition gradients{
    "gradients", [](const Scene& scene) { return scene.facts.get<TransferScheme>().carries_gradient; }};
inline constexpr Condition inertia{"corrected inertia",
                                   [](const Scene& s) { return s.facts.get<InertiaOfParticles>().is_corrected; }};
inline constexpr Condition moving_gradients{
    "gradients that move", [](const Scene& scene) { return scene.facts.get<IntegratorNeeds>().gradients_move; }};
inline constexpr Condition liquid_indicator{"liquid or spray", [](const Scene& scene) {
                                              return inertia.holds(scene) ||
                                                     scene.facts.get<TransferScheme>().reads_liquid_indicator;
                                            }};
inline constexpr Condition liquid_cells{"liquid or spray, gradients", [](const Scene& scene) {
                                          return liquid_indicator.holds(scene) || gradients.holds(scene);
                                        }};

inline constexpr Condition probes{"probes", [](const Scene& scene) { return scene.keys.contains("probes"); }};
inline constexpr Condition gauges{"gauges", [](const Scene& scene) { return scene.keys.contains("gauges"); }};
inline constexpr Condition meters{"meters", [](const Scene& scene) { return scene.keys.contains("meters"); }};
inline constexpr Condition patches{"patches", [](const Scene& scene) { return scene.keys.contains("patches"); }};
inline constexpr Condition exact_velocity{"exact velocity",
                                          [](const Scene& s) { return !s.facts.get<ExactScene>().velocity.empty(); }};
inline constexpr Condition exact_pressure{
    "exact pressure", [](const Scene& s) { return s.facts.get<ExactScene>().pressure.has_value(); }};
inline constexpr Condition some_pressure{"probes, patches, exact pressure", [](const Scene& scene) {
                                           return probes.holds(scene) || patches.holds(scene) ||
                                                  exact_pressure.holds(scene);
                                         }};
inline constexpr Condition surfaces{"output of the surface",
                                    [](const Scene& scene) { return scene.output.surface != "none"; }};

}  // namespace minamo::condition
