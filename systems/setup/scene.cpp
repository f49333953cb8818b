#include "systems/setup/scene.hpp"

#include "systems/pipeline.hpp"
#include "systems/setup/scene_checks.hpp"
#include "systems/transfer/scheme.hpp"

#include <algorithm>

namespace minamo {

namespace {

GridScene read_grid(Input& grid, std::size_t dimension) {
  GridScene scene;
  scene.low = grid.numbers("low", dimension, {.unit = "m", .doc = "corner of the box"});
  scene.high = grid.numbers("high", dimension, {.unit = "m", .doc = "opposite corner of the box"});
  for (const auto count : grid.integers(
           "cells", dimension,
           {.doc = "cells per direction; the spacing must come out equal", .at_least = 3, .at_most = 1'000'000'000})) {
    scene.cells.push_back(static_cast<int>(count));
  }
  check_grid(grid, scene);
  return scene;
}

const std::vector<std::string> wall_names{"slip", "no_slip"};

std::array<Wall, 2> read_wall(Input& input, const std::string& key, const Json& value) {
  const Json sides = value.is_array() ? value : Json::array({value, value});
  std::array<Wall, 2> walls{Wall::slip, Wall::slip};
  if (sides.size() != 2) {
    input.problem(key, "wrong length", "one wall, or a list of two: low side, high side", shown(value));
    return walls;
  }
  for (std::size_t side = 0; side < 2; ++side) {
    const std::string name = sides[side].is_string() ? sides[side].get<std::string>() : "";
    if (std::find(wall_names.begin(), wall_names.end(), name) == wall_names.end()) {
      input.problem(key, "unknown wall", R"(one of ["slip", "no_slip"])", shown(sides[side]),
                    closest_name(name, wall_names));
    }
    walls[side] = name == "no_slip" ? Wall::no_slip : Wall::slip;
  }
  return walls;
}

/// "slip" for all sides, or per axis {"x": "slip", "y": ["no_slip", "slip"]}.
std::vector<std::array<Wall, 2>> read_walls(Input& input, std::size_t dimension) {
  const Json name{{"enum", wall_names}};
  const Json axis{{"oneOf", {name, {{"type", "array"}, {"items", name}, {"minItems", 2}, {"maxItems", 2}}}}};
  const Json schema{{"description", "for all sides, or per axis, or per axis [low side, high side]"},
                    {"oneOf",
                     {name,
                      {{"type", "object"},
                       {"properties", {{"x", axis}, {"y", axis}, {"z", axis}}},
                       {"additionalProperties", false}}}}};
  const Json walls = input.raw("walls", schema, "slip");
  std::vector<std::array<Wall, 2>> all(dimension, {Wall::slip, Wall::slip});
  if (!walls.is_object()) {
    std::fill(all.begin(), all.end(), read_wall(input, "walls", walls));
    return all;
  }
  const std::vector<std::string> axes = dimension == 2 ? std::vector<std::string>{"x", "y"}
                                                       : std::vector<std::string>{"x", "y", "z"};
  for (const auto& [key, value] : walls.items()) {
    const auto found = std::find(axes.begin(), axes.end(), key);
    if (found == axes.end()) {
      input.problem("walls/" + key, "unknown key", dimension == 2 ? "x or y" : "x, y or z", shown(value));
    } else {
      all[static_cast<std::size_t>(found - axes.begin())] = read_wall(input, "walls/" + key, value);
    }
  }
  return all;
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
                   read = Where{in.expression("where", scene_scope(scene.constants),
                                              {.doc = "particles wherever this is true"})};
                 }}});
  return read;
}

ParticleScene read_particles(Input& input, const Scene& scene) {
  ParticleScene particles;
  input.object("shape", "the region that is filled", Input::Presence::required, [&](Input& shape) {
    particles.shape = read_shape(shape, scene);
    check_shape(shape, particles.shape, scene.grid);
  });
  particles.per_cell = static_cast<int>(
      input.integer("per_cell", {.doc = "particles per cell and direction", .fallback = 2, .at_least = 1, .at_most = 16}));
  input.variant("arrangement", "where in a cell the particles start", "lattice",
                {{"lattice", [](Input&) {}}, {"jittered", [&](Input& in) {
                    particles.jitter = static_cast<std::uint64_t>(
                        in.integer("seed", {.doc = "of the random numbers", .fallback = 1, .at_least = 0}));
                  }}});
  particles.velocity =
      input.expressions("velocity", static_cast<std::size_t>(scene.dimension), scene_scope(scene.constants),
                        {.unit = "m/s", .doc = "initial velocity", .fallback = 0});
  return particles;
}

void read_method(Input& input, Scene& scene) {
  input.object("transfer", "transfer between particles and grid", Input::Presence::optional, [&](Input& transfer) {
    Input::Variants variants;
    for (const std::string& name : transfer_scheme_names()) {
      variants.emplace_back(name, [&, name](Input& in) {
        if (name != "flip") return;
        scene.flip_blend = in.number(
            "blend", {.doc = "share of FLIP, the rest is PIC", .fallback = 1, .at_least = 0, .at_most = 1});
      });
    }
    scene.transfer = transfer.variant("scheme", "transfer scheme", "tpic", variants);
  });
  input.object("integrator", "time integration", Input::Presence::optional, [&](Input& integrator) {
    scene.integrator = integrator.variant(
        "scheme", "integrator", "newmark",
        {{"midpoint", [](Input&) {}}, {"newmark", [&](Input& in) {
            scene.newmark_beta = in.number("beta", {.doc = "Newmark's beta", .fallback = 0.25, .at_most = 0.5, .above = 0});
            scene.newmark_gamma = in.number("gamma", {.doc = "Newmark's gamma", .fallback = 0.5, .at_least = 0.5, .at_most = 1});
          }}});
  });
  const auto scheme = [&](std::string_view key, std::string_view doc, const std::string& only) {
    std::string name;
    input.object(key, doc, Input::Presence::optional, [&](Input& in) {
      name = in.choice("scheme", std::vector<std::string>{only}, doc, only);
    });
    return name;
  };
  scene.stabilization = scheme("stabilization", "pressure stabilization", "pspg");
  scene.volume = scheme("volume", "volume correction", "none");
  scene.solver = scheme("solver", "linear solver", "umfpack");
}

TimeScene read_time(Input& input) {
  TimeScene time;
  time.end = input.number("end", {.unit = "s", .doc = "end of the run", .above = 0});
  input.one_of("a fixed step, or one from the CFL number",
               {{"step",
                 [&](Input& in) { time.step = in.number("step", {.unit = "s", .doc = "length of a step", .above = 0}); }},
                {"cfl", [&](Input& in) {
                   time.cfl = in.number("cfl", {.doc = "cells that the fastest particle crosses in a step", .above = 0});
                   time.max_step = in.optional_number("max_step", {.unit = "s", .doc = "longest step", .above = 0});
                 }}});
  return time;
}

OutputScene read_output(Input& input, double end) {
  const double fiftieth = end / 50;
  return {.every = input.number("every", {.unit = "s", .doc = "simulated time between frames; by default end/50",
                                          .fallback = fiftieth, .above = 0}),
          .checkpoint = input.optional_number(
              "checkpoint", {.unit = "s", .doc = "simulated time between checkpoints; none by default", .above = 0})};
}

void read_systems(Input& input, const SystemRegistry& registry, Scene& scene) {
  input.list("systems", "extra systems in the step", 0, [&](Input& extra, std::size_t) {
    const std::string use = extra.choice("use", registry.names(), "registered name of the system");
    const std::string after = extra.choice("after", slot_names(), "slot of the step that it follows");
    if (extra.describing() || !registry.contains(use)) return;
    scene.systems.push_back({registry.make(use, scene.dimension, &extra), after});
  });
}

}  // namespace

ExpressionScope scene_scope(const std::map<std::string, double>& constants) {
  return {{"x", "y", "z", "t"}, constants};
}

Scene read_scene(Input& input, const SystemRegistry& registry) {
  Scene scene;
  scene.title = input.text("title", {.doc = "shown in pictures and reports", .fallback = ""});
  scene.dimension = static_cast<int>(input.integer("dimension", {.doc = "2 or 3", .at_least = 2, .at_most = 3}));
  const auto dimension = static_cast<std::size_t>(scene.dimension);
  scene.constants = input.named_numbers("constants", "numbers that expressions may use by name");
  check_constants(input, scene.constants);
  input.object("grid", "the box and its cells", Input::Presence::required,
               [&](Input& grid) { scene.grid = read_grid(grid, dimension); });
  scene.walls = read_walls(input, dimension);
  input.object("fluid", "the liquid", Input::Presence::required, [&](Input& fluid) {
    scene.density = fluid.number("density", {.unit = "kg/m^3", .doc = "density", .above = 0});
    scene.viscosity = fluid.number("viscosity", {.unit = "Pa s", .doc = "dynamic viscosity; 0 is inviscid", .at_least = 0});
  });
  scene.body_force = input.expressions("body_force", dimension, scene_scope(scene.constants),
                                       {.unit = "m/s^2", .doc = "force per unit mass", .fallback = 0});
  input.list("particles", "regions filled with liquid", 1,
             [&](Input& particles, std::size_t) { scene.particles.push_back(read_particles(particles, scene)); });
  read_method(input, scene);
  input.object("time", "how far and how fast", Input::Presence::required,
               [&](Input& time) { scene.time = read_time(time); });
  input.object("output", "what is written when", Input::Presence::optional,
               [&](Input& output) { scene.output = read_output(output, scene.time.end); });
  read_systems(input, registry, scene);
  return scene;
}

}  // namespace minamo
