/// \file
/// Runs that do not fit into memory.

#include "support/program_output.hpp"

#include <catch2/catch.hpp>

#include <filesystem>

using namespace minamo;

TEST_CASE("a run that needs terabytes is refused before anything is made", "[error]") {
  const std::string command = GENERATE("run", "check");
  const Folder folder;
  std::ofstream(folder / "a.json") << R"({"dimension": 3,
    "grid": {"low": [0, 0, 0], "high": [1, 1, 1], "cells": [450, 450, 450]}, "fluid": {"density": 1000, "viscosity": 0},
    "particles": [{"shape": {"box": {"low": [0, 0, 0], "high": [1, 1, 1]}}, "per_cell": 1}],
    "solver": {"scheme": "umfpack"}, "time": {"end": 1, "step": 0.01}})";
  const ProgramOutput refused = output_of_program(folder / "", {command, "a.json"});
  CHECK_THAT(
      refused.err,
      Catch::Matches("a\\.json: does not fit into memory; larger cells or fewer particles per cell need less, as "
                     "does the solver \"block\"\n"
                     "  expected  at most [0-9.]+ [MGT]B, (free memory|left) of .*\n"
                     "  got       about [0-9.]+ TB: 9\\.17e\\+07 particles on 9\\.17e\\+07 nodes\n"));
  CHECK(refused.code == 2);
  CHECK(refused.out.empty());
  CHECK_FALSE(std::filesystem::exists(folder / "out"));
}
