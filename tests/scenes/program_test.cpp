#include "support/folder.hpp"
#include "support/program.hpp"
#include "support/scene_run.hpp"

#include "engine/run/step_control.hpp"
#include "engine/storage/hdf5.hpp"

#include <catch2/catch.hpp>

#include <csignal>

using namespace minamo;

namespace {

using CommandLine = std::vector<std::string>;

/// `minamo run` of the dam break on a coarse grid, with more arguments.
CommandLine dam_break(const std::string& out, const CommandLine& more) {
  CommandLine arguments{"run",
                        scene_path("paper/dam_break_tpic.json"),
                        "--out",
                        out,
                        "--threads",
                        "1",
                        "--quiet",
                        "--set",
                        "/grid/cells=[20, 20]"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

Json json_of(const std::string& path) { return Json::parse(text_of(path)); }

std::vector<std::string> lines_of(const std::string& path) {
  std::istringstream text(text_of(path));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> missing(const Json& object, const std::vector<std::string>& keys) {
  std::vector<std::string> names;
  for (const std::string& key : keys) {
    if (!object.contains(key)) names.push_back(key);
  }
  return names;
}

/// Names of the datasets of a frame that differ between two runs.
std::vector<std::string> differing_fields(const std::string& a, const std::string& b, const std::string& frame) {
  const Hdf5File file_a(a + "/fields.h5", Hdf5File::Access::read);
  const Hdf5File file_b(b + "/fields.h5", Hdf5File::Access::read);
  std::vector<std::string> names;
  for (const char* field : {"position", "velocity", "pressure", "id", "mass", "volume", "velocity_gradient"}) {
    const std::string dataset = "/particles/" + frame + "/" + field;
    if (file_a.read_bytes(dataset) != file_b.read_bytes(dataset)) names.emplace_back(field);
  }
  return names;
}

/// What `minamo check` says of the scenes of a folder, all of which it accepts without a doubt.
std::string output_of_check(const std::string& folder) {
  CommandLine arguments{"check"};
  for (const auto& entry : std::filesystem::directory_iterator(MINAMO_SOURCE_DIR + folder)) {
    if (entry.path().extension() == ".json") arguments.push_back(entry.path());
  }
  const ProgramEnd end = run_program(arguments);
  CHECK(end.code == 0);
  for (const char* doubt : {"overlaps", "faster than sound", "lengths are in metres", "/time/", "/output/"})
    CHECK_THAT(end.output, !Catch::Contains(doubt));
  return end.output;
}

}  // namespace

TEST_CASE("a run leaves its files", "[scene]") {
  const Folder folder;
  REQUIRE(run_program(dam_break(folder / "out", {"--steps", "3"})).code == 0);
  const std::string file = GENERATE("scene.json", "history.csv", "fields.h5", "fields.xdmf", "summary.json");
  CAPTURE(file);
  CHECK(std::filesystem::file_size(folder / "out" + "/" + file) > 0);
}

TEST_CASE("a run writes a history of its start and every step", "[scene]") {
  const Folder folder;
  REQUIRE(run_program(dam_break(folder / "out", {"--steps", "3"})).code == 0);
  const auto lines = lines_of(folder / "out/history.csv");
  REQUIRE(lines.size() == 5);
  CHECK(lines[0].starts_with("step,time,dt,kinetic_energy,potential_energy,momentum_x,momentum_y,angular_momentum,"
                             "max_speed,max_divergence,overlap,active_nodes,iterations,residual"));
  CHECK(lines[4].starts_with("3,0.003,0.001,"));
}

TEST_CASE("peak memory is that of the run, however large the program that started it", "[scene]") {
  const Folder folder;
  constexpr std::int64_t held = 400'000'000;
  const std::vector<char> hold(held, 'x');
  REQUIRE(run_program(dam_break(folder / "out", {"--steps", "1"})).code == 0);
  CHECK(json_of(folder / "out/summary.json")["peak_memory_bytes"].get<std::int64_t>() < held / 2);
  CHECK(hold.back() == 'x');
}

TEST_CASE("a summary has the keys of the interface", "[scene]") {
  const Folder folder;
  REQUIRE(run_program(dam_break(folder / "out", {"--steps", "3"})).code == 0);
  const Json summary = json_of(folder / "out/summary.json");
  CHECK(missing(summary,
                {"scene", "status", "steps", "time", "wall_s", "cpu_s", "threads", "cpu_model", "version", "particles",
                 "active_nodes_max", "unknowns_max", "peak_memory_bytes", "systems", "conservation", "errors"})
            .empty());
  CHECK(missing(summary["conservation"], {"mass", "momentum", "angular_momentum", "energy", "overlap_max"}).empty());
  CHECK(missing(summary["systems"][0], {"name", "calls", "seconds", "declared_bytes", "share"}).empty());
  CHECK(summary["status"] == "done");
  CHECK(summary["steps"] == 3);
  CHECK(summary["particles"] == 200);
  CHECK(summary["conservation"]["mass"].get<double>() == Approx(42.632).epsilon(1e-14));  // a few roundings
}

TEST_CASE("the scene as run has defaults and overrides, and gives the same bits again", "[scene]") {
  const Folder folder;
  const CommandLine more{"--steps", "5", "--set", R"(/output={"every": 0.002})"};
  REQUIRE(run_program(dam_break(folder / "first", more)).code == 0);
  CHECK(json_of(folder / "first/scene.json")["grid"]["cells"] == Json({20, 20}));
  REQUIRE(run_program({"run", folder / "first/scene.json", "--out", folder / "second", "--threads", "2", "--steps", "5",
                       "--quiet"})
              .code == 0);
  CHECK(json_of(folder / "first/scene.json") == json_of(folder / "second/scene.json"));
  CHECK(differing_fields(folder / "first", folder / "second", "3").empty());
}

TEST_CASE("a scheme can be overridden alone: keys of the one in the file go with it", "[scene]") {
  const Folder folder;
  const std::string changed = GENERATE(R"(/transfer/scheme="flip")", R"(/transfer/scheme="apic")",
                                       R"(/integrator/scheme="midpoint")", R"(/solver/scheme="umfpack")");
  CAPTURE(changed);
  REQUIRE(run_program({"run", scene_path("paper/dam_break_tpic.json"), "--out", folder / "out", "--steps", "1",
                       "--quiet", "--set", changed})
              .code == 0);
  // What the new scheme knows, too, stays as it is in the file.
  const Json transfer = json_of(folder / "out/scene.json")["transfer"];
  CHECK((transfer["scheme"] == "flip" || transfer["inertia"] == "lumped"));
}

TEST_CASE("a CFL number can be overridden alone: the step in the file goes, and the other way round", "[scene]") {
  const Folder folder;
  const auto time_with = [&](const std::string& scene, const CommandLine& overrides) {
    CommandLine line{"run", scene_path(scene), "--out", folder / "out", "--steps", "1", "--quiet", "--overwrite"};
    for (const std::string& assignment : overrides) line.insert(line.end(), {"--set", assignment});
    REQUIRE(run_program(line).code == 0);
    return json_of(folder / "out/scene.json")["time"];
  };
  CHECK(time_with("paper/dam_break_tpic.json", {"/time/cfl=0.5"}) == Json({{"end", 5.0}, {"cfl", 0.5}}));
  CHECK(time_with("tap.json", {"/time/step=0.001"}) == Json({{"end", 3.0}, {"step", 0.001}}));  // had a max_step, too
  const ProgramEnd both =
      run_program({"check", scene_path("tap.json"), "--set", "/time/step=0.001", "--set", "/time/cfl=1"});
  CHECK(both.code == 2);
}

TEST_CASE("an override that the new scheme does not know is an error", "[scene]") {
  const Folder folder;
  const ProgramEnd wrong =
      run_program({"run", scene_path("paper/dam_break_tpic.json"), "--out", folder / "out", "--set",
                   R"(/transfer/scheme="flip")", "--set", R"(/transfer/inertia="lumped")"});
  CHECK(wrong.code == 2);
  CHECK_THAT(wrong.output, Catch::Contains("/transfer/inertia: unknown key with scheme \"flip\""));
}

TEST_CASE("bad input ends with 2 and runs nothing", "[scene]") {
  const Folder folder;
  const auto [set, message] =
      GENERATE(table<std::string, std::string>({{R"(/transfer/scheme="flop")", "/transfer/scheme"},
                                                {"/nonsense=1", "/nonsense"},
                                                {"/time/step=-1", "/time/step"}}));
  CAPTURE(set);
  const ProgramEnd end = run_program(dam_break(folder / "out", {"--set", set}));
  CHECK(end.code == 2);
  CHECK_THAT(end.output, Catch::Contains(message));
  CHECK_FALSE(std::filesystem::exists(folder / "out"));
}

TEST_CASE("a scene that is not there ends with 2", "[scene]") {
  CHECK(run_program({"run", "/nowhere/scene.json"}).code == 2);
}

TEST_CASE("an unknown option ends with 2", "[scene]") {
  CHECK(run_program({"run", scene_path("paper/dam_break_tpic.json"), "--nonsense"}).code == 2);
}

TEST_CASE("check accepts every scene", "[scene][long]") {
  CHECK_THAT(output_of_check("/scenes"), Catch::Contains("dam_break.json: valid, 1800 particles"));
}

TEST_CASE("check accepts the scenes of the paper", "[scene]") {
  CHECK_THAT(output_of_check("/scenes/paper"), Catch::Contains("dam_break_tpic.json: valid"));
}

TEST_CASE("an exact solution that ends in the course of the run fails it", "[scene]") {
  const Folder folder;
  const ProgramEnd end =
      run_program(dam_break(folder / "out", {"--set", R"json(/exact={"velocity": ["sqrt(0.0045 - t)", 0]})json"}));
  CHECK(end.code == 3);
  CHECK_THAT(end.output, Catch::Contains("exact: the velocity is not finite at t = 0.005 s"));
  CHECK(text_of(folder / "out/history.csv").find("nan") == std::string::npos);
  CHECK(json_of(folder / "out/summary.json")["steps"] == 4);
}

TEST_CASE("a run that fails ends with 3, says where, and leaves a checkpoint and a summary", "[scene]") {
  const Folder folder;
  // The force leaves the range of numbers at t = 0.0032; no step is short enough to get there.
  const ProgramEnd end =
      run_program(dam_break(folder / "out", {"--set", R"json(/body_force=[0, "-9.81/(t < 0.0032)"])json"}));
  CHECK(end.code == 3);
  CHECK_THAT(end.output, Catch::Contains("shortest dt") && Catch::Contains("body_force: not finite"));
  CHECK(std::filesystem::exists(folder / "out/checkpoint.h5"));
  const Json summary = json_of(folder / "out/summary.json");
  CHECK(summary["status"] == "failed");
  CHECK(summary["rejected_steps"] >= StepControl::most_halvings);
  CHECK(summary["time"] > 0.0031);
  CHECK(summary["time"] < 0.0032);
}

TEST_CASE("a motion that becomes no number ends the run at once", "[scene]") {
  const Folder folder;
  const ProgramEnd end =
      run_program({"run", scene_path("paddle.json"), "--out", folder / "out", "--threads", "1", "--set",
                   R"json(/bodies/0/motion={"prescribed": {"velocity": ["0.1*sqrt(0.01 - t)", 0]}})json", "--set",
                   R"json(/time={"end": 1, "step": 0.004})json"});
  CHECK(end.code == 3);
  CHECK_THAT(end.output, Catch::Contains("has a velocity that is not finite in the step from t = 0.008 s") &&
                             !Catch::Contains("taken back"));
  CHECK(json_of(folder / "out/summary.json")["steps"] == 2);
  CHECK(std::filesystem::exists(folder / "out/checkpoint.h5"));
}

TEST_CASE("an opening or a sponge that becomes no number, or an inflow that turns, ends the run at once", "[scene]") {
  const Folder folder;
  const auto [set, message] = GENERATE(table<std::string, std::string>(
      {{R"json(/openings/0/inflow={"velocity": ["0", "-sqrt(0.009 - t)"]})json", "the inflow of \"tap\" is not finite"},
       {R"json(/openings/0/inflow={"rate": "0.02*(0.009 - t)"})json", "the rate of \"tap\", what comes in, is -"},
       {R"json(/openings/1/outflow={"pressure": "sqrt(0.009 - t)"})json", "the pressure of \"overflow\" is not finite"},
       {R"json(/openings/1/outflow={"level": "0.1 + sqrt(0.009 - t)"})json", "the level of \"overflow\" is not finite"},
       {R"json(/sponge=[{"where": "sqrt(0.009 - t)", "rate": 1}])json", "sponge: \"where\" is not a number"},
       {R"json(/sponge=[{"where": "x > 0.5", "rate": "sqrt(0.009 - t)"}])json", "a rate is not a number"}}));
  CAPTURE(set);
  const ProgramEnd end = run_program({"run", scene_path("tap.json"), "--out", folder / "out", "--threads", "1", "--set",
                                      set, "--set", R"json(/time={"end": 1, "step": 0.004})json"});
  CHECK(end.code == 3);
  CHECK_THAT(end.output, Catch::Contains(message) && !Catch::Contains("taken back"));
  CHECK(json_of(folder / "out/summary.json")["steps"] == 2);
  CHECK(std::filesystem::exists(folder / "out/checkpoint.h5"));
}

TEST_CASE("an interrupted run ends with 130 and leaves a checkpoint", "[scene]") {
  const Folder folder;
  const int signal = GENERATE(SIGINT, SIGTERM);
  CAPTURE(signal);
  Program program(dam_break(folder / "out", {}));
  constexpr std::size_t a_few_rows = 2000;
  wait_for_file(folder / "out/history.csv", a_few_rows);
  program.send(signal);
  CHECK(program.wait().code == 130);
  CHECK(std::filesystem::exists(folder / "out/checkpoint.h5"));
  CHECK(json_of(folder / "out/summary.json")["status"] == "interrupted");
}

TEST_CASE("graph shows the systems of a scene and what they touch", "[scene]") {
  const ProgramEnd end = run_program({"graph", scene_path("paper/dam_break_pic.json"), "--format", "json"});
  REQUIRE(end.code == 0);
  const Json graph = Json::parse(end.output);
  CHECK_FALSE(graph["systems"].empty());
  CHECK_THAT(end.output, !Catch::Contains("velocity_gradient"));
  CHECK_THAT(end.output, Catch::Contains("p2g_velocity_pic"));
}

TEST_CASE("a run of no steps writes the start alone", "[scene]") {
  const Folder folder;
  REQUIRE(run_program(dam_break(folder / "out", {"--steps", "0"})).code == 0);
  CHECK(lines_of(folder / "out/history.csv").size() == 2);
  CHECK(json_of(folder / "out/summary.json")["steps"] == 0);
}

TEST_CASE("a run that gains energy says so at its end", "[scene]") {
  const Folder folder;
  // A cell of water that runs out into single particles.
  const ProgramEnd end = run_program(
      dam_break(folder / "out", {"--set", R"(/particles/0/shape={"box": {"low": [0, 0], "high": [0.0292, 0.0292]}})",
                                 "--set", R"(/integrator={"scheme": "midpoint"})", "--set", "/time/end=1"}));
  CHECK(end.code == 0);
  const Json summary = json_of(folder / "out/summary.json");
  CHECK(summary["conservation"]["energy_rise"] > 0.01);
  CHECK_THAT(end.output, Catch::Contains("energy rose by"));
}

TEST_CASE("a run whose pressure turns over from step to step says so at its end", "[scene]") {
  const Folder folder;
  // Water that falls flat on the floor of a shaft, and rests there.
  const auto fall = [&](const std::string& integrator) {
    const ProgramEnd end = run_program(dam_break(
        folder / "out", {"--set", R"(/grid={"low": [0, 0], "high": [0.1, 1], "cells": [4, 40]})", "--set",
                         R"(/particles/0/shape={"box": {"low": [0, 0.1], "high": [0.1, 0.6]}})", "--set",
                         "/integrator=" + integrator, "--set", "/time/step=0.004", "--steps", "100", "--overwrite"}));
    CHECK(end.code == 0);
    return std::pair(json_of(folder / "out/summary.json"), end.output);
  };
  const auto [undamped, warning] = fall(R"({"scheme": "newmark"})");
  CHECK(undamped["pressure_turns"] > 50);
  CHECK_THAT(warning, Catch::Contains("pressure turned over"));

  const auto [damped, nothing] = fall(R"({"scheme": "newmark", "gamma": 0.6})");
  CHECK(damped["pressure_turns"] < 20);
  CHECK(nothing.empty());

  CHECK_FALSE(fall(R"({"scheme": "midpoint"})").first.contains("pressure_turns"));
}

TEST_CASE("equal order keeps a pool at rest with the steps that it chooses", "[scene]") {
  const Folder folder;
  std::ofstream(folder / "pool.json") << R"({"dimension": 2, "grid": {"low": [0, 0], "high": [1, 1], "cells": [20, 20]},
    "discretization": {"scheme": "equal_order"}, "fluid": {"density": 1000, "viscosity": 1e-3},
    "body_force": [0, -9.81], "particles": [{"shape": {"box": {"low": [0, 0], "high": [1, 0.5]}}}],
    "time": {"end": 20}, "output": {"every": 20}})";
  const ProgramEnd end = run_program({"run", folder / "pool.json", "--out", folder / "out", "--quiet"});
  CHECK(end.code == 0);
  CHECK(end.output.empty());
  // With steps of sqrt(h/g) it was 0.4.
  CHECK(json_of(folder / "out/summary.json")["conservation"]["overlap_max"] < 0.05);
}

TEST_CASE("a run that loses volume says so while it goes on, and what to change", "[scene]") {
  const Folder folder;
  std::ofstream(folder / "pool.json") << R"({"dimension": 2, "grid": {"low": [0, 0], "high": [1, 1], "cells": [20, 20]},
    "discretization": {"scheme": "equal_order"}, "fluid": {"density": 1000, "viscosity": 1e-3}, "volume": {"scheme": "none"},
    "body_force": [0, -9.81], "particles": [{"shape": {"box": {"low": [0, 0], "high": [1, 0.5]}}}],
    "integrator": {"scheme": "newmark"}, "time": {"end": 20, "step": 0.07}, "output": {"every": 20}})";
  const ProgramEnd end = run_program({"run", folder / "pool.json", "--out", folder / "out", "--quiet"});
  CHECK(end.code == 0);
  CHECK_THAT(end.output, Catch::Contains("no room for it") && Catch::Contains("lower than its volume allows") &&
                             Catch::Contains("\"midpoint\"") && Catch::Contains("as long as the body force allows"));
  const Json summary = json_of(folder / "out/summary.json");
  CHECK(summary["warnings"].size() >= 3);
}

TEST_CASE("a sound run says nothing", "[scene]") {
  const Folder folder;
  const ProgramEnd end = run_program(dam_break(folder / "out", {"--steps", "10"}));
  CHECK(end.code == 0);
  CHECK_THAT(end.output, Catch::Equals(""));
  CHECK(json_of(folder / "out/summary.json")["warnings"].empty());
}

TEST_CASE("a run that keeps its energy says nothing of it", "[scene]") {
  const Folder folder;
  const ProgramEnd end = run_program(dam_break(folder / "out", {"--set", "/time/step=0.01", "--steps", "60"}));
  CHECK(end.code == 0);
  CHECK(json_of(folder / "out/summary.json")["conservation"]["energy_rise"] < 0.01);
  CHECK_THAT(end.output, !Catch::Contains("energy rose"));
}
