// What a run does to the results of an earlier one: those of an unfinished run stay until somebody says that they may
// go.

#include "support/program.hpp"
#include "support/program_output.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <csignal>
#include <filesystem>
#include <map>

using namespace minamo;

namespace {

namespace fs = std::filesystem;

using CommandLine = std::vector<std::string>;

const std::string pool_with_limit = R"json({"dimension": 2,
  "grid": {"low": [0, 0], "high": [0.4, 0.3], "cells": [16, 12]},
  "fluid": {"density": 1000, "viscosity": 0}, "constants": {"limit": 1e9}, "body_force": [0, "-9.81/(t < limit)"],
  "particles": [{"shape": {"box": {"low": [0, 0], "high": [0.2, 0.2]}}}],
  "time": {"end": 0.05, "step": 0.005}, "output": {"every": 0.02}})json";

/// A folder with a scene, `pool.json`, whose results go to `out`.
class FolderWithPool : public Folder {
 public:
  FolderWithPool() { std::ofstream(*this / "pool.json") << pool_with_limit; }
  ProgramOutput run(const CommandLine& more) const {
    CommandLine arguments{"run", "pool.json", "--threads", "1", "--out", "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return output_of_program(*this / "", arguments);
  }
  /// A run without end, once its first checkpoint after the start is there, and ended by that signal.
  void run_until(int signal) const {
    Program program({"run", *this / "pool.json", "--threads", "1", "--quiet", "--out", *this / "out", "--set",
                     "/time/end=1000", "--set", "/output/checkpoint=0.005"});
    wait_for_file(*this / "out/history.csv", 4000);  // some dozen rows
    program.send(signal);
    program.wait();
  }
  /// Names and bytes of all results.
  std::map<std::string, std::string> results() const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(*this / "out"))
      files[entry.path().filename()] = text_of(entry.path());
    return files;
  }
};

const std::string refusal =
    "out: the results of an unfinished run would be replaced\n"
    "  expected  --resume to go on with it, --overwrite to replace it, or another folder (--out)\n"
    "  got       a run";

}  // namespace

TEST_CASE("a run does not replace an unfinished one, however that ended, until it is told to", "[scene]") {
  const FolderWithPool folder;
  const std::string how = GENERATE("stopped by --steps", "failed", "interrupted", "ended without a summary");
  CAPTURE(how);
  if (how == "stopped by --steps") CHECK(folder.run({"--steps", "3"}).code == 0);
  if (how == "failed") CHECK(folder.run({"--set", "/constants/limit=0.012"}).code == 3);
  if (how == "interrupted") folder.run_until(SIGINT);
  if (how == "ended without a summary") folder.run_until(SIGKILL);
  const auto before = folder.results();
  const ProgramOutput again = folder.run({});
  CHECK(again.code == 2);
  CHECK_THAT(again.err, Catch::StartsWith(refusal) && Catch::Contains(how) && Catch::Contains(" at t = ") &&
                            Catch::Contains(" of "));
  CHECK(folder.results() == before);
  const ProgramOutput told = folder.run({"--overwrite"});
  CHECK(told.code == 0);
  CHECK_THAT(told.err, Catch::StartsWith("out: the results of an unfinished run are replaced\n"));
  CHECK(nlohmann::json::parse(text_of(folder / "out/summary.json"))["complete"] == true);
}

TEST_CASE("an unfinished run can be gone on with after another one was refused", "[scene]") {
  const FolderWithPool folder;
  REQUIRE(folder.run({"--steps", "3"}).code == 0);
  REQUIRE(folder.run({}).code == 2);
  CHECK(folder.run({"--resume"}).code == 0);
}

TEST_CASE("a run replaces a finished one and says so in one line, and nothing where there is none", "[scene]") {
  const FolderWithPool folder;
  const ProgramOutput first = folder.run({});
  CHECK_THAT(first.err, !Catch::Contains("replaced"));
  const ProgramOutput again = folder.run({});
  CHECK(again.code == 0);
  CHECK(again.err == "out: the results of an earlier run are replaced\n" + first.err);
  CHECK(folder.run({"--quiet"}).err.empty());
}

TEST_CASE("a run that took no step is replaced like a finished one", "[scene]") {
  const FolderWithPool folder;
  REQUIRE(folder.run({"--steps", "0"}).code == 0);
  CHECK(folder.run({"--steps", "0"}).code == 0);
}

TEST_CASE("a finished run that goes on to a later end is unfinished when it is killed", "[scene]") {
  const FolderWithPool folder;
  REQUIRE(folder.run({}).code == 0);
  Program program({"run", folder / "pool.json", "--threads", "1", "--quiet", "--out", folder / "out", "--resume",
                   "--set", "/time/end=1000", "--set", "/output/checkpoint=0.005"});
  wait_for_file(folder / "out/history.csv", 2 * fs::file_size(folder / "out/history.csv"));
  program.send(SIGKILL);
  program.wait();
  CHECK(folder.run({}).code == 2);
}

TEST_CASE("to go on with a run and to replace it are not asked for at once", "[scene]") {
  const FolderWithPool folder;
  const ProgramOutput both = folder.run({"--resume", "--overwrite"});
  CHECK(both.code == 2);
  CHECK_THAT(both.err, Catch::Contains("--resume") && Catch::Contains("--overwrite"));
}

TEST_CASE("a study replaces its variants, finished or not", "[scene]") {
  const FolderWithPool folder;
  std::ofstream(folder / "study.json") << R"({"scene": "pool.json", "vary": {"cells": [16]}, "error": "overlap"})";
  const CommandLine variant{"run", "pool.json", "--steps", "3", "--out", "out/cells16", "--threads", "1"};
  REQUIRE(output_of_program(folder / "", variant).code == 0);
  const ProgramOutput study = output_of_program(folder / "", {"study", "study.json", "--out", "out", "--threads", "1"});
  CHECK(study.code == 0);
  CHECK_THAT(study.err, !Catch::Contains("replaced"));
}

TEST_CASE("a quiet run prints nothing, not even the times that it was asked to measure", "[scene]") {
  const FolderWithPool folder;
  const CommandLine more = GENERATE(CommandLine{}, CommandLine{"--profile=trace.json"}, CommandLine{"--resume"});
  REQUIRE(folder.run({"--quiet"}).code == 0);
  CommandLine arguments{"--quiet"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const ProgramOutput run = folder.run(arguments);
  CHECK(run.code == 0);
  CHECK(run.out + run.err == "");
}
