#include "systems/bodies/bodies_part.hpp"
#include "systems/parts.hpp"
#include "systems/setup/discretization.hpp"
#include "systems/surface_tension/free_surface.hpp"
#include "systems/surface_tension/tension.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <numbers>

namespace minamo {

namespace {

SurfaceTension read_tension(Input& in, const Scene& scene) {
  SurfaceTension tension;
  tension.coefficient = in.number("coefficient", {.unit = "N/m", .doc = "surface tension", .at_least = 0});
  const double angle =
      in.number("contact_angle", {.unit = "degrees",
                                  .doc = "in the liquid, between a side of the box and the free surface at rest",
                                  .fallback = 90,
                                  .at_least = 0,
                                  .at_most = 180});
  in.choice("scheme", std::vector<std::string>{"explicit"}, "force of the surface as the step finds it", "explicit");
  // Exactly zero at 90 degrees, where a contact line is without force.
  tension.cosine_of_contact_angle = angle == 90 ? 0 : std::cos(angle * std::numbers::pi / 180);
  if (in.describing()) return tension;
  if (!is_conforming(scene))
    in.problem("", "not with equal_order", R"("discretization": {"scheme": "conforming"})", "equal_order");
  if (scene.facts.find<BodiesOfScene>() != nullptr && in.sound("contact_angle") && angle != 90)
    in.problem("contact_angle", "not with bodies, whose walls take 90 degrees", "90", fmt::format("{}", angle));
  return tension;
}

Contribution read_surface_tension(Input& input, Scene& scene) {
  std::optional<SurfaceTension> tension;
  input.object("surface_tension", "tension of the free surface", Input::Presence::only_if_present,
               [&](Input& in) { tension = read_tension(in, scene); });
  if (!tension || input.describing()) return {};
  scene.facts.set(*tension);
  return [tension](const Scene&, Recipe& recipe) {
    recipe.constant(*tension);
    recipe.add("material", "find_surface_distance");
    recipe.add("material", "find_free_surface");
    recipe.add("material", "measure_surface_around");
    recipe.add("material", "find_surface_traction");
    recipe.add("assemble", "add_surface_tension");
    recipe.add("measure", "measure_surface_energy", When::step);
    recipe.add("measure", "measure_surface_energy_at_start", When::standing);
  };
}

}  // namespace

void add_surface_tension(SystemRegistry& registry) {
  registry.add<FindSurfaceDistance>("find_surface_distance");
  registry.add<FindFreeSurface>("find_free_surface");
  registry.add<MeasureSurfaceAround>("measure_surface_around");
  registry.add<FindSurfaceTraction>("find_surface_traction");
  registry.add<AddSurfaceTension>("add_surface_tension");
  registry.add<MeasureSurfaceEnergy>("measure_surface_energy");
  registry.add<MeasureSurfaceEnergyAtStart>("measure_surface_energy_at_start");
  registry.add(Part{"surface_tension", "tension of the free surface, contact angle", read_surface_tension});
}

}  // namespace minamo
