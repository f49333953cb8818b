#include "systems/output/history.hpp"

#include "support/folder.hpp"
#include "support/scene_run.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
  return parts;
}

/// The rows of the history of some steps, split into fields.
std::vector<std::vector<std::string>> history(const Json& scene, int steps) {
  const Folder folder;
  SceneRun run(scene);
  run.world().resource<HistoryFile>().file.open(folder / "history.csv");
  run.step(steps);
  run.world().resource<HistoryFile>().file.close();
  std::vector<std::vector<std::string>> rows;
  for (const std::string& line : split(text_of(folder / "history.csv"), '\n')) rows.push_back(split(line, ','));
  return rows;
}

Json small_scene() { return with(scene_of_file("dam_break.json"), {"/grid/cells=[20, 20]"}); }

constexpr std::size_t columns_2d = 14;

}  // namespace

TEST_CASE("the history in the plane has the columns of the interface", "[unit]") {
  CHECK(history_header<2>() ==
        "step,time,dt,kinetic_energy,potential_energy,momentum_x,momentum_y,angular_momentum,max_speed,"
        "max_divergence,overlap,active_nodes,iterations,residual");
}

TEST_CASE("the history in space has the columns of the interface", "[unit]") {
  CHECK(history_header<3>() ==
        "step,time,dt,kinetic_energy,potential_energy,momentum_x,momentum_y,momentum_z,angular_momentum_x,"
        "angular_momentum_y,angular_momentum_z,max_speed,max_divergence,overlap,active_nodes,iterations,residual");
}

TEST_CASE("the history has a row for the start and one per step", "[unit]") {
  const auto rows = history(small_scene(), 3);
  REQUIRE(rows.size() == 4);
  CHECK(rows[0][0] == "0");
  CHECK(rows[0][1] == "0");
  CHECK(rows[0][2] == "0");
  CHECK(rows[3][0] == "3");
  CHECK(rows[3][1] == "0.003");
  CHECK(rows[3][2] == "0.001");
  CHECK(std::all_of(rows.begin(), rows.end(), [](const auto& row) { return row.size() == columns_2d; }));
}

TEST_CASE("the history has an empty potential energy where the force varies in time", "[unit]") {
  const auto rows = history(with(small_scene(), {R"(/body_force=[0, "-9.81*t"])"}), 1);
  CHECK(rows.at(1).at(4).empty());
  CHECK(rows.at(1).size() == columns_2d);
}
