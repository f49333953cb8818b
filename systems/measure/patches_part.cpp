#include "systems/bodies/geometry/outlines.hpp"
#include "systems/measure/patches.hpp"
#include "systems/scene/parts.hpp"
#include "systems/scene/read_shape.hpp"
#include "systems/scene/scene_checks.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

namespace minamo {

namespace {

/// Whatever else is wrong with them.
std::vector<std::string> names_of_bodies(const Input& root) {
  std::vector<std::string> names;
  for (std::size_t b = 0; b < root.elements("bodies").value_or(0); ++b)
    names.push_back(root.text_at(fmt::format("bodies/{}/name", b)).value_or(""));
  return names;
}

template <int Dim>
void read_patch(Input& input, Scene& scene, const std::vector<std::string>& bodies, Patches<Dim>& patches) {
  typename Patches<Dim>::Patch patch;
  patch.name = input.text("name", {.doc = "its columns are NAME_pressure, NAME_force_x, ..."});
  const std::string body = input.text("body", {.doc = "name of a body"});
  input.object("within", "a shape: the patch is the surface of the body in it, at the start; without it, all of it",
               Input::Presence::only_if_present,
               [&](Input& in) { patch.within = read_shape<Dim>(in, scene, ShapePlace::anywhere); });
  if (input.describing()) return;
  if (input.sound("name")) check_column_name(input, patch.name, "patch", scene);
  if (!input.sound("body")) return;
  const auto found = std::find(bodies.begin(), bodies.end(), body);
  if (found == bodies.end()) {
    input.problem("body", "no body of that name",
                  bodies.empty() ? "one of /bodies, of which there are none"
                                 : fmt::format("{}", fmt::join(bodies, ", ")),
                  shown(Json(body)), input.closest(body, bodies));
    return;
  }
  patch.body = static_cast<std::size_t>(found - bodies.begin());
  patches.patches.push_back(std::move(patch));
}

/// Pieces as fine as the pressure can tell.
constexpr double pieces_per_cell = 4;

template <int Dim>
void seed_patches(Patches<Dim> patches, World& world, SeedProblems& problems) {
  const double size = world.resource<Grid<Dim>>().spacing / pieces_per_cell;
  for (std::size_t k = 0; k < patches.patches.size(); ++k) {
    auto& patch = patches.patches[k];
    const auto& outline = world.resource<BodyOutlines<Dim>>().bodies[patch.body];
    patch.pieces = pieces_of<Dim>(outline.outline, size);
    if (!patch.within) continue;
    std::erase_if(patch.pieces, [&](const auto& piece) { return !patch.within->contains(piece.middle); });
    if (patch.pieces.empty()) {
      problems.note(fmt::format("/patches/{}/within", k), "no surface of the body is in it",
                    "a shape around a part of the surface", fmt::format("body \"{}\"", outline.name));
    }
  }
  world.resource<Patches<Dim>>() = std::move(patches);
}

template <int Dim>
Contribution read_patches_in(Input& input, Scene& scene) {
  Patches<Dim> patches;
  const auto bodies = names_of_bodies(input);
  input.list("patches", "parts of the surfaces of bodies whose pressure goes into the history", 0,
             [&](Input& in, std::size_t) { read_patch<Dim>(in, scene, bodies, patches); });
  if (patches.patches.empty()) return {};
  return [patches](const Scene&, Recipe& recipe) {
    recipe.seed(
        [patches](const Scene&, World& world, SeedProblems& problems) { seed_patches<Dim>(patches, world, problems); });
  };
}

Contribution read_patches(Input& input, Scene& scene) {
  return with_dimension(scene.dimension, [&](auto dim) { return read_patches_in<dim()>(input, scene); });
}

}  // namespace

void add_patches(SystemRegistry& registry) {
  registry.add<MeasurePatches>("measure_patches", OnRanks::adds_up);
  registry.add(Part{"patches", "parts of the surfaces of bodies whose pressure goes into the history", read_patches});
}

}  // namespace minamo
