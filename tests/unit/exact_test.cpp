#include "support/kernels.hpp"

#include "components/exact.hpp"
#include "components/measure.hpp"
#include "support/scene_run.hpp"
#include "systems/measure/error.hpp"
#include "systems/measure/weighted_mean.hpp"

#include <catch2/catch.hpp>

#include <oneapi/tbb/task_arena.h>

using namespace minamo;
using namespace minamo::kernels;
using scene_run::SceneRun;

namespace {

Expression field(const std::string& text) { return {text, scene_scope({})}; }

/// Random particles with velocity (x, -y t) and pressure x t at t = 2.
void exact_particles(World& world, std::size_t count) {
  fill<2>(world, count, 61);
  const auto x_p = world.column<particle::Position<2>>();
  for (std::size_t p = 0; p < count; ++p) {
    x_p[p] = world.column<particle::QuadraturePosition<2>>()[p];
    world.column<particle::Velocity<2>>()[p] = {x_p[p][0], -2 * x_p[p][1]};
    world.column<particle::Pressure>()[p] = 2 * x_p[p][0];
  }
  world.resource<Clock>().end_of_step = 2;
  world.resource<Rates>().time = 2;
  world.resource<exact::Velocity>().of_part.fill({field("x"), field("-y*t")});
  world.resource<exact::Pressure>() = {std::vector(exact::parts, field("x*t")), false};
}

double error(World& world, const std::string& of) {
  run<MeasureErrorVelocity<2>>(world);
  run<MeasureErrorPressure<2>>(world);
  const double* value = world.resource<measure::Columns>().find("error_" + of);
  REQUIRE(value);
  return *value;
}

template <class C, class Change>
void change_all(World& world, const Change& change) {
  for (auto& value : world.column<C>()) value = change(value);
}

}  // namespace

TEST_CASE("a weighted mean in parts is that of the whole", "[unit]") {
  Random random(3);
  WeightedMean whole;
  WeightedMean low;
  WeightedMean high;
  double weight = 0;
  double sum = 0;
  double squares = 0;
  for (int k = 0; k < 100; ++k) {
    const double w = random(0.5, 1.5);
    const double q = random(-1, 2);
    whole.add(w, q);
    (k < 30 ? low : high).add(w, q);
    weight += w;
    sum += w * q;
    squares += w * q * q;
  }
  low.join(high);
  // 100 roundings of sums of size 100.
  CHECK(std::abs(whole.mean - sum / weight) < 5e-16);
  CHECK(std::abs(low.mean - sum / weight) < 5e-16);
  CHECK(std::abs(whole.squares() - squares) < 1e-13);
  CHECK(std::abs(low.squares() - squares) < 5e-13);
  CHECK(std::abs(low.scatter - (squares - sum * sum / weight)) < 5e-13);
}

TEST_CASE("the scatter of numbers far from zero does not cancel", "[unit]") {
  WeightedMean numbers;
  for (const double q : {1e9 - 1, 1e9, 1e9 + 1}) numbers.add(2, q);
  CHECK(std::abs(numbers.scatter - 4) < 4e-7);  // a rounding of 1e9, three times
}

TEST_CASE("equal numbers have no scatter at all", "[unit]") {
  WeightedMean numbers;
  for (int k = 0; k < 10; ++k) numbers.add(0.1 * k + 0.1, 0.3);
  CHECK(numbers.scatter == 0);
}

TEST_CASE("particles that move exactly have no error", "[unit]") {
  const std::size_t count = GENERATE(1, 7, 600, 5000);
  CAPTURE(count);
  World world;
  exact_particles(world, count);
  CHECK(error(world, "velocity") < 1e-15);
  CHECK(error(world, "pressure") < 1e-15);
}

TEST_CASE("errors are relative to the exact field", "[unit]") {
  World world;
  exact_particles(world, 600);
  change_all<particle::Velocity<2>>(world, [](const Vec<2>& v) { return Vec<2>(1.1 * v); });
  change_all<particle::Pressure>(world, [](double p) { return 0.8 * p; });
  CHECK(std::abs(error(world, "velocity") - 0.1) < 5e-16);
  CHECK(std::abs(error(world, "pressure") - 0.2) < 5e-16);
}

TEST_CASE("errors weigh particles by their volume", "[unit]") {
  World world;
  exact_particles(world, 40);
  world.resource<exact::Velocity>().of_part.fill({field("2"), field("0")});
  change_all<particle::Velocity<2>>(world, [](const Vec<2>&) { return Vec<2>(2, 0); });
  world.column<particle::Velocity<2>>()[5] = {2, 3};
  const double share = world.column<particle::Mass>()[5] / scene_run::total_mass(world);
  CHECK(std::abs(error(world, "velocity") - std::sqrt(share * 9 / 4)) < 5e-16);
}

TEST_CASE("the error is the root mean square itself where the exact field is zero", "[unit]") {
  World world;
  exact_particles(world, 600);
  world.resource<exact::Velocity>().of_part.fill({field("0"), field("0*x")});
  world.resource<exact::Pressure>() = {std::vector(exact::parts, field("0")), false};
  change_all<particle::Velocity<2>>(world, [](const Vec<2>&) { return Vec<2>(3, 4); });
  change_all<particle::Pressure>(world, [](double) { return -7.; });
  CHECK(std::abs(error(world, "velocity") - 5) < 8e-15);
  CHECK(std::abs(error(world, "pressure") - 7) < 8e-15);
}

TEST_CASE("a free pressure is compared without its mean", "[unit]") {
  World world;
  exact_particles(world, 600);
  change_all<particle::Pressure>(world, [](double p) { return p + 3; });
  CHECK(error(world, "pressure") > 0.25);
  world.resource<exact::Pressure>().is_free = true;
  CHECK(error(world, "pressure") < 2e-15);
}

TEST_CASE("an error relates to the mean-free field if the pressure is free", "[unit]") {
  World world;
  exact_particles(world, 600);
  world.resource<exact::Pressure>() = {std::vector(exact::parts, field("x*t + 100")), true};
  change_all<particle::Pressure>(world, [](double p) { return 0.8 * p; });
  CHECK(std::abs(error(world, "pressure") - 0.2) < 1e-14);
}

TEST_CASE("velocity is compared at the end of the step, pressure when and where the balances hold", "[unit]") {
  World world;
  exact_particles(world, 600);
  world.resource<Clock>() = {.time = 1, .step = 1, .end_of_step = 2, .index = 1};
  world.resource<Rates>().time = 1.5;
  change_all<particle::Pressure>(world, [](double p) { return 0.75 * p; });
  change_all<particle::QuadraturePosition<2>>(world, [](const Vec<2>& y) { return Vec<2>(y + Vec<2>(1, 0)); });
  world.resource<exact::Pressure>() = {std::vector(exact::parts, field("(x - 1)*t")), false};
  CHECK(error(world, "velocity") < 1e-15);
  CHECK(error(world, "pressure") < 2e-15);
}

TEST_CASE("errors do not depend on the number of threads", "[unit][threads]") {
  World world;
  exact_particles(world, 5000);
  change_all<particle::Velocity<2>>(world, [](const Vec<2>& v) { return Vec<2>(v + Vec<2>(std::sin(1e3 * v[0]), 0)); });
  const double many = error(world, "velocity");
  tbb::task_arena one(1);
  CHECK(one.execute([&] { return error(world, "velocity"); }) == many);
}

TEST_CASE("a block in free flight follows its exact solution", "[verification]") {
  const Json scene = scene_run::with(scene_run::of_equal_order(scene_run::scene_of_file("ballistic_block.json")),
                                     {R"(/integrator/scheme=")" + std::string(GENERATE("newmark", "midpoint")) + '"'});
  SceneRun run(scene);
  run.step(20);
  const auto& columns = run.world().resource<measure::Columns>();
  CHECK(*columns.find("error_velocity") < 4e-14);  // 5e-15 measured
  CHECK(*columns.find("error_pressure") < 2e-8);   // 2.4e-9 measured; rho v h / dt is 3e4 Pa
}

TEST_CASE("a scene without exact block has neither its systems nor its columns", "[unit]") {
  const Json scene = scene_run::scene_of_file("dam_break.json");
  const auto steps = scene_run::step_names(scene);
  CHECK(std::none_of(steps.begin(), steps.end(), [](const std::string& n) { return n.find("error") != n.npos; }));
  CHECK(std::count(steps.begin(), steps.end(), "sample_pressure") == 0);
  SceneRun run(scene);
  run.start();
  CHECK(run.world().resource<measure::Columns>().columns.empty());
  CHECK_FALSE(run.world().has<exact::Velocity>());
  CHECK_FALSE(run.world().has<exact::Pressure>());
}

TEST_CASE("only the exact field that is given is measured", "[unit]") {
  const Json scene = scene_run::with(scene_run::scene_of_file("dam_break.json"), {R"(/exact={"velocity": [0, 0]})"});
  const auto steps = scene_run::step_names(scene);
  CHECK(std::count(steps.begin(), steps.end(), "measure_error_velocity") == 1);
  CHECK(std::count(steps.begin(), steps.end(), "measure_error_pressure") == 0);
}

TEST_CASE("an exact solution with ode variables starts without error", "[unit]") {
  SceneRun run(scene_run::scene_of_file("elliptical_drop.json"));
  run.start();
  CHECK(*run.world().resource<measure::Columns>().find("error_velocity") == 0);
}
