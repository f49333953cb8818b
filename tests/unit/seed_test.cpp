#include "support/extremes.hpp"
#include "support/kernels.hpp"
#include "support/scene_run.hpp"

#include "components/grid.hpp"
#include "components/node.hpp"
#include "systems/grid/lattice.hpp"
#include "systems/grid/node_volume.hpp"
#include "systems/shapes/primitives.hpp"

#include <catch2/catch.hpp>
#include <spdlog/fmt/fmt.h>

#include <memory>
#include <numbers>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

/// Ten cells of 0.1 m; the particles are given.
Json staggered_box(const std::string& particles) {
  Json scene = Json::parse(R"({
    "dimension": 2, "grid": {"low": [0, 0], "high": [1, 1], "cells": [10, 10]},
    "fluid": {"density": 1000, "viscosity": 0}, "time": {"end": 1, "step": 0.001}})");
  scene["particles"] = Json::parse(particles);
  return scene;
}
/// On nodes, for which the lattice is nearer to walls.
Json box(const std::string& particles) { return of_equal_order(staggered_box(particles)); }

std::vector<Vec<2>> places(const Json& scene) {
  SceneRun run(scene);
  return by_id<particle::Position<2>>(run.world());
}

std::uint8_t fixed_at(World& world, int i, int j) {
  return kernels::on_grid<2, node::Constraint>(world)[world.resource<Grid<2>>().row({i, j})];
}

}  // namespace

TEST_CASE("the dam break has 800 particles", "[unit]") {
  CHECK(places(scene_of_file("paper/dam_break_tpic.json")).size() == 800);
}

TEST_CASE("the liquid weighs density times area", "[unit]") {
  SceneRun run(scene_of_file("paper/dam_break_tpic.json"));
  // 800 equal numbers, a rounding each.
  CHECK(total_mass(run.world()) == Approx(1000 * 0.146 * 0.292).epsilon(9e-14));
}

TEST_CASE("particles have the volume of their mass", "[unit]") {
  SceneRun run(scene_of_file("paper/dam_break_tpic.json"));
  const auto m_p = run.world().column<particle::Mass>();
  const auto V_p = run.world().column<particle::Volume>();
  const double h = run.world().resource<Grid<2>>().spacing;
  std::size_t wrong = 0;
  for (std::size_t p = 0; p < m_p.size(); ++p) {
    wrong += std::abs(V_p[p] - h * h / 4) > 1e-15 * V_p[p] || std::abs(m_p[p] - 1000 * V_p[p]) > 1e-15 * m_p[p];
  }
  CHECK(wrong == 0);  // a rounding or two
}

TEST_CASE("the liquid weighs density times volume", "[unit]") {
  SceneRun run(scene_of_file("dam_break_3d.json"));
  CHECK(total_mass(run.world()) == Approx(1000 * 0.146 * 0.146 * 0.292).epsilon(1e-12));  // 24576 roundings at most
}

TEST_CASE("a lattice brings to every node of a full box the mass of its volume", "[unit]") {
  const int per_cell = GENERATE(1, 2, 3, 4);
  CAPTURE(per_cell);
  Json scene = box(R"([{"shape": {"box": {"low": [0, 0], "high": [1, 1]}}}])");
  scene["particles"][0]["per_cell"] = per_cell;
  SceneRun run(scene);
  const auto& grid = run.world().resource<Grid<2>>();
  std::vector<double> volume(grid.node_count(), 0.0);
  for (const Vec<2>& x : run.world().column<particle::Position<2>>()) {
    const kernels::PlainWeights<2> weights(grid, x);
    for (std::size_t i = 0; i < volume.size(); ++i) {
      volume[i] += std::pow(grid.spacing / per_cell, 2) * weights.value[i];
    }
  }
  Largest worst;
  for (std::size_t i = 0; i < volume.size(); ++i) {
    worst.add(std::abs(volume[i] / full_volume<2>(grid, grid.index(i)) - 1));
  }
  CHECK(worst.value() < 4e-14);  // 4e-15 measured; 1.9 % on walls with 2 per cell, were the lattice even
}

TEST_CASE("the row next to a wall starts nearer to it, but evenly for quadrature by particles", "[unit]") {
  Json scene = box(R"([{"shape": {"box": {"low": [0, 0], "high": [0.1, 0.1]}}, "per_cell": 1}])");
  CHECK((places(scene)[0] - Vec<2>(0.05 - 0.1 / 24, 0.05 - 0.1 / 24)).norm() < 1e-15);
  scene["quadrature"] = {{"scheme", "particles"}};
  CHECK((places(scene)[0] - Vec<2>(0.05, 0.05)).norm() < 1e-15);
}

TEST_CASE("a lattice lies at the middles of equal parts of a cell", "[unit]") {
  const auto x = places(box(R"([{"shape": {"box": {"low": [0.3, 0.5], "high": [0.4, 0.6]}}, "per_cell": 2}])"));
  REQUIRE(x.size() == 4);
  // x fastest; coordinates of size 1 with a rounding each.
  CHECK((x[0] - Vec<2>(0.325, 0.525)).norm() < 1e-15);
  CHECK((x[1] - Vec<2>(0.375, 0.525)).norm() < 1e-15);
  CHECK((x[2] - Vec<2>(0.325, 0.575)).norm() < 1e-15);
  CHECK((x[3] - Vec<2>(0.375, 0.575)).norm() < 1e-15);
}

TEST_CASE("a ball holds the lattice points within its radius", "[unit]") {
  const auto all = places(box(R"([{"shape": {"where": "1"}, "per_cell": 4}])"));
  const auto ball = places(box(R"([{"shape": {"ball": {"center": [0.52, 0.47], "radius": 0.2}}, "per_cell": 4,
                              "arrangement": "lattice"}])"));
  std::vector<Vec<2>> expected;
  std::copy_if(all.begin(), all.end(), std::back_inserter(expected),
               [](const Vec<2>& x) { return (x - Vec<2>(0.52, 0.47)).norm() <= 0.2; });
  CHECK(all.size() == 1600);
  CHECK(ball == expected);
}

TEST_CASE("a region by expression holds the lattice points where it is true", "[unit]") {
  const auto x = places(box(R"json([{"shape": {"where": "y < 0.5 && x > 0.2"}, "per_cell": 2}])json"));
  CHECK(x.size() == 16 * 10);
  CHECK(std::all_of(x.begin(), x.end(), [](const Vec<2>& at) { return at[1] < 0.5 && at[0] > 0.2; }));
}

TEST_CASE("jittered particles are one per part of a cell", "[unit]") {
  Json even = box(R"([{"shape": {"where": "1"}, "per_cell": 2}])");
  even["quadrature"] = {{"scheme", "particles"}};
  const auto lattice = places(even);
  const auto jittered = places(box(R"([{"shape": {"where": "1"}, "per_cell": 2, "arrangement": "jittered"}])"));
  REQUIRE(jittered.size() == lattice.size());
  Largest farthest;
  Smallest nearest;
  for (std::size_t p = 0; p < lattice.size(); ++p) {
    const double distance = (jittered[p] - lattice[p]).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
    farthest.add(distance);
    nearest.add(distance);
  }
  CHECK(farthest.value() <= 0.025 + 1e-15);
  CHECK(nearest.value() > 0);
}

TEST_CASE("liquid that the surface of its shape cuts has the volume and the middle of the shape", "[unit]") {
  const std::string shape = GENERATE(R"({"box": {"low": [0.3, 0.2], "high": [0.61, 0.77], "angle": 25}})",
                                     R"({"ball": {"center": [0.47, 0.52], "radius": 0.2371}})");
  CAPTURE(shape);
  SceneRun run(box(R"([{"per_cell": 2, "arrangement": "cut", "shape": )" + shape + "}]"));
  const double area = shape.find("box") != std::string::npos ? 0.31 * 0.57 : 3.14159265358979 * 0.2371 * 0.2371;
  const Vec<2> middle = shape.find("box") != std::string::npos ? Vec<2>(0.455, 0.485) : Vec<2>(0.47, 0.52);
  // The samples of a part, an eighth of it per direction, see corners rounded; pieces that go to a neighbour keep their
  // volume and leave its place. The lattice alone is up to 1e-2 off.
  CHECK(total_mass(run.world()) == Approx(1000 * area).epsilon(1e-3));
  Vec<2> moment = Vec<2>::Zero();
  const auto x_p = run.world().column<particle::Position<2>>();
  for (std::size_t p = 0; p < x_p.size(); ++p) moment += run.world().column<particle::Mass>()[p] * x_p[p];
  CHECK((moment / total_mass(run.world()) - middle).norm() < 1e-3);
}

TEST_CASE("an oblique or curved surface cuts its liquid unless the scene says otherwise", "[unit]") {
  const auto mass = [](const std::string& more) {
    SceneRun run(staggered_box(R"([{"per_cell": 2, )" + more + "}]"));
    return total_mass(run.world());
  };
  const std::string ball = R"("shape": {"ball": {"center": [0.52, 0.47], "radius": 0.23}})";
  const double exact = 1000 * std::numbers::pi * 0.23 * 0.23;
  CHECK(mass(ball) == Approx(exact).epsilon(1e-3));
  CHECK(mass(ball) == mass(ball + R"(, "arrangement": "cut")"));
  CHECK(std::abs(mass(ball + R"(, "arrangement": "lattice")") - exact) > 5e-3 * exact);
  const std::string told_by_lattice = GENERATE(
      R"("shape": {"where": "y < 0.333"})", R"("shape": {"distance": "y - 0.333"})",
      R"("shape": {"half_space": {"point": [0, 0.333], "normal": [0, 2]}})",
      R"("shape": {"difference": [{"box": {"low": [0, 0], "high": [1, 0.333]}}, {"box": {"low": [0, 0], "high": [0.3, 0.2]}}]})");
  CHECK(mass(told_by_lattice) == mass(told_by_lattice + R"(, "arrangement": "lattice")"));
  const std::string oblique = R"("shape": {"half_space": {"point": [0, 0.333], "normal": [0.1, 1]}})";
  CHECK(mass(oblique) == mass(oblique + R"(, "arrangement": "cut")"));
}

TEST_CASE("liquid that lies along parts of cells is that of a lattice, bit for bit", "[unit]") {
  const std::string shape = GENERATE(
      R"({"box": {"low": [0.3, 0.05], "high": [0.7, 0.35]}})", R"({"distance": "y - 0.35"})",
      R"({"half_space": {"point": [0, 0.35], "normal": [0, 1]}})",
      R"({"union": [{"box": {"low": [0, 0], "high": [0.3, 0.2]}}, {"box": {"low": [0.3, 0], "high": [1, 0.1]}}]})");
  const auto run = [&](const char* arrangement) {
    return std::make_unique<SceneRun>(
        staggered_box(fmt::format(R"([{{"per_cell": 2, "arrangement": "{}", "shape": {}}}])", arrangement, shape)));
  };
  const auto cut = run("cut");
  const auto lattice = run("lattice");
  CHECK(by_id<particle::Position<2>>(cut->world()) == by_id<particle::Position<2>>(lattice->world()));
  CHECK(by_id<particle::Volume>(cut->world()) == by_id<particle::Volume>(lattice->world()));
}

TEST_CASE("a shape that is smaller than a particle is one of its own volume, if it holds the middle of a part",
          "[unit]") {
  const auto run = [](double middle) {
    return SceneRun(staggered_box(
        fmt::format(R"([{{"per_cell": 1, "shape": {{"ball": {{"center": [{}, 0.55], "radius": 0.02}}}}}}])", middle)));
  };
  SceneRun small = run(0.56);
  REQUIRE(small.world().rows<Particles>() == 1);
  CHECK(total_mass(small.world()) == Approx(1000 * std::numbers::pi * 0.02 * 0.02).epsilon(0.05));
  CHECK_THROWS_WITH(run(0.58), Catch::Contains("no particle inside"));
}

TEST_CASE("liquid between walls of bodies reaches to them, wherever they lie", "[unit]") {
  const double off = GENERATE(0.0, 0.1, 0.2, 0.3, 0.45);  // [h]
  const int per_cell = GENERATE(2, 3);
  CAPTURE(off, per_cell);
  // 0.6 m wide, its floor on a line of the grid, as high as a lattice.
  const double low = 0.2 + 0.1 * off;
  Json scene =
      staggered_box(fmt::format(R"([{{"shape": {{"box": {{"low": [{}, 0.2], "high": [{}, 0.5]}}}}, "per_cell": {}}}])",
                                low, low + 0.6, per_cell));
  scene["bodies"] = Json::array();
  scene["bodies"].push_back(Json::parse(
      fmt::format(R"({{"name": "tank", "shape": {{"invert": {{"box": {{"low": [{}, 0.2], "high": [{}, 0.8]}}}}}}}})",
                  low, low + 0.6)));
  SceneRun run(scene);
  CHECK(total_mass(run.world()) == Approx(1000 * 0.6 * 0.3).epsilon(1e-9));
}

TEST_CASE("a part that bodies cut belongs to one of two regions", "[unit]") {
  // Their common side lies in parts that a beach cuts.
  Json scene = staggered_box(R"([{"shape": {"box": {"low": [0, 0], "high": [1, 0.33]}}, "per_cell": 2},
                       {"shape": {"box": {"low": [0, 0.33], "high": [1, 0.6]}}, "per_cell": 2}])");
  const Json one = staggered_box(R"([{"shape": {"box": {"low": [0, 0], "high": [1, 0.6]}}, "per_cell": 2}])");
  const bool is_cut = GENERATE(false, true);
  for (Json& region : scene["particles"]) region["arrangement"] = is_cut ? "cut" : "lattice";
  const Json beach =
      Json::parse(R"([{"name": "beach", "shape": {"half_space": {"point": [0.3, 0], "normal": [-0.7, 1]}}}])");
  const auto mass_of = [&](Json of) {
    of["bodies"] = beach;
    SceneRun run(of);
    return total_mass(run.world());
  };
  // Where a body and the side both cut a part, samples of it count: 4e-5.
  CHECK(mass_of(scene) == Approx(mass_of(one)).epsilon(is_cut ? 1e-4 : 1e-9));
}

TEST_CASE("jittered particles are the same for the same seed", "[unit]") {
  const auto with_seed = [](const std::string& seed) {
    return places(box(R"([{"shape": {"where": "1"}, "arrangement": "jittered", "seed": )" + seed + "}]"));
  };
  CHECK(with_seed("7") == with_seed("7"));
  CHECK(with_seed("7") != with_seed("8"));
}

TEST_CASE("particles start with the velocity of their place and its gradient", "[unit]") {
  SceneRun run(with(box(R"json([{"shape": {"box": {"low": [0.2, 0.2], "high": [0.6, 0.6]}},
                                 "velocity": ["2*x*y", "x - 3*y"]}])json"),
                    {R"(/transfer={"scheme": "tpic"})"}));
  const auto x = by_id<particle::Position<2>>(run.world());
  const auto v = by_id<particle::Velocity<2>>(run.world());
  const auto grad_v = by_id<particle::VelocityGradient<2>>(run.world());
  Largest worst;
  Largest worst_gradient;
  for (std::size_t p = 0; p < x.size(); ++p) {
    worst.add((v[p] - Vec<2>(2 * x[p][0] * x[p][1], x[p][0] - 3 * x[p][1])).norm());
    Mat<2> expected;
    expected << 2 * x[p][1], 2 * x[p][0], 1, -3;
    worst_gradient.add((grad_v[p] - expected).norm());
  }
  CHECK(worst.value() < 1e-15);           // one or two roundings of numbers of size 1
  CHECK(worst_gradient.value() < 1e-11);  // central differences over 2e-4 m: exact for quadratics up to 1e-16/2e-4
}

TEST_CASE("slip walls hold the normal component, corners both", "[unit]") {
  SceneRun run(with(box(R"([{"shape": {"where": "1"}}])"), {R"(/walls="slip")"}));
  run.start();
  CHECK(fixed_at(run.world(), 0, 5) == 0b01);
  CHECK(fixed_at(run.world(), 10, 5) == 0b01);
  CHECK(fixed_at(run.world(), 5, 0) == 0b10);
  CHECK(fixed_at(run.world(), 10, 10) == 0b11);
  CHECK(fixed_at(run.world(), 1, 9) == 0);
}

TEST_CASE("a no-slip wall holds all components on its own side", "[unit]") {
  SceneRun run(with(box(R"([{"shape": {"where": "1"}}])"), {R"(/walls={"x": ["slip", "no_slip"]})"}));
  run.start();
  CHECK(fixed_at(run.world(), 0, 5) == 0b01);
  CHECK(fixed_at(run.world(), 10, 5) == 0b11);
  CHECK(fixed_at(run.world(), 5, 10) == 0b10);
}

TEST_CASE("overlapping regions are refused", "[unit]") {
  const Json scene = box(R"([{"shape": {"box": {"low": [0, 0], "high": [0.5, 0.5]}}},
                             {"shape": {"box": {"low": [0.4, 0.4], "high": [0.6, 0.6]}}}])");
  CHECK_THROWS_WITH(SceneRun(scene), Catch::Contains("/particles/1/shape: overlaps an earlier one"));
}

TEST_CASE("a region without particles is refused", "[unit]") {
  const Json scene = box(R"([{"shape": {"box": {"low": [0.401, 0.401], "high": [0.415, 0.415]}}}])");
  CHECK_THROWS_WITH(SceneRun(scene), Catch::Contains("/particles/0/shape: no particle inside"));
}

TEST_CASE("a velocity that is not finite is refused", "[unit]") {
  const Json scene = box(R"json([{"shape": {"where": "1"}, "velocity": ["1/(x < 0.02 ? 0 : 1)", 0]}])json");
  CHECK_THROWS_WITH(SceneRun(scene), Catch::Contains("/particles/0/velocity: not finite"));
}

TEST_CASE("layers of a lattice are those of the whole one, jitter included", "[unit]") {
  Grid<2> grid;
  grid.cells = {7, 9};
  grid.spacing = 0.1;
  ParticleScene region;
  region.per_cell = 3;
  region.shape = SharedShape<2>(std::make_shared<shapes::Ball<2>>(Vec<2>(0.3, 0.5), 0.25));
  if (GENERATE(false, true)) region.jitter = 5;
  std::vector<Vec<2>> together;
  for (const Layers layers : {Layers{0, 3}, Layers{3, 4}, Layers{4, 4}, Layers{4, 12}}) {
    const auto some = lattice<2>(region, grid, {}, PartsTaken::middle_inside, layers);
    together.insert(together.end(), some.begin(), some.end());
  }
  CHECK(together == lattice<2>(region, grid));
  const Layers reached = layers_of<2>(region, grid);
  CHECK(reached[0] <= 2);
  CHECK(reached[1] >= 8);
  CHECK(reached[1] <= 9);
}
