/// \file
/// A scene in the mirror, or with its axes exchanged, runs as the image of the scene: nothing prefers a side of the
/// box, an axis, or one of two that are as near. What is compared are the first steps, before impacts let rounding
/// grow.

#include "support/mirror.hpp"
#include "support/scenes.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

const Mirror<2> in_x{{0, 1}, {true, false}};
const Mirror<2> in_y{{0, 1}, {false, true}};
const Mirror<2> exchanged{{1, 0}, {false, false}};
const Mirror<3> in_z{{0, 1, 2}, {false, false, true}};
const Mirror<3> exchanged_in_space{{2, 0, 1}, {true, false, false}};

/// A column of 8 x 6 cells in a box with other walls on every side, with an inner motion.
Json column() {
  return Json::parse(R"json({
    "dimension": 2, "grid": {"low": [-0.4, -0.2], "high": [0.6, 0.4], "cells": [10, 6]},
    "walls": {"x": ["slip", "no_slip"], "y": ["no_slip", "slip"]},
    "fluid": {"density": 1000, "viscosity": 5}, "body_force": [0.7, -9.81], "solver": {"scheme": "block", "tolerance": 1e-13},
    "particles": [{"shape": {"box": {"low": [-0.4, -0.2], "high": [0.15, 0.25]}}, "per_cell": 3,
                   "velocity": ["0.3*sin(7*y)", "0.4*x"]}],
    "time": {"end": 1, "step": 0.01}})json");
}

/// Two jets at an angle, one of which changes, fall into a basin with a drain and a side that is open at its level.
/// Edges of openings lie anywhere in cells.
Json jets() {
  return Json::parse(R"json({
    "dimension": 2, "grid": {"low": [-0.3, -0.2], "high": [0.7, 0.4], "cells": [20, 12]},
    "fluid": {"density": 1000, "viscosity": 2}, "body_force": [0, -9.81],
    "solver": {"scheme": "block", "tolerance": 1e-13},
    "particles": [{"shape": {"box": {"low": [-0.3, -0.2], "high": [0.7, 0.02]}}}],
    "openings": [
      {"name": "jet", "side": "x_low", "where": "y > 0.11 && y < 0.26",
       "inflow": {"velocity": ["1.2 + 0.3*sin(9*t)", "0.4 - t"]}},
      {"name": "tap", "side": "y_high", "where": "abs(x - 0.2) < 0.1", "inflow": {"velocity": ["0.3", "-1.5"]}},
      {"name": "spout", "side": "x_high", "where": "y < 0.1", "outflow": {"level": 0}},
      {"name": "drain", "side": "y_low", "where": "x < 0.05 && x > -0.17", "outflow": "free"}],
    "time": {"end": 1, "step": 8e-3}})json");
}

/// After some steps all that particles carry is that of the image, to rounding that grows.
template <int Dim>
void check_image(const Json& scene, const Mirror<Dim>& mirror, int steps, double rounding) {
  SceneRun run(scene);
  SceneRun image(mirrored<Dim>(scene, mirror));
  run.start();
  image.start();
  run.step(steps);
  image.step(steps);
  const Difference of = difference<Dim>(run, image, mirror);
  CHECK(of.position < rounding);
  CHECK(of.velocity < rounding);
  CHECK(of.gradient < rounding);
  CHECK(of.mass < rounding);
}

}  // namespace

TEST_CASE("every transfer scheme and integrator is the same in the mirror", "[property]") {
  Json scene = any_method(column());
  const Mirror<2> mirror = GENERATE(in_x, in_y, exchanged);
  const std::string discretization = GENERATE("conforming", "equal_order");
  CAPTURE(scene["transfer"], scene["integrator"], discretization, mirror.axis, mirror.mirrored);
  // With three particles per cell some lie in the middles of cells, where dual cells meet.
  scene["discretization"] = {{"scheme", discretization}};
  check_image<2>(scene, mirror, 5, 1e-11);
}

TEST_CASE("every solver of the pressure is the same in the mirror", "[property]") {
  const std::string discretization = GENERATE("conforming", "equal_order");
  const std::string solver = GENERATE(R"({"scheme": "umfpack"})", R"({"scheme": "block", "tolerance": 1e-13})");
  const Mirror<2> mirror = GENERATE(in_x, in_y, exchanged);
  CAPTURE(discretization, solver, mirror.axis, mirror.mirrored);
  check_image<2>(with(column(), {R"(/discretization={"scheme": ")" + discretization + "\"}", "/solver=" + solver}),
                 mirror, 5, 1e-10);
}

TEST_CASE("openings are the same in the mirror, with every transfer scheme", "[property]") {
  const std::string transfer = GENERATE("pic", "flip", "tpic", "tpic2", "apic", "xpic", "fmpm");
  const Mirror<2> mirror = GENERATE(in_x, in_y, exchanged);
  CAPTURE(transfer, mirror.axis, mirror.mirrored);
  check_image<2>(with(jets(), {R"(/transfer={"scheme": ")" + transfer + "\"}"}), mirror, 12, 1e-10);
}

TEST_CASE("what openings prescribe is the same in the mirror", "[property]") {
  const std::string of_jet =
      GENERATE(R"({"inflow": {"rate": "0.15"}})", R"({"inflow": {"velocity": ["1.5 - 20*(y - 0.2)^2", "0"]}})",
               R"({"outflow": {"pressure": "900 + 300*y"}})", R"({"outflow": {"pressure": 900, "kind": "static"}})");
  const std::string of_spout = GENERATE(R"({"inflow": {"level": 0.08}})", R"({"outflow": {"pressure": 1200}})",
                                        R"({"inflow": {"rate": 0.05, "level": "0.03"}})");
  const Mirror<2> mirror = GENERATE(in_x, in_y, exchanged);
  CAPTURE(of_jet, of_spout, mirror.axis, mirror.mirrored);
  Json scene = jets();
  const auto becomes = [](Json& opening, const std::string& flow) {
    opening.erase("inflow");
    opening.erase("outflow");
    opening.update(Json::parse(flow));
  };
  becomes(scene["openings"][0], of_jet);
  becomes(scene["openings"][2], of_spout);
  check_image<2>(scene, mirror, 8, 1e-10);
}

TEST_CASE("openings in 3-D are the same in the mirror", "[property]") {
  const Json scene = Json::parse(R"json({
    "dimension": 3, "grid": {"low": [-0.3, -0.2, -0.2], "high": [0.3, 0.2, 0.3], "cells": [12, 8, 10]},
    "fluid": {"density": 1000, "viscosity": 2}, "body_force": [0, 0, -9.81],
    "particles": [{"shape": {"box": {"low": [-0.3, -0.2, -0.2], "high": [0.3, 0.2, -0.1]}}, "per_cell": 3}],
    "openings": [
      {"name": "tap", "side": "z_high", "where": "abs(x + 0.05) < 0.1 && y > -0.13 && y < 0.07",
       "inflow": {"velocity": ["0.3", "0.2", "-1.5"]}},
      {"name": "jet", "side": "y_low", "where": "x^2 + (z - 0.1)^2 < 0.012", "inflow": {"velocity": [0, 1, 0]}},
      {"name": "spout", "side": "x_high", "outflow": {"level": -0.1}}],
    "solver": {"scheme": "block", "tolerance": 1e-13}, "time": {"end": 1, "step": 0.01}})json");
  const Mirror<3> mirror = GENERATE(in_z, exchanged_in_space);
  CAPTURE(mirror.axis, mirror.mirrored);
  check_image<3>(scene, mirror, 6, 1e-9);
}

TEST_CASE("a jet into a symmetric box does not drift", "[property]") {
  // Its edges at, and on either side of, faces and middles of cells. A jet drifted by 8 % of its speed to the low side.
  const int cells = GENERATE(24, 25, 26, 27);
  const Mirror<2> turned = GENERATE(in_y, exchanged);
  CAPTURE(cells, turned.axis);
  Json scene = Json::parse(R"json({
    "dimension": 2, "grid": {"low": [-0.06, -0.06], "high": [0.06, 0.06]},
    "fluid": {"density": 1400, "viscosity": 10},
    "particles": [{"shape": {"box": {"low": [-0.06, -0.06], "high": [0.06, -0.04]}}}],
    "openings": [{"name": "jet", "side": "y_high", "where": "abs(x) < 0.0125", "inflow": {"velocity": [0, -0.3]}}],
    "solver": {"scheme": "block", "tolerance": 1e-13}, "time": {"end": 1, "step": 0.01}})json");
  scene["grid"]["cells"] = {cells, cells};
  const Json seen = mirrored<2>(scene, turned);
  SceneRun run(seen);
  run.step(12);
  const Mirror<2> across = turned.axis[0] == 0 ? in_x : in_y;
  const Difference of = difference<2>(run, run, across);
  CHECK(of.position < 1e-9);
  CHECK(of.velocity < 1e-9);
}

TEST_CASE("walls and liquids are the same in the mirror", "[property]") {
  const std::string walls = GENERATE(R"("separating")", R"({"x": "periodic", "y": "slip"})",
                                     R"({"x": ["slip", {"slip_length": 0.02}], "y": "no_slip"})");
  const std::string fluid =
      GENERATE(R"({"density": 1000, "viscosity": 0.1})", R"({"density": 1000, "viscosity": 300})");
  const Mirror<2> mirror = GENERATE(in_x, in_y, exchanged);
  if (walls.find("separating") != std::string::npos && fluid.find("0.1") == std::string::npos) return;
  CAPTURE(walls, fluid, mirror.axis, mirror.mirrored);
  check_image<2>(with(column(), {"/walls=" + walls, "/fluid=" + fluid}), mirror, 5, 1e-9);
}

TEST_CASE("the lattice of a shape is the same in the mirror where its surface passes through particles", "[property]") {
  // In the middles of cells, to rounding, where particles lie; two regions meet there.
  const std::string first = GENERATE(
      R"({"box": {"low": [-0.4, -0.2], "high": [0.05, 0.15]}})", R"({"where": "x < 0.05 && y < 0.15"})",
      R"json({"distance": "max(3*(x - 0.05), y - 0.15)"})json", R"({"ball": {"center": [0.05, 0.05], "radius": 0.2}})");
  const Mirror<2> mirror = GENERATE(in_x, in_y, exchanged);
  CAPTURE(first, mirror.axis, mirror.mirrored);
  Json scene = column();
  scene["particles"][0]["shape"] = Json::parse(first);
  if (first.find("ball") == std::string::npos)
    scene["particles"].push_back(
        {{"shape", {{"box", {{"low", {0.05, -0.2}}, {"high", {0.25, 0.15}}}}}}, {"velocity", {0, 1}}});
  check_image<2>(scene, mirror, 0, 1e-12);
}

TEST_CASE("forces on exact integrals are the same in the mirror", "[property]") {
  // Next to a surface at an angle, at rest and moving. 0.15 m/s off where the acceleration next to a face was that of
  // one of its sides, and faces without liquid on the high side told whether it moves.
  const std::string degree = GENERATE("2", "3");
  const std::string velocity = GENERATE("[0, 0]", R"json(["0.02*sin(7*y)", "0.02*x"])json");
  const Mirror<2> mirror = GENERATE(in_x, in_y, exchanged);
  CAPTURE(degree, velocity, mirror.axis, mirror.mirrored);
  const Json scene = with(column(), {R"(/quadrature={"scheme": "exact"})", "/discretization/degree=" + degree,
                                     R"(/particles/0/shape={"where": "y < 0.1 + 0.0713*x"})",
                                     "/particles/0/velocity=" + velocity, "/time/step=0.005"});
  check_image<2>(scene, mirror, 8, 1e-8);
}

TEST_CASE("bodies are the same in the mirror", "[property]") {
  // At the edge of the liquid, at sides of the box, with sides and corners on points of the grid, and anywhere; a plate
  // a fifth of a cell thick with water on both sides.
  const std::string body = GENERATE(
      R"({"shape": {"ball": {"center": [0.02, 0.06], "radius": 0.09}}})",
      R"({"shape": {"box": {"low": [-0.33, -0.2], "high": [-0.21, 0.03]}}})",
      R"({"shape": {"box": {"low": [-0.2, -0.1], "high": [-0.1, 0.1]}}})",
      R"({"shape": {"box": {"low": [0.05, -0.3], "high": [0.25, 0.05]}}})",
      R"({"shape": {"box": {"low": [0.13, -1], "high": [1, 1]}}})",
      R"({"shape": {"box": {"low": [-1, -1], "high": [-0.21, 0.03]}}})",
      R"({"shape": {"polygon": {"vertices": [[-0.4, -0.2], [0.05, -0.2], [-0.4, 0.11]]}}})",
      R"({"shape": {"box": {"low": [-0.11, -1], "high": [-0.09, 1]}}, "motion": {"prescribed": {"velocity": ["-0.5", 0]}}})",
      R"({"shape": {"polygon": {"vertices": [[-0.3, -0.13], [-0.28, -0.13], [-0.17, 0.09], [-0.19, 0.09]]}},
          "motion": {"prescribed": {"velocity": ["0.3", "0.2"]}}})",
      R"json({"shape": {"ball": {"center": [0, 0.05], "radius": 0.08}},
              "motion": {"prescribed": {"velocity": ["-0.5", "-0.3*cos(3*t)"]}}})json",
      R"({"shape": {"ball": {"center": [-0.1, 0.2], "radius": 0.08}}, "motion": {"free": {"density": 400}}})");
  const std::string wall = GENERATE(R"("slip")", R"("no_slip")");
  const Mirror<2> mirror = GENERATE(in_x, in_y, exchanged);
  CAPTURE(body, wall, mirror.axis, mirror.mirrored);
  Json scene = column();
  scene["bodies"] = Json::array({Json::parse(body)});
  scene["bodies"][0].update(Json{{"name", "body"}, {"wall", Json::parse(wall)}});
  // Faces with next to no mass amplify rounding: up to 7e-10.
  check_image<2>(scene, mirror, 3, 7e-9);
}

TEST_CASE("walls of bodies are the same in the mirror, of two in a cell, too", "[property]") {
  const std::string wall = GENERATE(R"({"slip_length": 0.02})", R"("separating")", R"("no_slip")");
  const Mirror<2> mirror = GENERATE(in_x, in_y, exchanged);
  CAPTURE(wall, mirror.axis, mirror.mirrored);
  Json scene = column();
  scene["bodies"] = Json::parse(R"([{"shape": {"ball": {"center": [-0.2, 0], "radius": 0.07}}, "name": "left"},
                                    {"shape": {"ball": {"center": [-0.05, 0.03], "radius": 0.07}}, "name": "right"}])");
  for (Json& body : scene["bodies"]) body["wall"] = Json::parse(wall);
  check_image<2>(scene, mirror, 3, 7e-9);
}

TEST_CASE("bodies in 3-D are the same in the mirror", "[property]") {
  // The viscosity is the largest that friction at the start of a step takes with this slip length.
  const std::string body =
      GENERATE(R"({"shape": {"ball": {"center": [0.05, 0.02, 0], "radius": 0.11}}, "wall": "no_slip"})",
               R"({"shape": {"ball": {"center": [0.05, 0.02, 0], "radius": 0.11}}, "wall": {"slip_length": 0.02}})",
               R"({"shape": {"box": {"low": [-0.13, -0.3, -0.3], "high": [0.03, 0.07, 0]}}, "wall": "slip"})",
               R"({"shape": {"ball": {"center": [-0.05, 0.02, 0.1], "radius": 0.09}}, "wall": "no_slip",
                   "motion": {"free": {"density": 400}}})");
  const Mirror<3> mirror = GENERATE(in_z, exchanged_in_space);
  CAPTURE(body, mirror.axis, mirror.mirrored);
  Json scene = Json::parse(R"json({
    "dimension": 3, "grid": {"low": [-0.3, -0.2, -0.2], "high": [0.3, 0.2, 0.3], "cells": [6, 4, 5]},
    "fluid": {"density": 1000, "viscosity": 2}, "body_force": [0.5, 0.2, -9.81],
    "particles": [{"shape": {"box": {"low": [-0.3, -0.2, -0.2], "high": [0.1, 0.2, 0.1]}}, "per_cell": 2,
                   "velocity": ["0.3*sin(7*y)", "0.4*x", "0.2*y"]}],
    "solver": {"scheme": "block", "tolerance": 1e-13}, "time": {"end": 1, "step": 0.01}})json");
  scene["bodies"] = Json::array({Json::parse(body)});
  scene["bodies"][0]["name"] = "body";
  check_image<3>(scene, mirror, 2, 1e-9);
}

TEST_CASE("drops in 2-D are the same in the mirror", "[property]") {
  const std::string drop = GENERATE(R"({"ball": {"center": [0.03, 0.05], "radius": 0.16}})",
                                    R"({"ball": {"center": [0.1, 0.1], "radius": 0.17}})",  // in the middle of the box
                                    R"({"intersection": [{"ball": {"center": [0.03, -0.17], "radius": 0.2}},
                                                         {"box": {"low": [-0.4, -0.2], "high": [0.6, 0.4]}}]})");
  const bool on_body = GENERATE(false, true);
  const Mirror<2> mirror = GENERATE(in_x, in_y, exchanged);
  CAPTURE(drop, on_body, mirror.axis, mirror.mirrored);
  Json scene = with(column(), {R"(/walls="slip")", "/body_force=[0, 0]", "/particles/0/shape=" + drop,
                               R"(/surface_tension={"coefficient": 20, "contact_angle": 60})"});
  if (on_body)
    scene["bodies"] = Json::parse(
        R"([{"name": "body", "shape": {"ball": {"center": [0.03, -0.1], "radius": 0.1}}, "wall": "slip"}])");
  check_image<2>(scene, mirror, 5, 1e-10);
}

TEST_CASE("drops in 3-D are the same in the mirror", "[property]") {
  const std::string drop = GENERATE(R"({"ball": {"center": [0.03, 0.01, 0.05], "radius": 0.16}})",
                                    R"({"intersection": [{"ball": {"center": [0.03, -0.02, -0.17], "radius": 0.19}},
                                                         {"box": {"low": [-0.3, -0.2, -0.2], "high": [0.3, 0.2, 0.3]}}]})");
  const bool on_body = GENERATE(false, true);
  const Mirror<3> mirror = GENERATE(in_z, exchanged_in_space);
  CAPTURE(drop, on_body, mirror.axis, mirror.mirrored);
  Json scene = Json::parse(R"json({
    "dimension": 3, "grid": {"low": [-0.3, -0.2, -0.2], "high": [0.3, 0.2, 0.3], "cells": [6, 4, 5]}, "walls": "slip",
    "fluid": {"density": 1000, "viscosity": 2}, "surface_tension": {"coefficient": 20, "contact_angle": 60},
    "solver": {"scheme": "block", "tolerance": 1e-13}, "time": {"end": 1, "step": 0.01}})json");
  scene["particles"] = {
      {{"shape", Json::parse(drop)}, {"per_cell", 2}, {"velocity", {"0.3*sin(7*y)", "0.4*x", "0.2*y"}}}};
  if (on_body)
    scene["bodies"] = Json::parse(
        R"([{"name": "body", "shape": {"ball": {"center": [0.03, 0, -0.1], "radius": 0.1}}, "wall": "slip"}])");
  // Faces with next to no mass amplify rounding: up to 5e-8. Before: 2e-3 of the kinetic energy.
  check_image<3>(scene, mirror, 3, 2e-7);
}
