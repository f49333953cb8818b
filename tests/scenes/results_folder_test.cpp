// The folder of a run's results: what goes, what stays, and whose it is.

#include "support/program.hpp"
#include "support/program_output.hpp"

#include <nlohmann/json.hpp>

#include <catch2/catch.hpp>

#include <csignal>
#include <filesystem>
#include <set>

using namespace minamo;

namespace {

namespace fs = std::filesystem;

using CommandLine = std::vector<std::string>;

const std::string pool = R"({"dimension": 2, "grid": {"low": [0, 0], "high": [0.4, 0.3], "cells": [16, 12]},
  "fluid": {"density": 1000, "viscosity": 0}, "body_force": [0, -9.81],
  "particles": [{"shape": {"box": {"low": [0, 0], "high": [0.2, 0.2]}}}],
  "time": {"end": 0.1, "step": 0.005}, "output": {"every": 0.02}})";

/// A folder with a scene, `pool.json`.
class PoolFolder : public Folder {
 public:
  PoolFolder() { write("pool.json", pool); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(*this / name) << text; }
  ProgramOutput run(const std::string& scene, const CommandLine& more) const {
    CommandLine arguments{"run", scene, "--threads", "1", "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return output_of_program(*this / "", arguments);
  }
};

CommandLine surfaces(const std::string& format) { return {"--set", "/output/surface=\"" + format + "\""}; }

CommandLine operator+(CommandLine a, const CommandLine& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::set<std::string> files_in(const std::string& folder) {
  std::set<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.insert(entry.path().filename().string());
  return files;
}

}  // namespace

TEST_CASE("a run does not replace the scene that it is given", "[scene]") {
  const PoolFolder folder;
  folder.write("scene.json", pool);
  const ProgramOutput run = folder.run("scene.json", {"--out", "."});
  CHECK(run.code == 2);
  CHECK(run.err == "scene.json: is an input that a result would replace\n"
                   "  expected  another folder for the results (--out)\n  got       \".\" (string)\n");
  CHECK(files_in(folder / "") == std::set<std::string>{"pool.json", "scene.json"});
  CHECK(text_of(folder / "scene.json") == pool);
}

TEST_CASE("a run does not replace a file that its scene refers to", "[scene]") {
  const PoolFolder folder;
  fs::create_directory(folder / "out");
  const std::string path = "time,x,y\n0,0.3,0.15\n1,0.3,0.16\n";
  folder.write("out/history.csv", path);
  const ProgramOutput run =
      folder.run("pool.json", {"--out", "out", "--set",
                               R"(/bodies=[{"name": "b", "shape": {"ball": {"center": [0.3, 0.15], "radius": 0.05}},
                                  "motion": {"table": {"file": "out/history.csv"}}}])"});
  CHECK(run.code == 2);
  CHECK_THAT(run.err, Catch::StartsWith((folder / "out/history.csv") + ": is an input that a result would replace\n"));
  CHECK(text_of(folder / "out/history.csv") == path);
  CHECK(files_in(folder / "out") == std::set<std::string>{"history.csv"});
}

TEST_CASE("a study does not replace the table of others that it is given", "[scene]") {
  const PoolFolder folder;
  const std::string others = "code,setting,cost,error\nfoam,coarse,1,0.1\n";
  folder.write("others.csv", others);
  folder.write("study.json",
               R"({"scene": "pool.json", "vary": {"cells": [16]}, "error": "overlap", "others": "others.csv"})");
  const ProgramOutput study = output_of_program(folder / "", {"study", "study.json", "--out", ".", "--threads", "1"});
  CHECK(study.code == 2);
  CHECK_THAT(study.err, Catch::StartsWith((folder / "others.csv") + ": is an input that a result would replace\n"));
  CHECK(text_of(folder / "others.csv") == others);
}

TEST_CASE("a scene as run may be run again where it is", "[scene]") {
  const PoolFolder folder;
  REQUIRE(folder.run("pool.json", {"--out", "out"}).code == 0);
  const std::string history = text_of(folder / "out/history.csv");
  const ProgramOutput again = folder.run("out/scene.json", {"--out", "out"});
  CHECK(again.code == 0);
  CHECK(again.err.empty());
  CHECK(text_of(folder / "out/history.csv") == history);
  const ProgramOutput changed = folder.run("out/scene.json", {"--out", "out", "--set", "/time/end=0.2"});
  CHECK(changed.code == 2);
  CHECK(folder.run("out/scene.json", {"--out", "out", "--set", "/time/end=0.2", "--resume"}).code == 0);
}

TEST_CASE("surfaces of an earlier run go with its other results, and no other files", "[scene]") {
  const PoolFolder folder;
  const std::string before = GENERATE("vtp", "ply");
  const std::string now = GENERATE("vtp", "ply", "none");
  CAPTURE(before, now);
  REQUIRE(folder.run("pool.json", CommandLine{"--out", "out"} + surfaces(before)).code == 0);
  const std::set<std::string> foreign{"mine.vtp", "7.ply", "0001.stl"};
  for (const std::string& name : foreign) folder.write("out/surface/" + name, "mine");
  REQUIRE(folder.run("pool.json", CommandLine{"--out", "out", "--steps", "4"} + surfaces(now)).code == 0);
  std::set<std::string> expected = foreign;
  if (now != "none") expected.insert({"0000." + now, "0001." + now});
  CHECK(files_in(folder / "out/surface") == expected);
  CHECK(fs::exists(folder / "out/surface.pvd") == (now == "vtp"));
}

TEST_CASE("a folder of surfaces goes when nothing is left in it", "[scene]") {
  const PoolFolder folder;
  REQUIRE(folder.run("pool.json", CommandLine{"--out", "out"} + surfaces("vtp")).code == 0);
  REQUIRE(folder.run("pool.json", {"--out", "out"}).code == 0);
  CHECK_FALSE(fs::exists(folder / "out/surface"));
}

TEST_CASE("the index of surfaces names those that are there", "[scene]") {
  const PoolFolder folder;
  REQUIRE(folder.run("pool.json", CommandLine{"--out", "out", "--steps", "8"} + surfaces("none")).code == 0);
  REQUIRE(folder.run("pool.json", CommandLine{"--out", "out", "--resume"} + surfaces("vtp")).code == 0);
  const std::string index = text_of(folder / "out/surface.pvd");
  for (const char* name : {"0000", "0001", "0002", "0003", "0004", "0005"}) {
    const std::string file = "surface/" + std::string(name) + ".vtp";
    CAPTURE(file);
    CHECK((index.find(file) != std::string::npos) == fs::exists(folder / ("out/" + file)));
  }
  CHECK(fs::exists(folder / "out/surface/0005.vtp"));
}

TEST_CASE("two runs do not write into one folder, and a killed one does not keep it", "[scene]") {
  const PoolFolder folder;
  Program first(
      {"run", folder / "pool.json", "--threads", "1", "--quiet", "--out", folder / "out", "--set", "/time/end=1000"});
  wait_for_file(folder / "out/checkpoint.h5", 0);
  const CommandLine more = GENERATE(CommandLine{}, CommandLine{"--resume"});
  const ProgramOutput second = folder.run("pool.json", CommandLine{"--out", "out"} + more);
  CHECK(second.code == 2);
  CHECK(second.err == "out: another run is writing here\n  expected  a folder of its own for every run (--out)\n");
  first.send(SIGKILL);
  first.wait();
  CHECK(folder.run("pool.json", {"--out", "out", "--overwrite"}).code == 0);
}

TEST_CASE("a run says when it replaces the results of another scene", "[scene]") {
  const PoolFolder folder;
  fs::create_directory(folder / "other");
  folder.write("other/pool.json", pool);
  CHECK(folder.run("pool.json", {}).err.empty());
  CHECK(folder.run("./pool.json", {}).err.empty());
  CHECK(folder.run("other/pool.json", {}).err == "out/pool: results of ./pool.json are replaced\n");
}

TEST_CASE("a summary says whether the run came to its end", "[scene]") {
  const PoolFolder folder;
  const auto summary = [&] { return nlohmann::json::parse(text_of(folder / "out/summary.json")); };
  REQUIRE(folder.run("pool.json", {"--out", "out", "--steps", "3"}).code == 0);
  CHECK(summary()["complete"] == false);
  CHECK(summary()["end"] == 0.1);
  REQUIRE(folder.run("pool.json", {"--out", "out", "--resume"}).code == 0);
  CHECK(summary()["complete"] == true);
}

TEST_CASE("a trace may replace a trace, and nothing else", "[scene]") {
  const PoolFolder folder;
  REQUIRE(folder.run("pool.json", {"--steps", "1", "--profile", "trace.json"}).code == 0);
  const std::string trace = text_of(folder / "trace.json");
  CHECK(trace.size() > 100);
  CHECK(folder.run("pool.json", {"--steps", "2", "--overwrite", "--profile", "trace.json"}).code == 0);
  CHECK(text_of(folder / "trace.json").size() > trace.size());
  folder.write("victim.json", pool);
  CHECK(output_of_program(folder / "", {"run", "--profile", "victim.json", "pool.json"}).code == 2);
  CHECK(text_of(folder / "victim.json") == pool);
}
