#include "systems/setup/scene.hpp"

#include "systems/pipeline.hpp"
#include "systems/setup/scene_checks.hpp"
#include "systems/setup/scene_measure.hpp"
#include "systems/setup/scene_method.hpp"
#include "systems/setup/scene_walls.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace minamo {

namespace {

GridScene read_grid(Input& grid, std::size_t dimension) {
  GridScene scene;
  scene.low = grid.numbers("low", dimension, {.unit = "m", .doc = "corner of the box"});
  scene.high = grid.numbers("high", dimension, {.unit = "m", .doc = "opposite corner of the box"});
  for (const auto count : grid.integers(
           "cells", dimension,
           {.doc = "cells per direction; the spacing must come out equal", .at_least = 3, .at_most = 1'000'000})) {
    scene.cells.push_back(static_cast<int>(count));
  }
  if (grid.sound("low") && grid.sound("high") && grid.sound("cells")) check_grid(grid, scene);
  return scene;
}

/// A number or an expression per direction.
std::vector<Expression> read_vector(Input& input, const std::string& key, const Scene& scene, const Number& rule) {
  const auto dimension = static_cast<std::size_t>(scene.dimension);
  auto vector = input.expressions(key, dimension, scene_scope(scene.constants, scene.ode), rule);
  for (std::size_t d = 0; d < dimension; ++d) {
    check_coordinates(input, fmt::format("{}/{}", key, d), vector[d], scene.dimension);
  }
  return vector;
}

std::variant<Box, Ball, Where> read_shape(Input& shape, const Scene& scene) {
  const auto dimension = static_cast<std::size_t>(scene.dimension);
  std::variant<Box, Ball, Where> read;
  shape.one_of("a box, a ball, or an expression",
               {{"box",
                 [&](Input& in) {
                   in.object("box", "box with sides along the axes", Input::Presence::required, [&](Input& box) {
                     read = Box{box.numbers("low", dimension, {.unit = "m", .doc = "corner"}),
                                box.numbers("high", dimension, {.unit = "m", .doc = "opposite corner"})};
                   });
                 }},
                {"ball",
                 [&](Input& in) {
                   in.object("ball", "disc or ball", Input::Presence::required, [&](Input& ball) {
                     read = Ball{ball.numbers("center", dimension, {.unit = "m", .doc = "center"}),
                                 ball.number("radius", {.unit = "m", .doc = "radius", .above = 0})};
                   });
                 }},
                {"where", [&](Input& in) {
                   read = Where{in.expression("where", scene_scope(scene.constants, scene.ode),
                                              {.doc = "particles wherever this is true"})};
                   check_coordinates(in, "where", std::get<Where>(read).inside, scene.dimension);
                 }}});
  return read;
}

ParticleScene read_particles(Input& input, const Scene& scene) {
  ParticleScene particles;
  input.object("shape", "the region that is filled", Input::Presence::required, [&](Input& shape) {
    particles.shape = read_shape(shape, scene);
    check_shape(shape, particles.shape, scene.grid);
  });
  particles.per_cell = static_cast<int>(input.integer(
      "per_cell", {.doc = "particles per cell and direction", .fallback = 2, .at_least = 1, .at_most = 16}));
  if (input.sound("shape") && input.sound("per_cell")) check_particle_count(input, particles, scene.grid);
  input.variant("arrangement", "where in a cell the particles start", "lattice",
                {{"lattice", [](Input&) {}},
                 {"jittered", [&](Input& in) {
                    particles.jitter = static_cast<std::uint64_t>(
                        in.integer("seed", {.doc = "of the random numbers", .fallback = 1, .at_least = 0}));
                  }}});
  particles.velocity = read_vector(input, "velocity", scene, {.unit = "m/s", .doc = "initial velocity", .fallback = 0});
  return particles;
}

TimeScene read_time(Input& input) {
  TimeScene time;
  time.end = input.number("end", {.unit = "s", .doc = "end of the run", .above = 0});
  input.one_of(
      "a fixed step, or one from the CFL number",
      {{"step",
        [&](Input& in) { time.step = in.number("step", {.unit = "s", .doc = "length of a step", .above = 0}); }},
       {"cfl", [&](Input& in) {
          time.cfl = in.number("cfl", {.doc = "cells that the fastest particle crosses in a step", .above = 0});
          time.max_step = in.optional_number("max_step", {.unit = "s", .doc = "longest step", .above = 0});
        }}});
  return time;
}

OutputScene read_output(Input& input, double end) {
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
  return output;
}

void read_systems(Input& input, const SystemRegistry& registry, Scene& scene) {
  constexpr std::size_t most = 100;  // where each could stand is found by trying
  if (const auto count = input.elements("systems"); count > most)
    input.problem("systems", "too many", fmt::format("at most {}", most), std::to_string(*count));
  input.list("systems", "extra systems in the step", 0, [&](Input& extra, std::size_t) {
    const std::string use = extra.known_name("use", registry.names(), "name of the system, see `minamo list systems`");
    const std::string after = extra.choice("after", slot_names(), "slot of the step that it follows");
    if (extra.describing() || !extra.sound("use")) return;
    scene.systems.push_back({registry.make(use, scene.dimension, &extra), after});
  });
}

}  // namespace

ExpressionScope scene_scope(const std::map<std::string, double>& constants, const std::vector<OdeScene>& ode) {
  ExpressionScope scope{{"x", "y", "z", "t"}, constants};
  for (const OdeScene& variable : ode) scope.variables.push_back(variable.name);
  return scope;
}

namespace {

/// The dimension. Where the key is missing or wrong, that of the grid, so that its lists are not blamed as well.
int read_dimension(Input& input) {
  const auto dimension = input.integer(
      "dimension", {.doc = "of space, and the length of every list of coordinates", .at_least = 2, .at_most = 3});
  if (input.sound("dimension")) return static_cast<int>(dimension);
  return input.elements("grid/low") == 3 ? 3 : 2;
}

/// \param described  the dimension in description mode, where the document does not tell.
Scene read_scene(Input& input, const SystemRegistry& registry, std::optional<int> described) {
  Scene scene;
  input.optional_text("$schema", "JSON Schema of scenes, for editors; a run takes no notice");
  scene.title = input.text("title", {.doc = "shown in pictures and reports", .fallback = ""});
  scene.dimension = read_dimension(input);
  if (described) scene.dimension = *described;
  const auto dimension = static_cast<std::size_t>(scene.dimension);
  scene.constants = input.named_numbers("constants", "numbers that expressions may use by name");
  check_constants(input, scene.constants);
  input.use_constants(scene.constants);
  scene.ode = read_ode(input, scene.constants);
  input.object("grid", "the box and its cells", Input::Presence::required,
               [&](Input& grid) { scene.grid = read_grid(grid, dimension); });
  scene.walls = read_walls(input, scene.grid.cells);
  input.object("fluid", "the liquid", Input::Presence::required, [&](Input& fluid) {
    scene.density = fluid.number("density", {.unit = "kg/m^3", .doc = "density", .above = 0});
    scene.viscosity =
        fluid.number("viscosity", {.unit = "Pa s", .doc = "dynamic viscosity; 0 is inviscid", .at_least = 0});
  });
  scene.body_force =
      read_vector(input, "body_force", scene, {.unit = "m/s^2", .doc = "force per unit mass", .fallback = 0});
  input.list("particles", "regions filled with liquid", 1,
             [&](Input& particles, std::size_t) { scene.particles.push_back(read_particles(particles, scene)); });
  read_method(input, registry, scene);
  input.object("time", "how far and how fast", Input::Presence::required,
               [&](Input& time) { scene.time = read_time(time); });
  input.object("output", "what is written when", Input::Presence::optional,
               [&](Input& output) { scene.output = read_output(output, scene.time.end); });
  scene.exact = read_exact(input, scene);
  scene.probes = read_probes(input, scene);
  read_systems(input, registry, scene);
  return scene;
}

}  // namespace

Scene read_scene(Input& input, const SystemRegistry& registry) { return read_scene(input, registry, {}); }

void describe_scene(Input& input, const SystemRegistry& registry) {
  for (const int dimension : {2, 3}) read_scene(input, registry, dimension);
}

bool has_body_force(const Scene& scene) {
  return std::any_of(scene.body_force.begin(), scene.body_force.end(),
                     [](const Expression& b) { return !b.is_constant() || b({}) != 0; });
}

bool has_uniform_force(const Scene& scene) {
  return std::none_of(scene.body_force.begin(), scene.body_force.end(),
                      [](const Expression& b) { return b.uses("x") || b.uses("y") || b.uses("z"); });
}

}  // namespace minamo
