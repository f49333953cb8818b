#include "systems/openings/openings_part.hpp"

#include "components/contact.hpp"
#include "systems/bodies/bodies_part.hpp"
#include "systems/openings/columns.hpp"
#include "systems/openings/faces.hpp"
#include "systems/openings/measures.hpp"
#include "systems/openings/particles.hpp"
#include "systems/openings/shares.hpp"
#include "systems/scene/parts.hpp"
#include "systems/scene/scene_checks.hpp"
#include "systems/transfer/scheme.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace minamo {

namespace {

/// What stands in an opening in addition to its name and its place.
struct Flow {
  OpeningKind kind = OpeningKind::free;
  std::vector<Expression> velocity;
  Expression rate;
  std::optional<Expression> level;
  Expression pressure;
  bool is_static = false;
  int per_cell = 2;
};

ExpressionScope of_place_and_time(const std::map<std::string, double>& constants) { return scene_scope(constants); }

std::vector<std::string> side_names(int dimension) {
  std::vector<std::string> names;
  for (int d = 0; d < dimension; ++d) {
    for (const char* end : {"low", "high"}) names.push_back(fmt::format("{}_{}", "xyz"[d], end));
  }
  return names;
}

/// A number that depends on time alone.
Expression read_of_time(Input& in, const std::string& key, const std::map<std::string, double>& constants,
                        const Number& rule) {
  const Expression value = in.expression(key, {{"t"}, constants}, rule);
  const auto text = in.text_at(key);
  // Evaluated with the places of the others next to it.
  return text && in.sound(key) ? Expression(*text, of_place_and_time(constants)) : value;
}

/// Levels are coordinates in the box.
void check_level(Input& in, const std::optional<Vertical>& vertical, const GridScene& grid, const Expression& level) {
  if (in.describing() || !in.sound("level")) return;
  if (!vertical) {
    in.problem("level", "no direction that is down", "a constant body force along one axis", "another one, or none");
    return;
  }
  if (!level.is_constant()) return;
  const double at = level(std::array<double, 4>{});
  const double low = grid.low[vertical->axis];
  const double high = grid.high[vertical->axis];
  if (at >= low && at <= high) return;
  in.problem("level", at < low ? "below the box" : "above the box",
             fmt::format("{} = {} ... {} m", "xyz"[vertical->axis], low, high), fmt::format("{} m", at));
}

/// What reading a flow takes, once for values, messages and schema.
struct FlowRules {
  int dimension = 2;
  std::map<std::string, double> constants;
  std::optional<Vertical> vertical;
  GridScene grid;
  int per_cell = 3;  ///< of the first region of particles, whose lattice what comes in goes on with
};

Flow read_inflow(Input& input, const FlowRules& rules) {
  Flow flow;
  const auto read_level = [&](Input& in) {
    flow.level = read_of_time(in, "level", rules.constants,
                              {.unit = "m", .doc = "coordinate of the surface outside, in t and constants"});
    check_level(in, rules.vertical, rules.grid, *flow.level);
  };
  const auto has_rate = input.has("rate") || input.has("velocity");
  Input::Variants variants{
      {"velocity",
       [&](Input& in) {
         flow.kind = OpeningKind::velocity;
         flow.velocity =
             in.expressions("velocity", static_cast<std::size_t>(rules.dimension), of_place_and_time(rules.constants),
                            {.unit = "m/s", .doc = "of what comes in, in place and t"});
         for (std::size_t d = 0; d < flow.velocity.size() && !in.describing(); ++d)
           check_coordinates(in, fmt::format("velocity/{}", d), flow.velocity[d], rules.dimension);
       }},
      {"rate", [&](Input& in) {
         flow.kind = OpeningKind::rate;
         flow.rate = read_of_time(in, "rate", rules.constants,
                                  {.unit = "m^3/s",
                                   .doc = "flow into the box, spread evenly; m^2/s in 2-D; in t and constants",
                                   .at_least = 0});
         if (in.has("level")) read_level(in);
       }}};
  if (!has_rate || input.describing()) {
    variants.emplace_back("level", [&](Input& in) {
      flow.kind = OpeningKind::level;
      read_level(in);
    });
  }
  input.one_of("what comes in: by velocity, by flow rate, or by the level outside", variants);
  flow.per_cell = static_cast<int>(input.integer(
      "per_cell", {.doc = "particles per cell and direction; by default those of the first region of particles",
                   .fallback = rules.per_cell,
                   .at_least = 1,
                   .at_most = 16}));
  return flow;
}

Flow read_pressure_outside(Input& input, const FlowRules& rules) {
  Flow flow;
  input.one_of("the pressure outside: of a level, or given",
               {{"level",
                 [&](Input& in) {
                   flow.kind = OpeningKind::level;
                   flow.level = read_of_time(in, "level", rules.constants,
                                             {.unit = "m", .doc = "coordinate of the surface outside, in t"});
                   check_level(in, rules.vertical, rules.grid, *flow.level);
                 }},
                {"pressure", [&](Input& in) {
                   flow.kind = OpeningKind::pressure;
                   flow.pressure = in.expression("pressure", of_place_and_time(rules.constants),
                                                 {.unit = "Pa", .doc = "outside, in place and t"});
                   if (!in.describing()) check_coordinates(in, "pressure", flow.pressure, rules.dimension);
                   const std::vector<std::string> kinds{"static", "total"};
                   flow.is_static = in.choice("kind", kinds,
                                              "total: of a reservoir at rest, less rho v^2/2 where liquid comes in; "
                                              "static: on the side itself",
                                              "total") == "static";
                 }}});
  flow.per_cell = static_cast<int>(input.integer(
      "per_cell",
      {.doc = "particles per cell and direction, of what flows back; by default those of the first region of particles",
       .fallback = rules.per_cell,
       .at_least = 1,
       .at_most = 16}));
  return flow;
}

Json outflow_schema() {
  auto description = Input::Document::describe();
  FlowRules rules;
  read_pressure_outside(description.root(), rules);
  Json schema = description.schema();
  schema.erase("$schema");
  return {
      {"description",
       R"("free", or the pressure outside: {"level": m} or {"pressure": Pa}, which is that of a reservoir at rest, )"
       R"(the total pressure; with {"kind": "static"} that on the side itself)"},
      {"oneOf", {{{"enum", {"free"}}}, schema}}};
}

/// "free", or an object. The problems of an object of its own are those of the scene at a place.
Flow read_outflow(Input& input, const FlowRules& rules) {
  const Json value = input.raw("outflow", outflow_schema(), "free");
  if (input.describing()) return Flow();
  if (!value.is_object()) {
    if (!value.is_string() || value.get<std::string>() != "free") {
      input.problem("outflow", value.is_string() ? "unknown name" : "wrong type",
                    R"("free", {"level": m} or {"pressure": Pa})", shown(value),
                    value.is_string() ? closest_name(value.get<std::string>(), std::vector<std::string>{"free"}) : "");
    }
    return Flow();
  }
  Input::Document document(value, "");
  document.root().use_constants(rules.constants);
  const Flow flow = read_pressure_outside(document.root(), rules);
  document.finish();
  for (const Problem& problem : document.problems())
    input.problem("outflow" + problem.pointer, problem.what, problem.expected, problem.got, problem.closest);
  return flow;
}

Flow read_flow(Input& input, const FlowRules& rules) {
  Flow flow;
  input.one_of("what the opening is for", {{"inflow",
                                            [&](Input& of) {
                                              of.object("inflow", "liquid comes in", Input::Presence::required,
                                                        [&](Input& in) { flow = read_inflow(in, rules); });
                                            }},
                                           {"outflow", [&](Input& of) { flow = read_outflow(of, rules); }}});
  return flow;
}

/// A constant body force along one axis.
std::optional<Vertical> vertical_of(const BodyForce& b) {
  std::optional<Vertical> vertical;
  for (std::size_t d = 0; d < b.of_place_and_time.size(); ++d) {
    if (!b.of_place_and_time[d].is_constant()) return {};
    const double force = b.of_place_and_time[d]({});
    if (force == 0) continue;
    if (vertical) return {};
    vertical = Vertical{d, force};
  }
  return vertical;
}

/// A velocity that is the same everywhere and always does not point out of the box.
template <int Dim>
void check_inflow(Input& input, const Opening<Dim>& opening, const std::string& side) {
  const std::size_t d = opening.side / 2;
  if (opening.velocity.size() != Dim || !opening.velocity[d].is_constant()) return;
  const double velocity = opening.velocity[d](std::array<double, 4>{});
  const bool is_low = opening.side % 2 == 0;
  if (is_low ? velocity >= 0 : velocity <= 0) return;
  input.problem(fmt::format("inflow/velocity/{}", d), "points out of the box",
                fmt::format("at {} 0 m/s at {}; what leaves is an outflow", is_low ? "least" : "most", side),
                fmt::format("{} m/s", velocity));
}

template <int Dim>
void read_opening(Input& input, Scene& scene, const FlowRules& rules, OpeningSet<Dim>& set,
                  std::vector<std::optional<Expression>>& where) {
  Opening<Dim> opening;
  opening.name = input.text("name", {.doc = "its columns are NAME_mass_in, NAME_energy_in, NAME_rate"});
  const std::vector<std::string> sides = side_names(Dim);
  const std::string side = input.choice("side", sides, "of the box", {});
  const auto region = input.optional_expression("where", of_place_and_time(scene.constants),
                                                {.doc = "the part of the side; without it, all of it"});
  if (region && !input.describing()) {
    check_coordinates(input, "where", *region, Dim);
    if (region->uses("t")) input.problem("where", "depends on t", "an expression in places and constants: it stays");
  }
  const Flow flow = read_flow(input, rules);
  if (input.describing()) return;
  if (input.sound("name")) check_column_name(input, opening.name, "opening", scene);
  const auto at = std::find(sides.begin(), sides.end(), side);
  if (!input.sound("side") || at == sides.end()) return;
  opening.side = static_cast<std::size_t>(at - sides.begin());
  if (scene.grid.periodic[opening.side / 2]) {
    input.problem("side", "periodic", fmt::format("a side with a wall: \"walls\" without periodic {}", side[0]), side);
    return;
  }
  opening.kind = flow.kind;
  opening.velocity = flow.velocity;
  opening.rate = flow.rate;
  opening.level = flow.level;
  opening.pressure = flow.pressure;
  opening.is_static = flow.is_static;
  opening.per_cell = flow.per_cell;
  check_inflow<Dim>(input, opening, side);
  set.openings.push_back(std::move(opening));
  where.push_back(region);
}

template <int Dim>
void seed_openings(OpeningSet<Dim> set, const std::vector<std::optional<Expression>>& where, const Scene& scene,
                   World& world, SeedProblems& problems) {
  const Grid<Dim>& grid = world.resource<Grid<Dim>>();
  const auto* bodies = scene.facts.find<BodiesOfScene>();
  find_shares<Dim>(
      set, where,
      {grid, world.resource<Splines<Dim>>(), world.resource<Walls<Dim>>(), bodies ? &bodies->of<Dim>() : nullptr},
      problems);
  // Whether a face is the liquid's to leave, or the opening's, both would say.
  for (std::size_t o = 0; o < set.openings.size() && world.has<SeparatingSides<Dim>>(); ++o) {
    const std::size_t side = set.openings[o].side;
    if (!world.resource<SeparatingSides<Dim>>().side[side / 2][side % 2]) continue;
    problems.note(fmt::format("/openings/{}/side", o), "not on a separating side", R"(a side with another wall)",
                  side_names(Dim)[side]);
  }
  world.resource<OpeningSet<Dim>>() = set;
  std::size_t columns = 0;
  world.resize<Openings>(set.openings.size());
  for (std::size_t o = 0; o < set.openings.size(); ++o) {
    columns += columns_of<Dim>(set.openings[o], grid);
    world.column<opening::MassIn>()[o] = 0;
    world.column<opening::EnergyIn>()[o] = 0;
    world.column<opening::Drift<Dim>>()[o].setZero();
  }
  world.resize<OpeningColumns>(columns);
  std::size_t k = 0;
  // As a lattice of the grid would go on outside.
  for (const Opening<Dim>& opening : set.openings) {
    for (const std::size_t end = k + columns_of<Dim>(opening, grid); k < end; ++k) {
      world.column<opening::Front>()[k] = -0.5 * opening.spacing(grid);
      world.column<opening::Speed>()[k] = 0;
    }
  }
}

void number_on(const Scene&, World& world, SeedProblems&) {
  world.resource<opening::NextId>().value = sum_over_ranks(static_cast<std::int64_t>(world.rows<Particles>()));
}

void seed_with_openings(const OpeningsOfScene& openings, const std::vector<std::optional<Expression>>& where,
                        const Scene& scene, Recipe& recipe) {
  with_dimension(scene.dimension, [&](auto dim) {
    constexpr int Dim = dim();
    recipe.seed([set = openings.of<Dim>(), where](const Scene& of, World& world, SeedProblems& problems) {
      seed_openings<Dim>(set, where, of, world, problems);
    });
  });
}

Contribution read_openings(Input& input, Scene& scene) {
  OpeningsOfScene openings;
  std::vector<std::optional<Expression>> where;
  const bool is_there = input.elements("openings").value_or(0) > 0;
  FlowRules rules{.dimension = scene.dimension, .constants = scene.constants, .vertical = {}, .grid = scene.grid};
  if (!scene.particles.empty() && !input.describing()) rules.per_cell = scene.particles.front().per_cell;
  if (const auto* force = scene.facts.find<BodyForce>()) rules.vertical = vertical_of(*force);
  input.list("openings", "where liquid comes in through sides of the box, or leaves", 0, [&](Input& in, std::size_t) {
    with_dimension(scene.dimension,
                   [&](auto dim) { read_opening<dim()>(in, scene, rules, openings.of<dim()>(), where); });
  });
  if (!is_there || input.describing()) return {};
  openings.in_plane.vertical = openings.in_space.vertical = rules.vertical;
  scene.facts.set(openings);
  return [openings, where](const Scene& of, Recipe& recipe) {
    seed_with_openings(openings, where, of, recipe);
    recipe.seed(number_on);
  };
}

}  // namespace

void add_openings(SystemRegistry& registry) {
  registry.add<OpenFaces>("open_faces", OnRanks::own);
  registry.add<HoldInflow>("hold_inflow", OnRanks::own);
  registry.add<LetIn>("let_in", OnRanks::alike_on_all);
  registry.add<GiveGradient>("give_gradient", OnRanks::own);
  registry.add<FillAtOpenings>("fill_at_openings", OnRanks::adds_up);
  registry.add<PassInflow>("pass_inflow", OnRanks::own);
  registry.add<PrescribeInflow>("prescribe_inflow", OnRanks::own);
  registry.add<PushAtOpenings>("push_at_openings", OnRanks::own);
  registry.add<RequireOutlet>("require_outlet", OnRanks::adds_up);
  registry.add<TakeOpeningVelocities>("take_opening_velocities", OnRanks::adds_up);
  registry.add<MoveColumns>("move_columns", OnRanks::alike_on_all);
  registry.add<LetOut>("let_out", OnRanks::adds_up);
  registry.add<MeasureOpenings>("measure_openings", OnRanks::adds_up);
  registry.add<MeasureOpeningsAtStart>("measure_openings_at_start", OnRanks::adds_up);
  registry.add(Part{"openings", "where liquid comes in through sides of the box, or leaves", read_openings});
}

}  // namespace minamo
