#include "systems/step/exclusions.hpp"

#include "systems/step/conditions.hpp"
#include "systems/viscosity/friction_choice.hpp"

#include <spdlog/fmt/fmt.h>

namespace minamo {

const std::vector<Exclusion>& exclusions() {
  using namespace condition;
  constexpr std::string_view on_faces = R"("discretization": {"scheme": "conforming"})";
  constexpr std::string_view on_nodes = "equal_order";
  constexpr std::string_view midpoint_rule = R"("midpoint")";
  constexpr std::string_view constant = "a constant viscosity";
  constexpr std::string_view one_fluid = R"("fluid")";
  constexpr std::string_view at_moving_walls =
      "the acceleration that it carries along a wall that moves grows without bound in four of ten hard cases";
  static const std::vector<Exclusion> table{
      {"/fluid/rheology", rheology_of_one, equal_order, on_faces, on_nodes, "its nodes have one viscosity"},
      {"/fluids", fluids, equal_order, on_faces, on_nodes, "its nodes have one density"},
      {"/bodies", bodies, equal_order, on_faces, on_nodes, "nothing cuts the cells of its nodes"},
      {"/openings", openings, equal_order, on_faces, on_nodes, "its sides are walls all along"},
      {"/sponge", sponge, equal_order, on_faces, on_nodes, "it acts on velocities of faces"},
      {"/surface_tension", surface_tension, equal_order, on_faces, on_nodes, "its force acts on faces"},
      {"/quadrature/scheme", exact, equal_order, R"("mixed")", R"("exact")", "it integrates splines of faces"},
      {"/volume/scheme", delta, conforming, R"(one of ["none", "projection"])", R"("delta")", "it shifts by nodes"},

      {"/quadrature/scheme", exact, surface_tension, R"("mixed")", R"("exact")",
       "what pressure is balanced against would have to hold the force of the surface"},

      {"/integrator/scheme", newmark, free_bodies, midpoint_rule, R"("newmark")", at_moving_walls},
      {"/integrator/scheme", newmark, moving_bodies, midpoint_rule, R"("newmark")", at_moving_walls},
      {"/integrator/scheme", newmark, openings, midpoint_rule, R"("newmark")", "what comes in has no acceleration"},
      {"/integrator/scheme", newmark, separating, midpoint_rule, R"("newmark")",
       "contact is found for velocities, not for accelerations"},

      {"/solver/scheme", umfpack, bodies, R"("block")", R"("umfpack")", "its matrix knows of no open shares"},
      {"/solver/scheme", umfpack, openings, R"("block")", R"("umfpack")", "its matrix knows of no open sides"},
      {"/solver/scheme", umfpack, separating, R"("block")", R"("umfpack")", "its matrix knows of no contact"},

      {"/discretization/degree", degree_3, openings, "2", "3",
       "edges of openings are known in splines of degree 2 alone"},

      {"/fluid/rheology", rheology_of_one, free_bodies, constant, "a rheology",
       "what free bodies take of viscosity is known at the start of a step alone"},
      {"/fluid/rheology", rheology_of_one, separating, constant, "a rheology",
       "balances are solved again for contact without the viscosity"},
      {"/fluids", rheology_of_several, separating, "constant viscosities", "a rheology",
       "balances are solved again for contact without the viscosity"},
      {"/fluids", fluids, free_bodies, one_fluid, R"("fluids")", "buoyancy knows of one density"},
      {"/openings", openings, fluids, one_fluid, R"("fluids")", "what comes in has one density"},
      {"/surface_tension", surface_tension, fluids, one_fluid, R"("fluids")", "its surface is that of one liquid"},
  };
  return table;
}

namespace {

/// In the balances viscosity is too large for what solves them without: a smaller number would do.
std::optional<Problem> too_viscous(const Scene& scene, const std::string& file) {
  if (scene.facts.find<Rheology>() != nullptr || !condition::implicit_viscosity.holds(scene)) return {};
  for (const Condition& with : {condition::free_bodies, condition::separating}) {
    if (!with.holds(scene)) continue;
    return Problem{file,
                   "/fluid/viscosity",
                   fmt::format("too large for {}", with.words),
                   least_friction_text(scene),
                   fmt::format("{} Pa s", scene.facts.get<Fluid>().viscosity),
                   {}};
  }
  return {};
}

}  // namespace

std::vector<Problem> exclusions_of(const Scene& scene, const std::string& file) {
  std::vector<Problem> problems;
  for (const Exclusion& row : exclusions()) {
    const bool is_noted = std::any_of(problems.begin(), problems.end(),
                                      [&](const Problem& problem) { return problem.pointer == row.key; });
    if (is_noted || !row.has.holds(scene) || !row.with.holds(scene)) continue;
    problems.push_back({file,
                        std::string(row.key),
                        fmt::format("not with {}", row.with.words),
                        std::string(row.expected),
                        std::string(row.got),
                        {}});
  }
  if (const auto problem = too_viscous(scene, file)) problems.push_back(*problem);
  return problems;
}

}  // namespace minamo
