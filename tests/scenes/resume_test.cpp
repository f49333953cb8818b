// A run that goes on from its checkpoint ends with the bytes of one that never stopped.

#include "support/build.hpp"
#include "support/folder.hpp"
#include "support/program.hpp"
#include "support/program_output.hpp"
#include "support/scene_run.hpp"

#include <catch2/catch.hpp>

#include <csignal>
#include <cstdlib>
#include <random>
#include <thread>

using namespace minamo;

namespace {

using CommandLine = std::vector<std::string>;

CommandLine run_of(const std::string& scene_name, const CommandLine& overrides) {
  CommandLine arguments{"run", scene_path(scene_name), "--threads", "1", "--quiet"};
  for (const std::string& assignment : overrides) arguments.insert(arguments.end(), {"--set", assignment});
  return arguments;
}

CommandLine with(CommandLine arguments, const CommandLine& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

/// What must come out byte for byte the same.
const CommandLine output{"history.csv", "fields.h5", "fields.xdmf", "scene.json", "checkpoint.h5"};

struct Case {
  std::string scene;
  CommandLine overrides;
};

const CommandLine coarse{"/grid/cells=[20, 20]", "/output/every=0.02", "/output/checkpoint=0.03"};

Case coarse_dam_break(const CommandLine& overrides) { return {"paper/dam_break_tpic.json", with(coarse, overrides)}; }

const std::string conforming = R"(/discretization={"scheme": "conforming"})";

Case coarse_conforming(const CommandLine& overrides) {
  return {"dam_break.json", with(with(coarse, {conforming}), overrides)};
}

const std::vector<Case> cases{
    coarse_dam_break({}),
    coarse_dam_break({R"(/transfer={"scheme": "flip"})", R"(/solver={"scheme": "umfpack"})"}),
    coarse_dam_break({R"(/time={"end": 5, "cfl": 0.5})", R"(/integrator={"scheme": "midpoint"})"}),
    coarse_dam_break({R"(/stabilization={"scheme": "oss"})", R"(/transfer={"scheme": "tpic2"})"}),
    coarse_dam_break({R"(/stabilization={"scheme": "vms"})", R"(/transfer={"scheme": "xpic", "order": 3})"}),
    // The first part ends with a row that has its turn, the second and the whole with one that has not.
    coarse_dam_break({"/output/history=5"}),
    coarse_dam_break({"/output/history=5", "/time/step=0.1", R"(/integrator={"scheme": "midpoint"})"}),
    coarse_dam_break({"/fluid/viscosity=5", R"(/volume={"scheme": "delta"})", R"(/integrator={"scheme": "midpoint"})"}),
    // Steps are rejected on both sides of the checkpoint.
    coarse_dam_break({"/time/step=0.1", R"(/integrator={"scheme": "midpoint"})"}),
    coarse_conforming({}),
    coarse_conforming({R"(/discretization/degree=3)", R"(/transfer={"scheme": "tpic2"})",
                       R"(/integrator={"scheme": "midpoint"})", R"(/volume={"scheme": "projection"})"}),
    coarse_conforming({R"(/time={"end": 5, "cfl": 0.5})", R"(/integrator={"scheme": "midpoint"})",
                       R"(/transfer={"scheme": "flip"})"}),
    coarse_conforming(
        {"/fluid/viscosity=50", R"(/transfer={"scheme": "apic"})", R"(/volume={"scheme": "projection"})"}),
    {"elliptical_drop.json", {"/grid/cells=[20, 20]", "/output/every=0.02"}},
    {"elliptical_drop.json", {"/grid/cells=[20, 20]", "/output/every=0.02", conforming}},
    {"dam_break_3d.json", {"/grid/cells=[14, 7, 14]", "/output/every=0.01", conforming}},
    {"poiseuille.json", {"/output/every=0.1"}},
    {"paddle.json", {"/output/every=0.02", "/grid/cells=[80, 15]"}},
    {"paddle.json", {"/output/every=0.02", "/grid/cells=[80, 15]", R"(/bodies/0/wall="separating")"}},
    {"wave_under_lid.json", {"/output/every=0.01", R"(/walls="separating")"}},
    {"mixer.json", {"/output/every=0.01", "/grid/cells=[20, 20]"}},
    {"floating_box.json", {"/output/every=0.01", "/grid/cells=[40, 20]"}},
    {"oscillating_drop.json", {"/output/every=0.01"}},
    {"tap.json", {"/output/every=0.02", "/grid/cells=[48, 32]"}},
    {"weir.json", {"/output/every=0.05", "/grid/cells=[80, 12]", "/time/step=0.01"}},
    {"dam_break_3d.json", {"/grid/cells=[14, 7, 14]", "/output/every=0.01"}},
    {"granular_slope.json", {"/output/every=0.02"}},
    {"lock_exchange.json", {"/grid/cells=[48, 8]", "/output/every=0.5"}},
};

}  // namespace

TEST_CASE("a run that goes on ends with the bytes of one that never stopped", "[scene]") {
  // All of them; under the sanitizers, where a start takes ten times as long, one in four.
  std::vector<Case> tried;
  for (std::size_t k = 0; k < cases.size(); k += is_address_sanitized() ? 4 : 1) tried.push_back(cases[k]);
  const Case of = GENERATE_COPY(from_range(tried));
  CAPTURE(of.scene, of.overrides);
  const Folder folder;
  const CommandLine run = run_of(of.scene, of.overrides);
  REQUIRE(run_program(with(run, {"--out", folder / "whole", "--steps", "12"})).code == 0);
  REQUIRE(run_program(with(run, {"--out", folder / "parts", "--steps", "5"})).code == 0);
  REQUIRE(run_program(with(run, {"--out", folder / "parts", "--steps", "9", "--resume"})).code == 0);
  REQUIRE(run_program(with(run, {"--out", folder / "parts", "--steps", "12", "--resume"})).code == 0);
  CHECK(differing_files(folder / "whole", folder / "parts", output).empty());
}

TEST_CASE("a run that is killed at any moment goes on to the bytes of one that was not", "[scene][long]") {
  // More of them by hand: MINAMO_KILLS=200 build/test/minamo_tests "a run that is killed at any moment*"
  const char* wanted = std::getenv("MINAMO_KILLS");
  const int kills = wanted != nullptr ? std::atoi(wanted) : 8;
  const Folder folder;
  const CommandLine coarse_and_short{"/grid/cells=[20, 20]", "/output/every=0.002", "/output/checkpoint=0.003",
                                     "/time/end=0.15"};
  const CommandLine run = GENERATE_COPY(run_of("paper/dam_break_tpic.json", coarse_and_short),
                                        run_of("dam_break.json", with(coarse_and_short, {conforming})));
  const auto begin = std::chrono::steady_clock::now();
  REQUIRE(run_program(with(run, {"--out", folder / "whole"})).code == 0);
  const std::chrono::duration<double> duration = std::chrono::steady_clock::now() - begin;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0, 1);
  int resumed = 0;
  for (int k = 0; k < kills; ++k) {
    std::filesystem::remove_all(folder / "parts");
    Program program(with(run, {"--out", folder / "parts"}));
    std::this_thread::sleep_for(share(random) * duration);
    program.send(SIGKILL);
    program.wait();
    CommandLine again = with(run, {"--out", folder / "parts"});
    if (std::filesystem::exists(folder / "parts/checkpoint.h5")) again.emplace_back("--resume");
    resumed += again.back() == "--resume" ? 1 : 0;
    REQUIRE(run_program(again).code == 0);
    const auto differing = differing_files(folder / "whole", folder / "parts", output);
    CAPTURE(k, differing);
    REQUIRE(differing.empty());
  }
  WARN(resumed << " of " << kills << " killed runs had a checkpoint and went on from it");
  CHECK(resumed > 0);
}

TEST_CASE("a run may go on to a later end", "[scene]") {
  const Folder folder;
  const CommandLine run = run_of("paper/dam_break_tpic.json", coarse);
  REQUIRE(run_program(with(run, {"--out", folder / "whole", "--set", "/time/end=0.05"})).code == 0);
  REQUIRE(run_program(with(run, {"--out", folder / "parts", "--set", "/time/end=0.03"})).code == 0);
  REQUIRE(run_program(with(run, {"--out", folder / "parts", "--set", "/time/end=0.05", "--resume"})).code == 0);
  CHECK(differing_files(folder / "whole", folder / "parts", output).empty());
}

TEST_CASE("a run that is complete is left alone", "[scene]") {
  const Folder folder;
  const CommandLine run =
      with(run_of("paper/dam_break_tpic.json", with(coarse, {"/time/end=0.005"})), {"--out", folder / "out"});
  REQUIRE(run_program(run).code == 0);
  const std::string before = text_of(folder / "out/summary.json");
  CommandLine aloud = with(run, {"--resume"});
  std::erase(aloud, "--quiet");
  const ProgramEnd again = run_program(aloud);
  CHECK(again.code == 0);
  CHECK_THAT(again.output, Catch::Contains("is complete"));
  CHECK(text_of(folder / "out/summary.json") == before);
}

TEST_CASE("what does not fit a checkpoint is refused, and nothing is changed", "[scene]") {
  const Folder folder;
  const CommandLine run = with(run_of("paper/dam_break_tpic.json", coarse), {"--out", folder / "out"});
  REQUIRE(run_program(with(run, {"--steps", "5"})).code == 0);
  CommandLine more{"--resume"};
  std::string message;
  SECTION("another scene: every difference, and no other") {
    more.insert(more.end(), {"--set", R"(/transfer={"scheme": "flip"})", "--set", "/fluid/density=900", "--set",
                             "/title=\"other\"", "--set", "/output/every=0.5"});
    message = "dam_break_tpic.json: /fluid/density: differs from the scene of the checkpoint\n"
              "  expected  1000 (number)\n  got       900 (number)\n";
  }
  SECTION("no checkpoint") {
    std::filesystem::remove(folder / "out/checkpoint.h5");
    message = "checkpoint.h5: no such checkpoint";
  }
  SECTION("no checkpoint, but another file") {
    std::ofstream(folder / "out/checkpoint.h5") << "a diary";
    message = "checkpoint.h5: is no checkpoint";
  }
  SECTION("half a checkpoint") {
    std::filesystem::resize_file(folder / "out/checkpoint.h5", 5000);
    message = "checkpoint.h5: is no checkpoint";
  }
  SECTION("no fields") {
    std::filesystem::remove(folder / "out/fields.h5");
    message = "fields.h5: is missing, or shorter than at the checkpoint";
  }
  SECTION("a shorter history") {
    std::filesystem::resize_file(folder / "out/history.csv", 600);
    message = "history.csv: is missing, or ends before the checkpoint";
  }
  const auto fields = text_of(folder / "out/fields.h5");
  const auto checkpoint = text_of(folder / "out/checkpoint.h5");
  const ProgramEnd end = run_program(with(run, more));
  CHECK(end.code == 2);
  CHECK_THAT(end.output, Catch::Contains(message));
  CHECK_THAT(end.output, !Catch::Contains("/title") && !Catch::Contains("/output"));
  CHECK(text_of(folder / "out/fields.h5") == fields);
  CHECK(text_of(folder / "out/checkpoint.h5") == checkpoint);
}
