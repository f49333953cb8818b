#include "systems/bodies/bodies_part.hpp"
#include "systems/ranks/ghost_cells.hpp"
#include "systems/scene/parts.hpp"
#include "systems/scene/schemes.hpp"
#include "systems/surface_tension/free_surface.hpp"
#include "systems/surface_tension/near_bodies.hpp"
#include "systems/surface_tension/tension.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <numbers>

namespace minamo {

namespace {

/// How far from a face the fill lies that its force follows from: points of the surface in the cells that touch it,
/// tractions at the sites of these, elements around those, and the nodes of their cubes.
constexpr int sites_of_surface_force = 6;

/// Exactly zero at 90 degrees, where a contact line is without force.
double cosine_of(double angle) { return angle == 90 ? 0 : std::cos(angle * std::numbers::pi / 180); }

SurfaceTension read_tension(Input& in, const Scene& scene) {
  SurfaceTension tension;
  tension.coefficient = in.number("coefficient", {.unit = "N/m", .doc = "surface tension", .at_least = 0});
  const double angle = in.number("contact_angle", {.unit = "degrees",
                                                   .doc = "in the liquid, between a wall and the free surface at rest",
                                                   .fallback = 90,
                                                   .at_least = 0,
                                                   .at_most = 180});
  const std::string scheme = in.choice("scheme", std::vector<std::string>{"explicit", "implicit"},
                                       "force of the surface as the step finds it; implicit is refused", "explicit");
  if (scheme == "implicit" && !in.describing())
    in.problem("scheme", "no implicit force was found that pays", R"("explicit", with steps up to (E116))");
  tension.cosine_of_contact_angle = cosine_of(angle);
  if (in.describing()) return tension;
  const auto* bodies = scene.facts.find<BodiesOfScene>();
  bool any_slips = scene.facts.get<WallFriction>().any_side_slips;
  if (bodies != nullptr) {
    with_dimension(scene.dimension, [&](auto dim) {
      for (const auto& body : bodies->of<dim()>().bodies) {
        const bool sticks = body.wall.kind == BodyWall::Kind::no_slip;
        tension.bodies.push_back({cosine_of(body.contact_angle.value_or(angle)), sticks});
        any_slips = any_slips || !sticks;
      }
    });
  }
  if (in.sound("contact_angle") && angle != 90 && !any_slips)
    in.problem("contact_angle", "no wall lets contact lines move",
               R"(a wall "slip", "separating" or {"slip_length": m})", R"("no_slip" everywhere)");
  return tension;
}

/// Angles of bodies that nothing is done with.
void check_bodies(Input& input, const Scene& scene, bool has_tension) {
  const auto* bodies = scene.facts.find<BodiesOfScene>();
  if (bodies == nullptr) return;
  with_dimension(scene.dimension, [&](auto dim) {
    const auto& all = bodies->of<dim()>().bodies;
    for (std::size_t b = 0; b < all.size(); ++b) {
      if (!all[b].contact_angle) continue;
      const std::string key = fmt::format("bodies/{}/contact_angle", b);
      if (!has_tension) input.problem(key, "without surface tension", R"("surface_tension": {"coefficient": ...})");
      if (has_tension && all[b].wall.kind == BodyWall::Kind::no_slip)
        input.problem(key, "without slip contact lines do not move",
                      R"("wall": "slip", "separating" or {"slip_length": m})", R"("no_slip")");
    }
  });
}

void seed_solids(const BodiesOfScene& bodies, const Scene& scene, Recipe& recipe) {
  with_dimension(scene.dimension, [&](auto dim) {
    constexpr int Dim = dim();
    recipe.seed([set = bodies.of<Dim>()](const Scene&, World& world, SeedProblems&) {
      world.resource<SolidAtRest>() =
          solid_at_rest<Dim>(set, world.resource<Grid<Dim>>(), world.resource<Splines<Dim>>());
    });
  });
}

Contribution read_surface_tension(Input& input, Scene& scene) {
  std::optional<SurfaceTension> tension;
  input.object("surface_tension", "tension of the free surface", Input::Presence::only_if_present,
               [&](Input& in) { tension = read_tension(in, scene); });
  if (input.describing()) return {};
  check_bodies(input, scene, tension.has_value());
  if (!tension) return {};
  scene.facts.set(*tension);
  return [tension](const Scene& of, Recipe& recipe) {
    recipe.constant(*tension);
    recipe.seed([](const Scene&, World& world, SeedProblems&) { reach_on_ranks(world, sites_of_surface_force); });
    if (const auto* bodies = of.facts.find<BodiesOfScene>()) seed_solids(*bodies, of, recipe);
  };
}

}  // namespace

void add_surface_tension(SystemRegistry& registry) {
  registry.add<FindSurfaceDistance>("find_surface_distance", OnRanks::adds_up);
  registry.add<ExtendSurfaceDistance>("extend_surface_distance", OnRanks::own);
  registry.add<FindFreeSurface>("find_free_surface", OnRanks::adds_up);
  registry.add<MeasureSurfaceAround>("measure_surface_around", OnRanks::own);
  registry.add<FindSurfaceTraction>("find_surface_traction", OnRanks::adds_up);
  registry.add<AddSurfaceTension>("add_surface_tension", OnRanks::own);
  registry.add<MeasureSurfaceEnergy>("measure_surface_energy", OnRanks::adds_up);
  registry.add<MeasureSurfaceEnergyAtStart>("measure_surface_energy_at_start", OnRanks::adds_up);
  registry.add(Part{"surface_tension", "tension of the free surface, contact angle", read_surface_tension});
}

}  // namespace minamo
