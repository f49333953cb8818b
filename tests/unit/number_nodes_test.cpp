#include "support/kernels.hpp"

#include <catch2/catch.hpp>

#include <set>

using namespace minamo;
using namespace minamo::kernels;

namespace {

/// 30 cells along every axis, a periodic one first.
template <int Dim>
Grid<Dim> roomy_grid() {
  Grid<Dim> grid;
  grid.spacing = 0.5;
  grid.cells.fill(30);
  grid.high = Vec<Dim>::Constant(15);
  grid.periodic[0] = true;
  return grid;
}

/// Particles at random places of a cube, sorted, their nodes numbered.
template <int Dim>
void place(World& world, double low, double high, std::uint64_t seed) {
  world.resource<Grid<Dim>>() = roomy_grid<Dim>();
  world.resize<Particles>(50);
  Random random(seed);
  for (Vec<Dim>& y : world.column<particle::QuadraturePosition<Dim>>()) {
    y = fold<Dim>(roomy_grid<Dim>(), random.vector<Dim>(low, high));
  }
  run<Bin<Dim>>(world);
  run<NumberNodes<Dim>>(world);
}

/// Places in the order of the grid of the 3^d nodes around every occupied cell.
template <int Dim>
std::set<std::size_t> touched(World& world) {
  const Grid<Dim> grid = roomy_grid<Dim>();
  std::set<std::size_t> places;
  for (const auto& cell : world.resource<OccupiedCells<Dim>>().cells) {
    const SupportBox<Dim> support(grid, cell.node);
    for_each_support<Dim>(
        [&](std::size_t, const Index<Dim>& offset) { places.insert(grid.row(support.site(grid, offset))); });
  }
  return places;
}

template <int Dim>
std::vector<std::size_t> numbered(World& world) {
  std::vector<std::size_t> places;
  for (const Index<Dim>& site : world.column<node::Site<Dim>>()) places.push_back(roomy_grid<Dim>().row(site));
  return places;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the nodes of occupied cells have rows, in the order of the grid, and no others", "[unit]",
                       ((int Dim), Dim), 2, 3) {
  // At a wall and the seam of the periodic axis, inside, at the far end.
  const double low = GENERATE(-0.5, 4.0, 13.0);
  CAPTURE(low);
  World world;
  place<Dim>(world, low, low + 2.5, 71);
  const auto expected = touched<Dim>(world);
  CHECK(numbered<Dim>(world) == std::vector<std::size_t>(expected.begin(), expected.end()));
}

TEMPLATE_TEST_CASE_SIG("a cell knows the rows of its nodes", "[unit]", ((int Dim), Dim), 2, 3) {
  World world;
  place<Dim>(world, -0.5, 2, 72);
  const Grid<Dim> grid = roomy_grid<Dim>();
  const auto sites = world.column<node::Site<Dim>>();
  std::size_t wrong = 0;
  for (const auto& cell : world.resource<OccupiedCells<Dim>>().cells) {
    const Support<Dim> support(grid, cell);
    for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) {
      wrong += sites[support.node[k]] != support.site(grid, offset);
    });
    wrong += sites[support.own()] != cell.node;
  }
  CHECK(wrong == 0);
}

TEMPLATE_TEST_CASE_SIG("nodal state moves with its node; a node that was dry starts from zero", "[unit]",
                       ((int Dim), Dim), 2, 3) {
  World world;
  place<Dim>(world, 1, 4, 73);
  const auto before = numbered<Dim>(world);
  for (std::size_t i = 0; i < before.size(); ++i) {
    world.column<node::Pressure>()[i] = 1 + static_cast<double>(before[i]);
  }
  place<Dim>(world, 2, 5, 74);
  const auto after = numbered<Dim>(world);
  const std::set<std::size_t> was_wet(before.begin(), before.end());
  std::vector<double> expected;
  for (const std::size_t place : after) {
    expected.push_back(was_wet.count(place) == 1 ? 1 + static_cast<double>(place) : 0);
  }
  REQUIRE(std::count(expected.begin(), expected.end(), 0.0) > 0);
  REQUIRE(std::count(expected.begin(), expected.end(), 0.0) < static_cast<std::ptrdiff_t>(expected.size()));
  const auto p_i = world.column<node::Pressure>();
  CHECK(std::vector<double>(p_i.begin(), p_i.end()) == expected);
}

TEST_CASE("a node has what the walls at its site hold", "[unit]") {
  World world;
  world.resource<Walls<2>>().held[1] = {0b10, 0b11};
  const double low = GENERATE(-0.5, 12.6);
  CAPTURE(low);
  place<2>(world, low, low + 2.4, 75);
  const auto sites = world.column<node::Site<2>>();
  const auto fixed = world.column<node::Constraint>();
  std::size_t wrong = 0;
  std::size_t held = 0;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const int expected = sites[i][1] == 0 ? 0b10 : sites[i][1] == 30 ? 0b11 : 0;
    wrong += fixed[i] != expected;
    held += expected != 0;
  }
  CHECK(wrong == 0);
  CHECK(held > 0);
}
