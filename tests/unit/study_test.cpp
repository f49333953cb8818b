#include "support/folder.hpp"
#include "support/scene_run.hpp"
#include "tools/program/history_reader.hpp"
#include "tools/program/study_others.hpp"
#include "tools/program/study_table.hpp"
#include "tools/program/study_variant.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

const std::string studies = std::string(MINAMO_SOURCE_DIR) + "/scenes/studies/";

/// A study of the Taylor-Green scene.
Study study_of(const std::string& vary, const std::string& further = "") {
  return read_study(
      parse_json(R"({"scene": "../taylor_green.json", "vary": )" + vary + further + R"(, "error": "velocity"})",
                 "study.json"),
      studies + "study.json");
}

std::vector<std::string> names_of(const Study& study) {
  std::vector<std::string> names;
  for (const Variant& variant : make_variants(study, registry())) names.push_back(variant.name);
  return names;
}

StudyRow row(const std::string& scheme, double cells, std::optional<double> error, double wall_seconds) {
  return {.values = {scheme, std::to_string(static_cast<int>(cells))},
          .resolution = cells,
          .error = error,
          .wall_seconds = wall_seconds,
          .status = error ? "done" : "failed"};
}

/// Two schemes; the resolutions of the first out of order, and one without an error between them.
StudyTable table() {
  return {.keys = {"/transfer/scheme", "cells"},
          .heads = {"transfer", "cells"},
          .resolution_at = 1,
          .cpu_model = "Abacus, 2 wires",
          .threads = 3,
          .rows = {row("pic", 64, 0.01, 8), row("pic", 16, 0.16, 1), row("pic", 32, {}, 2), row("tpic", 16, 0.05, 2),
                   row("tpic", 48, 0.05 / 9, 9)}};
}

template <class T>
std::vector<T> all(T Standing::*member) {
  std::vector<T> values;
  for (const Standing& standing : standings(table())) values.push_back(standing.*member);
  return values;
}

}  // namespace

TEST_CASE("the order is that against the next coarser variant of the same line that has an error", "[unit]") {
  const auto order = all(&Standing::order);
  CHECK(order[0].value() == Approx(2).epsilon(1e-15));  // a sixteenth of the error at four times the cells
  CHECK(order[4].value() == Approx(2).epsilon(1e-15));  // a ninth at three times
  CHECK_FALSE(order[1]);
  CHECK_FALSE(order[2]);
  CHECK_FALSE(order[3]);
}

TEST_CASE("on the frontier is who is not beaten in both time and error", "[unit]") {
  // pic 64 takes longer than tpic 16 but has a smaller error; tpic 48 has the smallest.
  CHECK(all(&Standing::on_frontier) == std::vector<bool>{true, true, false, true, true});
  StudyTable beaten = table();
  beaten.rows[0].wall_seconds = 10;
  CHECK_FALSE(standings(beaten)[0].on_frontier);
}

TEST_CASE("the rank is by time times error", "[unit]") {
  // 0.08, 0.16, none, 0.1, 0.05
  CHECK(all(&Standing::rank) == std::vector<std::optional<int>>{2, 4, {}, 3, 1});
}

TEST_CASE("study.csv has parameters first, empty fields where nothing is known, and quotes", "[unit]") {
  std::istringstream csv(as_csv(table()));
  std::vector<std::string> lines;
  for (std::string line; std::getline(csv, line);) lines.push_back(line);
  REQUIRE(lines.size() == 6);
  CHECK(lines[0] ==
        "/transfer/scheme,cells,error,order,wall_s,cpu_per_s,time_step,steps,particles,unknowns_max,cpu_model,threads,"
        "status,rank,frontier");
  CHECK(lines[1] == "pic,64,0.01,2.0000,8,0,0,0,0,0,\"Abacus, 2 wires\",3,done,2,1");
  CHECK(lines[3] == "pic,32,,,2,0,0,0,0,0,\"Abacus, 2 wires\",3,failed,,0");
}

TEST_CASE("the table has a line per variant, numbers under each other", "[unit]") {
  std::istringstream text(as_text(table()));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  REQUIRE(lines.size() == 6);
  CHECK(lines[0] == "transfer  cells  error [1]  order  wall [s]  steps  time x error rank  frontier  status");
  CHECK(lines[1] == "pic       64     1.000e-02   2.00         8      0                  2         *    done");
  CHECK(lines[3] == "pic       32             -      -         2      0                  -            failed");
}

TEST_CASE("cells along x give the counts with equal spacing", "[unit]") {
  CHECK(equal_cells({0, 0}, {2, 1}, 40) == std::vector<int>{40, 20});
  CHECK(equal_cells({-1, 0, 2}, {1, 3, 2.5}, 8) == std::vector<int>{8, 12, 2});
  // 0.584/0.146 is not 4 in floating point.
  CHECK(equal_cells({0, 0}, {0.584, 0.146}, 16) == std::vector<int>{16, 4});
}

TEST_CASE("cells along x that leave a fraction across are refused with the nearest counts", "[unit]") {
  const Study study = study_of(R"({"cells": [16, 21]})",
                               R"(, "set": {"/grid/high": [1, 0.5], "/particles/0/shape/box/high": [1, 0.5]})");
  CHECK_THROWS_WITH(make_variants(study, registry()),
                    Catch::Contains("variant cells21: /grid/cells: unequal spacing") &&
                        Catch::Contains("closest   [22, 11]"));
}

TEST_CASE("every combination is a variant with a name, the last parameter fastest", "[unit]") {
  CHECK(names_of(study_of(
            R"({"/transfer/scheme": ["pic", "flip"], "cells": [8, [16, 16]], "/particles/0/per_cell": [2]})")) ==
        std::vector<std::string>{"pic_cells8_per_cell2", "pic_cells_16_16_per_cell2", "flip_cells8_per_cell2",
                                 "flip_cells_16_16_per_cell2"});
}

TEST_CASE("objects are named after their scheme, and names stay apart", "[unit]") {
  const std::string vary = R"({"/transfer": [{"scheme": "flip", "blend": 0.9}, {"scheme": "flip"}],
                               "/title": ["a/b", "a b"]})";
  CHECK(names_of(study_of(vary)) ==
        std::vector<std::string>{"flip_blend_0.9_a_b", "flip_blend_0.9_a_b-2", "flip_a_b", "flip_a_b-2"});
}

TEST_CASE("heads of columns are the last word that tells them apart", "[unit]") {
  const std::vector<Json> one{1};
  CHECK(short_names({{"/transfer/scheme", one}, {"cells", one}, {"/particles/0/per_cell", one}}) ==
        std::vector<std::string>{"transfer", "cells", "per_cell"});
  CHECK(short_names({{"/particles/0/per_cell", one}, {"/particles/1/per_cell", one}}) ==
        std::vector<std::string>{"/particles/0/per_cell", "/particles/1/per_cell"});
}

TEST_CASE("the time step follows the varied numbers and replaces a CFL number", "[unit]") {
  const Study study = study_of(R"({"cells": [8, 16], "courant": [0.1, 0.2]})",
                               R"(, "set": {"/time": {"end": 1, "cfl": 0.5, "max_step": 1}}, "end": 0.5,
                                    "time_step": "courant/cells")");
  std::vector<double> steps;
  for (const Variant& variant : make_variants(study, registry())) {
    steps.push_back(variant.scene.scene.time.step.value());
    CHECK(variant.scene.scene.time.end == 0.5);
  }
  CHECK(steps == std::vector<double>{0.1 / 8, 0.2 / 8, 0.1 / 16, 0.2 / 16});
}

TEST_CASE("a mean of the history is linear between rows and leaves out what lies outside", "[unit]") {
  const Folder folder;
  std::ofstream(folder / "history.csv") << "step,time,a,b,c\n0,0,9,1,\n1,1,2,1,\n2,2,4,1,\n3,4,8,1,\n4,5,99,1,\n";
  const History history(folder / "history.csv");
  // a is 2, 4, 8 at 1, 2, 4: (3*1 + 6*2)/3 = 5.
  CHECK(history.mean("a", 1, 4) == Approx(5).epsilon(1e-15));
  CHECK(history.mean("2*a - b", 0.5, 4.5) == Approx(9).epsilon(1e-15));
  CHECK(history.mean("a", 3.9, 4.1) == 8);
  CHECK(std::isnan(history.mean("a", 2.5, 3.5)));
  CHECK(std::isnan(history.mean("c", 1, 4)));
}

TEST_CASE("errors are relative to what they should be", "[unit]") {
  const Folder folder;
  std::ofstream(folder / "history.csv") << "step,time,potential_energy\n0,0,10\n1,1,10\n";
  const Json summary = {{"errors", {{"velocity", 0.25}}}, {"conservation", {{"overlap_max", 0.5}}}};
  const auto error = [&](const ErrorMeasure& measure) {
    return error_of(measure, {folder / "", summary, 3.0}).value();
  };
  CHECK(error(ErrorOfSummary{"velocity"}) == 0.25);
  CHECK(error(ErrorOfSummary{"overlap"}) == 0.5);
  CHECK(error(ErrorOfHistory{"potential_energy", 8, 0, 1}) == Approx(0.25).epsilon(1e-15));
  CHECK(error(ErrorOfFarthest{4}) == Approx(0.25).epsilon(1e-15));
}

TEST_CASE("an error may be what a program prints of the folder", "[unit]") {
  const Folder folder;
  const auto error = [&](const std::string& script) {
    std::ofstream(folder / "it's.sh") << "#!/bin/sh\n" << script << '\n';
    std::filesystem::permissions(folder / "it's.sh", std::filesystem::perms::owner_all);
    return error_of(ErrorOfProgram{folder / "it's.sh", {"0.5", "a b"}, ""}, {folder / "run 1", {}, 0});
  };
  CHECK(error(R"([ "$2" = "a b" ] && [ "${3##*/}" = "run 1" ] && echo "$1")").value() == 0.5);
  CHECK_FALSE(error("echo nan").has_value());
  CHECK_THROWS_WITH(error("echo 1 2"), Catch::Contains("printed no number"));
  CHECK_THROWS_WITH(error("true"), Catch::Contains("printed no number"));
  CHECK_THROWS_WITH(error("echo 1; exit 3"), Catch::Contains("ended with code 3"));
}

TEST_CASE("by processor time frontier and rank are those of the other column", "[unit]") {
  StudyTable cheap = table();
  cheap.cost = Cost::cpu;
  for (StudyRow& row : cheap.rows) row.cpu_seconds = 10 - row.wall_seconds;
  const auto all = standings(cheap);
  CHECK(all[4].on_frontier);        // the least error is now the least cost
  CHECK_FALSE(all[0].on_frontier);  // which nothing else beats
  CHECK(all[4].rank == 1);
}

TEST_CASE("next to a point of others stands the cheapest variant that is at least as accurate", "[unit]") {
  const StudyTable ours = table();
  const auto pairs = at_equal_error(ours, {{"Abc", "fine", 20, 0.05}, {"Abc", "too fine", 20, 0.001}});
  REQUIRE(pairs.size() == 2);
  REQUIRE(pairs[0].ours == &ours.rows[3]);  // 2 s; both of the others within 0.05 take longer
  CHECK(pairs[1].ours == nullptr);
  CHECK(as_csv(ours, pairs) == "code,setting,transfer,cells,their error,our error,their cost,our cost,ratio\n"
                               "Abc,fine,tpic,16,0.05,0.05,20,2,10\n"
                               "Abc,too fine,-,-,0.001,-,20,-,-\n");
}

TEST_CASE("points of others are read by the names of their columns", "[unit]") {
  const std::string mark = GENERATE("", "\xef\xbb\xbf");  // of a spreadsheet
  const Folder folder;
  std::ofstream(folder / "others.csv") << mark << "error,particles,code,setting,cost\n0.1,800,Abc,40 x 40,2.5\n\n";
  const std::vector<OtherPoint> others = read_others(folder / "others.csv");
  REQUIRE(others.size() == 1);
  CHECK(others[0].code == "Abc");
  CHECK(others[0].setting == "40 x 40");
  CHECK(others[0].cost == 2.5);
  CHECK(others[0].error == 0.1);
}

TEST_CASE("the farthest particle is measured from the centre of mass", "[unit]") {
  SceneRun run(
      with(scene_of_file("paper/rotating_square_tpic.json"), {"/grid/cells=[20, 20]", "/particles/0/per_cell=2"}));
  // The outermost particles of the unit square are half a particle spacing, 1/16, inside its corners.
  CHECK(farthest_distance(run.world(), 2) == Approx(std::sqrt(2.0) * (0.5 - 1.0 / 16)).epsilon(1e-15));
}

// Particles of the coarsest grids are laid out; finer ones ask for more of the same.
TEST_CASE("every study next to the scenes is valid", "[unit][long]") {
  for (const auto& entry : std::filesystem::directory_iterator(studies)) {
    if (entry.path().extension() != ".json") continue;  // results lie next to the studies
    CAPTURE(entry.path().string());
    const Study study = read_study(entry.path().string());
    std::vector<Variant> variants;
    REQUIRE_NOTHROW(variants = read_variants(study, read_json(study.scene), registry()));
    const auto coarsest = std::min_element(variants.begin(), variants.end(), [](const Variant& a, const Variant& b) {
      return a.resolution < b.resolution;
    });
    for (const Variant& variant : variants) {
      if (variant.resolution == coarsest->resolution) CHECK_NOTHROW(rehearse(variant.scene.scene, variant.name));
    }
  }
}
