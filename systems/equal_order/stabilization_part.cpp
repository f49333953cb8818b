#include "components/fluid.hpp"
#include "systems/equal_order/mass_balance.hpp"
#include "systems/equal_order/material.hpp"
#include "systems/equal_order/pressure_gradient.hpp"
#include "systems/equal_order/viscosity.hpp"
#include "systems/equal_order/vms.hpp"
#include "systems/scene/discretization.hpp"
#include "systems/scene/parts.hpp"
#include "systems/scene/schemes.hpp"

namespace minamo {

namespace {

/// Where a run starts from: the pressure gradient of a liquid at rest.
template <int Dim>
void seed_pressure_gradient(const Scene& scene, World& world) {
  const auto& force = scene.facts.get<BodyForce>().of_place_and_time;
  const auto x_p = world.column<particle::Position<Dim>>();
  const auto grad_p_p = world.column<particle::PressureGradient<Dim>>();
  Arguments arguments(scene.start);
  for (std::size_t p = 0; p < x_p.size(); ++p) {
    grad_p_p[p] = scene.facts.get<Fluid>().density * vector_at<Dim>(force, arguments.at<Dim>(x_p[p]));
  }
}

Contribution read_oss(Input&, Scene&) {
  return [](const Scene&, Recipe& recipe) {
    recipe.seed([](const Scene& of, World& world, SeedProblems&) {
      with_dimension(of.dimension, [&](auto dim) { seed_pressure_gradient<dim()>(of, world); });
    });
  };
}

/// Only equal order needs one.
Contribution read_stabilization(const Stabilization& stabilization, Input& input, Scene& scene) {
  const bool is_read = stabilization.read && (!is_conforming(scene) || input.describing());
  return is_read ? stabilization.read(input, scene) : Contribution{};
}

/// Whoever names one for a discretization without pressure modes to stabilize is told.
Contribution read_key(const Part& part, Input& input, Scene& scene) {
  if (is_conforming(scene) && !input.describing()) {
    if (!input.has("stabilization")) return {};  // nor in the scene as run
    input.problem("stabilization", "not with the conforming discretization, which is stable without one",
                  R"(no key "stabilization", or "discretization": {"scheme": "equal_order"})");
  }
  return part.read(input, scene);
}

}  // namespace

void add_stabilization(SystemRegistry& registry) {
  registry.add<FindTau>("find_tau");
  registry.add<FindTauVms>("find_tau_vms");
  registry.add<AssembleDivergence>("divergence_matrix");
  registry.add<AssembleDivergenceOss>("divergence_matrix_oss");
  registry.add<AssembleLaplacian>("laplacian_matrix");
  registry.add<AssembleViscosity>("viscosity_matrix");
  registry.add<G2PPressureGradient>("g2p_pressure_gradient");
  registry.add<P2GPressureGradient>("p2g_pressure_gradient");
  registry.add(Stabilization{{"oss", "orthogonal subscales: what the projected pressure gradient leaves", read_oss}});
  registry.add(Stabilization{{"pspg", "residual of the momentum balance, one parameter tau", {}}});
  registry.add(Stabilization{{"vms", "variational multiscale, parameters per cell, with a bulk viscosity", {}}});
  Part part = choice<Stabilization>("stabilization", "pressure stabilization", always("pspg"), read_stabilization);
  part.read = [inner = part](Input& input, Scene& scene) { return read_key(inner, input, scene); };
  registry.add(part);
}

}  // namespace minamo
