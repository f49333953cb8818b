// A history of every n-th step is part of the history of every step, and the run is the same.

#include "engine/storage/hdf5.hpp"
#include "support/folder.hpp"
#include "support/program.hpp"
#include "support/program_output.hpp"
#include "support/scene_run.hpp"

#include <catch2/catch.hpp>

using namespace minamo;

namespace {

using CommandLine = std::vector<std::string>;

const CommandLine small_and_checkpointed{"/grid/cells=[20, 20]", "/output/every=0.02", "/output/checkpoint=0.03"};

/// Runs a dam break into the folder. \return its summary
Json run_dam_break(const CommandLine& overrides, const std::string& steps, const std::string& folder) {
  CommandLine line{"run", scene_path("dam_break.json"), "--quiet", "--out", folder, "--steps", steps};
  for (const CommandLine& some : {small_and_checkpointed, overrides}) {
    for (const std::string& assignment : some) line.insert(line.end(), {"--set", assignment});
  }
  REQUIRE(run_program(line).code == 0);
  return Json::parse(text_of(folder + "/summary.json"));
}

CommandLine rows_of_file(const std::string& file) {
  std::istringstream text(text_of(file));
  CommandLine lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

/// The header, the rows of every n-th step and the last.
CommandLine thinned(const CommandLine& history, long every) {
  CommandLine rows{history.at(0)};
  for (std::size_t row = 1; row < history.size(); ++row) {
    if (std::stol(history[row]) % every == 0 || row + 1 == history.size()) rows.push_back(history[row]);
  }
  return rows;
}

/// The particles and the clock, byte for byte; not what the run remembers of its history.
std::map<std::string, std::vector<std::byte>> state_of(const std::string& folder) {
  const Hdf5File file(folder + "/checkpoint.h5", Hdf5File::Access::read);
  std::map<std::string, std::vector<std::byte>> state;
  for (const char* name : {"particle.position", "particle.velocity", "particle.velocity_gradient", "particle.id",
                           "clock", "step_control", "step.totals"}) {
    state[name] = file.read_bytes(std::string("/state/") + name);
  }
  return state;
}

/// But for the rise of energy, which only the rows see.
Json conserved(Json summary) {
  summary["conservation"].erase("energy_rise");
  return summary["conservation"];
}

}  // namespace

TEST_CASE("a history of every n-th step has those rows of one of every step, and the run is the same", "[property]") {
  const auto overrides = GENERATE(values<CommandLine>({
      {"/transfer={\"scheme\": \"tpic\"}"},
      {R"(/exact={"velocity": [0, 0], "pressure": 0})", R"(/probes=[{"name": "wall", "at": [0, 0.1]}])"},
      {R"(/time={"end": 5, "cfl": 0.5})", R"(/volume={"scheme": "none"})"},
      {"/time/step=0.1"},  // attempts are rejected
  }));
  const Folder folder;
  const Json of_all = run_dam_break(overrides, "12", folder / "all");
  for (const long every : {3, 5, 100}) {
    CAPTURE(overrides, every);
    const std::string some = folder / std::to_string(every);
    CommandLine thin = overrides;
    thin.push_back("/output/history=" + std::to_string(every));
    const Json of_some = run_dam_break(thin, "12", some);
    CHECK(rows_of_file(some + "/history.csv") == thinned(rows_of_file(folder / "all/history.csv"), every));
    CHECK(state_of(some) == state_of(folder / "all"));
    CHECK(text_of(some + "/fields.h5") == text_of(folder / "all/fields.h5"));
    CHECK(conserved(of_some) == conserved(of_all));
    for (const char* key : {"rejected_steps", "active_nodes_max", "unknowns_max", "errors", "steps", "time"}) {
      CAPTURE(key);
      CHECK(of_some[key] == of_all[key]);
    }
  }
}

TEST_CASE("systems that measure run in steps that the history has a row of", "[scene]") {
  const Folder folder;
  const Json summary = run_dam_break({"/output/history=5"}, "12", folder / "out");
  std::map<std::string, int> calls;
  for (const Json& system : summary["systems"]) calls[system["name"]] = system["calls"];
  for (const char* name : {"measure_energy", "measure_momentum", "measure_max_speed", "measure_face_divergence"}) {
    CHECK(calls[name] == 3);  // 5, 10, 12
  }
  CHECK(calls["write_history"] == 3);
  CHECK(calls["accept_step_on_faces"] == 12);
  CHECK(calls["advect_by_faces"] == 12);
}

TEST_CASE("a run may go on with a row for other steps", "[scene]") {
  const Folder folder;
  run_dam_break({"/output/history=4"}, "6", folder / "out");
  CommandLine line{"run", scene_path("dam_break.json"), "--quiet", "--out", folder / "out", "--steps", "9", "--resume"};
  for (const std::string& assignment : small_and_checkpointed) line.insert(line.end(), {"--set", assignment});
  REQUIRE(run_program(line).code == 0);
  std::string steps;
  for (const std::string& row : rows_of_file(folder / "out/history.csv")) steps += row.substr(0, row.find(',')) + " ";
  CHECK(steps == "step 0 4 7 8 9 ");
}
