#include "components/grid.hpp"
#include "engine/run/communicator.hpp"
#include "systems/grid/activate.hpp"
#include "systems/grid/bin.hpp"
#include "systems/grid/capacity.hpp"
#include "systems/grid/grid_of.hpp"
#include "systems/grid/node_neighbours.hpp"
#include "systems/grid/number_nodes.hpp"
#include "systems/scene/discretization.hpp"
#include "systems/scene/parts.hpp"
#include "systems/scene/scene_checks.hpp"

namespace minamo {

namespace {

void read_box(Input& in, std::size_t dimension, GridScene& grid) {
  grid.low = in.numbers("low", dimension, {.unit = "m", .doc = "corner of the box"});
  grid.high = in.numbers("high", dimension, {.unit = "m", .doc = "opposite corner of the box"});
  for (const auto count : in.integers(
           "cells", dimension,
           {.doc = "cells per direction; the spacing must come out equal", .at_least = 3, .at_most = 1'000'000})) {
    grid.cells.push_back(static_cast<int>(count));
  }
  if (in.sound("low") && in.sound("high") && in.sound("cells")) check_grid(in, grid);
}

std::vector<std::string> sort_on_faces(const Scene& scene) {
  if (all_ranks() == nullptr) return {"bin_by_cell", "number_sites"};
  std::vector<std::string> systems{"migrate_particles", "bin_by_cell", "find_ghost_cells", "number_sites",
                                   "plan_site_exchange"};
  if (is_conforming(scene) && scene.schemes.at("quadrature") == "exact") {
    systems.insert(systems.begin(), "keep_former_rows");
    systems.emplace_back("ask_for_former_rows");
  }
  return systems;
}

Contribution read_grid(Input& input, Scene& scene) {
  const auto dimension = static_cast<std::size_t>(scene.dimension);
  scene.grid.periodic.assign(dimension, false);
  input.object("grid", "the box and its cells", Input::Presence::required,
               [&](Input& in) { read_box(in, dimension, scene.grid); });
  return [](const Scene& of, Recipe& recipe) {
    add_systems(of, recipe, "sort", {{"bin", "number_nodes", "find_capacity"}, sort_on_faces(of)});
    add_systems(of, recipe, "boundaries", {{"activate", "find_neighbours"}, {}});
    with_dimension(of.dimension, [&](auto dim) {
      const auto grid = grid_of<dim()>(of.grid);
      recipe.constant(grid);
      if (is_conforming(of)) recipe.constant(make_splines(grid, of.facts.get<Discretization>().degree));
    });
  };
}

}  // namespace

void add_grid(SystemRegistry& registry) {
  registry.add<Bin>("bin");
  registry.add<NumberNodes>("number_nodes");
  registry.add<FindCapacity>("find_capacity");
  registry.add<FindAdvectedCapacity>("find_advected_capacity");
  registry.add<Activate>("activate");
  registry.add<FindNeighbours>("find_neighbours");
  registry.add(Part{"grid", "the box and its cells", read_grid});
}

}  // namespace minamo
