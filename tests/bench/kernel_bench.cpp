/// \file
/// Kernels against the machine, a table in Markdown: `minamo_bench "[roofline]" --benchmark-samples 11`. Transfers and
/// matrices in a full box of particles at random places, the solve in a dam break.

#include "bench/roofline.hpp"
#include "engine/run/clock.hpp"
#include "engine/run/linear_solver.hpp"
#include "support/kernels.hpp"
#include "support/scene_run.hpp"
#include "systems/equal_order/mass_balance.hpp"
#include "systems/equal_order/material.hpp"
#include "systems/equal_order/viscosity.hpp"
#include "systems/grid/activate.hpp"
#include "systems/grid/node_neighbours.hpp"
#include "systems/transfer/mass.hpp"
#include "systems/transfer/tpic.hpp"

#include <catch2/catch.hpp>
#include <oneapi/tbb/global_control.h>
#include <spdlog/fmt/fmt.h>

using namespace minamo;
using roofline::Rows;
using roofline::Work;

namespace {

struct Box {
  int cells;
  std::size_t per_cell;  ///< particles, on average
};
template <int Dim>
Box box() {
  if (roofline::is_quick()) return Dim == 2 ? Box{20, 16} : Box{8, 8};
  return Dim == 2 ? Box{100, 16} : Box{30, 8};
}

/// Particles at random places with a velocity gradient, sorted, and nodes with mass and rows.
template <int Dim>
void fill(World& world) {
  const auto [cells, per_cell] = box<Dim>();
  auto& grid = world.resource<Grid<Dim>>();
  grid.spacing = 1.0 / cells;
  grid.cells.fill(cells);
  grid.low = Vec<Dim>::Zero();
  grid.high = Vec<Dim>::Ones();
  world.resource<Fluid>() = {.density = 1, .viscosity = 1};
  world.resize<Particles>(per_cell * power(static_cast<std::size_t>(cells), Dim));
  kernels::Random random(1);
  for (Vec<Dim>& y : world.column<particle::QuadraturePosition<Dim>>()) y = random.vector<Dim>(0, 1);
  for (Vec<Dim>& v : world.column<particle::Velocity<Dim>>()) v = random.vector<Dim>(-1, 1);
  for (Mat<Dim>& gradient : world.column<particle::VelocityGradient<Dim>>()) gradient = random.matrix<Dim>(-1, 1);
  for (double& m : world.column<particle::Mass>()) m = 1;
  kernels::set_volumes(world);
  kernels::run<Bin<Dim>>(world);
  kernels::run<NumberNodes<Dim>>(world);
  kernels::run<P2GMass<Dim>>(world);
  kernels::run<Activate<Dim>>(world);
  kernels::run<GatherMoments<Dim>>(world);
  REQUIRE(world.rows<ActiveNodes>() == grid.node_count());
}

template <int Dim>
Rows rows_of(World& world) {
  return {.particles = static_cast<double>(world.rows<Particles>()),
          .cells = static_cast<double>(world.resource<OccupiedCells<Dim>>().cells.size()),
          .nodes = static_cast<double>(world.rows<ActiveNodes>())};
}

/// Measures kernels that run one after the other as one, on one thread and on two.
template <int Dim>
void measure(World& world, const std::string& name, std::size_t rows, const Work& work,
             const std::vector<System>& kernels) {
  for (const System& kernel : kernels) kernel.prepare(world);
  for (const int threads : roofline::thread_counts()) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    const double seconds = roofline::median_seconds([&] {
      for (const System& kernel : kernels) kernel.run(world);
    });
    CHECK(seconds > 0);
    roofline::print({fmt::format("{}, {}-D", name, Dim), threads, rows, seconds, work});
  }
}

template <int Dim>
void measure_transfers() {
  World world;
  fill<Dim>(world);
  const Rows rows = rows_of<Dim>(world);
  const std::size_t particles = world.rows<Particles>();
  measure<Dim>(world, "P2G of mass and velocity, TPIC", particles,
               roofline::p2g_mass<Dim>(rows) + roofline::p2g_velocity_tpic<Dim>(rows),
               {make_system("p2g_mass", P2GMass<Dim>{}), make_system("p2g_velocity_tpic", P2GVelocityTpic<Dim>{})});
  measure<Dim>(world, "G2P of velocity, TPIC", particles, roofline::g2p_velocity_tpic<Dim>(rows),
               {make_system("g2p_velocity_tpic", G2PVelocityTpic<Dim>{})});
}

template <int Dim>
void measure_matrices() {
  World world;
  fill<Dim>(world);
  const Rows rows = rows_of<Dim>(world);
  const std::size_t nodes = world.rows<ActiveNodes>();
  measure<Dim>(world, "moments", world.rows<Particles>(), roofline::moments<Dim>(rows),
               {make_system("moments", GatherMoments<Dim>{})});
  world.resource<Clock>().step = 1e-3;
  kernels::run<FindNeighbours<Dim>>(world);
  kernels::run<SetMaterial<Dim>>(world);
  kernels::run<FindTau<Dim>>(world);
  measure<Dim>(world, "divergence matrix", nodes, roofline::divergence_matrix<Dim>(rows),
               {make_system("divergence_matrix", AssembleDivergence<Dim>{})});
  measure<Dim>(world, "laplacian matrix", nodes, roofline::laplacian_matrix<Dim>(rows),
               {make_system("laplacian_matrix", AssembleLaplacian<Dim>{})});
  measure<Dim>(world, "viscosity matrix", nodes, roofline::viscosity_matrix<Dim>(rows),
               {make_system("viscosity_matrix", AssembleViscosity<Dim>{})});
}

/// The solve of the last step once more, from the pressure that it started from.
template <int Dim>
void measure_solve(const std::string& scene, const std::vector<std::string>& overrides, int steps) {
  scene_run::SceneRun run(scene_run::with(scene_run::scene_of_file(scene), overrides));
  run.step(steps - 1);
  World& world = run.world();
  const auto p_i = world.column<node::Pressure>();
  const std::vector<double> before(p_i.begin(), p_i.end());
  run.step();
  std::copy(before.begin(), before.end(), p_i.begin());
  std::vector<System> solve;
  for (const char* name : {"assemble_schur", "factorize_velocity", "factorize_pressure", "solve_block"}) {
    solve.push_back(scene_run::registry().make(name, Dim));
    solve.back().run(world);
  }
  const auto iterations = static_cast<double>(world.resource<SolveReport>().iterations);
  const std::size_t nodes = world.rows<ActiveNodes>();
  REQUIRE(iterations > 0);
  measure<Dim>(world, fmt::format("block solve, {} iterations", iterations), nodes,
               roofline::block_solve<Dim>(static_cast<double>(nodes), iterations), solve);
}

}  // namespace

TEST_CASE("bandwidth and peak of the machine", "[!benchmark][roofline]") {
  for (const int threads : roofline::thread_counts()) {
    for (const double bytes : {24e3, 600e3, 12e6, 400e6}) {
      const double bandwidth = roofline::triad_bandwidth(bytes, threads);
      CHECK(bandwidth > 0);
      roofline::print({fmt::format("triad over {:.3g} MB", 1e-6 * bytes),
                       threads,
                       static_cast<std::size_t>(bytes / 24),
                       bytes / bandwidth,
                       {.bytes = bytes, .flops = bytes / 12}});
    }
    constexpr std::size_t count = 1'000'000;
    const double flops = 2.0 * count;
    roofline::print({"multiply-adds", threads, count, flops / roofline::multiply_add_peak(threads), {.flops = flops}});
  }
}

TEST_CASE("TPIC transfers in two dimensions", "[!benchmark][roofline][transfer]") { measure_transfers<2>(); }

TEST_CASE("TPIC transfers in three dimensions", "[!benchmark][roofline][transfer]") { measure_transfers<3>(); }

TEST_CASE("matrices in two dimensions", "[!benchmark][roofline][assembly]") { measure_matrices<2>(); }

TEST_CASE("matrices in three dimensions", "[!benchmark][roofline][assembly]") { measure_matrices<3>(); }

TEST_CASE("block solve in two dimensions", "[!benchmark][roofline][solve]") {
  measure_solve<2>("paper/dam_break_tpic.json",
                   {roofline::is_quick() ? "/grid/cells=[40,40]" : "/grid/cells=[160,160]", "/particles/0/per_cell=4",
                    "/time/step=5e-4"},
                   10);
}

TEST_CASE("block solve in three dimensions", "[!benchmark][roofline][solve]") {
  // A tolerance that the pressure of the step before does not meet.
  std::vector<std::string> settings{R"(/discretization={"scheme": "equal_order"})",
                                    R"(/solver={"scheme": "block", "tolerance": 1e-11})"};
  if (roofline::is_quick()) settings.emplace_back("/grid/cells=[16,8,16]");
  measure_solve<3>("dam_break_3d.json", settings, 5);
}
