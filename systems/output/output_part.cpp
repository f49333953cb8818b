#include "systems/bodies/bodies_part.hpp"
#include "systems/measure/acceptance.hpp"
#include "systems/output/body_fields.hpp"
#include "systems/output/fields.hpp"
#include "systems/output/history.hpp"
#include "systems/output/read_fields.hpp"
#include "systems/output/surface/level_set.hpp"
#include "systems/output/surface/write_surfaces.hpp"
#include "systems/scene/discretization.hpp"
#include "systems/scene/parts.hpp"
#include "systems/scene/time_counts.hpp"
#include "systems/step/memory.hpp"

namespace minamo {

namespace {

std::string read_surface(Input& input, int dimension) {
  const auto format =
      input.choice("surface", std::vector<std::string>{"none", "vtp", "ply", "vdb"},
                   "of every frame: lines or triangles for ParaView (vtp) or Blender (ply), or in 3-D a "
                   "level set (vdb, with OpenVDB)",
                   "none");
  if (format != "vdb") return format;
  if (dimension == 2) {
    input.problem("surface", "level sets are of scenes in 3-D", "vtp or ply in 2-D", shown(Json("vdb")));
  } else if (!can_write_level_sets()) {
    input.problem("surface", "this program was built without OpenVDB", "vtp or ply, or `tools/run --openvdb SCENE`",
                  shown(Json("vdb")));
  }
  return format;
}

OutputScene read_times(Input& input, int dimension, double end) {
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
  output.surface = read_surface(input, dimension);
  return output;
}

void add_surfaces(const Scene& scene, Recipe& recipe) {
  if (scene.output.surface == "none") return;
  recipe.constant(SurfaceOutput{surface_format_of(scene.output.surface), scene.grid.spacing / fewest_per_cell(scene)});
}

Contribution read_output(Input& input, Scene& scene) {
  FieldsChoice fields;
  input.object("output", "what is written when", Input::Presence::optional, [&](Input& in) {
    scene.output = read_times(in, scene.dimension, scene.time.end);
    check_output_times(in, scene.output, scene.time);
    fields = read_fields(in, scene);
  });
  return [fields](const Scene& of, Recipe& recipe) {
    recipe.constant(fields);
    recipe.constant(HistoryInterval{of.output.history});
    add_surfaces(of, recipe);
  };
}

}  // namespace

void add_output(SystemRegistry& registry) {
  registry.add<AcceptStep>("accept_step");
  registry.add<AcceptStepOnFaces>("accept_step_on_faces", OnRanks::adds_up);
  registry.add<NoteStep>("note_step", OnRanks::own);
  registry.add<WriteHistory>("write_history", OnRanks::first_rank_writes);
  registry.add<FlushHistory>("flush_history", OnRanks::first_rank_writes);
  registry.add<SamplePressure>("sample_pressure");
  registry.add<WriteFrame>("write_frame", OnRanks::first_rank_writes);
  registry.add<WriteBodies>("write_bodies", OnRanks::first_rank_writes);
  registry.add<WriteSurfaces>("write_surfaces", OnRanks::first_rank_writes);
  registry.add<WriteXdmf>("write_xdmf", OnRanks::first_rank_writes);
  registry.add(Part{"output", "what is written when", read_output});
}

}  // namespace minamo
