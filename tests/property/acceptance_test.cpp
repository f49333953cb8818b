#include "systems/measure/acceptance.hpp"

#include "engine/run/step_control.hpp"
#include "support/scene_run.hpp"
#include "tools/program/scene_file.hpp"

#include <catch2/catch.hpp>

#include <limits>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

Json coarse_dam_break() { return with(scene_of_file("paper/dam_break_tpic.json"), {"/grid/cells=[20, 20]"}); }

void accept(World& world) { make_system<AcceptStep<2>>("accept_step").run(world); }

}  // namespace

TEST_CASE("a step of a healthy run is accepted", "[property]") {
  SceneRun run(coarse_dam_break());
  run.step(3);
  CHECK_NOTHROW(accept(run.world()));
}

TEST_CASE("a step that cannot be trusted is rejected with its place and value", "[property]") {
  SceneRun run(coarse_dam_break());
  run.step(3);
  World& world = run.world();
  const double h = world.resource<Grid<2>>().spacing;
  std::string message;
  SECTION("a residual that is too large") {
    world.resource<SolveReport>().residual = 1e-3;
    message = "solve: |r|/|b| = 0.001";
  }
  SECTION("a residual that is not a number") {
    world.resource<SolveReport>().residual = not_a_number;
    message = "solve: |r|/|b| = nan";
  }
  SECTION("a node that moves too far") {
    const auto u_i = world.column<node::Displacement<2>>();
    const auto site = world.column<node::Site<2>>();
    u_i[7] = {11 * h, 0};
    message = "solve: node (" + std::to_string(site[7][0]) + ", " + std::to_string(site[7][1]) +
              ") moves by (11, 0) cells, more than 10";
  }
  SECTION("a node whose displacement is not a number, whatever the others do") {
    const auto u_i = world.column<node::Displacement<2>>();
    u_i[GENERATE(std::size_t{0}, std::size_t{7})] = {0, not_a_number};
    message = "moves by (0, nan) cells";
  }
  SECTION("a particle whose velocity is not finite") {
    world.column<particle::Velocity<2>>()[5] = {1, std::numeric_limits<double>::infinity()};
    message = "particle " + std::to_string(world.column<particle::Id>()[5]) + " at ";
  }
  SECTION("a particle whose velocity has no square") {
    world.column<particle::Velocity<2>>()[5] = {-1e200, 0};
    message = "particle " + std::to_string(world.column<particle::Id>()[5]) + " at ";
  }
  SECTION("the last particle, whose place is not a number") {
    world.column<particle::Position<2>>().back() = {-not_a_number, 0};
    message = "particle " + std::to_string(world.column<particle::Id>().back()) + " at (-nan, 0)";
  }
  SECTION("a particle whose velocity gradient is not finite") {
    world.column<particle::VelocityGradient<2>>()[5](1, 0) = -std::numeric_limits<double>::infinity();
    message = " and a gradient that is not finite";
  }
  SECTION("an overlap that grows by more than a fifth") {
    world.resource<measure::Overlap>().value += 0.21;
    message = "advect: the overlap grows from";
  }
  CHECK_THROWS_AS(accept(world), StepRejected);
  CHECK_THROWS_WITH(accept(world), Catch::Contains(message));
}

TEST_CASE("a ballistic node may move as far as it likes, for it moves no particle", "[property]") {
  SceneRun run(coarse_dam_break());
  run.step(3);
  run.world().column<node::Mass>()[7] = 1e-12;
  run.world().column<node::Displacement<2>>()[7] = {11 * run.world().resource<Grid<2>>().spacing, 0};
  CHECK_NOTHROW(accept(run.world()));
}

TEST_CASE("a velocity that is not finite is found in the step in which it appears", "[property]") {
  SceneRun run(coarse_dam_break());
  run.step(3);
  run.world().column<particle::Velocity<2>>()[5] = {not_a_number, 0};
  CHECK_THROWS_AS(run.step(1), StepRejected);
}

TEST_CASE("on faces only a step that moves liquid is held to have squeezed it", "[property]") {
  // Their overlap is that of the middle of a step: what a long step leaves behind is found in the next one.
  const auto after = [](const char* velocity) {
    SceneRun run(
        with(scene_of_file("dam_break.json"), {"/grid/cells=[20, 20]", R"(/discretization={"scheme": "conforming"})",
                                               std::string("/particles/0/velocity=") + velocity}));
    run.step(3);
    run.world().resource<measure::Overlap>().value += 0.21;
    make_system<AcceptStepOnFaces<2>>("accept_step_on_faces").run(run.world());
  };
  CHECK_NOTHROW(after("[1, 0]"));
  CHECK_THROWS_WITH(after("[8, 0]"), Catch::Contains("advect: the overlap grows from"));
}

TEST_CASE("where much is lost a step may add little, but a short one is taken whatever it adds", "[property]") {
  SceneRun run(coarse_dam_break());
  run.step(3);
  World& world = run.world();
  const auto grows = [&](double from, double to, int halvings) {
    world.resource<StepTotals>().overlap = from;
    world.resource<StepTotals>().overlap_max = from;
    world.resource<measure::Overlap>().value = to;
    world.resource<StepControl>().halvings = halvings;
    accept(world);
  };
  CHECK_NOTHROW(grows(0.1, 0.15, 0));
  CHECK_THROWS_WITH(grows(0.3, 0.35, 0), Catch::Contains("advect: the overlap grows on from 0.3 to 0.35"));
  CHECK_THROWS_AS(grows(0.3, 0.35, 2), StepRejected);
  CHECK_NOTHROW(grows(0.3, 0.31, 0));
  CHECK_NOTHROW(grows(0.3, 0.35, 3));
  CHECK_THROWS_AS(grows(0.3, 0.51, 3), StepRejected);
}

TEST_CASE("a run with larger CFL numbers may move farther in a step", "[property]") {
  const Scene scene = read(with(coarse_dam_break(), {R"(/time={"end": 1, "cfl": 8})"}));
  World world;
  seed(scene, "scene.json", world);
  CHECK(world.resource<LargestMove>().cells == 16);
}
