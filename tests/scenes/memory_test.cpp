/// \file
/// The memory of runs: estimated against measured, and refused where a limit leaves too little.

#include "support/build.hpp"
#include "support/program.hpp"
#include "support/program_output.hpp"
#include "support/scene_run.hpp"
#include "systems/step/memory.hpp"

#include <catch2/catch.hpp>

using namespace minamo;

TEST_CASE("a run takes as much memory as was estimated, within the bounds that are documented", "[scene]") {
  if (is_address_sanitized()) return;  // which takes several times the memory, and all address space
  // Water, and honey: in 3-D the factors of its velocities are most of what a run takes.
  const auto [name, viscosity, steps, most] =
      GENERATE(table<std::string, std::string, std::string, double>({{"dam_break.json", "1e-3", "1000", 2.4},
                                                                     {"dam_break_3d.json", "1e-3", "5", 2.4},
                                                                     {"dam_break_3d.json", "1e3", "1", 4}}));
  CAPTURE(name, viscosity);
  const Folder folder;
  const std::string override = "/fluid/viscosity=" + viscosity;
  REQUIRE(output_of_program(folder / "", {"run", scene_path(name), "--steps", steps, "--out", "out", "--set", override})
              .code == 0);
  const auto taken = read_json(folder / "out/summary.json").at("peak_memory_bytes").get<double>();
  const Scene scene = scene_run::read(scene_run::with(scene_run::scene_of_file(name), {override}));
  const double estimated = memory_of(scene, size_of(scene));
  CHECK(taken <= estimated);
  CHECK(taken >= estimated / most);
}

TEST_CASE("a run that does not fit into a limited address space is refused, and nothing is written", "[scene]") {
  if (is_address_sanitized()) return;  // which takes several times the memory, and all address space
  const Folder folder;
  const std::vector<std::string> arguments{"run", scene_path("dam_break.json"), "--set", "/grid/cells=[640,640]"};
  const ProgramOutput refused = output_of_program(folder / "", arguments, "ulimit -v 300000 && ");
  CHECK_THAT(refused.err, Catch::Contains("does not fit into memory") &&
                              Catch::Contains(" MB, left of the address space, ulimit -v\n"));
  CHECK(refused.code == 2);
  CHECK_FALSE(std::filesystem::exists(folder / "out"));
}
