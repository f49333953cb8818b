#include "systems/step/pipeline.hpp"

#include "systems/measure/force_work.hpp"
#include "systems/scene/discretization.hpp"

#include <algorithm>
#include <span>

namespace minamo {

namespace {

void append(std::vector<System>& systems, const std::vector<System>& more) {
  systems.insert(systems.end(), more.begin(), more.end());
}

/// The systems of a slot that run in every step, or in a standing one.
std::vector<System> in_slot(const Recipe& recipe, std::string_view slot, When list) {
  std::vector<System> systems;
  for (const Recipe::Placed& placed : recipe.placed()) {
    if (placed.slot == slot && (placed.when == When::always || placed.when == list)) systems.push_back(placed.system);
  }
  return systems;
}

std::vector<Slot>::const_iterator slot_named(std::string_view name) {
  return std::find_if(slots().begin(), slots().end(), [&](const Slot& slot) { return slot.name == name; });
}

/// The slot behind which all forces of a step and all that moves particles are known.
constexpr std::string_view last_that_moves = "volume";

/// Of slots one after the other.
std::vector<System> make_step(const Scene& scene, std::span<const Slot> of) {
  std::vector<System> step;
  for (const Slot& slot : of) {
    append(step, in_slot(scene.recipe, slot.name, When::step));
    for (const ExtraSystem& extra : scene.systems) {
      if (extra.after == slot.name) step.push_back(extra.system);
    }
    if (slot.name == last_that_moves && force_work_of(scene).is_by_force)
      step.push_back(scene.recipe.make(is_conforming(scene) ? "count_face_force_work" : "count_force_work"));
  }
  return step;
}

/// The slots `first` to `last`, as a standing step has them.
std::vector<System> standing_slots(const Recipe& recipe, std::string_view first, std::string_view last) {
  const auto end = slot_named(last) + 1;
  std::vector<System> systems;
  for (auto slot = slot_named(first); slot != end; ++slot) append(systems, in_slot(recipe, slot->name, When::standing));
  return systems;
}

std::vector<System> make_start(const Scene& scene) {
  const Recipe& recipe = scene.recipe;
  std::vector<System> start = recipe.first();
  if (force_work_of(scene).is_given) start.push_back(recipe.make("begin_energy_given"));
  const auto stand = [&](const System& configure, const std::vector<System>& after) {
    start.push_back(configure);
    append(start, standing_slots(recipe, "sort", "solve"));
    append(start, after);
  };
  for (const Recipe::StandingStep& step : recipe.standing_steps()) stand(step.configure, step.after);
  // The pressure that the first frame shows.
  stand(recipe.make("place_quadrature_step_ahead"), standing_slots(recipe, "accept", "record"));
  return start;
}

}  // namespace

Pipeline make_pipeline(const Scene& scene) {
  // No slot of a step without a row comes after one that it leaves out, so it has nothing to miss.
  const std::vector<System> always = make_step(scene, {slots().begin(), slot_named(record_slots)});
  return {make_start(scene), make_step(scene, slots()), always.size(), scene.recipe.output()};
}

}  // namespace minamo
