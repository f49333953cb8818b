#include "components/fluids.hpp"
#include "systems/scene/parts.hpp"
#include "systems/scene/read_shape.hpp"
#include "systems/scene/scene.hpp"
#include "systems/scene/scene_checks.hpp"
#include "systems/seeding/regions.hpp"
#include "systems/seeding/seed_particles.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace minamo {

namespace {

using Region = std::variant<Where, SharedShape<2>, SharedShape<3>>;

/// A shape, or `where`.
Region read_region(Input& input, const Scene& scene) {
  std::optional<Where> where;
  const Input::Variants where_it_is_true{
      {"where", [&](Input& in) {
         where = Where{in.expression("where", scene.scope, {.doc = "particles wherever this is true"})};
         check_coordinates(in, "where", where->inside, scene.dimension);
       }}};
  return with_dimension(scene.dimension, [&](auto dim) {
    auto shape = read_shape<dim()>(input, scene, ShapePlace::inside_the_grid, where_it_is_true);
    return shape ? Region(std::move(shape)) : Region(where.value_or(Where()));
  });
}

/// Whether the surface lies along the grid: as far apart as particles are, it may be told by whole ones.
template <int Dim>
bool is_along_grid(const Shape<Dim>& shape) {
  const auto parts = shape.convex_parts();
  if (!parts) return false;
  return std::all_of(parts->begin(), parts->end(), [](const ConvexPart<Dim>& part) {
    return std::all_of(part.begin(), part.end(), [](const Facet<Dim>& facet) {
      return facet.face == Facet<Dim>::inner || facet.normal.cwiseAbs().maxCoeff() > 1 - 1e-12;
    });
  });
}

/// Whether whole particles stand for a region unless the scene says otherwise. Those that an oblique or curved surface
/// cuts would make steps of it; of an expression nothing tells how its surface lies.
bool is_told_by_lattice(const Region& region) {
  if (std::holds_alternative<Where>(region)) return true;
  const auto of_shape = [](const auto& shape) { return !shape->is_bounded_by_distance() || is_along_grid(*shape); };
  const auto* plane = std::get_if<SharedShape<2>>(&region);
  return plane != nullptr ? of_shape(*plane) : of_shape(std::get<SharedShape<3>>(region));
}

std::size_t read_fluid_of(Input& input, const Scene& scene) {
  const std::string doc = "which of the \"fluids\"; required with several";
  const auto* fluids = scene.facts.find<Fluids>();
  if (!input.describing() && fluids != nullptr && !fluids->names.empty()) {
    const auto& names = fluids->names;
    const auto only = names.size() == 1 ? std::optional(names.front()) : std::nullopt;
    const auto named = std::find(names.begin(), names.end(), input.choice("fluid", names, doc, only));
    return static_cast<std::size_t>(named - names.begin());
  }
  const bool is_named = input.optional_text("fluid", doc).has_value();
  if (is_named && !input.describing() && fluids == nullptr)
    input.problem("fluid", "there are no fluids with names", "\"fluids\", not \"fluid\"");
  return 0;
}

ParticleScene read_particles(Input& input, const Scene& scene, CutRegions& cut) {
  ParticleScene particles;
  input.object("shape", "the region that is filled", Input::Presence::required,
               [&](Input& shape) { particles.shape = read_region(shape, scene); });
  particles.per_cell = static_cast<int>(input.integer(
      "per_cell", {.doc = "particles per cell and direction", .fallback = 3, .at_least = 1, .at_most = 16}));
  if (input.sound("shape") && input.sound("per_cell")) check_particle_count(input, particles, scene.grid);
  bool is_cut = false;
  const bool is_where = std::holds_alternative<Where>(particles.shape);
  input.variant("arrangement",
                "where in a cell the particles start; \"lattice\" of a \"where\", of a \"distance\", and if all of the "
                "shape lies along the grid",
                !input.describing() && is_told_by_lattice(particles.shape) ? "lattice" : "cut",
                {{"lattice", [](Input&) {}},
                 {"jittered",
                  [&](Input& in) {
                    particles.jitter = static_cast<std::uint64_t>(
                        in.integer("seed", {.doc = "of the random numbers", .fallback = 1, .at_least = 0}));
                  }},
                 {"cut", [&](Input&) { is_cut = true; }}});
  if (is_cut && !input.describing() && input.sound("shape") && is_where) {
    input.problem("arrangement", "\"where\" has no distance to cut parts at", "another shape, or \"lattice\"",
                  "\"cut\"");
    is_cut = false;
  }
  cut.is_cut.push_back(is_cut);
  particles.velocity = read_vector(input, "velocity", scene, {.unit = "m/s", .doc = "initial velocity", .fallback = 0});
  return particles;
}

/// A liquid that no region names was misspelt, or forgotten.
void check_fluids_used(Input& input, const Scene& scene) {
  const auto* fluids = scene.facts.find<Fluids>();
  if (fluids == nullptr || !input.sound("particles")) return;
  const auto& of_regions = scene.facts.get<FluidsOfRegions>().of;
  for (std::size_t k = 0; k < fluids->names.size(); ++k) {
    if (std::find(of_regions.begin(), of_regions.end(), k) != of_regions.end()) continue;
    input.problem("fluids/" + fluids->names[k], "no particles of it",
                  fmt::format("particles with \"fluid\": \"{}\"", fluids->names[k]));
  }
}

/// Whether there is an opening through which liquid comes into an empty box. Openings are read later.
bool may_come_in(const Input& root) {
  for (std::size_t k = 0; k < root.elements("openings").value_or(0); ++k) {
    const std::string opening = fmt::format("openings/{}", k);
    const auto keys = root.names(opening + "/inflow");
    const auto has = [&](const char* key) { return std::find(keys.begin(), keys.end(), key) != keys.end(); };
    if (has("velocity") || has("rate")) return true;
  }
  return false;
}

Contribution read_regions(Input& input, Scene& scene) {
  FluidsOfRegions fluids;
  CutRegions cut;
  input.list("particles", "regions filled with liquid; none where all of it comes in through openings", 0,
             [&](Input& in, std::size_t) {
               fluids.of.push_back(read_fluid_of(in, scene));
               scene.particles.push_back(read_particles(in, scene, cut));
             });
  if (!input.describing() && scene.particles.empty() && input.sound("particles") && !may_come_in(input)) {
    input.problem("particles", "no liquid",
                  "at least one region, or an inflow by velocity or rate: a level outside lets in where liquid is",
                  input.has("particles") ? "" : "none");
  }
  scene.facts.set(fluids);
  scene.facts.set(cut);
  check_fluids_used(input, scene);
  return [](const Scene&, Recipe& recipe) {
    recipe.seed([](const Scene& of, World& world, SeedProblems& problems) {
      with_dimension(of.dimension, [&](auto dim) { seed_particles<dim()>(of, world, problems); });
    });
  };
}

}  // namespace

void add_particles(SystemRegistry& registry) {
  registry.add(Part{"particles", "regions filled with liquid", read_regions});
}

}  // namespace minamo
