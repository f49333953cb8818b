#include "systems/bodies/bodies_part.hpp"
#include "systems/measure/acceptance.hpp"
#include "systems/output/body_fields.hpp"
#include "systems/output/fields.hpp"
#include "systems/output/history.hpp"
#include "systems/parts.hpp"
#include "systems/setup/discretization.hpp"
#include "systems/setup/memory.hpp"
#include "systems/surface/write_surfaces.hpp"

namespace minamo {

namespace {

OutputScene read_times(Input& input, double end) {
  Number every{.unit = "s", .doc = "simulated time between frames; by default end/50", .above = 0};
  OutputScene output;
  if (input.describing()) {
    input.optional_number("every", every);  // its default is not one number
  } else {
    every.fallback = end / 50;
    output.every = input.number("every", every);
  }
  output.checkpoint = input.optional_number(
      "checkpoint",
      {.unit = "s", .doc = "simulated time between checkpoints; by default at start and end alone", .above = 0});
  output.history = input.integer(
      "history",
      {.doc = "steps from one row of history.csv to the next; the last has one, too", .fallback = 1, .at_least = 1});
  output.surface = input.choice("surface", std::vector<std::string>{"none", "vtp", "ply"},
                                "of every frame: lines or triangles for ParaView (vtp) or Blender (ply)", "none");
  return output;
}

void add_surfaces(const Scene& scene, Recipe& recipe) {
  if (scene.output.surface == "none") return;
  recipe.constant(SurfaceOutput{scene.output.surface == "vtp" ? SurfaceFormat::vtp : SurfaceFormat::ply,
                                scene.grid.spacing / fewest_per_cell(scene)});
  recipe.add_output("write_surfaces");
}

Contribution read_output(Input& input, Scene& scene) {
  input.object("output", "what is written when", Input::Presence::optional,
               [&](Input& in) { scene.output = read_times(in, scene.time.end); });
  return [](const Scene& of, Recipe& recipe) {
    add_systems(of, recipe, "accept", {{"accept_step"}, {"accept_step_on_faces"}}, When::step);
    recipe.add("accept", "note_step");
    recipe.add("record", "write_history");
    recipe.constant(HistoryInterval{of.output.history});
    recipe.add_output("flush_history");
    recipe.add_output(is_conforming(of) ? "recover_pressure" : "sample_pressure");
    recipe.add_output("write_frame");
    if (of.facts.find<BodiesOfScene>()) recipe.add_output("write_bodies");
    add_surfaces(of, recipe);
    recipe.add_output("write_xdmf");
  };
}

}  // namespace

void add_output(SystemRegistry& registry) {
  registry.add<AcceptStep>("accept_step");
  registry.add<AcceptStepOnFaces>("accept_step_on_faces");
  registry.add<NoteStep>("note_step");
  registry.add<WriteHistory>("write_history");
  registry.add<FlushHistory>("flush_history");
  registry.add<SamplePressure>("sample_pressure");
  registry.add<WriteFrame>("write_frame");
  registry.add<WriteBodies>("write_bodies");
  registry.add<WriteSurfaces>("write_surfaces");
  registry.add<WriteXdmf>("write_xdmf");
  registry.add(Part{"output", "what is written when", read_output});
}

}  // namespace minamo
