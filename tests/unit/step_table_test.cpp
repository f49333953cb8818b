/// \file
/// The tables of the step: rows, and what parts say of them.

#include "support/folder.hpp"
#include "support/scene_run.hpp"

#include "systems/step/exclusions.hpp"
#include "systems/step/step_table.hpp"

#include <catch2/catch.hpp>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <filesystem>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

const StepTable& either_table() { return GENERATE(0, 1) == 0 ? table_of_faces() : table_of_equal_order(); }

std::vector<std::string> names_in(const Scene& scene, std::string_view slot) {
  std::vector<std::string> names;
  for (const System& system : systems_of(scene, slot, When::step)) names.push_back(system.name);
  return names;
}

}  // namespace

TEST_CASE("the rows of the step are in the order of the slots, and name systems that are registered", "[unit]") {
  std::size_t last = 0;
  for (const Row& row : either_table().rows) {
    CAPTURE(row.slot, row.system);
    const auto slot =
        std::find_if(slots().begin(), slots().end(), [&](const Slot& one) { return one.name == row.slot; });
    if (slot != slots().end()) {
      const auto at = static_cast<std::size_t>(slot - slots().begin());
      CHECK(at >= last);
      last = at;
    }
    CHECK((row.system.front() == '<' || registry().contains(row.system)));
  }
}

TEST_CASE("what the built-in parts ask for has a row, so that their order is not the order of the step", "[unit]") {
  const Scene scene = read(scene_of_file(GENERATE("dam_break.json", "dam_break_3d.json")));
  for (const Recipe::Placed& placed : scene.recipe.placed()) {
    CAPTURE(placed.slot, placed.system.name);
    const auto& rows = table_of(scene).rows;
    CHECK(std::any_of(rows.begin(), rows.end(),
                      [&](const Row& row) { return row.slot == placed.slot && row.system == placed.system.name; }));
  }
}

TEST_CASE("what a part from outside adds comes behind the rows of its slot", "[unit]") {
  Scene scene = read(scene_of_file("dam_break.json"));
  std::vector<std::string> expected = names_in(scene, "advect");
  scene.recipe.add("advect", "measure_gauges", When::step);
  expected.emplace_back("measure_gauges");
  CHECK(names_in(scene, "advect") == expected);
}

TEST_CASE("a system that has a row stands there when a part adds it", "[unit]") {
  Scene scene = read(scene_of_file("dam_break.json"));
  scene.recipe.add("measure", "measure_gauges");
  const std::vector<std::string> names = names_in(scene, "measure");
  CHECK(std::find(names.begin(), names.end(), "measure_gauges") != names.end());
  scene.recipe.add("boundaries", "hold_faces");
  const std::vector<std::string> boundaries = names_in(scene, "boundaries");
  CHECK(std::count(boundaries.begin(), boundaries.end(), "hold_faces") == 1);
  CHECK(boundaries.front() == "hold_faces");
}

TEST_CASE("a part that fills a row that no table has is told", "[unit]") {
  Scene scene = read(scene_of_file("dam_break.json"));
  scene.recipe.fill("<p2g_velocty>", std::vector<std::string>{"p2g_faces_pic"});
  CHECK_THROWS_WITH(make_pipeline(scene), "no table of the step has the row <p2g_velocty>");
}

TEST_CASE("what excludes what: every row has a reason, and a broken scene that is told so", "[unit]") {
  const auto& row = GENERATE(from_range(exclusions()));
  CAPTURE(row.key, row.has.words, row.with.words);
  CHECK(!row.why.empty());
  const std::string told = fmt::format("{}: not with {}\n", row.key, row.with.words);
  bool is_told = false;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(MINAMO_SOURCE_DIR) / "tests" / "error")) {
    if (entry.path().extension() != ".txt") continue;
    is_told = is_told || text_of(entry.path()).find(told) != std::string::npos;
  }
  CHECK(is_told);
}
