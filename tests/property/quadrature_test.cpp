#include "support/dense_equations.hpp"
#include "support/extremes.hpp"
#include "support/kernels.hpp"
#include "support/scenes.hpp"

#include "systems/equal_order/mass_balance.hpp"
#include "systems/grid/activate.hpp"
#include "systems/grid/filled_nodes.hpp"
#include "systems/grid/node_neighbours.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::kernels;
using namespace minamo::scene_run;

namespace {

constexpr double density = 1000;

/// A lattice of 4 particles per cell and direction, each moved by up to `shift` of its distance to the next, below
/// x = `surface` cells: cells at walls and away from them, full ones, ones at the surface, empty ones.
template <int Dim>
void fill_lattice(World& world, double shift, double surface, std::uint64_t seed) {
  const Grid<Dim> grid = small_grid<Dim>();
  set_grid<Dim>(world, grid);
  world.resource<Fluid>() = {density, 0};
  constexpr int per_cell = 4;
  const double apart = grid.spacing / per_cell;
  Random random(seed);
  std::vector<Vec<Dim>> places;
  Index<Dim> count;
  for (int d = 0; d < Dim; ++d) count[static_cast<std::size_t>(d)] = per_cell * grid.cells[static_cast<std::size_t>(d)];
  count[0] = static_cast<int>(per_cell * surface);
  const auto add_row = [&](auto&& self, Index<Dim> at, std::size_t d) -> void {
    for (at[d] = 0; at[d] < count[d]; ++at[d]) {
      if (d > 0) {
        self(self, at, d - 1);
        continue;
      }
      Vec<Dim> x = grid.low;
      for (int e = 0; e < Dim; ++e) x[e] += apart * (at[static_cast<std::size_t>(e)] + 0.5 + shift * random(-0.5, 0.5));
      places.push_back(x);
    }
  };
  add_row(add_row, Index<Dim>{}, Dim - 1);
  world.resize<Particles>(places.size());
  const auto y_p = world.column<particle::QuadraturePosition<Dim>>();
  const auto m_p = world.column<particle::Mass>();
  const auto id = world.column<particle::Id>();
  for (std::size_t p = 0; p < places.size(); ++p) {
    y_p[p] = places[p];
    m_p[p] = density * std::pow(apart, Dim);
    id[p] = static_cast<std::int64_t>(p);
  }
  set_volumes(world);
  sort<Dim>(world);
  run<P2GMass<Dim>>(world);
  run<FindFilledNodes<Dim>>(world);
}

/// A tank with jittered particles that fill it up to 4.75 of 7 cells: walls, full cells, a surface.
template <int Dim>
Json tank() {
  Json scene = Json::parse(R"({"fluid": {"density": 1000, "viscosity": 2},
    "transfer": {"scheme": "tpic", "inertia": "lumped", "spin": "gradient"}, "solver": {"scheme": "umfpack"},
    "time": {"end": 1, "step": 1e-3}})");
  const std::vector<double> low(Dim, 0);
  const std::vector<double> high = Dim == 2 ? std::vector{0.7, 0.5} : std::vector{0.7, 0.5, 0.4};
  const std::vector<int> cells = Dim == 2 ? std::vector{7, 5} : std::vector{7, 5, 4};
  scene["dimension"] = Dim;
  scene["grid"] = {{"low", low}, {"high", high}, {"cells", cells}};
  scene["body_force"] = Dim == 2 ? Json{-9.81, 0} : Json{-9.81, 0, 0};
  scene["particles"] = {{{"shape", {{"where", "x < 0.475"}}}, {"per_cell", 4}, {"arrangement", "jittered"}}};
  return of_equal_order(scene);
}

/// Of norms of whole matrices; moments of degree 4, whose terms cancel: 1e-15 measured.
constexpr double rounding_of_moments = 8e-15;

/// The assembled equations are those of plain loops over particles and Gauss points.
template <int Dim>
void check_equations(SceneRun& run) {
  const auto got = dense::as_assembled<Dim>(run.world());
  const auto expected = dense::assemble<Dim>(run);
  REQUIRE(got.matrix.rows() == expected.matrix.rows());
  const auto differs = [](const auto& a, const auto& b) { return (a - b).norm() / b.norm(); };
  CHECK(differs(got.matrix, expected.matrix) < rounding_of_moments);
  CHECK(differs(got.right_hand_side, expected.right_hand_side) < rounding_of_moments);
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("theta of a node is that of the least filled node around it", "[property]", ((int Dim), Dim), 2,
                       3) {
  World world;
  fill_lattice<Dim>(world, 0.2, 4.75, 31);
  const Grid<Dim> grid = small_grid<Dim>();
  const auto theta = on_grid<Dim, node::FilledIndicator>(world);
  const auto m_i = on_grid<Dim, node::Mass>(world);
  std::size_t full = 0;
  std::size_t partly = 0;
  for (std::size_t i = 0; i < theta.size(); ++i) {
    const Index<Dim> own = grid.index(i);
    Smallest least;
    for_each_support<Dim>([&](std::size_t, const Index<Dim>& offset) {
      Index<Dim> at;
      double volume = 1;
      for (std::size_t d = 0; d < at.size(); ++d) {
        at[d] = std::clamp(own[d], 1, grid.cells[d] - 1) + offset[d] - 1;
        const int from_wall = std::min(at[d], grid.cells[d] - at[d]);
        volume *= grid.spacing * (from_wall == 0 ? 13. / 24 : from_wall == 1 ? 23. / 24 : 1);
      }
      least.add(m_i[grid.row(at)] / (density * volume));
    });
    CAPTURE(i, least.value());
    CHECK(std::abs(theta[i] - std::clamp((least.value() - 0.9) / 0.07, 0., 1.)) < 3e-15);  // a rounding of 1, over 0.07
    full += theta[i] == 1;
    partly += theta[i] > 0 && theta[i] < 1;
    // The surface lies 4.75 cells from the wall; node 5 is not full.
    if (own[0] >= 4) CHECK(theta[i] == 0);
  }
  CHECK(full > 0);
  CHECK(partly > 0);
}

TEMPLATE_TEST_CASE_SIG("mixed quadrature is the integral of theta and the sum of 1 - theta over particles",
                       "[property][long]", ((int Dim), Dim), 2, 3) {
  std::string integrator = "midpoint";
  if constexpr (Dim == 2) integrator = GENERATE(as<std::string>(), "midpoint", "newmark");  // 3-D takes 20 s sanitized
  SceneRun run(with(tank<Dim>(), {R"(/integrator={"scheme": ")" + integrator + "\"}"}));
  run.step();
  const auto theta = run.world().template column<node::FilledIndicator>();
  CHECK(std::count(theta.begin(), theta.end(), 0) > 0);
  CHECK(std::count(theta.begin(), theta.end(), 1) > 0);
  CHECK(std::count_if(theta.begin(), theta.end(), [](double t) { return t > 0 && t < 1; }) > 0);
  check_equations<Dim>(run);
}

TEMPLATE_TEST_CASE_SIG("inside the liquid matrices do not depend on where the particles are", "[property]",
                       ((int Dim), Dim), 2, 3) {
  const auto rows_of = [](std::uint64_t seed) {
    World world;
    fill_lattice<Dim>(world, 0.3, 7, seed);
    run<Activate<Dim>>(world);
    run<GatherMoments<Dim>>(world);
    run<FindNeighbours<Dim>>(world);
    for (double& rho_c : world.column<cell::Density>()) rho_c = density;
    for (double& tau_c : world.column<cell::Tau>()) tau_c = 1e-6;
    run<AssembleDivergence<Dim>>(world);
    run<AssembleLaplacian<Dim>>(world);
    const auto C = world.column<matrix::Stabilization<Dim>>();
    return std::vector(C.begin(), C.end());
  };
  // The box is full: every cell is.
  CHECK(rows_of(33) == rows_of(34));
}

TEMPLATE_TEST_CASE_SIG("where nothing is full, mixed quadrature is that of the particles", "[property]",
                       ((int Dim), Dim), 2, 3) {
  World world;
  fill<Dim>(world, 300, 35);
  world.resource<Fluid>() = {1e9, 0};  // the particles have hardly any volume
  run<GatherMoments<Dim>>(world);
  const auto sums = world.resource<Moments<Dim>>();
  run<FindFilledNodes<Dim>>(world);
  run<GatherMoments<Dim>>(world);
  const auto& mixed = world.resource<Moments<Dim>>();
  Largest worst;
  for (std::size_t c = 0; c < sums.of_cell.size(); ++c) {
    for (std::size_t k = 0; k < sums.of_cell[c].size(); ++k) {
      worst.add(std::abs(mixed.of_cell[c][k] - sums.of_cell[c][k]) / sums.of_cell[c][0]);
    }
  }
  CHECK(worst.value() < 1e-15);  // 0 measured
  CHECK(std::count(mixed.is_filled.begin(), mixed.is_filled.end(), 1) == 0);
}

TEST_CASE("the integral ends where dual cells hold no particle", "[property]") {
  // One particle in the middle of every cell lies in the corner of a dual cell, that nearer to the middle of the box;
  // the outermost are moved towards the walls: nodes one cell off a wall have none.
  SceneRun run(with(tank<2>(), {R"(/particles=[{"shape": {"where": "1"}, "per_cell": 1}])", "/grid/high=[0.7, 0.7]",
                                "/grid/cells=[7, 7]"}));
  run.step();
  const auto theta = run.world().column<node::FilledIndicator>();
  CHECK(std::count(theta.begin(), theta.end(), 1) > 0);
  check_equations<2>(run);
}
