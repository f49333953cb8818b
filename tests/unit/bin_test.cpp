#include "support/extremes.hpp"
#include "support/kernels.hpp"

#include <catch2/catch.hpp>

#include <set>

using namespace minamo;
using namespace minamo::kernels;

namespace {

/// Wide enough for three blocks of cells in a row, so that colours come back.
template <int Dim>
Grid<Dim> wide_grid() {
  Grid<Dim> grid;
  grid.spacing = 0.25;
  for (int d = 0; d < Dim; ++d) {
    grid.cells[static_cast<std::size_t>(d)] = 17 - d;
    grid.high[d] = grid.spacing * (17 - d);
  }
  return grid;
}

constexpr std::size_t particles = 3000;

template <int Dim>
void bin_random(World& world) {
  fill<Dim>(world, particles, 31, wide_grid<Dim>());
}

/// The nodes that the particles of a block of cells can write to.
template <int Dim>
std::set<std::size_t> nodes_of(const Grid<Dim>& grid, const OccupiedCells<Dim>& cells,
                               const typename OccupiedCells<Dim>::Block& block) {
  std::set<std::size_t> nodes;
  for (std::size_t c = block.begin; c < block.end; ++c) {
    const Support<Dim> support(grid, cells.cells[c]);
    nodes.insert(support.node.begin(), support.node.end());
  }
  return nodes;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the cells share out all particles, in order", "[unit]", ((int Dim), Dim), 2, 3) {
  World world;
  bin_random<Dim>(world);
  std::size_t next = 0;
  bool in_order = true;
  for (const auto& cell : world.resource<OccupiedCells<Dim>>().cells) {
    in_order = in_order && cell.begin == next && cell.end > cell.begin;
    next = cell.end;
  }
  CHECK(in_order);
  CHECK(next == particles);
}

TEMPLATE_TEST_CASE_SIG("a particle is in the dual cell of the nearest node", "[unit]", ((int Dim), Dim), 2, 3) {
  World world;
  bin_random<Dim>(world);
  const Grid<Dim> grid = wide_grid<Dim>();
  const auto y_p = world.column<particle::QuadraturePosition<Dim>>();
  Largest farthest;
  for (const auto& cell : world.resource<OccupiedCells<Dim>>().cells) {
    for (std::size_t p = cell.begin; p < cell.end; ++p) {
      farthest.add((y_p[p] - grid.position(cell.node)).cwiseAbs().template maxCoeff<Eigen::PropagateNaN>());
    }
  }
  CHECK(farthest.value() <= 0.5 * grid.spacing);
}

TEMPLATE_TEST_CASE_SIG("particles of one cell keep their order", "[unit]", ((int Dim), Dim), 2, 3) {
  World world;
  bin_random<Dim>(world);
  const auto id = world.column<particle::Id>();
  bool rising = true;
  for (const auto& cell : world.resource<OccupiedCells<Dim>>().cells) {
    rising = rising && std::is_sorted(id.begin() + cell.begin, id.begin() + cell.end);
  }
  CHECK(rising);
}

TEMPLATE_TEST_CASE_SIG("what a particle carries is sorted with it", "[unit]", ((int Dim), Dim), 2, 3) {
  World world;
  const Grid<Dim> grid = wide_grid<Dim>();
  set_grid<Dim>(world, grid);
  world.resize<Particles>(particles);
  const auto carry = [&](const auto& check) {
    const auto y_p = world.column<particle::QuadraturePosition<Dim>>();
    const auto v_p = world.column<particle::Velocity<Dim>>();
    const auto id = world.column<particle::Id>();
    for (std::size_t p = 0; p < particles; ++p) check(id[p], y_p[p], v_p[p]);
  };
  Random random(32);
  std::int64_t next = 0;
  carry([&](std::int64_t& id, Vec<Dim>& y, Vec<Dim>& v) {
    id = next++;
    y = random_place<Dim>(random, grid, static_cast<std::size_t>(id));
    v = static_cast<double>(id) * y;
  });
  run<Bin<Dim>>(world);
  bool together = true;
  carry([&](std::int64_t id, const Vec<Dim>& y, const Vec<Dim>& v) {
    together = together && v == Vec<Dim>(static_cast<double>(id) * y);
  });
  CHECK(together);
}

TEMPLATE_TEST_CASE_SIG("the blocks share out all cells", "[unit]", ((int Dim), Dim), 2, 3) {
  World world;
  bin_random<Dim>(world);
  const auto& cells = world.resource<OccupiedCells<Dim>>();
  std::vector<int> times(cells.cells.size(), 0);
  for (const auto& colour : cells.blocks) {
    for (const auto& block : colour) {
      for (std::size_t c = block.begin; c < block.end; ++c) ++times[c];
    }
  }
  CHECK(times == std::vector<int>(times.size(), 1));
}

TEMPLATE_TEST_CASE_SIG("blocks of one colour share no node", "[unit]", ((int Dim), Dim), 2, 3) {
  World world;
  bin_random<Dim>(world);
  const auto& cells = world.resource<OccupiedCells<Dim>>();
  const auto c = GENERATE(range(std::size_t{0}, OccupiedCells<Dim>::colours));
  CAPTURE(c);
  std::set<std::size_t> taken;
  std::size_t sum = 0;
  for (const auto& block : cells.blocks[c]) {
    const auto nodes = nodes_of<Dim>(wide_grid<Dim>(), cells, block);
    sum += nodes.size();
    taken.insert(nodes.begin(), nodes.end());
  }
  CHECK(sum == taken.size());
}

TEST_CASE("blocks of one colour share no node across the ends of periodic axes", "[unit]") {
  const int cells = GENERATE(range(5, 27));
  CAPTURE(cells);
  Grid<2> grid;
  grid.spacing = 0.25;
  grid.cells = {cells, 17};
  grid.high = grid.spacing * Vec<2>(cells, 17);
  grid.periodic = {true, false};
  World world;
  set_grid<2>(world, grid);
  world.resize<Particles>(grid.node_count());
  for (std::size_t i = 0; i < grid.node_count(); ++i) {
    world.column<particle::QuadraturePosition<2>>()[i] = node_position<2>(grid, i);
  }
  sort<2>(world);
  const auto& occupied = world.resource<OccupiedCells<2>>();
  REQUIRE(occupied.cells.size() == grid.node_count());
  std::size_t shared = 0;
  for (const auto& colour : occupied.blocks) {
    std::set<std::size_t> taken;
    std::size_t sum = 0;
    for (const auto& block : colour) {
      const auto nodes = nodes_of<2>(grid, occupied, block);
      sum += nodes.size();
      taken.insert(nodes.begin(), nodes.end());
    }
    shared += sum - taken.size();
  }
  CHECK(shared == 0);
}

TEST_CASE("a colour has several blocks in a wide grid", "[unit]") {
  World world;
  bin_random<2>(world);
  CHECK(world.resource<OccupiedCells<2>>().blocks[0].size() == 4);  // 2 x 2 of 4 x 4 blocks
}

TEST_CASE("sorting sorted particles changes nothing", "[unit]") {
  World world;
  bin_random<2>(world);
  const auto id = world.column<particle::Id>();
  const std::vector<std::int64_t> before(id.begin(), id.end());
  run<Bin<2>>(world);
  const auto after = world.column<particle::Id>();
  CHECK(std::equal(before.begin(), before.end(), after.begin(), after.end()));
}
