#include "components/step.hpp"
#include "engine/run/communicator.hpp"
#include "systems/equal_order/block.hpp"
#include "systems/equal_order/monolithic.hpp"
#include "systems/equal_order/unpack.hpp"
#include "systems/equal_order/velocity_factors.hpp"
#include "systems/linear/umfpack.hpp"
#include "systems/scene/discretization.hpp"
#include "systems/scene/parts.hpp"
#include "systems/scene/schemes.hpp"
#include "systems/step/memory.hpp"
#include "systems/step/time_plan.hpp"
#include "systems/viscosity/friction_choice.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// Whether friction couples the velocities of a step so much that the block solver may factorize them (E60).
bool is_stiff(const Scene& scene) {
  const double h = scene.grid.spacing;
  return scene.facts.get<Fluid>().viscosity * step_from_rest(scene) > 0.1 * scene.facts.get<Fluid>().density * h * h;
}

/// The block solver's: whole factors, of the velocities in stiff liquids, of the pressure where few particles have many
/// nodes, have more in a node the more nodes there are. In 3-D those of the velocities end at a number of nodes.
double block_bytes_per_node(const Scene& scene, double nodes) {
  if (scene.dimension == 2) return 8e3 + (is_stiff(scene) ? 900 * std::log2(nodes) : 0);
  const double factorized = std::min(nodes, most_factorized_in_space / 3.0);
  const double of_velocity = is_stiff(scene) ? 6e3 * std::cbrt(factorized) * factorized / nodes : 0;
  const double of_pressure = fewest_per_cell(scene) == 1 ? 65 * std::pow(nodes, 2.0 / 3) : 0;
  return 45e3 + of_velocity + of_pressure;
}

/// A node of UMFPACK's factors has more the more nodes there are.
double umfpack_bytes_per_node(const Scene& scene, double nodes) {
  // Without viscosity the directions are not coupled directly.
  const double coupled = scene.facts.get<Fluid>().viscosity > 0 ? 1 : 0.5;
  return scene.dimension == 2 ? 2e3 + coupled * 4e3 * std::log2(nodes) : 45e3 + coupled * 20e3 * std::cbrt(nodes);
}

Contribution read_tolerance(Input& input, Scene&) {
  const SolverTolerance tolerance{input.number(
      "tolerance", {.doc = "residual over right-hand side", .fallback = 1e-8, .at_least = 1e-13, .at_most = 1e-3})};
  return [tolerance](const Scene&, Recipe& recipe) { recipe.constant(tolerance); };
}

Contribution read_solver(const LinearSolver& solver, Input& input, Scene& scene) {
  scene.facts.set(solver);
  if (all_ranks() != nullptr && solver.project_on_faces.empty()) {
    input.problem("scheme", "solves all equations in one process", shown(Json("block")) + " on several ranks",
                  shown(Json(solver.name)));
  }
  const Contribution options = solver.read ? solver.read(input, scene) : Contribution{};
  return [solver, options](const Scene& of, Recipe& recipe) {
    if (is_conforming(of)) {
      recipe.fill("<solve>",
                  all_ranks() == nullptr ? solver.solve_on_faces : std::vector<std::string>{"solve_multipliers_petsc"});
      recipe.fill("<project>", solver.project_on_faces);
      recipe.fill("<solve_viscosity>", solver.solve_friction_on_faces);
    } else {
      std::vector<std::string> systems = solver.prepare;
      systems.insert(systems.end(), solver.solve.begin(), solver.solve.end());
      recipe.fill("<solve>", systems);
      recipe.fill("<solve_volume>", solver.solve_volume);
    }
    recipe.constant(SolverTolerance{});
    if (options) options(of, recipe);
  };
}

}  // namespace

void add_solver(SystemRegistry& registry) {
  registry.add<AssembleMonolithic>("assemble_monolithic");
  registry.add<FactorizeUmfpack>("factorize_umfpack");
  registry.add<SolveUmfpack>("solve_umfpack");
  registry.add<SolveVolumeUmfpack>("solve_volume_umfpack");
  registry.add<AssembleSchur>("assemble_schur");
  registry.add<FactorizeVelocity>("factorize_velocity");
  registry.add<FactorizePressure>("factorize_pressure");
  registry.add<SolveBlock>("solve_block");
  registry.add<SolveVolumeBlock>("solve_volume_block");
  registry.add<UnpackSolution>("unpack_solution");
  registry.add(LinearSolver{.name = "block",
                            .doc = "block elimination and GMRES, (E55) to (E60)",
                            .prepare = {"assemble_schur", "factorize_velocity", "factorize_pressure"},
                            .solve = {"solve_block"},
                            .solve_volume = {"solve_volume_block"},
                            .read = read_tolerance,
                            .bytes_per_node = block_bytes_per_node});
  registry.add(LinearSolver{.name = "umfpack",
                            .doc = "sparse LU of all equations at once, the reference",
                            .prepare = {"assemble_monolithic", "factorize_umfpack"},
                            .solve = {"solve_umfpack"},
                            .solve_volume = {"solve_volume_umfpack"},
                            .solve_on_faces = {"solve_faces_umfpack"},
                            .project_on_faces = {},
                            .solve_friction_on_faces = {"solve_face_friction_umfpack"},
                            .bytes_per_node = umfpack_bytes_per_node,
                            .leaner = "block"});
  registry.add(choice<LinearSolver>("solver", "linear solver", always("block"), read_solver));
}

}  // namespace minamo
