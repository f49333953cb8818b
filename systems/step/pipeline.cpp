#include "systems/step/pipeline.hpp"

#include "systems/measure/force_work.hpp"
#include "systems/scene/discretization.hpp"
#include "systems/scene/schemes.hpp"
#include "systems/step/step_table.hpp"

#include <algorithm>
#include <span>

namespace minamo {

namespace {

void append(std::vector<System>& systems, const std::vector<System>& more) {
  systems.insert(systems.end(), more.begin(), more.end());
}

std::vector<Slot>::const_iterator slot_named(std::string_view name) {
  return std::find_if(slots().begin(), slots().end(), [&](const Slot& slot) { return slot.name == name; });
}

/// The slot behind which all forces of a step and all that moves particles are known.
constexpr std::string_view last_that_moves = "volume";

ForceWork force_work(const Scene& scene) {
  std::vector<System> systems;
  for (const Slot& slot : slots()) {
    for (const When list : {When::step, When::standing}) append(systems, systems_of(scene, slot.name, list));
  }
  return force_work_of(scene, systems);
}

/// Of slots one after the other.
std::vector<System> make_step(const Scene& scene, std::span<const Slot> of, const ForceWork& work) {
  std::vector<System> step;
  for (const Slot& slot : of) {
    append(step, systems_of(scene, slot.name, When::step));
    for (const ExtraSystem& extra : scene.systems) {
      if (extra.after == slot.name) step.push_back(extra.system);
    }
    if (slot.name == last_that_moves && work.is_by_force)
      step.push_back(scene.recipe.make(is_conforming(scene) ? "count_face_force_work" : "count_force_work"));
  }
  return step;
}

/// The slots `first` to `last`, as a standing step has them.
std::vector<System> standing_slots(const Scene& scene, std::string_view first, std::string_view last) {
  const auto end = slot_named(last) + 1;
  std::vector<System> systems;
  for (auto slot = slot_named(first); slot != end; ++slot)
    append(systems, systems_of(scene, slot->name, When::standing));
  return systems;
}

std::vector<System> make_start(const Scene& scene, const ForceWork& work) {
  const Recipe& recipe = scene.recipe;
  std::vector<System> start = systems_of(scene, "start", When::always);
  if (work.is_given) start.push_back(recipe.make("begin_energy_given"));
  const auto stand = [&](const System& configure, const std::vector<System>& after) {
    start.push_back(configure);
    append(start, standing_slots(scene, "sort", "solve"));
    append(start, after);
  };
  for (const StandingRow& row : table_of(scene).standing) {
    if (!holds(row.all, scene)) continue;
    std::vector<System> after;
    for (const std::string& system : row.after) append(after, systems_named(scene, system, When::standing));
    stand(recipe.make(scene.facts.get<IntegratorNeeds>().also_configured), after);
  }
  for (const Recipe::StandingStep& step : recipe.standing_steps()) stand(step.configure, step.after);
  // The pressure that the first frame shows.
  stand(recipe.make("place_quadrature_step_ahead"), standing_slots(scene, "accept", "record"));
  return start;
}

}  // namespace

Pipeline make_pipeline(const Scene& scene) {
  require_rows(scene.recipe);
  const ForceWork work = force_work(scene);
  // No slot of a step without a row comes after one that it leaves out, so it has nothing to miss.
  const auto record = slot_named(record_slots);
  std::vector<System> step = make_step(scene, {slots().begin(), record}, work);
  const std::size_t always = step.size();
  append(step, make_step(scene, {record, slots().end()}, work));
  std::vector<System> output = systems_of(scene, "output", When::always);
  append(output, scene.recipe.output());
  return {make_start(scene, work), std::move(step), always, std::move(output)};
}

}  // namespace minamo
