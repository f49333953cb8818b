#include "systems/output/history.hpp"

#include "support/folder.hpp"
#include "support/scene_run.hpp"

#include <catch2/catch.hpp>
#include <spdlog/fmt/fmt.h>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
  return parts;
}

/// The lines of the history of some steps, split into fields; the header is the first.
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

Json few_cells() { return with(scene_of_file("paper/dam_break_tpic.json"), {"/grid/cells=[20, 20]"}); }

constexpr std::size_t columns_2d = 14;

}  // namespace

TEST_CASE("the history in 2-D has the columns of the interface", "[unit]") {
  CHECK(history_header<2>({}) ==
        "step,time,dt,kinetic_energy,potential_energy,momentum_x,momentum_y,angular_momentum,max_speed,"
        "max_divergence,overlap,active_nodes,iterations,residual");
}

TEST_CASE("the history in 3-D has the columns of the interface", "[unit]") {
  CHECK(history_header<3>({}) ==
        "step,time,dt,kinetic_energy,potential_energy,momentum_x,momentum_y,momentum_z,angular_momentum_x,"
        "angular_momentum_y,angular_momentum_z,max_speed,max_divergence,overlap,active_nodes,iterations,residual");
}

TEST_CASE("the history has a row for the start and one per step", "[unit]") {
  const auto rows = history(few_cells(), 3);
  REQUIRE(rows.size() == 5);
  CHECK(rows[0][0] == "step");
  CHECK(rows[1][0] == "0");
  CHECK(rows[1][1] == "0");
  CHECK(rows[1][2] == "0");
  CHECK(rows[4][0] == "3");
  CHECK(rows[4][1] == "0.003");
  CHECK(rows[4][2] == "0.001");
  CHECK(std::all_of(rows.begin(), rows.end(), [](const auto& row) { return row.size() == columns_2d; }));
}

TEST_CASE("the history has an empty potential energy where the force varies in time", "[unit]") {
  const auto rows = history(with(few_cells(), {R"(/body_force=[0, "-9.81*t"])"}), 1);
  CHECK(rows.at(2).at(4).empty());
  CHECK(rows.at(2).size() == columns_2d + 1);
  CHECK(rows.at(0).back() == "energy_balance");
}

TEST_CASE("probes come after the columns of every history, errors last", "[unit]") {
  const auto rows = history(with(few_cells(), {R"(/exact={"velocity": [0, 0], "pressure": 0})",
                                               R"(/probes=[{"name": "wall", "at": [0, 0.1]}])"}),
                            1);
  const std::vector<std::string> further(rows.at(0).begin() + columns_2d, rows.at(0).end());
  CHECK(further == std::vector<std::string>{"wall_pressure", "wall_velocity_x", "wall_velocity_y", "error_velocity",
                                            "error_pressure"});
  CHECK(std::all_of(rows.begin(), rows.end(), [](const auto& row) { return row.size() == columns_2d + 5; }));
}

TEST_CASE("errors end with what is known of the exact solution, and the totals keep the last", "[unit]") {
  SceneRun run(with(few_cells(), {R"(/exact={"velocity": [0, 0], "pressure": 0, "until": 0.0015})"}));
  const Folder folder;
  run.world().resource<HistoryFile>().file.open(folder / "history.csv");
  run.step(2);
  run.world().resource<HistoryFile>().file.close();
  const auto lines = split(text_of(folder / "history.csv"), '\n');
  CHECK_THAT(lines.at(3), Catch::EndsWith(",,"));  // at 2 ms, after 0, 1 ms
  const auto last_known = split(lines.at(2), ',');
  const RunTotals& totals = run.world().resource<RunTotals>();
  CHECK(last_known.at(columns_2d) == fmt::format("{}", totals.error_velocity));
  CHECK(last_known.at(columns_2d + 1) == fmt::format("{}", totals.error_pressure));
  CHECK(totals.error_pressure > 0);
}

TEST_CASE("a column that the header does not have ends the run", "[error]") {
  SceneRun run(few_cells());
  run.step();
  run.world().resource<measure::Columns>().set("enstrophy", 1);
  CHECK_THROWS_WITH(run.step(), Catch::Contains("column enstrophy of history.csv was not measured at the start"));
}

TEST_CASE("a history is cut behind whole rows", "[unit]") {
  const Folder folder;
  const auto [text, rows, left, found] =
      GENERATE(table<std::string, int, std::string, int>({{"h\n1\n2\n3\n", 2, "h\n1\n2\n", 2},
                                                          {"h\n1\n2\n", 2, "h\n1\n2\n", 2},
                                                          {"h\n1\n2", 2, "h\n1\n", 1},
                                                          {"h\n1\n", 5, "h\n1\n", 1},
                                                          {"h", 5, "", -1},
                                                          {"", 0, "", -1}}));
  CAPTURE(text, rows);
  std::ofstream(folder / "history.csv") << text;
  CHECK(cut_history(folder / "history.csv", rows) == found);
  CHECK(text_of(folder / "history.csv") == left);
}
