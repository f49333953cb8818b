#include "components/grid.hpp"
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

Contribution read_grid(Input& input, Scene& scene) {
  const auto dimension = static_cast<std::size_t>(scene.dimension);
  scene.grid.periodic.assign(dimension, false);
  input.object("grid", "the box and its cells", Input::Presence::required,
               [&](Input& in) { read_box(in, dimension, scene.grid); });
  return [](const Scene& of, Recipe& recipe) {
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
