#include "systems/parts.hpp"
#include "systems/setup/scene.hpp"
#include "systems/setup/schemes.hpp"
#include "systems/assemble/matrices.hpp"
#include "systems/assemble/stabilization.hpp"
#include "systems/assemble/vms.hpp"

namespace minamo {

namespace {

/// L where K gives it, or from the moments.
void add_laplacian(const Scene& scene, Recipe& recipe) {
  const bool viscous = scene.facts.get<Fluid>().viscosity > 0;
  recipe.add("assemble", viscous ? "laplacian_from_viscosity" : "laplacian_matrix");
}

Contribution read_pspg(Input&, Scene&) {
  return [](const Scene& scene, Recipe& recipe) {
    add_laplacian(scene, recipe);
    recipe.add("assemble", "stabilize_pspg");
  };
}

/// A bulk viscosity even of an inviscid liquid.
Contribution read_vms(Input&, Scene&) {
  return adds("assemble", {"viscosity_matrix", "add_vms_bulk_viscosity", "stabilize_vms"});
}

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
  return [](const Scene& scene, Recipe& recipe) {
    add_laplacian(scene, recipe);
    recipe.add("assemble", "p2g_pressure_gradient");
    recipe.add("assemble", "stabilize_oss");
    recipe.add("solve", "g2p_pressure_gradient");
    recipe.seed([](const Scene& of, World& world, SeedProblems&) {
      with_dimension(of.dimension, [&](auto dim) { seed_pressure_gradient<dim()>(of, world); });
    });
  };
}

}  // namespace

void add_stabilization(SystemRegistry& registry) {
  registry.add<AssembleLaplacian>("laplacian_matrix");
  registry.add<LaplacianFromViscosity>("laplacian_from_viscosity");
  registry.add<StabilizePspg>("stabilize_pspg");
  registry.add<StabilizeVms>("stabilize_vms");
  registry.add<AddVmsBulkViscosity>("add_vms_bulk_viscosity");
  registry.add<StabilizeOss>("stabilize_oss");
  registry.add<G2PPressureGradient>("g2p_pressure_gradient");
  registry.add<P2GPressureGradient>("p2g_pressure_gradient");
  registry.add(Stabilization{{"oss", "orthogonal subscales: what the projected pressure gradient leaves", read_oss}});
  registry.add(Stabilization{{"pspg", "residual of the momentum balance, one parameter tau", read_pspg}});
  registry.add(Stabilization{{"vms", "variational multiscale, parameters per cell, with a bulk viscosity", read_vms}});
  registry.add(choice<Stabilization>("stabilization", "pressure stabilization", "pspg"));
}

}  // namespace minamo
