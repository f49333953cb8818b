/// \file
/// What `minamo check` tells of a run against the run.

#include "support/build.hpp"
#include "support/program_output.hpp"
#include "support/scene_run.hpp"
#include "tools/program/scene_file.hpp"

#include <catch2/catch.hpp>

#include <filesystem>

using namespace minamo;
using Catch::Matchers::Contains;

namespace {

namespace fs = std::filesystem;

/// A scene of scenes/ with another end, in a file of its own.
Json shortened(const std::string& name, double end, double every) {
  Json scene = read_json(std::string(MINAMO_SOURCE_DIR) + "/scenes/" + name);
  scene.erase("$schema");
  scene["time"]["end"] = end;
  scene["output"] = {{"every", every}};
  return scene;
}

Outlook outlook_before(const Json& scene) {
  return rehearse(understand_scene(scene, "a.json", scene_run::registry()).scene, "a.json").outlook;
}

double bytes_in(const std::string& folder) {
  double bytes = 0;
  for (const char* file : {"/fields.h5", "/fields.xdmf", "/history.csv", "/checkpoint.h5"})
    bytes += static_cast<double>(fs::file_size(folder + file));
  return bytes;
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

}  // namespace

TEST_CASE("steps, frames and disk are as check tells", "[scene]") {
  const auto [name, end, every] = GENERATE(table<std::string, double, double>({{"poiseuille.json", 0.2, 0.03},
                                                                               {"gate.json", 0.05, 0.002},
                                                                               {"bingham_film.json", 0.1, 0.01},
                                                                               {"drop_3d.json", 0.05, 0.01}}));
  CAPTURE(name);
  const Folder folder;
  const Json scene = shortened(name, end, every);
  const Outlook outlook = outlook_before(scene);
  std::ofstream(folder / "a.json") << scene.dump();
  REQUIRE(output_of_program(folder / "", {"run", "a.json", "--quiet", "--out", "out", "--threads", "1"}).code == 0);
  const Json summary = read_json(folder / "out/summary.json");
  CHECK(static_cast<double>(count_of(text_of(folder / "out/fields.xdmf"), "<Time ")) == outlook.frames);
  if (outlook.steps_are_known) CHECK(summary["steps"] == outlook.steps);
  if (!outlook.steps_are_known) CHECK(summary["steps"] <= 1.2 * outlook.steps);
  const double taken = bytes_in(folder / "out");
  CAPTURE(taken, outlook.disk_bytes);
  CHECK(outlook.disk_bytes > 0.7 * taken);
  CHECK(outlook.disk_bytes < 1.5 * taken);
}

TEST_CASE("check prints grid, step, frames, memory, disk and what limits the step, of every file", "[scene]") {
  const Folder folder;
  std::ofstream(folder / "a.json") << read_json(std::string(MINAMO_SOURCE_DIR) + "/scenes/dam_break.json").dump();
  Json fixed = shortened("dam_break_3d.json", 0.3, 0.02);
  std::ofstream(folder / "b.json") << fixed.dump();
  const ProgramOutput check = output_of_program(folder / "", {"check", "a.json", "b.json"});
  CHECK(check.code == 0);
  CHECK(check.err.empty());
  CHECK_THAT(check.out,
             Contains("a.json: valid, 1800 particles\n"
                      "  grid     40 x 40 cells of 0.0146 m, a box of 0.584 m x 0.584 m\n"
                      "  liquid   1800 particles\n"
                      "  step     0.00643 s at first, limited by waves of a liquid at rest; about 1.16e+03 steps at "
                      "3.38 m/s, after a fall through the box\n"
                      "  frames   101, one every 0.05 s up to 5 s\n"
                      "  memory   about ") &&
                 Contains("\n  disk     about "));
  CHECK_THAT(check.out, Contains("\nb.json: valid, 18522 particles\n"
                                 "  grid     28 x 14 x 28 cells of 0.0208571 m, a box of 0.584 m x 0.292 m x 0.584 m\n"
                                 "  liquid   18522 particles\n"
                                 "  step     0.002 s as given, 150 steps; at 3.38 m/s, after a fall through the box, "
                                 "0.32 cells a step\n"));
}

TEST_CASE("what limits the step is told by its name", "[scene]") {
  const auto [time, tension, viscosity, limit] = GENERATE(table<std::string, double, double, std::string>(
      {{R"({"end": 5})", 0, 10, "CFL number 1: the body force"},
       {R"({"end": 5})", 0, 1e-3, "waves of a liquid at rest"},
       {R"({"end": 1, "max_step": 1e-3})", 0, 10, "max_step"},
       {R"({"end": 0.1})", 0, 10, "the time from one frame to the next"},
       {R"({"end": 1})", 1, 10, "waves of surface tension"}}));
  Json scene = read_json(std::string(MINAMO_SOURCE_DIR) + "/scenes/dam_break.json");
  scene["time"] = Json::parse(time);
  scene.erase("output");
  scene["fluid"]["viscosity"] = viscosity;
  if (tension > 0) scene["surface_tension"] = {{"coefficient", tension}};
  CAPTURE(time, tension, viscosity);
  const Outlook outlook = outlook_before(scene);
  CHECK_THAT(outlook.limit, Contains(limit));
  scene["particles"][0]["velocity"] = {10, 0};
  if (limit.starts_with("CFL"))
    CHECK_THAT(outlook_before(scene).limit, Contains("CFL number 1: the fastest particle, 10 m/s"));
}

namespace {

/// Megabytes that messages say there are at most.
std::vector<double> limits_in(const std::string& text) {
  std::vector<double> limits;
  const std::string before = "at most ";
  for (auto at = text.find(before); at != std::string::npos; at = text.find(before, at + 1))
    limits.push_back(std::stod(text.substr(at + before.size())));
  return limits;
}

}  // namespace

TEST_CASE("check refuses what a run refuses for its memory, whatever file comes before", "[scene]") {
  if (is_address_sanitized()) return;  // which takes all address space
  const Folder folder;
  Json scene = read_json(std::string(MINAMO_SOURCE_DIR) + "/scenes/dam_break.json");
  const auto with_cells = [&](const char* name, int cells) {
    scene["grid"]["cells"] = {cells, cells};
    std::ofstream(folder / name) << scene.dump();
  };
  with_cells("small.json", 100);
  with_cells("large.json", 600);
  const std::string limit = "ulimit -v 400000 && ";
  const auto checked =
      limits_in(output_of_program(folder / "", {"check", "large.json", "small.json", "large.json"}, limit).err);
  const auto run = limits_in(output_of_program(folder / "", {"run", "large.json"}, limit).err);
  REQUIRE(checked.size() == 2);
  REQUIRE(run.size() == 1);
  CHECK(checked[0] == Approx(run[0]).epsilon(0.03));  // code and heap, a few megabytes
  CHECK(checked[1] == Approx(run[0]).epsilon(0.08));  // the threads of the file before keep stacks of 8 MB each
}
